# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rows of a study, and how its curves are told apart."""
import csv
import html
import json
import math
import sys

MOST_CURVES = 8  # of a plot; then only the highest cut levels are drawn, and sweeps part into figures
# Colours that the colour-blind tell apart (Okabe and Ito); a method has the same one in every plot.
COLOURS = {"finite cell": "#0072B2", "weighted cell": "#D55E00", "tetrahedra": "#009E73", "hexahedra": "#CC79A7",
           "sparse grid": "#7F7F7F"}
MORE_COLOURS = ("#E69F00", "#56B4E9", "#000000", "#8C6D31", "#5E3C99", "#D9B300", "#0072B2", "#D55E00", "#009E73",
                "#CC79A7")
MARKS, LINES = "os^Dv*Xp<>Ph", ("-", "--", "-.", ":")
SIZES = {f"Discretization/{entry}" for entry in ("Cells", "Cell size", "Mesh size", "Refinement steps")}


def number(row, column):
    """The value as a finite number, or None."""
    try:
        value = float(row.get(column) or "")
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def shown(text, digits=5):
    """Numbers with few digits, all else as it is; whether it is a number."""
    try:
        value = float(text)
    except ValueError:
        return html.escape(text), False
    if value.is_integer() and abs(value) < 1e15 and "e" not in text:
        return (f"{int(value):,}".replace(",", "\u2009") if abs(value) >= 1e4 else text), True
    return f"{value:.{digits}g}", True


def has_failed(row):
    return row.get("converged") == "false"


def values(rows, column, filled=False):
    """The different values of a column, numbers by size, the rest in the order of rows; blanks too unless filled."""
    found = list(dict.fromkeys(row.get(column) or "" for row in rows if row.get(column) or not filled))
    return sorted(found, key=lambda v: float(v or -1)) if all(is_number(v or "0") for v in found) else found


def is_number(text):
    return shown(text)[1]


def length_unit(largest):
    return next(unit for unit in (("m", 1), ("cm", 1e2), ("mm", 1e3), ("µm", 1e6)) if largest * unit[1] >= 1
                or unit[0] == "µm")


def is_of_sizes(sweep):
    """Does an entry of section Sweeps set nothing but how large cells are?"""
    settings = [setting for choice in sweep.split("|") for setting in choice.partition(":")[2].split(";")]
    entries = {setting.partition("=")[0].strip() for setting in settings} - {""}
    return bool(entries) and entries <= SIZES


class Study:
    """The rows of results.csv, what run.json says of them, and how their curves are told apart.

    `tells` is a list of columns that tell curves apart: rows with the same values there are one curve.
    """

    def __init__(self, folder):
        self.folder = folder
        with open(folder / "results.csv", newline="") as file:
            self.rows = list(csv.DictReader(file))
        if not self.rows:
            sys.exit(f"{folder / 'results.csv'} has no rows.")
        try:
            self.run = json.loads((folder / "run.json").read_text())
        except (OSError, ValueError):
            self.run = {}
        prefix = "Sweeps/"
        sweeps = {name[len(prefix):]: text for name, text in self.run.get("parameters", {}).items()
                  if name.startswith(prefix)}
        self.sweeps = list(sweeps)
        for name in filter(lambda one: is_of_sizes(sweeps[one]), sweeps):
            for row in self.rows:  # `uniform 8` and `uniform 16` are points of one curve
                row[name] = row[name].rstrip("0123456789 ") or row[name]
        self.tells = [c for c in ("method", *self.sweeps, "degree", "cut_levels")
                      if len(values(self.rows, c, True)) > 1]
        self.unit, self.factor = length_unit(max((number(row, "cell_size") or 0 for row in self.rows), default=1))
        # what a colour and a kind of line stand for; marks stand for the rest
        self.colour = self.tells[0] if self.tells else "method"
        self.line = "degree" if "degree" in self.tells and self.colour != "degree" else None
        kinds = [kind for kind in values(self.rows, self.colour) if kind not in COLOURS]
        self.colours = {**COLOURS, **{kind: MORE_COLOURS[i % len(MORE_COLOURS)] for i, kind in enumerate(kinds)}}

    def tells_without(self, x):
        """For a plot against cut levels, sizes tell curves apart."""
        tells = [c for c in self.tells if c != x]
        return tells + ["cell_size"] if x == "cut_levels" and len(values(self.rows, "cell_size")) > 1 else tells

    def name(self, row, tells, rows=()):
        """In words; without the sweeps that are the same in all `rows`, which the title of a panel says."""
        tells = [c for c in tells if not rows or c not in self.sweeps or len(values(rows, c)) > 1]
        words = {"degree": "degree {}", "cut_levels": "{} levels"}
        parts = [f"h = {(number(row, c) or 0) * self.factor:.3g} {self.unit}" if c == "cell_size" else
                 words.get(c, "{}").format(row[c]).replace("1 levels", "1 level") for c in tells if row.get(c)]
        return ", ".join(parts) or row.get("method") or row["case"]

    def style(self, row, tells, rows):
        """Colour, line and mark of a row's curve among those of `rows`."""
        marks = [c for c in tells if c not in (self.colour, self.line) and len(values(rows, c, True)) > 1]
        marks = marks or [self.colour]
        kinds = sorted({tuple(r.get(c) or "" for c in marks) for r in self.rows}, key=lambda k: ("" in k, k))
        mark = kinds.index(tuple(row.get(c) or "" for c in marks))
        line = values(self.rows, self.line).index(row[self.line]) if self.line else 0
        colour = self.colours[row.get(self.colour) or ""]
        if self.tells and self.colour not in tells:  # it does not tell these curves apart
            colour = MORE_COLOURS[mark % len(MORE_COLOURS)]
        return {"color": colour, "marker": MARKS[mark % len(MARKS)],
                "linestyle": LINES[line % len(LINES)]}

    @staticmethod
    def curves(rows, tells):
        found = {}
        for row in rows:
            found.setdefault(tuple(row.get(c) for c in tells), []).append(row)
        return list(found.values())

    def finest_levels(self):
        """Of each curve the rows with the most cut levels if there are too many, and what a caption says of that."""
        if "cut_levels" not in self.tells or len(self.curves(self.rows, self.tells)) <= MOST_CURVES:
            return self.rows, ""
        kept = []
        for curve in self.curves(self.rows, [c for c in self.tells if c != "cut_levels"]):
            most = max((number(row, "cut_levels") or 0 for row in curve if row.get("dofs")), default=0)
            kept += [row for row in curve if (number(row, "cut_levels") or 0) == most]
        return kept, " Shown are the highest cut levels; the full table has all."

    def references(self):
        """The rows of the runs that errors are measured against."""
        found = []
        for file in sorted(self.folder.glob("reference*/results.csv")):
            with open(file, newline="") as stream:
                found += list(csv.DictReader(stream))
        return found

    def panels(self, rows, tells, most=MOST_CURVES):
        """Title and rows of each panel: as many sweeps as needed part the curves into panels of at most so many."""
        for n in range(len(self.sweeps) + 1):
            parts = {}
            for row in rows:
                parts.setdefault(tuple(row.get(c) for c in self.sweeps[:n]), []).append(row)
            if n == len(self.sweeps) or all(len(self.curves(part, tells)) <= most for part in parts.values()):
                return [(", ".join(f"{c}: {v}" for c, v in zip(self.sweeps, key)), part) for key, part in parts.items()]
        return []
