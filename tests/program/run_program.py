#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the whole program and checks what it prints, returns and writes.

usage: run_program.py SOFTCELL GROUP
GROUP is one of command_line, bad_input, ranks, checkpoints, dynamics, motion_failures, methods, studies, cook_membrane,
organ, multigrid, sweeps, resume, report.
"""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import method_tests
import motion_test
import program
import report_test
import study_tests
from bad_files import write_files
from bad_inputs import BAD_INPUTS
from program import BAR, GOOD_SURFACE, check, failures, rows, same_row, softcell


def command_line(folder):
    """Options that only print, and the printed parameters as a parameter file."""
    status, out, _ = softcell("--help")
    check(status == 0 and "--print-parameters" in out, "--help says how to use the program")
    status, out, _ = softcell("--version")
    check(status == 0 and out.startswith("softcell "), "--version names the version")
    for arguments in ((), ("--no-such-option",), ("a.prm", "b.prm"), ("a.prm", "--set")):
        status, _, error = softcell(*arguments)
        check(status == 1 and error.startswith("softcell: "), f"{arguments} is refused: {status} {error}")

    status, printed, _ = softcell("--print-parameters")
    check(status == 0 and "set Young modulus" in printed, "--print-parameters lists the entries")
    (folder / "printed.prm").write_text(printed)
    status, out, error = softcell("printed.prm", "--check", "--set", "Geometry/Type = sphere", "--set",
                                  "Regions/base = z < 0.01", "--set", "Loads/base = clamp", folder=folder)
    check(status == 0, f"printed parameters are a parameter file: {out} {error}")
    (folder / "bar.prm").write_text(BAR)
    status, out, error = softcell("bar.prm", "--check", folder=folder)
    check(status == 0 and "unknowns" in out, f"--check says how large the problem is: {out} {error}")
    check(not (folder / "runs").exists(), "--check writes nothing")
    status, out, error = softcell("bar.prm", "--quiet", "--output", "quiet", folder=folder)
    check(status == 0 and out == "", f"--quiet is quiet: {out} {error}")

    check({"results.csv", "run.json", "solution.pvd", "surface.vtp"} <= set(os.listdir(folder / "quiet")),
          f"the output folder is complete: {os.listdir(folder / 'quiet')}")
    record = json.loads((folder / "quiet" / "run.json").read_text())
    check(record["status"] == "done" and record["parameters"]["Material/Young modulus"] == "5000",
          "run.json has status and parameters")
    row = rows(folder / "quiet" / "results.csv")[0]
    columns = ("case method degree cut_levels cells cut_cells dofs integration_points load_steps newton_iterations "
               "linear_iterations setup_s assembly_s solve_s total_s peak_rss_mib volume strain_energy "
               "l2_displacement min_jacobian converged tip_ux tip_uy tip_uz base_fx base_fy base_fz").split()
    check([c for c in columns if not row.get(c)] == [], f"all columns have values: {row}")
    area, pull = math.pi * 0.05**2, 30
    check(abs(float(row["base_fy"]) - pull * area) < 0.02 * pull * area,
          f"the base holds what the top is loaded with: {row['base_fy']} against {pull * area}")

    status, out, _ = softcell("bar.prm", "--set", "Loads/top = traction 0, -1e9, 0", "--set",
                                "Solver/Load steps = 1", "--output", "far", folder=folder)
    check(status == 2 and rows(folder / "far" / "results.csv")[0]["converged"] == "false" and "may help" in out,
          f"what does not converge has status 2, is marked and gets advice: {status} {out}")


def bad_input(folder):
    """Each mistake ends at once with status 1, one sentence that names it, and nothing written."""
    write_files(folder)
    (folder / "base.prm").write_text(BAR)
    for name, settings, text, messages in BAD_INPUTS:
        file = "base.prm"
        if text is not None:
            file = "mistake.prm"
            (folder / file).write_text(text.replace("@BAR@", BAR))
        arguments = [word for setting in settings for word in ("--set", setting)]
        status, out, error = softcell(file, *arguments, "--output", "out", folder=folder)
        check(status == 1, f"{name}: status {status} in place of 1: {out} {error}")
        for message in messages:
            check(message.lower() in error.lower(), f"{name}: '{message}' is not in: {error}")
        check(error.rstrip("\n").isprintable(), f"{name}: bytes that no terminal shows: {error!r}")
        check(error.count("\n") == 1 and "exception" not in error.lower() and "/usr/" not in error,
              f"{name}: not one sentence: {error}")
        check(not (folder / "out").exists(), f"{name}: something was written")
        shutil.rmtree(folder / "out", ignore_errors=True)
    status, _, error = softcell("base.prm", "--output", "base.prm", folder=folder)
    check(status == 1 and "base.prm" in error and error.count("\n") == 1, f"file for a folder: {status} {error}")
    status, _, error = softcell("base.prm", "--check", "--output", "/proc/out", folder=folder)
    check(status == 1 and "/proc/out" in error and error.count("\n") == 1, f"no place for a folder: {status} {error}")
    (folder / "crlf.prm").write_bytes(b"\xef\xbb\xbf" + BAR.replace("\n", "\r\n").encode())
    status, _, error = softcell("crlf.prm", "--check", folder=folder)
    check(status == 0, f"the line ends and the byte order mark of other systems are read: {status} {error}")
    (folder / "good.prm").write_text(GOOD_SURFACE)
    for file, warning in (("good.off", False), ("inside_out.off", True)):
        status, out, error = softcell("good.prm", "--check", "--set", f"Geometry/File = {file}", folder=folder)
        check(status == 0 and ("turned" in (out + error).lower()) == warning,
              f"{file} is repaired where it needs it: {status} {out} {error}")
    status, _, error = softcell("base.prm", "--set", "Material/Yung modulus = 1", ranks=3, folder=folder)
    check(status == 1 and error.count("Young modulus") == 1, f"three ranks complain once: {status} {error}")


def ranks(folder):
    """One, two and three ranks give the same row to 1e-8."""
    (folder / "bar.prm").write_text(BAR)
    refinement = "weighted cell; Refinement steps = 2"
    for method in ("weighted cell", "finite cell", "moment fitting", "sparse grid", "tetrahedra", "hexahedra",
                   refinement):
        entries = [f"Discretization/{entry}" for entry in f"Method = {method}".split("; ")]
        if method == "moment fitting":  # with errors
            entries.append("Study/Reference = Discretization/Cells = 6")
        settings = [word for entry in entries for word in ("--set", entry)]
        results = []
        for n in (1, 2, 3):
            status, out, error = softcell("bar.prm", *settings, "--output", f"{method}{n}", ranks=n, folder=folder)
            check(status == 0, f"{method} on {n} ranks: status {status}: {out[-2000:]} {error[-2000:]}")
            check("\x1b" not in out, f"{method} on {n} ranks: no live line where the output is no terminal")
            if status == 0:
                results.append(rows(folder / f"{method}{n}" / "results.csv")[0])
        for n, row in enumerate(results[1:], 2):
            same_row(results[0], row, 1e-8, f"{method} on {n} ranks")


def checkpoints(folder):
    """A run that was killed goes on to the same row, and what does not fit is refused."""
    (folder / "bar.prm").write_text(BAR + """
subsection Output
  set Checkpoint = true
  set Every      = 2
end
""")
    steps = ("--set", "Solver/Load steps = 40")
    status, _, error = softcell("bar.prm", *steps, "--output", "whole", folder=folder)
    check(status == 0, f"run with states: {status} {error}")
    states = (folder / "whole" / "solution.pvd").read_text()
    check([f'timestep="{t}"' in states for t in (0.05, 0.025, 1)] == [True, False, True] and states.count("file=") == 20,
          f"every second load step is a state: {states}")

    run = subprocess.Popen([program.executable, "bar.prm", *steps, "--output", "killed"], cwd=folder, stdout=subprocess.DEVNULL)
    while run.poll() is None and not (folder / "killed" / "checkpoint.h5").exists():
        time.sleep(0.001)
    run.kill()
    run.wait()
    check(not (folder / "killed" / "results.csv").exists(), "the run was killed before its end")
    record = json.loads((folder / "killed" / "run.json").read_text())
    check(record["status"] == "running", f"a killed run is marked as running: {record['status']}")
    for ranks_now in (1, 2):
        status, out, error = softcell("bar.prm", *steps, "--output", f"on{ranks_now}", "--set",
                                      "Solver/Start from = killed/checkpoint.h5", folder=folder, ranks=ranks_now)
        check(status == 0, f"a killed run goes on: {status} {out} {error}")
        on = rows(folder / f"on{ranks_now}" / "results.csv")[0]
        whole = rows(folder / "whole" / "results.csv")[0]
        check(0 < int(on.pop("load_steps")) < int(whole.pop("load_steps")), "it takes the steps that are left")
        same_row(whole, on, 1e-8, f"stop and go on {ranks_now} ranks")

    # of a refined grid: it goes on as it was, is refined further, and a reference is found again
    def refined(steps, to, start, *more):
        entries = (f"Discretization/Refinement steps = {steps}", f"Solver/Start from = {start}", *more)
        return softcell("bar.prm", *[word for entry in entries for word in ("--set", entry)], "--output", to, folder=folder)

    for steps, to, start in ((1, "once", ""), (1, "again", "once/checkpoint.h5"), (2, "twice", ""),
                             (2, "once_more", "once/checkpoint.h5")):
        status, out, error = refined(steps, to, start)
        check(status == 0, f"{to}: status {status} {out} {error}")
    for one, other in (("once", "again"), ("twice", "once_more")):
        pair = [rows(folder / to / "results.csv")[0] for to in (one, other)]
        for row in pair:  # which a run that has nothing left to solve does not know
            row.pop("condition", None)
        same_row(*pair, 1e-8, other)
    status, _, error = refined(0, "less", "once/checkpoint.h5")
    check(status == 1 and "refined 1 times" in error and "Refinement steps = 0" in error, f"too few steps: {error}")
    for cells, is_there in (("3", False), ("3, 4", True)):
        status, out, error = refined(0, "study", "", "Study/Reference = Discretization/Refinement steps = 1",
                                     f"Study/Cells = {cells}")
        check(status == 0 and ("Solved before: reference" in out) == is_there,
              f"adaptive reference, cells {cells}: {out} {error}")

    short = (folder / "whole" / "checkpoint.h5").read_bytes()
    (folder / "short.h5").write_bytes(short[:len(short) // 2])
    for file, setting in (("short.h5", "Output/Every = 0"), ("whole/checkpoint.h5", "Discretization/Cells = 5")):
        status, _, error = softcell("bar.prm", "--set", f"Solver/Start from = {file}", "--set", setting, "--output",
                                    "out", folder=folder)
        check(status == 1 and file in error and error.count("\n") == 1, f"{file} with {setting}: {status} {error}")
        check(not (folder / "out").exists(), f"{file} with {setting}: something was written")


if len(sys.argv) != 3:
    sys.exit(__doc__)
program.executable = os.path.abspath(sys.argv[1])
with tempfile.TemporaryDirectory() as temporary:
    groups = {"command_line": command_line, "bad_input": bad_input, "ranks": ranks, "checkpoints": checkpoints,
              "dynamics": motion_test.dynamics, "motion_failures": motion_test.motion_failures,
              "methods": method_tests.methods, "studies": method_tests.studies,
              "cook_membrane": method_tests.cook_membrane, "multigrid": method_tests.multigrid,
              "organ": method_tests.organ, "sweeps": study_tests.sweeps, "resume": study_tests.resume,
              "report": report_test.report}
    groups[sys.argv[2]](pathlib.Path(temporary))
print(f"{len(failures)} failures")
sys.exit(1 if failures else 0)
