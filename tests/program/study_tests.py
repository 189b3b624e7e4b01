# SPDX-License-Identifier: LGPL-2.1-or-later
"""Studies as a user runs them: what is swept, interrupted and resumed."""
import json
import subprocess
import time

import program
from program import BAR, check, rows, same_row, softcell

STUDY = BAR + """
subsection Solver
  set Load steps = 8
end
subsection Study
  set Methods   = weighted cell, sparse grid
  set Cells     = 3, 4
  set Reference = Discretization/Method = tetrahedra; Discretization/Degree = 2; Discretization/Mesh size = 0.05
end
"""
CASES = ["weighted_cell_n3", "weighted_cell_n4", "sparse_grid_n3", "sparse_grid_n4"]


def solved(out):
    """Names of the runs that were solved, and not only checked or kept."""
    names = [line.split(": ", 1)[1] for line in out.splitlines() if line.startswith("Case ")]
    return (["reference"] if "\nReference: " in out else []) + names


def study(folder, *settings, to, ranks=1, status=0):
    """Runs the study; its output and its rows by case."""
    arguments = [word for setting in settings for word in ("--set", setting)]
    result, out, error = softcell("study.prm", *arguments, "--output", to, folder=folder, ranks=ranks)
    check(result == status, f"study into {to}: status {result}: {out[-2000:]} {error[-2000:]}")
    return out, {row["case"]: row for row in rows(folder / to / "results.csv")}


def resume(folder):
    """A study that was killed goes on where it stopped, to the same table."""
    (folder / "study.prm").write_text(STUDY)
    out, whole = study(folder, to="whole")
    check(solved(out) == ["reference", *CASES] and list(whole) == CASES, f"all cases are solved: {solved(out)}")

    run = subprocess.Popen([program.executable, "study.prm", "--output", "killed"], cwd=folder,
                           stdout=subprocess.DEVNULL)
    while run.poll() is None and not (folder / "killed" / CASES[1] / "results.csv").exists():
        time.sleep(0.001)
    run.kill()
    run.wait()
    before = {row["case"]: row for row in rows(folder / "killed" / "results.csv")}
    record = json.loads((folder / "killed" / "run.json").read_text())
    check(2 <= len(before) < 4 and record["status"] == "running", f"it was killed before its end: {list(before)}")
    out, after = study(folder, to="killed")
    kept = [name for name in CASES if name not in solved(out)]
    check(kept[:2] == CASES[:2] and "reference" not in solved(out), f"it goes on where it stopped: {solved(out)}")
    check(list(after) == CASES, f"and has all rows: {list(after)}")
    for name in CASES:
        same_row(whole[name], after[name], 1e-8, f"{name} of a study that was killed")
    check(all(after[name]["total_s"] == before[name]["total_s"] for name in CASES[:2]), "what is kept is as before")
    record = json.loads((folder / "killed" / "run.json").read_text())
    check(record["status"] == "done" and all(record["linear_residuals"][name] for name in CASES),
          "the record of a study that went on has all residuals")

    # What is asked for decides, and what was solved is found again.
    table = (folder / "killed" / "results.csv").read_bytes()
    out, fewer = study(folder, "Study/Cells = 3", to="killed")
    check(solved(out) == [] and list(fewer) == CASES[::2], f"a smaller study: {solved(out)} {list(fewer)}")
    out, _ = study(folder, to="killed")
    check(solved(out) == [] and (folder / "killed" / "results.csv").read_bytes() == table, "nothing is left to do")
    new = ["weighted_cell_n5", "sparse_grid_n5"]
    out, more = study(folder, "Study/Cells = 3, 4, 5", to="killed")
    check(solved(out) == new and len(more) == 6, f"a larger study: {solved(out)}")
    (folder / "killed" / "reference" / "checkpoint.h5").unlink()
    (folder / "killed" / new[1] / "results.csv").unlink()
    out, _ = study(folder, "Study/Cells = 3, 4, 5", to="killed")
    check(solved(out) == ["reference", new[1]], f"what someone removed is solved again: {solved(out)}")
    (folder / "killed" / "reference" / "checkpoint.h5").write_text("junk")
    larger = "Study/Cells = 3, 4, 5, 6"
    for _ in range(2):  # what has no errors is tried again
        out, table = study(folder, larger, to="killed", status=2)
        check(len(solved(out)) == 2 and out.count("The reference failed") == 1 and len(table) == 8,
              f"a reference that fails is tried once: {solved(out)}")
        check(all((row["relative_l2_error"] == "") == name.endswith("n6") for name, row in table.items()),
              "cases go on without it")
    for settings in (["Material/Poisson ratio = 0.35"], ["Study/Resume = false"]):
        out, _ = study(folder, *settings, to="killed")
        check(solved(out) == ["reference", *CASES], f"{settings}: all is solved again: {solved(out)}")
    for n_ranks, expected in ((2, ["reference", *CASES]), (2, [])):
        out, _ = study(folder, to="whole", ranks=n_ranks)
        check(solved(out) == expected, f"on {n_ranks} ranks: {solved(out)}")


def sweeps(folder):
    """Materials, loads and solvers are swept; a case that fails is a row and not the end."""
    (folder / "study.prm").write_text(STUDY + """
subsection Sweeps
  set tissue = soft: Material/Young modulus = 2500 | stiff:
  set solver = CG: | direct: Solver/Linear solver = direct
end
""")
    settings = ("Study/Methods = weighted cell", "Material/Model = linear")
    out, table = study(folder, *settings, to="swept")
    check(len(table) == 8 and out.count("\nReference: ") == 2, f"a reference for every tissue: {list(table)}")
    for name, row in table.items():
        check(name.endswith(f"_{row['tissue']}_{row['solver']}"), f"{name}: {row['tissue']}, {row['solver']}")
        # a linear body of half the stiffness moves twice as far, and is as far from its reference
        stiff = table[name.replace("soft", "stiff")]
        factor = 2 if row["tissue"] == "soft" else 1
        for column, expected in (("tip_uy", factor), ("relative_l2_error", 1), ("observed_rate", 1)):
            a, b = (float(one[column] or "nan") for one in (row, stiff))
            check(abs(a / b / expected - 1) < 1e-6 or row[column] == stiff[column] == "",
                  f"{name}: {column} {row[column]} against {stiff[column]}")

    # One case cannot reach its load; the folder of another cannot be made.
    (folder / "failing").mkdir()
    (folder / "failing" / "weighted_cell_soft_near").write_text("in the way")
    settings = ("Study/Methods = weighted cell", "Study/Cells =", "Study/Reference =", "Solver/Load steps = 1",
                "Sweeps/solver = near: | far: Loads/top = traction 0, -1e9, 0")
    out, table = study(folder, *settings, to="failing", status=2)
    converged = {name[len("weighted_cell_"):]: row["converged"] for name, row in table.items()}
    check(converged == {"soft_near": "false", "soft_far": "false", "stiff_near": "true", "stiff_far": "false"},
          f"what fails is a row: {converged}")
    check(all(row["failure"] for row in table.values() if row["converged"] == "false"), "and says why")
    (folder / "failing" / "weighted_cell_soft_near").unlink()
    out, table = study(folder, *settings, to="failing", status=2)
    check(solved(out) == ["weighted_cell_soft_near"], f"what could not be written is tried again: {solved(out)}")
    check(table["weighted_cell_soft_near"]["converged"] == "true", "and then succeeds")
