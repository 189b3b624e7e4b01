#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compares softcell with CalculiX on the same meshes: linear elasticity, and Saint-Venant-Kirchhoff at large bending.

usage: calculix.py     needs calculix-ccx and build/release/softcell; exits with 1 if they differ by more than 1e-6

CalculiX's *ELASTIC with NLGEOM relates the second Piola-Kirchhoff stress to Green's strain linearly. Its *HYPERELASTIC
laws split the energy in another way than softcell's, so they are not compared. Nor is the energy that it prints with
NLGEOM: it depends on the size of the increments and tends to twice the integral of S : E / 2 as they shrink.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import common

# Large, because CalculiX takes forces below 1e-8 for zero.
YOUNG, POISSON, DENSITY = 5e9, 0.3, 1e9
GRAVITY = (0.02, 0.04, -0.1)
PRESSURE = 5e6

# The corners of each face of a cell, and between which corners the further nodes of C3D10 are.
FACES = {
    4: [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)],
    8: [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)],
}
EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]


def add_edge_nodes(points, cells):
    """The mesh with a node in the middle of each edge of its tetrahedra."""
    pairs = np.sort(cells[:, EDGES], axis=2)
    edges, number = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    middles = points[edges].mean(axis=1)
    return np.vstack([points, middles]), np.hstack([cells, len(points) + number.reshape(len(cells), -1)])


def table(rows):
    """Lines of numbers, of which CalculiX reads at most 20 characters each."""
    return "\n".join(", ".join(f"{x:.13e}" if isinstance(x, float) else str(x) for x in row) for row in rows)


def pressed_faces(body):
    """Cell, face and pressure on the body's top."""
    points, cells = body.mesh
    top = points[:, 2] > body.length - 1e-6
    return [
        (cell, f"P{face}", PRESSURE)
        for cell, corners in enumerate(cells, 1)
        for face, local in enumerate(FACES[len(corners)], 1)
        if top[corners[list(local)]].all()
    ]


def input_file(body, degree, law):
    """CalculiX's input: a body held at its base under its weight and, if it is linear, a pressure on its top."""
    points, cells = body.mesh
    element = {(4, 1): "C3D4", (4, 2): "C3D10", (8, 1): "C3D8"}[cells.shape[1], degree]
    if degree == 2:
        points, cells = add_edge_nodes(points, cells)
    held = np.flatnonzero(points[:, 2] < 1e-6) + 1
    linear = law == "linear"
    return f"""*NODE, NSET=ALL
{table([i, *point] for i, point in enumerate(points.tolist(), 1))}
*ELEMENT, TYPE={element}, ELSET=BODY
{table([i, *cell] for i, cell in enumerate((cells + 1).tolist(), 1))}
*NSET, NSET=BASE
{table([i] for i in held)}
*NSET, NSET=TIP
{body.tip() + 1}
*MATERIAL, NAME=TISSUE
*ELASTIC
{YOUNG}, {POISSON}
*DENSITY
{DENSITY}
*SOLID SECTION, ELSET=BODY, MATERIAL=TISSUE
*BOUNDARY
BASE, 1, 3
*STEP, INC=1000{"" if linear else ", NLGEOM"}
*STATIC
0.1, 1.
*CONTROLS, PARAMETERS=FIELD
1e-11, 1e-11, , , , 1e-14, 1e-11, 1e-14
*DLOAD
BODY, GRAV, {np.linalg.norm(GRAVITY)}, {table([(GRAVITY / np.linalg.norm(GRAVITY)).tolist()])}
{table(pressed_faces(body)) if linear else '**'}
*NODE PRINT, NSET=TIP, FREQUENCY=1000
U
*EL PRINT, ELSET=BODY, TOTALS=ONLY, FREQUENCY=1000
ELSE, EVOL
*END STEP
"""


def calculix(body, degree, law):
    """The results of CalculiX, under the names that they have in softcell's results.csv; it prints seven digits."""
    with tempfile.TemporaryDirectory() as folder:
        case = pathlib.Path(folder, "case.inp")
        case.write_text(input_file(body, degree, law))
        subprocess.run(["ccx", "case"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        lines = case.with_suffix(".dat").read_text().splitlines()
    # "name for set ...", an empty line, the values
    titles = [i for i, line in enumerate(lines) if " for set " in line]
    values = {lines[i].split(" for set ")[0].strip(): lines[i + 2].split() for i in titles}
    results = {"volume": float(values["total volume"][0])}
    if law == "linear":
        results["strain_energy"] = float(values["total internal energy"][0])
    for c, value in zip("xyz", values["displacements (vx,vy,vz)"][1:]):
        results["tip_u" + c] = float(value)
    return results


def softcell(body, degree, law):
    """The results of softcell."""
    entries = {
        **body.entries(degree, law),
        "Material/Young modulus": YOUNG,
        "Material/Poisson ratio": POISSON,
        "Material/Density": DENSITY,
        "Loads/Gravity": common.listed(GRAVITY),
    }
    if law == "linear":
        entries["Loads/top"] = f"traction 0, 0, {-PRESSURE}"
    return common.run_softcell(entries, body.mesh)


def main():
    """Runs every case with both codes."""
    bodies = common.bodies()
    worst = 0.0
    for name, degree in (("prism", 1), ("prism", 2), ("block", 1)):
        for law in ("linear", "Saint-Venant-Kirchhoff"):
            body = bodies[name]
            load = "weight and end pressure" if law == "linear" else "weight"
            title = f"{name}, {body.method} of degree {degree}, {law}, {load}"
            worst = max(worst, common.compare(title, softcell(body, degree, law), calculix(body, degree, law)))
    return common.verdict(worst)


if __name__ == "__main__":
    sys.exit(main())
