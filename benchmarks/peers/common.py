# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the comparisons with other codes share: the bodies, their meshes, runs of softcell, and the table.

A mesh is a pair of arrays: points (n_points, 3) in m, and cells (n_cells, 4 or 8), the corners of tetrahedra or of
hexahedra in Gmsh's order.
"""
import csv
import dataclasses
import itertools
import pathlib
import subprocess
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOFTCELL = ROOT / "build/release/softcell"
TOLERANCE = 1e-6

# Sizes of the block in m, and its cells along x, y, z.
BLOCK = np.array([0.1, 0.08, 0.4])
BLOCK_CELLS = (3, 3, 10)


def block():
    """A block of hexahedra whose inner nodes are moved, so that cells are skew and their faces are not plane."""
    lattice = list(itertools.product(*[range(n + 1) for n in BLOCK_CELLS]))
    s = np.array(lattice) / BLOCK_CELLS
    x, y, z = np.pi * s.T
    shift = np.stack([np.sin(x) * np.cos(2 * y + z), np.sin(y) * np.cos(x - 2 * z), np.sin(z) * np.cos(x + y)], axis=1)
    number = {place: i for i, place in enumerate(lattice)}
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [
        [number[tuple(np.add(cell, corner))] for corner in corners]
        for cell in itertools.product(*[range(n) for n in BLOCK_CELLS])
    ]
    return BLOCK * (s + 0.25 * shift / BLOCK_CELLS), np.array(cells)


def read_msh(file):
    """The tetrahedra of a Gmsh file (MSH 2.2, ASCII)."""
    lines = pathlib.Path(file).read_text().splitlines()
    nodes, elements = lines.index("$Nodes"), lines.index("$Elements")
    rows = [line.split() for line in lines[nodes + 2 : lines.index("$EndNodes")]]
    number = {row[0]: i for i, row in enumerate(rows)}
    points = np.array([row[1:] for row in rows], dtype=float)
    rows = [line.split() for line in lines[elements + 2 : lines.index("$EndElements")]]
    return points, np.array([[number[node] for node in row[-4:]] for row in rows if row[1] == "4"])


def write_msh(file, mesh):
    """Writes a mesh for Gmsh and softcell (MSH 2.2, ASCII)."""
    points, cells = mesh
    kind = {4: 4, 8: 5}[cells.shape[1]]
    nodes = [f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(points.tolist(), 1)]
    elements = [f"{i} {kind} 2 0 0 {' '.join(map(str, cell + 1))}" for i, cell in enumerate(cells, 1)]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes)), *nodes, "$EndNodes", "$Elements"]
    pathlib.Path(file).write_text("\n".join([*lines, str(len(elements)), *elements, "$EndElements", ""]))


@dataclasses.dataclass
class Body:
    """A body along z, held at its base z = 0; y < side selects its side."""

    mesh: tuple
    method: str
    length: float
    side: float
    geometry: dict

    def tip(self):
        """The number of the vertex whose displacement is compared."""
        return np.argmax(self.mesh[0].sum(axis=1))

    def entries(self, degree, law):
        """softcell's parameters for the body."""
        return {
            **self.geometry,
            "Discretization/Method": self.method,
            "Discretization/Degree": degree,
            "Material/Model": law,
            "Regions/base": "z < 1e-6",
            "Regions/top": f"z > {self.length} - 1e-6",
            "Regions/side": f"y < {self.side}",
            "Loads/base": "clamp",
            "Probes/tip": listed(self.mesh[0][self.tip()].tolist()),
            "Solver/Linear tolerance": 1e-10,
        }


def bodies():
    """The bodies by name."""
    prism = {"Geometry/Type": "hexagonal prism", "Geometry/Radius": 0.05, "Geometry/Length": 0.6}
    box = {"Geometry/Type": "box", "Geometry/Size": listed(BLOCK)}
    return {
        "prism": Body(read_msh(ROOT / "meshes/hexagonal_prism.msh"), "tetrahedra", 0.6, -0.0433, prism),
        "block": Body(block(), "hexahedra", BLOCK[2], 1e-6, box),
    }


def listed(numbers):
    """Numbers as softcell reads them."""
    return ", ".join(map(str, numbers))


def run_softcell(entries, mesh=None):
    """Runs softcell with {"Section/Entry": value}; returns the numbers of the row of results.csv."""
    entries = {**entries, "Output/Volume": "false", "Output/Surface": "false"}
    with tempfile.TemporaryDirectory() as folder:
        if mesh is not None:
            write_msh(f"{folder}/mesh.msh", mesh)
            entries["Discretization/Mesh file"] = f"{folder}/mesh.msh"
        text = ""
        for path, value in entries.items():
            section, entry = path.split("/")
            text += f"subsection {section}\n  set {entry} = {value}\nend\n"
        pathlib.Path(folder, "case.prm").write_text(text)
        subprocess.run([SOFTCELL, f"{folder}/case.prm", "--output", f"{folder}/run", "--quiet"], check=True)
        with open(f"{folder}/run/results.csv", newline="") as file:
            row = next(csv.DictReader(file))
    return {key: float(value) for key, value in row.items() if is_number(value)}


def is_number(text):
    """Whether text reads as a number."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def compare(case, ours, theirs):
    """Prints the quantities that the peer gives beside softcell's; returns the largest relative difference.

    A component of a vector (NAME_ux, NAME_uy, NAME_uz) is compared relative to the vector's length.
    """
    print(f"\n### {case}\n\n| quantity | softcell | peer | relative difference |\n|---|---:|---:|---:|")
    worst = 0.0
    for name, value in theirs.items():
        scale = abs(value)
        if name[-2:] in ("ux", "uy", "uz", "fx", "fy", "fz"):
            scale = np.linalg.norm([theirs[name[:-1] + c] for c in "xyz"])
        difference = abs(ours[name] - value) / scale
        worst = max(worst, difference)
        print(f"| {name} | {ours[name]:.9g} | {value:.9g} | {difference:.1e} |")
    return worst


def verdict(worst):
    """The exit status: 1, with a message, if a difference exceeds the tolerance."""
    print(f"\nlargest relative difference: {worst:.1e} (allowed: {TOLERANCE:.0e})")
    return int(not worst < TOLERANCE)
