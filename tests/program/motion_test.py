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
        return rows(folder / to / "results.csv")[0], out + error

    def check_row(to, row, frames):
        last = frames[-1]
        for column, expected in (("time", last["time"]), ("time_steps", len(frames)),
                                 ("kinetic_energy", last["kinetic_energy"]), ("top_fy", last["top_fy"]),
                                 ("strain_energy", last["strain_energy"]),
                                 ("slowest_step_ms", max(float(frame["step_ms"]) for frame in frames)),
                                 ("linear_iterations", sum(int(frame["linear_iterations"]) for frame in frames)),
                                 ("shortened_steps", sum(float(frame["way"]) < 1 for frame in frames))):
            # frames.csv has nine digits; single precision, with a budget, six
            check(abs(float(row[column]) - float(expected)) <= 1e-5 * abs(float(expected)),
                  f"{to}: {column} is {row[column]} in results.csv and {expected} in frames.csv")
        for column in ("load_steps", "newton_iterations", "assembly_s", "load_factor"):
            check(not row.get(column), f"{to}: a motion has no {column}, but {row.get(column)}")

    static, _ = run("static", *tool)
    for to, settings, tolerance in (("exact", ["Solver/Linear tolerance = 1e-8"], 1e-5),
                                    ("newmark", ["Solver/Linear tolerance = 1e-8", "Dynamics/Scheme = Newmark"], 1e-4),
                                    ("penalty", ["Loads/Imposed displacement = penalty", "Loads/Penalty = 1e7"], 0.02),
                                    ("hurried", ["Dynamics/Frame budget = 5"], 0.01)):
        row, _ = run(to, *motion, *settings)
        frames = rows(folder / to / "frames.csv")
        check(len(frames) == 120 and float(frames[-1]["time"]) == 2, f"{to}: {len(frames)} frames")
        check_row(to, row, frames)
        check("solution_0002.vtu" in " ".join(os.listdir(folder / to)), f"{to}: states {os.listdir(folder / to)}")
        found, expected = float(frames[-1]["top_fy"]), float(static["top_fy"])
        check(abs(found - expected) < tolerance * abs(expected), f"{to}: the tool feels {found}, held still {expected}")
        check(abs(float(row["tip_uy"]) - 0.01) < 1e-4, f"{to}: the tip is at {row['tip_uy']}")
    row, out = run("late", *motion, "Dynamics/Frame budget = 1e-3", "Dynamics/End time = 0.1")
    check(row["late_steps"] == "6" and "6 of 6 steps took longer than Dynamics/Frame budget" in out,
          f"late steps: {row['late_steps']}: {out}")
    (folder / "tool.csv").write_text("t,x,y,z\n0,0,0,0\n0.01,0,0,-0.9\n0.1,0,0,-0.9\n")  # a leap
    row, out = run("leap", *motion, "Dynamics/End time = 0.1")
    check_row("leap", row, rows(folder / "leap" / "frames.csv"))
    check(int(row["shortened_steps"]) > 0 and f"{row['shortened_steps']} of 6 steps went only a part" in out,
          f"shortened steps: {row['shortened_steps']}: {out}")
