# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whole runs of a body in motion."""
import os

from program import BAR, check, rows, softcell


def dynamics(folder):
    """A tool bends a bar by its recorded path, holds it, and feels what it feels in a static run."""
    (folder / "bar.prm").write_text(BAR)
    (folder / "tool.csv").write_text("t,x,y,z\n0,0,0,0\n0.2,0,0.01,0\n2,0,0.01,0\n")
    tool = ["Loads/top = displacement path", "Loads/Path = tool.csv", "Discretization/Method = weighted cell"]
    motion = [*tool, "Solver/Mode = dynamic", "Dynamics/Mass damping = 20", "Output/Every = 40"]

    def run(to, *entries):
        words = [word for entry in entries for word in ("--set", entry)]
        status, out, error = softcell("bar.prm", *words, "--output", to, folder=folder)
        check(status == 0, f"{to}: status {status}: {out[-2000:]} {error[-2000:]}")
        return rows(folder / to / "results.csv")[0]

    static = run("static", *tool)
    for to, settings, tolerance in (("exact", ["Solver/Linear tolerance = 1e-8"], 1e-5),
                                    ("newmark", ["Solver/Linear tolerance = 1e-8", "Dynamics/Scheme = Newmark"], 1e-4),
                                    ("penalty", ["Loads/Imposed displacement = penalty", "Loads/Penalty = 1e7"], 0.02),
                                    ("hurried", ["Dynamics/Frame budget = 5"], 0.01)):
        row = run(to, *motion, *settings)
        frames = rows(folder / to / "frames.csv")
        check(len(frames) == 120 and float(frames[-1]["time"]) == 2, f"{to}: {len(frames)} frames")
        check("solution_0002.vtu" in " ".join(os.listdir(folder / to)), f"{to}: states {os.listdir(folder / to)}")
        found, expected = float(frames[-1]["top_fy"]), float(static["top_fy"])
        check(abs(found - expected) < tolerance * abs(expected), f"{to}: the tool feels {found}, held still {expected}")
        check(abs(float(row["tip_uy"]) - 0.01) < 1e-4, f"{to}: the tip is at {row['tip_uy']}")
