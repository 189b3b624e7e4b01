#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Processor time of FEniCSx and softcell for the bending of a cylinder to about the same error at the tip, on one core.

usage: fenicsx_speed.py     needs python3-dolfinx, python3-gmsh and build/release/softcell

The body and load of prm/studies/cylinder_bending.prm. FEniCSx solves by linear tetrahedra, conjugate gradients and GAMG
with the rigid-body motions; softcell does so on the same mesh and by its other methods. The codes take turns, twice,
and the shorter time counts. FEniCSx's is that of building the function space, assembling and solving, without imports,
meshing and compiling; softcell's is that of the whole program.
"""
import os
import resource
import sys
import tempfile
import time

os.environ["OMP_NUM_THREADS"] = "1"

import gmsh
import numpy as np
import ufl
from dolfinx import fem, la, mesh, nls
from mpi4py import MPI
from petsc4py import PETSc

import common
import fenicsx

RADIUS, LENGTH = 0.05, 0.6
TRACTION = (0.0, -30.0, 0.0)
MESH_SIZE = 0.006
N_STEPS = 3  # of FEniCSx, whose Newton method has no line search and fails with two
TOLERANCE = 1e-6
ROUNDS = 2
COMPILED = {"cffi_extra_compile_args": ["-O3", "-march=native", "-ffast-math"], "cffi_libraries": ["m"]}

# softcell's cases: name, degree, and what differs from the parameter file.
CASES = [
    ("weighted cell", 1, {"Discretization/Cells": 12}),
    ("finite cell", 1, {"Discretization/Cells": 12}),
    ("tetrahedra", 2, {"Discretization/Cells": 5}),
    ("hexahedra", 2, {"Discretization/Cells": 3}),
]
# The u_y of the tip in m by curved hexahedra of degree 3, four across the diameter; of degree 2: -0.38922.
EXACT = -0.38935


def cylinder_mesh():
    """Tetrahedra of the cylinder by Gmsh."""
    with tempfile.TemporaryDirectory() as folder:
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MeshSizeMin", MESH_SIZE)
        gmsh.option.setNumber("Mesh.MeshSizeMax", MESH_SIZE)
        gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
        gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, LENGTH, RADIUS)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(3, [1])
        gmsh.model.mesh.generate(3)
        gmsh.write(f"{folder}/cylinder.msh")
        gmsh.finalize()
        return common.read_msh(f"{folder}/cylinder.msh")


def rigid_motions(V):
    """PETSc's near null space of the six rigid-body motions."""
    x, y, z = V.tabulate_dof_coordinates().T
    o, i = np.zeros_like(x), np.ones_like(x)
    motions = [(i, o, o), (o, i, o), (o, o, i), (-y, x, o), (z, o, -x), (o, -z, y)]
    basis = [la.create_petsc_vector(V.dofmap.index_map, V.dofmap.bs) for _ in motions]
    for vector, motion in zip(basis, motions):
        vector.array[:] = np.stack(motion, axis=1).ravel()
    la.orthonormalize(basis)
    return PETSc.NullSpace().create(vectors=basis)


def solve_by_fenicsx(domain):
    """The displacement, the load applied in equal steps."""
    V = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
    u, v = fem.Function(V), ufl.TestFunction(V)
    base = mesh.locate_entities_boundary(domain, 2, lambda X: X[2] < 1e-6)
    top = np.sort(mesh.locate_entities_boundary(domain, 2, lambda X: X[2] > LENGTH - 1e-6))
    tags = mesh.meshtags(domain, 2, top, np.full(len(top), 1, dtype=np.int32))
    clamp = fem.dirichletbc(np.zeros(3), fem.locate_dofs_topological(V, 2, base), V)

    factor = fem.Constant(domain, 0.0)
    energy = fenicsx.energy_density("Neo-Hookean", ufl.Identity(3) + ufl.grad(u))
    residual = ufl.derivative(energy * ufl.dx(domain, metadata={"quadrature_degree": 1}), u, v)
    residual -= factor * ufl.inner(ufl.as_vector(TRACTION), v) * ufl.Measure("ds", domain, subdomain_data=tags)(1)
    problem = fem.petsc.NonlinearProblem(residual, u, [clamp], jit_params=COMPILED)
    solver = nls.petsc.NewtonSolver(MPI.COMM_WORLD, problem)
    solver.A.setNearNullSpace(rigid_motions(V))
    solver.convergence_criterion = "incremental"
    solver.rtol = TOLERANCE
    options, prefix = PETSc.Options(), solver.krylov_solver.getOptionsPrefix()
    options[prefix + "ksp_type"] = "cg"
    options[prefix + "ksp_rtol"] = TOLERANCE
    options[prefix + "pc_type"] = "gamg"
    solver.krylov_solver.setFromOptions()
    for step in range(1, N_STEPS + 1):
        factor.value = step / N_STEPS
        solver.solve(u)
    if solver.krylov_solver.getConvergedReason() < 0:
        sys.exit("FEniCSx's conjugate gradients failed; give more load steps.")
    return u


def fenicsx_row(domain):
    """Unknowns, tip displacement and processor time of FEniCSx."""
    start = time.process_time()
    u = solve_by_fenicsx(domain)
    seconds = time.process_time() - start
    tip = fenicsx.value_at(np.array([0, 0, LENGTH]), u)[1]
    return u.function_space.dofmap.index_map.size_global * 3, tip, seconds


def softcell_row(method, degree, parameters, tetrahedra=None):
    """Unknowns, tip displacement and processor time of softcell, on its own mesh or on given tetrahedra."""
    entries = {
        "Geometry/Type": "cylinder",
        "Geometry/Radius": RADIUS,
        "Geometry/Length": LENGTH,
        "Regions/base": "z < 1e-6",
        "Regions/top": f"z > {LENGTH} - 1e-6",
        "Material/Young modulus": fenicsx.YOUNG,
        "Material/Poisson ratio": fenicsx.POISSON,
        "Discretization/Method": method,
        "Discretization/Degree": degree,
        "Loads/base": "clamp",
        "Loads/top": "traction " + common.listed(TRACTION),
        "Probes/tip": common.listed([0, 0, LENGTH]),
        "Solver/Residual tolerance": TOLERANCE,
        "Solver/Update tolerance": TOLERANCE,
        "Solver/Linear tolerance": TOLERANCE,
        **parameters,
    }
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    row = common.run_softcell(entries, tetrahedra)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return int(row["dofs"]), row["tip_uy"], seconds


def main():
    """Lets the codes take turns and prints the shortest time of each."""
    tetrahedra = cylinder_mesh()
    domain = fenicsx.fenicsx_mesh(*tetrahedra)
    peer = "FEniCSx, tetrahedra 1"
    runs = {
        peer: lambda: fenicsx_row(domain),
        "softcell, tetrahedra 1, same mesh": lambda: softcell_row("tetrahedra", 1, {}, tetrahedra),
    }
    for case in CASES:
        runs[f"softcell, {case[0]} {case[1]}"] = lambda case=case: softcell_row(*case)

    rows = {name: [] for name in runs}
    for _ in range(ROUNDS):
        for name, run in runs.items():
            rows[name].append(run())
            print(f"{name}: {rows[name][-1][2]:.2f} s", file=sys.stderr)
    print("| code and method | unknowns | tip u_y, m | error, % | processor time, s | FEniCSx's / this time |")
    print("|---|---:|---:|---:|---:|---:|")
    least = {name: min(results, key=lambda row: row[2]) for name, results in rows.items()}
    for name, (unknowns, tip, seconds) in least.items():
        error = 100 * abs(tip / EXACT - 1)
        ratio = least[peer][2] / seconds
        print(f"| {name} | {unknowns} | {tip:.5f} | {error:.2f} | {seconds:.2f} | {ratio:.1f} |")


if __name__ == "__main__":
    sys.exit(main())
