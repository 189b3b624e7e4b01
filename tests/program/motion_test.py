# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whole runs of a body in motion."""
import json
import math
import os
import subprocess
import time

import program
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


def motion_failures(folder):
    """A motion that fails has status 2 and says why; it leaves its frames, as one does that is killed."""
    (folder / "bar.prm").write_text(BAR)
    motion = ["Solver/Mode = dynamic", "Discretization/Method = weighted cell", "Solver/Linear tolerance = 1e-3",
              "Dynamics/End time = 0.2", "Output/Every = 1"]

    def table(file):
        return rows(file) if file.exists() else []

    def words(*entries):
        return [word for entry in (*motion, *entries) for word in ("--set", entry)]

    def run(to, *entries):
        status, out, error = softcell("bar.prm", *words(*entries), "--output", to, folder=folder)
        row = table(folder / to / "results.csv")
        return status, row[0] if row else {}, table(folder / to / "frames.csv"), out + error

    for to, pull, settings in (("torn", "-1e300", []), ("torn_in_a_hurry", "-1e300", ["Dynamics/Frame budget = 50"]),
                               ("far_linear", "-1e20", ["Material/Model = linear"]),
                               ("far_in_a_hurry", "-1e20", ["Dynamics/Frame budget = 50"])):
        status, row, frames, out = run(to, f"Loads/top = traction 0, t < 0.09 ? -30 : {pull}, 0", *settings)
        check(status == 2 and row.get("converged") == "false", f"{to}: status {status}: {row}")
        failure = row.get("failure", "")
        check(failure.startswith("step 6 of 12, to t = 0.1 s, failed: ") and f"Not converged: {failure}." in out,
              f"{to}: {failure}: {out}")
        check(len(frames) == 5 and row.get("time_steps") == "5" and math.isclose(float(row["time"]), 5 / 60),
              f"{to}: {len(frames)} frames: {row}")
        for one in (row, *frames):
            for column, value in one.items():
                check(value.lower() not in ("nan", "-nan", "inf", "-inf"), f"{to}: {column} is {value}")
        states, record = (folder / to / "solution.pvd").read_text(), json.loads((folder / to / "run.json").read_text())
        check(states.count("file=") == 5, f"{to}: {states}")
        check(record["status"] == "not converged", f"{to}: run.json says {record['status']}")

    status, row, frames, out = run("too_strong", "Loads/top = traction 0, t < 0.09 ? -30 : -1e20, 0")
    check(status == 2 and len(frames) == 12 and all(float(frame["way"]) == 0 for frame in frames[5:]) and
          row.get("unsolved_steps") == "7" and "7 of 12 steps went only a part of their way" in out,
          f"what gains energy on any way stays, which is no motion: {row}: {frames}: {out}")

    few = ["Solver/Linear iterations = 1", "Solver/Linear tolerance = 1e-6"]
    for to, settings, expected in (("unsolved", [], 2), ("asked_for", ["Dynamics/Frame budget = 1000"], 0)):
        status, row, frames, out = run(to, *few, *settings)
        residuals = [float(frame["linear_residual"]) for frame in frames]
        n = sum(residual > 1e-6 for residual in residuals)
        message = f"{n} of 12 steps left their linear system above Solver/Linear tolerance = 1e-06"
        check(status == expected and row.get("converged") == ("false" if expected else "true"),
              f"{to}: status {status}: {row}")
        check(len(frames) == 12 and n > 0 and row.get("unsolved_steps") == str(n) and message in out,
              f"{to}: {len(frames)} frames, {n} of them unsolved, {row.get('unsolved_steps')} in results.csv: {out}")
        check(math.isclose(float(row.get("largest_linear_residual", 0)), max(residuals, default=0), rel_tol=1e-8),
              f"{to}: largest residual {row.get('largest_linear_residual')}, in frames.csv {residuals}")
        check((message in row.get("failure", "")) == (expected == 2), f"{to}: failure {row.get('failure')}")
    status, row, frames, out = run("rest", "Loads/top = traction 0, 0, 0")
    check(status == 0 and row.get("converged") == "true" and row.get("unsolved_steps") == "0",
          f"at rest: {status}: {row}")

    long = words("Dynamics/End time = 100", "Output/Every = 0")
    run = subprocess.Popen([program.executable, "bar.prm", *long, "--output", "killed"], cwd=folder,
                           stdout=subprocess.DEVNULL)
    file, n_lines, end = folder / "killed" / "frames.csv", 0, time.time() + 300
    while run.poll() is None and n_lines < 5 and time.time() < end:
        time.sleep(0.01)
        n_lines = file.read_text().count("\n") if file.exists() else 0
    run.kill()
    run.wait()
    check(not (folder / "killed" / "results.csv").exists(), "the motion was killed before its end")
    frames = table(file)
    check(n_lines >= 5 and len(frames) >= n_lines - 1, f"killed: {len(frames)} frames of {n_lines} lines")
    for n, frame in enumerate(frames, 1):
        check(None not in frame.values() and math.isclose(float(frame["time"]), n / 60, rel_tol=1e-6),
              f"killed: frame {n} is {frame}")
