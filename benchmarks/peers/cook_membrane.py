#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cook's membrane at finite strain by FEniCSx: the numbers with which tests/program/method_tests.py compares softcell.

usage: cook_membrane.py     needs python3-dolfinx; prints the rows n x n of the table in README.md

Plane strain, Neo-Hookean as softcell has it, E = 240.565, held on x = 0, dead shear traction 6.25 on x = 48. Quadratic
quadrilaterals, n x n of equal size along the edges. u_y is that of (48, 52), the middle of the loaded edge.
"""
import logging

import numpy as np
import ufl
from dolfinx import fem, log, mesh
from mpi4py import MPI

from fenicsx import solve

YOUNG, TRACTION = 240.565, 6.25
POISSON = (0.3, 0.45, 0.499)
SIZES = (12, 24, 48, 96)
N_STEPS = 5


def membrane(n):
    """The panel with corners (0, 0), (48, 44), (48, 60) and (0, 44), in n x n cells."""
    domain = mesh.create_unit_square(MPI.COMM_WORLD, n, n, mesh.CellType.quadrilateral)
    s, t = domain.geometry.x[:, 0].copy(), domain.geometry.x[:, 1].copy()
    domain.geometry.x[:, 0] = 48 * s
    domain.geometry.x[:, 1] = 44 * s + t * (44 - 28 * s)
    return domain


def deflections(n):
    """u_y of (48, 52) for every Poisson ratio."""
    domain = membrane(n)
    V = fem.VectorFunctionSpace(domain, ("Lagrange", 2))
    held = fem.locate_dofs_geometrical(V, lambda X: X[0] < 1e-9)
    middle = fem.locate_dofs_geometrical(V, lambda X: np.hypot(X[0] - 48, X[1] - 52) < 1e-9)
    clamp = fem.dirichletbc(np.zeros(2), held, V)
    end = mesh.locate_entities_boundary(domain, 1, lambda X: X[0] > 48 - 1e-9)
    tags = mesh.meshtags(domain, 1, np.sort(end), np.full(len(end), 1, dtype=np.int32))
    dx = ufl.Measure("dx", domain, metadata={"quadrature_degree": 5})
    ds = ufl.Measure("ds", domain, subdomain_data=tags)

    results = []
    for poisson in POISSON:
        u, v = fem.Function(V), ufl.TestFunction(V)
        lame, shear = YOUNG * poisson / ((1 + poisson) * (1 - 2 * poisson)), YOUNG / (2 * (1 + poisson))
        F = ufl.Identity(2) + ufl.grad(u)
        ln_J = ufl.ln(ufl.det(F))
        energy = shear / 2 * (ufl.inner(F, F) - 2) - shear * ln_J + lame / 2 * ln_J**2
        factor = fem.Constant(domain, 0.0)
        residual = ufl.derivative(energy * dx, u, v) - factor * TRACTION * v[1] * ds(1)
        solve(residual, u, clamp, factor, N_STEPS)
        results.append(u.x.array.reshape(-1, 2)[middle[0], 1])
    return results


def main():
    """Prints the table."""
    logging.disable(logging.INFO)
    log.set_log_level(log.LogLevel.WARNING)
    print("| cells | " + " | ".join(f"nu = {nu}" for nu in POISSON) + " |\n|---|" + "---:|" * len(POISSON))
    for n in SIZES:
        print(f"| {n} x {n} | " + " | ".join(f"{u:.9f}" for u in deflections(n)) + " |", flush=True)


if __name__ == "__main__":
    main()
