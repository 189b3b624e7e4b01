#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes DIR/report.html from what a study left in DIR: tables, plots and pictures on a page that needs nothing else.

usage: report.py DIR [FILE.prm]     the comment on top of the parameter file becomes the page's title and first words
"""
import base64
import html
import pathlib
import sys

import report_plots as plots
from report_study import Study, has_failed, is_number, number, shown

MOST_ROWS = 12  # of the first table
ERRORS = (0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
STYLE = """body { font: 16px/1.5 system-ui, sans-serif; max-width: 70rem; margin: 2rem auto; padding: 0 1.5rem;
  color: #1c1e21; } h1 { font-size: 1.7rem; line-height: 1.25; } h2 { margin-top: 2.2rem; font-size: 1.25rem; }
.wide { overflow-x: auto; } .small, figcaption, summary { font-size: 14px; color: #444; }
table { border-collapse: collapse; font-size: 13.5px; font-variant-numeric: tabular-nums; margin: .5rem 0;
  border-top: 1.5px solid #333; border-bottom: 1.5px solid #333; }
th, td { padding: .18rem .45rem; text-align: right; white-space: nowrap; }
th { border-bottom: 1px solid #333; font-weight: 600; vertical-align: bottom; } td.text, th.text { text-align: left; }
tr.failed td { color: #a4161a; } table.facts td { white-space: normal; } details { margin: .7rem 0; } summary { cursor: pointer; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(31rem, 1fr)); gap: 1.2rem 1.5rem; }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(15.5rem, 1fr)); gap: .8rem; }
figure { margin: 0; } figure.broad, .figures > p { grid-column: 1 / -1; }
img, svg { max-width: 100%; height: auto; } .tiles figcaption { line-height: 1.3; }
.scale { display: block; margin: 0 auto .5rem; width: 30rem; }"""


def table(rows, columns, heads=None):
    """An HTML table; columns without values are left out."""
    columns = [name for name in columns if any(row.get(name) for row in rows)]
    is_text = {c: not all(is_number(row.get(c) or "0") for row in rows) for c in columns}
    heads_or_names = {**{c: html.escape(c) for c in columns}, **(heads or {})}
    head = "".join(f"<th{' class=text' if is_text[c] else ''}>{heads_or_names[c]}</th>" for c in columns)
    lines = [f"<div class=wide><table><tr>{head}</tr>"]
    for row in rows:
        cells = "".join(f"<td{' class=text' if is_text[c] else ''}>{shown(row.get(c) or '', 3 if heads else 6)[0]}</td>"
                        for c in columns)
        lines.append(f"<tr{' class=failed' if has_failed(row) else ''}>{cells}</tr>")
    return "\n".join(lines) + "</table></div>"


HEADS = {"method": "method", "degree": "degree", "cut_levels": "cut<br>levels", "h": "h, {unit}", "dofs": "unknowns",
         "load_steps": "load<br>steps", "newton_iterations": "Newton<br>iterations",
         "linear_iterations": "linear<br>iterations", "condition": "condition", "assembly_s": "assembly,<br>s",
         "total_s": "total,<br>s", "l2": "error in<br>L2, %", "observed_rate": "order", "h1": "error in<br>H1, %",
         "observed_rate_h1": "order", "stress": "error of<br>stress, %", "failure": "load<br>reached"}


def summary(study):
    """The columns that matter, of all cases or of the finest of each series."""
    rows, note = study.rows, ""
    if len(rows) > MOST_ROWS:
        finest = [max(curve, key=lambda row: number(row, "dofs") or 0)
                  for curve in study.curves(study.finest_levels()[0], study.tells)]
        rows = (finest + [row for row in study.rows if has_failed(row) and row not in finest])[:3 * MOST_ROWS]
        what = (f"The first {len(rows)}" if len(finest) == len(study.rows) else "The finest case of each series"
                + (", then what did not converge" if len(rows) > len(finest) else ""))
        if len(rows) < len(study.rows):
            note = f"<p class=small>{what}; all {len(study.rows)} cases are below.</p>"
    rows = [dict(row) for row in rows]
    for row in rows:
        if has_failed(row):
            reached = number(row, "load_factor")
            row["failure"] = "" if reached is None else f"{reached:.3g}"
        row["h"] = f"{number(row, 'cell_size') * study.factor:.4g}" if row.get("cell_size") else ""
        for short, column in (("l2", "relative_l2_error"), ("h1", "relative_h1_error"),
                              ("stress", "relative_stress_error")):
            row[short] = str(100 * number(row, column)) if number(row, column) is not None else ""
    columns = [c for c in HEADS if c in study.tells or c not in ("degree", "cut_levels")]
    if any(row["l2"] for row in rows):
        columns.remove("condition")  # it is what studies without errors are about
    columns[1:1] = study.sweeps
    heads = {c: HEADS.get(c, html.escape(c)).format(unit=study.unit) for c in columns}
    return table(rows, columns, heads) + note


def seconds_to_errors(study):
    """The seconds of each method's fastest case within an error, and which method is the fastest of all."""
    solved = [row for row in study.rows
              if not has_failed(row) and None not in (number(row, "total_s"), number(row, "relative_l2_error"))]
    tells = [c for c in study.tells if c != "cut_levels"]
    curves = {study.name(curve[0], tells): curve for curve in study.curves(solved, tells)}
    rows = []
    for bound in ERRORS if 2 <= len(curves) <= MOST_ROWS else ():
        times = {name: min((number(case, "total_s") for case in curve if number(case, "relative_l2_error") <= bound),
                           default=None) for name, curve in curves.items()}
        times = {name: time for name, time in times.items() if time is not None}
        if times:
            fastest = min(times, key=times.get) if not study.sweeps else ""
            rows.append({"bound": f"{100 * bound:g} %", "fastest": fastest,
                         **{name: f"{time:.3g}" for name, time in times.items()}})
    heads = {"bound": "error in<br>L2 below", **{name: html.escape(name).replace(", ", ",<br>") for name in curves},
             "fastest": "the fastest"}
    note = ("Seconds that the fastest case of each method takes to an error; blank where no case of this study has so "
            "small an error.")
    return f"<h2>Time to an error</h2><p class=small>{note}</p>" + table(rows, list(heads), heads) if rows else ""


def embedded(file):
    return "data:image/png;base64," + base64.b64encode(file.read_bytes()).decode()


def pictures(study):
    """A tile for each case that picture.py drew, with the scale that all have in common."""
    tiles = []
    for row in study.rows:
        file = study.folder / row["case"] / "tile.png"
        if file.exists():
            name = html.escape(study.name(row, [*study.tells, "cell_size"]))
            reached = number(row, "load_factor")
            fate = f" <b>Not converged: at {reached:.3g} of the load.</b>" if has_failed(row) else ""
            tiles.append(f'<figure><img alt="{name}" src="{embedded(file)}">'
                         f"<figcaption>{name}.{fate}</figcaption></figure>")
    if not tiles:
        return ""
    scale = study.folder / "scale.png"
    bar = f'<img class=scale alt="scale of colours" src="{embedded(scale)}">' if scale.exists() else ""
    words = "Grey: the body at rest. All pictures have the same scale."
    if len(tiles) < len(study.rows):
        words += f" Drawn are {len(tiles)} of {len(study.rows)} cases, the finest of each series first."
    return f"<h2>Deformed bodies</h2><p class=small>{words}</p>{bar}<div class=tiles>{''.join(tiles)}</div>"


def title_and_words(folder, parameter_file):
    """The comment on top of a parameter file: its first sentence, and the rest as paragraphs."""
    lines = []
    for line in pathlib.Path(parameter_file).read_text().splitlines() if parameter_file else []:
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# ").rstrip())
    paragraphs = [" ".join(part.split("\n")).strip() for part in "\n".join(lines).split("\n\n")]
    title = paragraphs[0].rstrip(".") or folder.resolve().name
    return html.escape(title), "".join(f"<p>{html.escape(text)}</p>" for text in paragraphs[1:] if text)


def description(study):
    """What was run, by what, where, with which parameters."""
    run = study.run
    facts = [("cases", f"{len(study.rows)}" + (f", of which {sum(map(has_failed, study.rows))} did not converge"
                                               if any(map(has_failed, study.rows)) else ""))]
    if run.get("status") == "running":
        facts.append(("status", "the study was not finished"))
    for row in study.references():
        fate = ", not converged" if has_failed(row) else ""
        facts.append((row["case"].replace("_", " "), f"{row['method']}, degree {row['degree']}, "
                      f"{shown(row['dofs'])[0]} unknowns, {shown(row['total_s'], 3)[0]} s{fate}"))
    constant = [HEADS[c].replace("<br>", " ") + " " + study.rows[0][c] for c in ("method", "degree", "cut_levels")
                if c not in study.tells and study.rows[0].get(c)]
    facts += [("all cases", ", ".join(constant))] if constant else []
    if run:
        facts += [("program", f"softcell {run.get('version')}, commit {run.get('commit', 'unknown')}"),
                  ("run", f"{run.get('written')} on {run.get('ranks')} rank(s) of {run.get('host')}"),
                  ("command", run.get("command_line", ""))]
    lines = "".join(f"<tr><td class=text>{html.escape(name)}</td><td class=text>{html.escape(fact)}</td></tr>"
                    for name, fact in facts)
    parameters = "\n".join(f"{name} = {value}" for name, value in run.get("parameters", {}).items())
    remarks = "".join(f"<p>{html.escape(text)}</p>" for text in run.get("remarks", []))
    libraries = "\n".join(f"{name} {version}" for name, version in run.get("libraries", {}).items())
    folded = [("Parameters", f"<pre>{html.escape(parameters)}</pre>"),
              ("Libraries", f"<pre>{html.escape(libraries)}</pre>"), ("Remarks", remarks)]
    return f"<div class=wide><table class=facts>{lines}</table></div>" + "".join(
        f"<details class=small><summary>{head}</summary>{body}</details>" for head, body in folded if body and run)


def main(folder, parameter_file=None):
    study = Study(folder)
    title, words = title_and_words(folder, parameter_file)
    sections = [("Errors", [plots.error_plots]), ("Cut levels", [plots.level_plots]), ("Time", [plots.cost_plots]),
                ("Load steps and iterations", [plots.count_plots, plots.bar_plots, plots.history_plots]),
                ("Probes", [plots.probe_plots])]
    body = ""
    for head, makers in sections:
        figures = "".join(figure for make in makers for figure in make(study))
        body += f"<h2>{head}</h2><div class=figures>{figures}</div>" if figures else ""
    page = f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>{STYLE}</style></head><body>
<h1>{title}</h1>
{words}
{description(study)}
<h2>Results</h2>
{summary(study)}
<details><summary>All columns of all cases (results.csv)</summary>{table(study.rows, list(study.rows[0]))}</details>
{seconds_to_errors(study)}
{body}
{pictures(study)}
</body></html>
"""
    (folder / "report.html").write_text(page)
    print(folder / "report.html")


if len(sys.argv) not in (2, 3):
    sys.exit(__doc__)
main(pathlib.Path(sys.argv[1]), *sys.argv[2:])
