#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compares softcell with FEniCSx on the same meshes: finite elastic deformations under dead and follower loads.

usage: fenicsx.py     needs python3-dolfinx and build/release/softcell; exits with 1 if they differ by more than 1e-6

The energies are written here in UFL, from which FEniCSx derives forces and tangents by itself.
"""
import logging
import sys

import basix
import numpy as np
import ufl
from dolfinx import fem, geometry, log, mesh, nls
from mpi4py import MPI
from petsc4py import PETSc

import common

YOUNG, POISSON, DENSITY = 5000.0, 0.3, 1000.0
GRAVITY = (0.02, 0.0, -0.1)
TRACTION = (0.0, -30.0, 0.0)
PRESSURE = 8.0
N_STEPS = 10


def softcell(body, degree, law, load):
    """The results of softcell."""
    entries = {
        **body.entries(degree, law),
        "Material/Young modulus": YOUNG,
        "Material/Poisson ratio": POISSON,
        "Material/Density": DENSITY,
        "Loads/Gravity": common.listed(GRAVITY),
    }
    if load == "pressure":
        entries["Loads/side"] = f"pressure {PRESSURE}"
    else:
        entries["Loads/top"] = "traction " + common.listed(TRACTION)
    return common.run_softcell(entries, body.mesh)


def fenicsx_mesh(points, cells):
    """The same mesh in FEniCSx, which numbers the corners of a hexahedron lexicographically."""
    kind = {4: "tetrahedron", 8: "hexahedron"}[cells.shape[1]]
    if kind == "hexahedron":
        cells = cells[:, [0, 1, 3, 2, 4, 5, 7, 6]]
    element = ufl.VectorElement("Lagrange", ufl.Cell(kind, geometric_dimension=3), 1)
    return mesh.create_mesh(MPI.COMM_WORLD, cells, points, ufl.Mesh(element))


def energy_density(law, F):
    """Strain energy per volume at rest."""
    lame = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    shear = YOUNG / (2 * (1 + POISSON))
    C = F.T * F
    if law == "Neo-Hookean":
        ln_J = ufl.ln(ufl.det(F))
        return shear / 2 * (ufl.tr(C) - 3) - shear * ln_J + lame / 2 * ln_J**2
    E = (C - ufl.Identity(3)) / 2
    return lame / 2 * ufl.tr(E) ** 2 + shear * ufl.inner(E, E)


def integration_degree(body, degree):
    """The degree that makes FEniCSx take softcell's rule: one and four points, and Gauss's of degree + 1."""
    return degree if body.method == "tetrahedra" else 2 * degree + 1


def fenicsx(body, degree, law, load):
    """The results of FEniCSx, under the names that they have in softcell's results.csv."""
    domain = fenicsx_mesh(*body.mesh)
    V = fem.VectorFunctionSpace(domain, ("Lagrange", degree))
    u, v = fem.Function(V), ufl.TestFunction(V)

    base = mesh.locate_entities_boundary(domain, 2, lambda X: X[2] < 1e-6)
    top = mesh.locate_entities_boundary(domain, 2, lambda X: X[2] > body.length - 1e-6)
    side = mesh.locate_entities_boundary(domain, 2, lambda X: X[1] < body.side)
    loaded = np.sort(side if load == "pressure" else top)
    tags = mesh.meshtags(domain, 2, loaded, np.full(len(loaded), 1, dtype=np.int32))
    dx = ufl.Measure("dx", domain, metadata={"quadrature_degree": integration_degree(body, degree)})
    ds = ufl.Measure("ds", domain, subdomain_data=tags, metadata={"quadrature_degree": 2 * degree + 1})

    factor = fem.Constant(domain, 0.0)
    F = ufl.Identity(3) + ufl.grad(u)
    residual = ufl.derivative(energy_density(law, F) * dx, u, v)
    residual -= factor * DENSITY * ufl.inner(ufl.as_vector(GRAVITY), v) * dx
    if load == "pressure":
        area = ufl.det(F) * ufl.inv(F).T * ufl.FacetNormal(domain)
        residual += factor * PRESSURE * ufl.inner(area, v) * ds(1)
    else:
        residual -= factor * ufl.inner(ufl.as_vector(TRACTION), v) * ds(1)

    held = fem.locate_dofs_topological(V, 2, base)
    clamp = fem.dirichletbc(np.zeros(3), held, V)
    solve(residual, u, clamp, factor, N_STEPS)

    forces = fem.petsc.assemble_vector(fem.form(residual)).array.reshape(-1, 3)
    rule, _ = basix.make_quadrature(
        basix.cell.string_to_type(domain.topology.cell_name()), integration_degree(body, degree)
    )
    jacobian = fem.Expression(ufl.det(F), rule).eval(np.arange(len(body.mesh[1]), dtype=np.int32))
    results = {
        "volume": integral(1 * dx),
        "strain_energy": integral(energy_density(law, F) * dx),
        "l2_displacement": integral(ufl.inner(u, u) * dx) ** 0.5,
        "min_jacobian": jacobian.min(),
    }
    for name, vector in (("tip_u", value_at(body.mesh[0][body.tip()], u)), ("base_f", forces[held].sum(axis=0))):
        results.update({name + c: value for c, value in zip("xyz", vector)})
    return results


def solve(residual, u, clamp, factor, n_steps):
    """Newton's method with MUMPS, the load in equal steps."""
    problem = fem.petsc.NonlinearProblem(residual, u, [clamp])
    solver = nls.petsc.NewtonSolver(MPI.COMM_WORLD, problem)
    solver.convergence_criterion = "incremental"
    solver.rtol = 1e-11
    options, prefix = PETSc.Options(), solver.krylov_solver.getOptionsPrefix()
    options[prefix + "ksp_type"] = "preonly"
    options[prefix + "pc_type"] = "lu"
    options[prefix + "pc_factor_mat_solver_type"] = "mumps"
    solver.krylov_solver.setFromOptions()
    for step in range(1, n_steps + 1):
        factor.value = step / n_steps
        solver.solve(u)


def integral(expression):
    """The value of an integral."""
    return fem.assemble_scalar(fem.form(expression))


def value_at(point, u):
    """u at a point of the body at rest."""
    domain = u.function_space.mesh
    tree = geometry.BoundingBoxTree(domain, 3, padding=1e-9)
    candidates = geometry.compute_collisions(tree, point[None])
    cells = geometry.compute_colliding_cells(domain, candidates, point[None]).links(0)
    return u.eval(point, cells[:1])


def main():
    """Runs every case with both codes."""
    logging.disable(logging.INFO)
    log.set_log_level(log.LogLevel.WARNING)
    worst = 0.0
    for name, body in common.bodies().items():
        for degree in (1, 2):
            for law, load in (
                ("Neo-Hookean", "traction"),
                ("Saint-Venant-Kirchhoff", "traction"),
                ("Neo-Hookean", "pressure"),
            ):
                ours = softcell(body, degree, law, load)
                theirs = fenicsx(body, degree, law, load)
                title = f"{name}, {body.method} of degree {degree}, {law}, weight and {load}"
                worst = max(worst, common.compare(title, ours, theirs))
    return common.verdict(worst)


if __name__ == "__main__":
    sys.exit(main())
