#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The defect of weighted cells in the patch test, by a program that shares no code with softcell.

usage: weighted_cell_patch_test.py [CELLS ...]

A linear cube of 1 m lies across the axes in a grid of CELLS cells (4 and 8) across its bounding box. Tractions of a linear
displacement act on its sides, which springs hold that are at rest there. Octants of cells and the sides are sampled by
midpoints. Printed is the relative error in L2 of the displacement's gradient, over the points of the rule.
"""
import itertools
import sys

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

E, NU, SPRING, SPREAD = 1000, 0.3, 1000, 0.1  # Pa, 1, Pa/m, 1
MU, LAMBDA = E / (2 * (1 + NU)), E * NU / ((1 + NU) * (1 - 2 * NU))
GRADIENT = np.array([[0.1, 0.2, 0], [-0.05, 0, 0], [0, 0, 0.15]])  # of the displacement, (component, axis)
STRESS = MU * (GRADIENT + GRADIENT.T) + LAMBDA * np.trace(GRADIENT) * np.eye(3)
EDGES = np.array([[2, -2, 1], [2, 1, -2], [1, 2, 2]]) / 3  # of the cube, as columns
ORIGIN, WIDTH = np.array([-2, -2, 0]) / 3, 5 / 3  # of its bounding box
CORNERS = np.array(list(itertools.product((0, 1), repeat=3)))  # of a unit cell


def shapes(xi):
    """Trilinear shapes (points, 8) and their derivatives (points, 8, 3) in the unit cell."""
    one = np.where(CORNERS, xi[:, None, :], 1 - xi[:, None, :])
    sign = np.where(CORNERS, 1, -1)[None]
    gradients = np.stack([sign[..., d] * np.prod(np.delete(one, d, axis=2), axis=2) for d in range(3)], axis=2)
    return one.prod(axis=2), gradients


def filled(lower, h, samples):
    """The part of each octant of a cell that lies in the cube."""
    middles = (np.arange(samples) + 0.5) / (2 * samples)
    inner = np.stack(np.meshgrid(middles, middles, middles, indexing="ij"), axis=-1).reshape(-1, 3)
    points = lower + h * (CORNERS[:, None, :] / 2 + inner)
    across = points @ EDGES
    return np.all((across > 0) & (across < 1), axis=2).mean(axis=1)


def defect(n, samples=32, side_samples=400):
    h = WIDTH / n
    fractions = {}
    for cell in itertools.product(range(n), repeat=3):
        v = filled(ORIGIN + h * np.array(cell), h, samples)
        if v.sum() == 0:
            continue
        if (v > 0.1 * v.max()).sum() < 4:
            v = v + SPREAD * (v.mean() - v)
        fractions[cell] = v

    gauss = 0.5 + (2 * CORNERS - 1) / (2 * np.sqrt(3))
    dN = shapes(gauss)[1] / h
    strain = np.zeros((8, 6, 24))
    for a in range(8):
        for row, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))):
            strain[:, row, 3 * a + i] = dN[:, a, j]
            if i != j:
                strain[:, row, 3 * a + j] = dN[:, a, i]
    law = np.diag([2 * MU] * 3 + [MU] * 3)
    law[:3, :3] += LAMBDA
    point_stiffness = np.einsum("qki,kl,qlj->qij", strain, law, strain) * h**3 / 8

    unknowns = {cell: (3 * (np.ravel_multi_index((np.array(cell) + CORNERS).T, [n + 1] * 3))[:, None] + np.arange(3)).ravel()
                for cell in fractions}
    stiffness = {cell: np.tensordot(v, point_stiffness, 1) for cell, v in fractions.items()}
    force = np.zeros(3 * (n + 1)**3)

    s = (np.arange(side_samples) + 0.5) / side_samples
    first, second = (m.ravel() for m in np.meshgrid(s, s, indexing="ij"))
    centres = {cell: ORIGIN + h * (np.array(cell) + 0.5) for cell in fractions}
    names, places = list(centres), np.array(list(centres.values()))
    for axis, end in itertools.product(range(3), (0, 1)):
        local = np.empty((side_samples**2, 3))
        local[:, axis], local[:, axis - 1], local[:, axis - 2] = end, first, second
        X = local @ EDGES.T
        traction = STRESS @ EDGES[:, axis] * (1 if end else -1)
        cells = np.floor((X - ORIGIN) / h - 1e-9 * (1 if end else -1) * EDGES[:, axis]).astype(int)
        for cell in map(tuple, np.unique(cells, axis=0)):
            here = X[np.all(cells == cell, axis=1)]
            if cell not in fractions:  # the sampling saw nothing of it: the nearest cell, extended
                cell = names[np.argmin(np.linalg.norm(places - here.mean(axis=0), axis=1))]
            N = shapes((here - ORIGIN) / h - np.array(cell))[0] / side_samples**2
            load = N.sum(axis=0)[:, None] * traction + SPRING * N.T @ (here @ GRADIENT.T)
            force[unknowns[cell]] += load.ravel()
            stiffness[cell] = stiffness[cell] + np.kron(SPRING * side_samples**2 * N.T @ N, np.eye(3))

    used = np.unique(np.concatenate(list(unknowns.values())))
    rows = np.concatenate([np.repeat(u, 24) for u in unknowns.values()])
    columns = np.concatenate([np.tile(u, 24) for u in unknowns.values()])
    entries = np.concatenate([stiffness[cell].ravel() for cell in unknowns])
    K = coo_matrix((entries, (rows, columns)), shape=[len(force)] * 2).tocsc()[used][:, used]
    u = np.zeros(len(force))
    u[used] = spsolve(K, force[used])

    error = volume = 0
    for cell, v in fractions.items():
        found = np.einsum("ac,qad->qcd", u[unknowns[cell]].reshape(8, 3), dN)
        error += v @ ((found - GRADIENT)**2).sum(axis=(1, 2))
        volume += v.sum()
    return np.sqrt(error / volume) / np.linalg.norm(GRADIENT)


for n in [int(argument) for argument in sys.argv[1:]] or [4, 8]:
    print(f"{n} cells: {defect(n):.4f}")
