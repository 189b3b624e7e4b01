# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole program, what it writes, and parameter files to run it with."""
import csv
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
MPIRUN = ["mpirun", "--allow-run-as-root", "--oversubscribe"]
# A bending bar, small enough to run in a second.
BAR = """
subsection Geometry
  set Type   = cylinder
  set Radius = 0.05
  set Length = 0.2
end
subsection Regions
  set base = z < 1e-6
  set top  = z > 0.2 - 1e-6
end
subsection Material
  set Young modulus = 5000
  set Poisson ratio = 0.3
end
subsection Discretization
  set Cells      = 4
  set Cut levels = 2
  set Mesh size  = 0.025
end
subsection Loads
  set base = clamp
  set top  = traction 0, -30, 0
end
subsection Solver
  set Residual tolerance = 1e-11
  set Linear tolerance   = 1e-12
end
subsection Probes
  set tip = 0, 0, 0.2
end
"""
GOOD_SURFACE = """
subsection Geometry
  set Type = surface
end
subsection Regions
  set base = z < 1e-6
end
subsection Discretization
  set Cells = 4
end
subsection Loads
  set base = clamp
end
"""
# Of a row of results.csv, what need not be the same on any number of ranks.
NOT_COMPARED = {"newton_iterations", "linear_iterations", "most_linear_iterations", "setup_s", "assembly_s", "solve_s",
                "total_s", "errors_s", "peak_rss_mib", "condition", "fingerprint"}
failures = []
executable = None  # set by who runs the tests


def check(condition, message):
    if not condition:
        failures.append(message)
        print("FAILED:", message)


def softcell(*arguments, ranks=1, folder="."):
    """Runs the program; its exit status, its output and its error output."""
    mpi = [] if ranks == 1 else [*MPIRUN, "-n", str(ranks)]
    run = subprocess.run([*mpi, executable, *arguments], cwd=folder, capture_output=True, text=True, timeout=600,
                         stdin=subprocess.DEVNULL, env={**os.environ, "OMPI_MCA_rmaps_base_oversubscribe": "1"})
    return run.returncode, run.stdout, run.stderr


def rows(file):
    with open(file, newline="") as stream:
        return list(csv.DictReader(stream))


def same_row(one, other, tolerance, what):
    check(set(one) == set(other), f"{what}: other columns: {set(one) ^ set(other)}")
    scales = {}  # of vectors, whose components are as good as the largest one
    for column, value in one.items():
        if column[-3:-1] in ("_u", "_f") and value:
            scales[column[:-1]] = max(abs(float(value)), scales.get(column[:-1], 0))
    for kind in ("_u", "_f"):  # what is held moves as little as rounding says
        largest = max((scale for name, scale in scales.items() if name[-2:] == kind), default=0)
        scales.update({name: max(scale, 1e-4 * largest) for name, scale in scales.items() if name[-2:] == kind})
    for column in set(one) & set(other) - NOT_COMPARED:
        a, b = one[column], other[column]
        try:
            size = scales.get(column[:-1], max(abs(float(a)), abs(float(b))))
            same = abs(float(a) - float(b)) <= tolerance * size
        except ValueError:
            same = a == b
        check(same, f"{what}: {column} is {a} and {b}")
