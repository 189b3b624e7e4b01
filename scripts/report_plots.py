# SPDX-License-Identifier: LGPL-2.1-or-later
"""The plots of a report, as SVG: one legend for each figure, the same colour for a method in all of them."""
import html
import io
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib import ticker

from report_study import has_failed, length_unit, number, shown, values

MOST_BARS = 40  # of a figure; then sweeps part them into figures
HEIGHT = 3.1  # of the axes of a figure, in inches
CROSS = {"linestyle": "", "marker": "x", "markersize": 8, "markeredgewidth": 2}
plt.rcParams.update({"font.size": 9.5, "axes.titlesize": 10, "legend.fontsize": 9.5, "axes.linewidth": 0.8,
                     "axes.spines.top": False, "axes.spines.right": False, "lines.linewidth": 1.4,
                     "lines.markersize": 5, "svg.hashsalt": "softcell", "axes.grid": True, "grid.color": "#dddddd",
                     "grid.linewidth": 0.5, "axes.axisbelow": True})


class Axis:
    """A column as the abscissa or ordinate of a plot."""

    def __init__(self, column, label, factor=1, integer=False):
        self.column, self.label, self.factor, self.integer = column, label, factor, integer

    def value(self, row):
        found = number(row, self.column)
        return None if found is None else found * self.factor

    def set_up(self, axis, numbers, is_log=True):
        axis.set_label_text(self.label)
        if self.integer or not is_log:
            axis.set_major_locator(ticker.MaxNLocator(6, integer=self.integer))
            return
        axis.axes.set_xscale("log") if axis.axis_name == "x" else axis.axes.set_yscale("log")
        marks = sorted({float(f"{n:.3g}") for n in numbers})
        decades = math.log10(marks[-1] / marks[0])
        if self.column == "cell_size" and len(marks) <= 6:
            axis.set_major_locator(ticker.FixedLocator(marks))
        else:
            subs = ((1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8) if decades < 0.4 else (1, 1.5, 2, 3, 4, 6) if decades < 1.1
                    else (1, 2, 5) if decades < 2 else (1,))
            axis.set_major_locator(ticker.LogLocator(subs=subs, numticks=20))
        axis.set_minor_locator(ticker.LogLocator(subs=range(1, 10), numticks=20))
        axis.set_major_formatter(tick)
        axis.set_minor_formatter(ticker.NullFormatter())


DOFS, LEVELS = Axis("dofs", "unknowns"), Axis("cut_levels", "cut levels", integer=True)
SECONDS, ASSEMBLY = Axis("total_s", "time to the solution, s"), Axis("assembly_s", "one tangent assembly, s")
L2, H1, STRESS = (Axis(f"relative_{c}_error", f"relative error {what}, %", 100)
                  for c, what in (("l2", "in L2"), ("h1", "in H1"), ("stress", "of the stress")))
STEPS, REACHED = Axis("load_steps", "load steps", integer=True), Axis("load_factor", "share of the load reached")
NEWTON, LINEAR = (Axis(f"{n.lower()}_iterations", f"{n} iterations", integer=True) for n in ("Newton", "linear"))


def tick(value, _=None):
    """1, 2, 50, 0.03, 2·10⁵."""
    if 1e-3 <= abs(value) < 1e4 or value == 0:
        return f"{value:g}"
    power = math.floor(math.log10(abs(value)) + 1e-9)
    factor = f"{value / 10**power:.3g}"
    return ("" if factor == "1" else factor + r"$\cdot$") + f"$10^{{{power}}}$"


def slope_triangle(axes, order, place):
    """A triangle whose side falls like h^order, in the lower right corner; the place counts from there to the left."""
    (left, right), (low, high) = (tuple(map(math.log10, limits())) for limits in (axes.get_xlim, axes.get_ylim))
    width = min(0.2 * (right - left), 0.4 * (high - low) / order)
    x, y = right - (0.06 + 0.32 * place) * (right - left) - width, low + 0.04 * (high - low)
    axes.fill([10**x, 10**(x + width), 10**(x + width)], [10**y, 10**y, 10**(y + order * width)], facecolor="#eeeeee",
              edgecolor="#555555", linewidth=0.9)
    axes.annotate(f"{order}", (10**(x + width), 10**(y + order * width / 2)), xytext=(3, 0), color="#333333",
                  textcoords="offset points", va="center")
    axes.set_xlim(10**left, 10**right)
    axes.set_ylim(10**low, 10**high)


def finished(figure, panels, caption, height=HEIGHT):
    """The figure as SVG with a single legend below and a caption."""
    entries = {}
    for axes in panels:
        entries.update(reversed(pair) for pair in zip(*axes.get_legend_handles_labels()))
    width = figure.get_figwidth()
    longest = max(map(len, entries), default=0)
    columns = max(1, min(len(entries), int(width / (0.55 + 0.075 * longest))))
    below = 0.15 + 0.2 * math.ceil(len(entries) / columns)
    figure.set_figheight(height + below)
    figure.tight_layout(rect=(0, below / (height + below), 1, 1), w_pad=1.5)
    if entries:
        figure.legend(entries.values(), entries.keys(), frameon=False, loc="lower center", ncol=columns,
                      borderaxespad=0.2, handlelength=2.4, columnspacing=1.5)
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    plt.close(figure)
    svg = text.getvalue()
    wide = " class=broad" if len(panels) > 1 else ""
    return f"<figure{wide}>{svg[svg.index('<svg'):]}<figcaption>{html.escape(caption)}</figcaption></figure>"


def new_figure(n_panels, title):
    figure, panels = plt.subplots(1, n_panels, figsize=({1: 5.2, 2: 8, 3: 10.8}[n_panels], HEIGHT), squeeze=False)
    if title:
        panels[0][0].set_title(title, loc="left")
    return figure, panels[0]


def draw_curves(study, axes, rows, x, y, rate=None):
    """y against x on logarithmic axes, a curve for each series of what converged; the number of curves."""
    tells, xs, ys = study.tells_without(x.column), [], []
    curves = study.curves([row for row in rows if not has_failed(row)], tells)
    for curve in curves:
        points = sorted(((x.value(row), y.value(row), row) for row in curve
                         if x.value(row) is not None and (y.value(row) or 0) > 0), key=lambda point: point[0])
        if not points:
            continue
        order = number(points[0][2], rate) if rate else None
        axes.plot([p[0] for p in points], [p[1] for p in points], **study.style(curve[0], tells, rows),
                  label=study.name(curve[0], tells, rows) + (f" ({order:.2f})" if order is not None else ""))
        xs += [p[0] for p in points]
        ys += [p[1] for p in points]
    if xs:
        x.set_up(axes.xaxis, xs)
        y.set_up(axes.yaxis, ys)
    return len(set(xs))


def draw_counts(study, axes, rows, x, y):
    """A whole number for every case, side by side, and a cross where it did not converge."""
    tells = study.tells_without(x.column)
    curves = study.curves(rows, tells)
    for i, curve in enumerate(curves):
        shift = 0.5 * ((i + 0.5) / len(curves) - 0.5) if x.integer else 0
        style = {**study.style(curve[0], tells, rows), "linewidth": 0.6}
        points = sorted((x.value(row) + shift, y.value(row) or 0, has_failed(row)) for row in curve)
        axes.plot([p[0] for p in points if not p[2]], [p[1] for p in points if not p[2]],
                  label=study.name(curve[0], tells, rows), **style)
        for point in points:
            if point[2]:
                axes.plot(*point[:2], color=style["color"], clip_on=False, **CROSS)
    if any(map(has_failed, rows)):
        axes.plot([], [], color="#444444", label="did not converge", **CROSS)
    x.set_up(axes.xaxis, [x.value(row) for row in rows])
    y.set_up(axes.yaxis, [], is_log=False)
    axes.set_ylim(0, 1.08 * max([1, *(y.value(row) or 0 for row in rows)]))


def error_plots(study):
    """Errors against size, unknowns and time, for each norm and of the stress."""
    rows, note = study.finest_levels()
    size = Axis("cell_size", f"cell size h, {study.unit}", study.factor)
    is_adaptive = any(row.get("refinement_steps") for row in rows)  # then cells have many sizes
    xs = (DOFS, SECONDS) if is_adaptive else (size, DOFS, SECONDS)
    where = " against " + ("" if is_adaptive else "cell size, ") + "unknowns and time."
    orders = (" In brackets the observed order between the two finest cell sizes; triangles show the order of theory."
              if size in xs else "")
    for y, theory, rate in ((L2, 1, "observed_rate"), (H1, 0, "observed_rate_h1"), (STRESS, 0, "observed_rate_stress")):
        for title, part in study.panels([row for row in rows if y.value(row) is not None], study.tells):
            figure, panels = new_figure(len(xs), title)
            counts = [draw_curves(study, axes, part, x, y, rate if x is size else None)
                      for axes, x in zip(panels, xs)]
            if counts[xs.index(DOFS)] < 2:
                plt.close(figure)
                continue
            for axes in panels[1:]:  # what the first one says
                for line in axes.lines:
                    line.set_label("_")
            degrees = sorted({int(row["degree"]) for row in part if row.get("degree")}, reverse=True)
            low, high = panels[0].get_ylim()
            panels[0].set_ylim(low * (low / high)**0.12)  # room for the triangles
            for place, degree in enumerate(degrees[:2] if size in xs and counts[0] > 1 else []):
                slope_triangle(panels[0], degree + theory, place)
            yield finished(figure, panels, f"R{y.label[1:-3]}{where}{orders}{note}")


def level_plots(study):
    """Errors and times against the halvings of cut cells."""
    if "cut_levels" not in study.tells:
        return
    rows = [row for row in study.rows if row.get("cut_levels")]
    ys = [y for y in (L2, ASSEMBLY, SECONDS) if any(y.value(row) for row in rows)]
    for title, part in study.panels(rows, study.tells_without("cut_levels")):
        figure, panels = new_figure(len(ys), title)
        for axes, y in zip(panels, ys):
            draw_curves(study, axes, part, LEVELS, y)
        yield finished(figure, panels, ("Error, time of one" if L2 in ys else "Time of one") + " assembly of the "
                       "tangent and of the whole solution against the number of times that cut cells are halved.")


def cost_plots(study):
    if has_single_cases(study):
        return  # then there are bars
    rows, note = study.finest_levels()
    for title, part in study.panels(rows, study.tells):
        if len(values(part, "dofs")) < 2:
            continue
        figure, panels = new_figure(2, title)
        for axes, y in zip(panels, (ASSEMBLY, SECONDS)):
            draw_curves(study, axes, part, DOFS, y)
        yield finished(figure, panels, "Time of one assembly of the tangent and time of the whole solution against "
                       f"unknowns.{note}")


def has_single_cases(study):
    """Is there neither a size nor a level to plot against?"""
    return all(len(curve) == 1 for curve in study.curves(study.rows, [c for c in study.tells if c != "cut_levels"]))


def bar_plots(study):
    """Of cases that only methods and sweeps tell apart, a bar for each."""
    if not has_single_cases(study) or len(study.rows) < 2:
        return
    for title, rows in study.panels(study.rows, study.tells, MOST_BARS):
        ys = [y for y in (REACHED, STEPS, NEWTON, LINEAR, SECONDS) if len(values(rows, y.column)) > 1][:3]
        if not ys:
            continue
        figure, panels = plt.subplots(1, len(ys), sharey=True, squeeze=False, figsize=(10.8, 0.9 + 0.24 * len(rows)))
        for axes, y in zip(panels[0], ys):
            bars = axes.barh([study.name(row, study.tells, rows) for row in rows], [y.value(row) or 0 for row in rows],
                             0.7, color=[study.style(row, study.tells, rows)["color"] for row in rows])
            for bar, row in zip(bars, rows):
                if has_failed(row):
                    bar.set(hatch="////", edgecolor="white")
            y.set_up(axes.xaxis, [], is_log=False)
            axes.set_xlim(0, 1 if y is REACHED else None)
            axes.set_ylim(-0.7, len(rows) - 0.3)
            axes.grid(False, axis="y")
        panels[0][0].invert_yaxis()
        panels[0][0].set_title(title, loc="left")
        note = " Hatched: did not converge." if any(map(has_failed, rows)) else ""
        yield finished(figure, panels[0], f"All cases side by side.{note}", figure.get_figheight())


def count_plots(study):
    """Load steps and Newton iterations, against levels where these are swept."""
    x = LEVELS if "cut_levels" in study.tells else DOFS
    ys = []
    for y in (STEPS, NEWTON):
        found = {y.value(row) for row in study.rows}
        if len(found) > 1 or any(map(has_failed, study.rows)):
            ys.append(y)
        elif found != {None}:
            n = int(found.pop())
            yield f"<p>All cases take {n} {y.label if n > 1 else y.label[:-1]}.</p>"
    if has_single_cases(study):
        return  # then there are bars
    ys += [REACHED] if any(map(has_failed, study.rows)) else []
    tells = study.tells_without(x.column)
    for title, part in study.panels([row for row in study.rows if x.value(row) is not None], tells) if ys else ():
        figure, panels = new_figure(len(ys), title)
        for axes, y in zip(panels, ys):
            draw_counts(study, axes, part, x, y)
        yield finished(figure, panels, ", ".join(y.label for y in ys).capitalize().replace("newton", "Newton") + ".")


def history_plots(study):
    """Residuals of the last linear system of the finest case of each series."""
    histories = study.run.get("linear_residuals", {})
    rows = [row for row in study.finest_levels()[0] if len(histories.get(row["case"], [])) > 1]
    for title, part in study.panels(rows, study.tells):
        figure, panels = new_figure(1, title)
        finest = [max(curve, key=lambda row: number(row, "dofs") or 0)
                  for curve in study.curves(part, study.tells)[:12]]
        styles = [study.style(row, study.tells, part) for row in finest]
        have_one_colour = len(finest) > 1 and len({style["color"] for style in styles}) == 1
        for i, (row, style) in enumerate(zip(finest, styles)):
            history = histories[row["case"]]
            if have_one_colour:
                style = {**style, "color": f"C{i}"}
            panels[0].plot(history, **style, markevery=max(1, len(history) // 8),
                           label=f"{study.name(row, study.tells, part)}, {shown(row['dofs'])[0]} unknowns")
        panels[0].set_yscale("log")
        panels[0].xaxis.set_major_locator(ticker.MaxNLocator(integer=True))
        panels[0].set_xlabel("iteration")
        panels[0].set_ylabel("relative residual")
        yield finished(figure, panels,
                       "Iterative solution of the last linear system of the finest case of each series.")


def probe_plots(study):
    """Of each probe the component that moves most, against unknowns."""
    references = study.references()
    rows, note = study.finest_levels()
    rows = [row for row in rows if not has_failed(row)]
    ys = []
    for name in [c[:-3] for c in study.rows[0] if c.endswith("_ux")]:
        largest, axis = max((max((abs(number(row, f"{name}_u{d}") or 0) for row in rows), default=0), d) for d in "xyz")
        if largest > 0:
            unit, factor = length_unit(largest)
            ys.append(Axis(f"{name}_u{axis}", f"{name}: $u_{axis}$, {unit}", factor))
    for title, part in study.panels(rows, study.tells) if ys else ():
        if len(values(part, "dofs")) < 2:
            continue
        figure, panels = new_figure(len(ys[:3]), title)
        for axes, y in zip(panels, ys):
            for curve in study.curves(part, study.tells):
                curve = sorted(curve, key=DOFS.value)
                axes.plot([DOFS.value(row) for row in curve], [y.value(row) for row in curve],
                          label=study.name(curve[0], study.tells, part), **study.style(curve[0], study.tells, part))
            if len(references) == 1 and y.value(references[0]) is not None:
                axes.axhline(y.value(references[0]), color="#222222", linewidth=1, linestyle=(0, (6, 3)),
                             label="reference")
            DOFS.set_up(axes.xaxis, [DOFS.value(row) for row in part])
            y.set_up(axes.yaxis, [], is_log=False)
        yield finished(figure, panels, f"Displacement of the probes against unknowns.{note}")
