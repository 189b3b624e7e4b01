# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surfaces, images, meshes and paths with faults, for bad_inputs.py."""
import struct

# A tetrahedron with outward normals, in metres.
VERTICES = [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)]
TRIANGLES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]


def off(vertices, triangles):
    lines = ["OFF", f"{len(vertices)} {len(triangles)} 0"]
    lines += [" ".join(str(x) for x in vertex) for vertex in vertices]
    lines += ["3 " + " ".join(str(i) for i in triangle) for triangle in triangles]
    return "\n".join(lines) + "\n"


def moved(vertices, x):
    return [(v[0] + x, v[1] + 0.01, v[2] + 0.01) for v in vertices]


def shifted(triangles, n):
    return [tuple(i + n for i in triangle) for triangle in triangles]


def write_files(folder):
    """Surfaces and images, each with one fault, and one without."""
    def write(name, vertices, triangles):
        (folder / name).write_text(off(vertices, triangles))

    (folder / "early.csv").write_text("-2,0,0,0\n-1,0,0,0\n")
    (folder / "back.csv").write_text("t,x,y,z\n1,0,0,0\n0.5,0,0,0\n")
    (folder / "names.csv").write_text("t,x,y,z\n")
    write("good.off", VERTICES, TRIANGLES)
    write("open.off", VERTICES, TRIANGLES[:3])
    write("inside_out.off", VERTICES, [t[::-1] for t in TRIANGLES])
    write("nan.off", [("nan", 0, 0), *VERTICES[1:]], TRIANGLES)
    # a fin on an edge, and two tetrahedra one of which pierces the other
    write("fin.off", [*VERTICES, (0.1, 0.1, 0.1)], [*TRIANGLES, (0, 1, 4)])
    write("apart.off", VERTICES + moved(VERTICES, 0.2), TRIANGLES + shifted(TRIANGLES, 4))
    write("pierced.off", VERTICES + moved(VERTICES, 0.02), TRIANGLES + shifted(TRIANGLES, 4))
    (folder / "truncated.off").write_text(off(VERTICES, TRIANGLES)[:60])
    (folder / "truncated.stl").write_bytes(b"\0" * 80 + struct.pack("<I", 1000) + b"\0" * 70)
    (folder / "junk.ply").write_bytes(bytes(range(256)) * 4)
    (folder / "surface.xyz").write_text("0 0 0\n")
    (folder / "empty.off").write_text("")
    nodes = ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 0.5"]
    (folder / "tangled.msh").write_text(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n"
        + "".join(f"{i} {node}\n" for i, node in enumerate(nodes, 1))
        + "$EndNodes\n$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 2 3 5\n$EndElements\n")
    text = (folder / "tangled.msh").read_text()
    (folder / "truncated.msh").write_text(text[:150])
    (folder / "no_node.msh").write_text(text.replace("1 2 3 5", "1 2 3 9"))
    (folder / "nan.msh").write_text(text.replace("0 0 0.5", "0 0 nan"))
    header = ("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nspacings: 1 1 1\nencoding: raw\n\n").encode()
    (folder / "image.nrrd").write_bytes(header + b"\1" * 512)
    (folder / "two.nrrd").write_bytes(header + b"\1" * 256 + b"\2" * 256)
    (folder / "great.nrrd").write_bytes(header.replace(b"8 8 8", b"200000 8 8"))
    (folder / "apart.mhd").write_text("ObjectType = Image\nNDims = 3\nDimSize = 8 8 8\nElementSpacing = 1 1 1\n"
                                      "ElementType = MET_UCHAR\nElementDataFile = gone.raw\n")
    (folder / "truncated.nrrd").write_bytes(header + b"\1" * 100)
