#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes DIR/report.html from DIR/results.csv and the pictures beside it; the page needs nothing else.

usage: report.py DIR
"""
import base64
import csv
import html
import io
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

# Columns of a plot: file column and label of each axis. A plot is left out where a column has no values.
PLOTS = [
    ("cells", "cells", "relative_l2_error", "relative error in L2"),
    ("dofs", "unknowns", "relative_l2_error", "relative error in L2"),
    ("total_s", "time in s", "relative_l2_error", "relative error in L2"),
    ("dofs", "unknowns", "relative_h1_error", "relative error in H1"),
    ("cut_levels", "cut levels", "assembly_s", "one tangent assembly in s"),
    ("dofs", "unknowns", "assembly_s", "one tangent assembly in s"),
    ("dofs", "unknowns", "total_s", "time in s"),
]
STYLE = """body { font: 16px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem;
  color: #1c1e21; } h1, h2 { font-weight: 600; } .wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .6rem; border-bottom: 1px solid #ddd; text-align: right; white-space: nowrap; }
th { background: #f5f6f7; } td.text { text-align: left; } .failed { color: #b00020; }
figure { display: inline-block; margin: 0 1rem 1rem 0; max-width: 34rem; vertical-align: top; }
figure.picture { max-width: 100%; } img, svg { max-width: 100%; height: auto; } figcaption { color: #555; }"""


def number(row, column):
    """The value as a number, or None."""
    try:
        return float(row.get(column) or "")
    except ValueError:
        return None


def shown(text):
    """Numbers with five digits, all else as it is; whether it is a number."""
    try:
        value = float(text)
    except ValueError:
        return html.escape(text), False
    return (text if value.is_integer() and abs(value) < 1e15 and "e" not in text else f"{value:.5g}"), True


def series(rows, x, y):
    """Points of converged cases by method, degree and, unless they are the abscissa, cut levels."""
    curves = {}
    for row in rows:
        point = number(row, x), number(row, y)
        if None in point or row.get("converged") == "false":
            continue
        name = row.get("method") or row.get("case") or "all"
        for column, text in (("degree", "degree"), ("cut_levels", "levels")):
            if column != x and len({r.get(column) for r in rows}) > 1 and row.get(column):
                name += f", {text} {row[column]}"
        if x == "cut_levels":
            name += f", {row.get('cells')} cells" if len({r.get("cells") for r in rows}) > 1 else ""
        curves.setdefault(name, []).append(point)
    return {name: sorted(points) for name, points in curves.items()}


def plot(rows, x, x_label, y, y_label):
    """An SVG of y against x, or nothing where there are no two points to draw."""
    curves = series(rows, x, y)
    if len({point[0] for points in curves.values() for point in points}) < 2:
        return ""
    figure, axes = plt.subplots(figsize=(6.4, 5.0), layout="constrained")
    methods, drawn = [], {}
    for name, points in curves.items():
        method = name.split(",")[0]
        methods += [] if method in methods else [method]
        n = drawn[method] = drawn.get(method, -1) + 1  # a colour for each method, a mark for each of its curves
        axes.plot(*zip(*points), color=f"C{methods.index(method) % 10}", marker="os^Dv*Xp"[n % 8],
                  linestyle=("-", "--", "-.", ":")[n % 4], markersize=5, linewidth=1.3, label=name)
    values = [value for points in curves.values() for point in points for value in point[1:]]
    if x == "cut_levels":
        axes.xaxis.get_major_locator().set_params(integer=True)
    elif all(p[0] > 0 for points in curves.values() for p in points):
        axes.set_xscale("log")
    if all(value > 0 for value in values):
        axes.set_yscale("log")
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend(fontsize=7.5, frameon=False, loc="upper center", bbox_to_anchor=(0.45, -0.12), ncol=3)
    text = io.StringIO()
    figure.savefig(text, format="svg")
    plt.close(figure)
    svg = text.getvalue()
    return f"<figure>{svg[svg.index('<svg'):]}<figcaption>{y_label} against {x_label}</figcaption></figure>"


def table(rows):
    columns = [name for name in rows[0] if any(row.get(name) for row in rows)]
    lines = ["<div class=wide><table><tr>" + "".join(f"<th>{html.escape(c)}</th>" for c in columns) + "</tr>"]
    for row in rows:
        cells = [shown(row.get(column) or "") for column in columns]
        mark = " class=failed" if row.get("converged") == "false" else ""
        lines.append(f"<tr{mark}>" + "".join(
            f"<td>{text}</td>" if is_number else f"<td class=text>{text}</td>" for text, is_number in cells) + "</tr>")
    return "\n".join(lines) + "</table></div>"


def pictures(folder):
    for file in sorted(folder.glob("**/*.png")):
        data = base64.b64encode(file.read_bytes()).decode()
        name = html.escape(str(file.relative_to(folder)))
        yield f'<figure class=picture><img alt="{name}" src="data:image/png;base64,{data}">' \
              f"<figcaption>{name}</figcaption></figure>"


def record(folder):
    """What was run, from run.json where it is there."""
    try:
        run = json.loads((folder / "run.json").read_text())
    except (OSError, ValueError):
        return ""
    return "<p>" + html.escape(
        f"softcell {run.get('version')} (commit {run.get('commit', 'unknown')[:12]}), "
        f"{run.get('ranks')} rank(s) on {run.get('host')}, {run.get('written')}: ") \
        + f"<code>{html.escape(run.get('command_line', ''))}</code></p>"


def main(folder):
    with open(folder / "results.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        sys.exit(f"{folder / 'results.csv'} has no rows.")
    title = html.escape(folder.resolve().name)
    plots = "".join(plot(rows, *entry) for entry in PLOTS)
    images = "".join(pictures(folder))
    page = f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>{STYLE}</style></head><body>
<h1>{title}</h1>
{record(folder)}
<h2>Results</h2>
{table(rows)}
{"<h2>Plots</h2>" + plots if plots else ""}
{"<h2>Pictures</h2>" + images if images else ""}
</body></html>
"""
    (folder / "report.html").write_text(page)
    print(folder / "report.html")


if len(sys.argv) != 2:
    sys.exit(__doc__)
main(pathlib.Path(sys.argv[1]))
