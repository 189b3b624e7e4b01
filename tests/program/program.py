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
