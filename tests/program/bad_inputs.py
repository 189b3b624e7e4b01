# SPDX-License-Identifier: LGPL-2.1-or-later
"""The mistakes of a user, and what must be in the answer to each."""
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


def surface(file):
    return ["Geometry/Type = surface", f"Geometry/File = {file}"]


def mesh(file):
    return ["Discretization/Method = tetrahedra", f"Discretization/Mesh file = {file}"]


def image(file, *more):
    return ["Geometry/Type = image", f"Geometry/File = {file}", "Geometry/Scale = 0.01", *more]


MULTIGRID = ["Solver/Preconditioner = geometric multigrid", "Discretization/Method = weighted cell"]

DYNAMIC = ["Solver/Mode = dynamic", "Discretization/Method = weighted cell", "Dynamics/End time = 0.1"]
TOOL = [*DYNAMIC, "Loads/top = displacement path"]

# Name of the mistake; settings on the command line; text of the parameter file (None: the bar, @BAR@ stands for it);
# parts of the message.
BAD_INPUTS = [
    ("unknown entry", ["Material/Yung modulus = 1"], None, ["Yung modulus", "Material", "Young modulus"]),
    ("unknown entry in the file", [], "@BAR@subsection Solver\n  set Lode steps = 3\nend\n",
     ["mistake.prm:", "Lode steps", "Load steps"]),
    ("unknown section", [], "@BAR@subsection Solvers\n  set Load steps = 3\nend\n", ["Solvers", "'Solver'"]),
    ("open section", [], "@BAR@subsection Solver\n", ["mistake.prm:", "Solver", "end"]),
    ("section in a section", [], "@BAR@subsection Solver\n  subsection Output\n  end\nend\n",
     ["mistake.prm:", "Solver/Output", "'end' missing"]),
    ("line of great length", [], "@BAR@subsection Output\n  set Directory " + 100000 * "x" + "\nend\n",
     ["mistake.prm:", "not understood"]),
    ("tolerance that every guess meets", ["Solver/Residual tolerance = 1"], None,
     ["Residual tolerance", "from 0 to 0.1"]),
    ("update that is always small", ["Solver/Update tolerance = 2"], None, ["Update tolerance", "from 0 to 0.1"]),
    ("line without meaning", [], "@BAR@Cells = 4\n", ["mistake.prm:", "Cells = 4"]),
    ("value of another kind", ["Material/Density = heavy"], None, ["Material/Density", "heavy", "number"]),
    ("value out of range", ["Discretization/Cut levels = -1"], None, ["Discretization/Cut levels", "-1"]),
    ("displacement of no reference", ["Loads/top = displacement reference"], None, ["Loads/top", "Study/Reference"]),
    ("unknown choice", ["Discretization/Method = finite sell"], None, ["Discretization/Method", "finite cell"]),
    ("unknown material", ["Material/Model = rubber"], None, ["Material/Model", "rubber", "Neo-Hookean"]),
    ("modulus of zero", ["Material/Young modulus = 0"], None, ["Young modulus", "0"]),
    ("negative modulus", ["Material/Young modulus = -5"], None, ["Young modulus", "-5"]),
    ("incompressible", ["Material/Poisson ratio = 0.5"], None, ["Poisson ratio", "0.5"]),
    ("Poisson ratio of two", ["Material/Poisson ratio = 2"], None, ["Poisson ratio", "2"]),
    ("radius of zero", ["Geometry/Radius = 0"], None, ["Radius", "0"]),
    ("missing surface", surface("nowhere.off"), None, ["Geometry/File", "/nowhere.off"]),
    ("folder for a surface", surface("."), None, [".", "is a folder"]),
    ("unknown format", surface("surface.xyz"), None, ["surface.xyz"]),
    ("empty surface", surface("empty.off"), None, ["empty.off"]),
    ("truncated surface", surface("truncated.off"), None, ["truncated.off"]),
    ("truncated binary surface", surface("truncated.stl"), None, ["truncated.stl"]),
    ("junk for a surface", surface("junk.ply"), None, ["junk.ply"]),
    ("NaN in a surface", surface("nan.off"), None, ["nan.off"]),
    ("open surface", surface("open.off"), None, ["open.off", "3"]),
    ("surface that is no manifold", surface("fin.off"), None, ["fin.off"]),
    ("surface through itself", surface("pierced.off"), None, ["pierced.off"]),
    ("missing image", image("nowhere.nrrd"), None, ["Geometry/File", "/nowhere.nrrd"]),
    ("folder for an image", image("."), None, ["is a folder", "Geometry/File"]),
    ("truncated image", image("truncated.nrrd"), None, ["truncated.nrrd"]),
    ("empty label", image("image.nrrd", "Geometry/Labels = 7"), None, ["image.nrrd", "7", "1"]),
    ("region that selects nothing", ["Regions/base = z < -1"], None, ["base", "nothing"]),
    ("region without a comparison", ["Regions/top = 0.1"], None, ["Regions/top = '0.1'", "everywhere", "z > 0.1"]),
    ("region that cannot be read", ["Regions/base = z <"], None, ["base", "z <"]),
    ("load on no region", ["Loads/side = clamp"], None, ["side", "base", "top"]),
    ("load of no kind", ["Loads/top = tracktion 0, 0, 1"], None, ["top", "tracktion", "traction"]),
    ("load without values", ["Loads/top = traction 0, 1"], None, ["top", "traction"]),
    ("free to move", ["Loads/base = traction 0, 30, 0"], None, ["free"]),
    ("part that nothing holds", [*surface("apart.off"), "Regions/top = z > 0.02", "Probes/tip = 0.01, 0.01, 0.01"], None,
     ["2 separate parts", "free to move along x, y and z"]),
    ("assignment in a load", ["Loads/top = traction 0, x = 3, 0"], None, ["Loads/top", "x = 3", "=="]),
    ("load without end", ["Loads/top = traction 1/0, 0, 0"], None, ["Loads/top", "finite"]),
    ("load without a value on the way", ["Loads/top = traction sqrt(t - 0.25), 0, 0"], None,
     ["Loads/top", "finite", "t = 0.1"]),
    ("springs that push", ["Loads/base = springs -1e6"], None, ["Loads/base", "-1e6", "negative"]),
    ("springs of no stiffness", ["Loads/base = springs 0"], None, ["free to move along x, y and z"]),
    ("cavity that leaves nothing", ["Geometry/Type = hollow sphere", "Geometry/Inner radius = 0.06"], None,
     ["Geometry/Inner radius = 0.06", "Radius = 0.05", "smaller"]),
    ("load by no solution", ["Loads/top = traction exact"], None, ["Loads/top", "exact", "Manufactured solution"]),
    ("load beside a manufactured one", ["Loads/Manufactured solution = sine"], None,
     ["Loads/top", "0, -30, 0", "traction exact"]),
    ("weight beside a manufactured load", ["Loads/Manufactured solution = sine", "Loads/Gravity = 0, 0, -9.81"], None,
     ["Manufactured solution = sine", "Gravity"]),
    ("manufactured solution of two materials", image("two.nrrd", "Loads/Manufactured solution = sine"), None,
     ["Manufactured solution = sine", "2"]),
    ("two references", ["Loads/Manufactured solution = sine", "Loads/top = traction exact",
                        "Study/Reference = Discretization/Cells = 8"], None,
     ["Study/Reference", "Manufactured solution = sine", "remove"]),
    ("negative penalty", ["Loads/Penalty = -5", "Loads/Imposed displacement = penalty"], None,
     ["Loads/Penalty", "-5", "negative"]),
    ("probe that is no point", ["Probes/tip = 0, 1"], None, ["tip", "0, 1"]),
    ("region with the weight's columns", [], "@BAR@subsection Regions\n  set gravity = z < 0.1\nend\n",
     ["Regions/gravity", "Loads"]),
    ("region with the name of an entry", ["Regions/Penalty = z < 0.1"], None, ["Regions/Penalty", "Loads"]),
    ("region given twice", [], "@BAR@subsection Regions\n  set base = z < 0.1\nend\n", ["Regions/base", "another entry"]),
    ("probe given twice", [], "@BAR@subsection Probes\n  set tip = 0, 0, 0.1\nend\n", ["Probes/tip", "another entry"]),
    ("entry given twice", [], "@BAR@subsection Material\n  set Poisson ratio = 0.2\nend\n",
     ["Poisson ratio", "mistake.prm:", "already"]),
    ("entry without a name", [], "@BAR@subsection Regions\n  set   = z < 0.1\nend\n", ["mistake.prm:", "set   ="]),
    ("probe that is no number", ["Probes/tip = nan, 0, 0"], None, ["Probes/tip", "nan"]),
    ("Young modulus that is no number", ["Material/Young modulus = nan"], None, ["Young modulus", "nan"]),
    ("infinite density", ["Material/Density = inf"], None, ["Density", "inf"]),
    ("number beyond all", ["Geometry/Length = 1e999"], None, ["Length", "1e999"]),
    ("infinite gravity", ["Loads/Gravity = 0, 0, -inf"], None, ["Gravity", "-inf"]),
    ("no cells", ["Discretization/Cells = 0"], None, ["Cells", "0"]),
    ("empty list of cells", ["Discretization/Cells ="], None, ["Cells", "''"]),
    ("two numbers of cells", ["Discretization/Cells = 4, 4"], None, ["Cells = 4, 4", "three"]),
    ("scale of zero", [*surface("good.off"), "Geometry/Scale = 0"], None, ["Scale", "0"]),
    ("too many load steps", ["Solver/Load steps = 1000000000"], None, ["Load steps", "1 to 9999999"]),
    ("study of no method", ["Study/Methods = ,"], None, ["Study/Methods", "give some of"]),
    ("cells too large", ["Discretization/Cell size = 5"], None, ["Discretization/Cell size = 5", "coarse"]),
    ("grid too large", ["Discretization/Grid scale = 1000"], None, ["Grid scale = 1000", "coarse"]),
    ("image of great size", image("great.nrrd"), None, ["great.nrrd", " 200000 voxels"]),
    ("image without its voxels", image("apart.mhd"), None, ["/gone.raw", "apart.mhd"]),
    ("no load steps", ["Solver/Load steps = 0"], None, ["Load steps", "0", "adaptive"]),
    ("unknown mode", ["Solver/Mode = quasistatic"], None, ["Solver/Mode", "dynamic", "static"]),
    ("contradictory supports", ["Discretization/Method = hexahedra", "Loads/top = displacement 0, 0, 0.1",
                                "Regions/top = z < 1e-6 && x > 0"], None, ["base", "top"]),
    ("supports by penalty that contradict", ["Regions/top = z < 0.1", "Loads/top = displacement 0, 0, 0.1"], None,
     ["Loads/base", "Loads/top", "0.1 m along z"]),
    ("levels that no method has", ["Study/Cut levels = 1, 2", "Discretization/Method = sparse grid"], None,
     ["Study/Cut levels", "1, 2"]),
    ("degree that moment fitting does not have", ["Discretization/Method = moment fitting", "Discretization/Degree = 4"],
     None, ["Discretization/Degree = 4", "3", "finite cell"]),
    ("the same case twice", ["Study/Cells = 2, 2"], None, ["Study", "n2", "twice"]),
    ("case that is no number", ["Study/Cells = 2, many"], None, ["Study/Cells", "many", "whole number"]),
    ("unknown method in a study", ["Study/Methods = weighted cell, finite sell"], None,
     ["Study/Methods", "finite sell"]),
    ("unknown method of the reference", ["Study/Reference = Discretization/Method = finite sell"], None,
     ["Study/Reference", "finite sell"]),
    ("reference that is no setting", ["Study/Reference = tetrahedra"], None, ["Study/Reference", "tetrahedra"]),
    ("mistake in the last case", ["Study/Methods = weighted cell, tetrahedra", "Study/Degrees = 1, 3"], None,
     ["tetrahedra", "degree"]),
    ("sweep without a label", ["Sweeps/tissue = Material/Density = 1 | b: Material/Density = 2"], None,
     ["Sweeps/tissue", "Material/Density = 1", "label"]),
    ("sweep without a value", ["Sweeps/tissue = a: Material/Density"], None, ["Sweeps/tissue, a", "Material/Density"]),
    ("sweep of an unknown entry", ["Sweeps/tissue = a: Material/Densty = 1"], None,
     ["Sweeps/tissue, a", "Densty", "'Density'"]),
    ("sweep out of range", ["Sweeps/tissue = a: Discretization/Cut levels = -1"], None, ["Sweeps/tissue, a", "-1"]),
    ("sweep to a wrong modulus", ["Sweeps/tissue = soft: Material/Young modulus = -5 | firm: "], None,
     ["soft: ", "Young modulus", "-5"]),
    ("label given twice", ["Sweeps/tissue = a: | a: Material/Density = 1"], None, ["Sweeps/tissue", "'a'", "twice"]),
    ("labels that make one name", ["Sweeps/tissue = a b: | a_b: Material/Density = 1"], None, ["a_b", "twice"]),
    ("sweep given twice", [], "@BAR@subsection Sweeps\n  set a = b:\n  set a = c:\nend\n",
     ["Sweeps/a", "another entry"]),
    ("sweep with a column's name", ["Sweeps/tip_ux = a: Material/Density = 1"], None, ["Sweeps/tip_ux", "column"]),
    ("sweep with an error's name", ["Sweeps/estimated_error = a: Material/Density = 1"], None,
     ["Sweeps/estimated_error", "column"]),
    ("sweep of what the study sweeps", ["Sweeps/size = a: Discretization/Cells = 3", "Study/Cells = 4, 5"], None,
     ["Discretization/Cells", "swept twice"]),
    ("sweep of the study", ["Sweeps/size = a: Study/Cells = 3"], None, ["Sweeps/size", "Study/Cells"]),
    ("mistake in a swept load", ["Sweeps/pull = a: | b: Loads/top = tracktion 1, 0, 0"], None,
     ["tracktion", "traction"]),
    ("missing checkpoint", ["Solver/Start from = nowhere.h5"], None, ["Start from", "/nowhere.h5"]),
    ("junk for a checkpoint", ["Solver/Start from = junk.ply"], None, ["junk.ply"]),
    ("probe outside the body", ["Probes/tip = 9, 9, 9"], None, ["tip", "9"]),
    ("probe beside the body", ["Probes/tip = 0.07, 0, 0.1"], None, ["tip", "0.07", "not in the body"]),
    ("unstable Nitsche", ["Loads/Nitsche factor = 0"], None, ["Loads/Nitsche factor", "0"]),
    ("all of a cut cell", ["Discretization/Alpha = 1"], None, ["Discretization/Alpha", "1"]),
    ("negative ghost penalty", ["Discretization/Ghost penalty = -1"], None, ["Discretization/Ghost penalty", "-1"]),
    ("two starts", ["Solver/Start from = some.h5", "Solver/Coarse grids = 1"], None, ["Coarse grids", "some.h5"]),
    ("coarser than a mesh that is there", ["Discretization/Mesh file = some.msh", "Solver/Coarse grids = 1"], None,
     ["Coarse grids", "some.msh"]),
    ("cells of a mesh that is there", ["Discretization/Mesh file = some.msh", "Study/Cells = 4, 8"], None,
     ["Study/Cells", "some.msh"]),
    ("missing mesh", mesh("nowhere.msh"), None, ["Mesh file", "/nowhere.msh"]),
    ("empty mesh", mesh("empty.off"), None, ["empty.off", "is empty"]),
    ("truncated mesh", mesh("truncated.msh"), None, ["truncated.msh", "cut short"]),
    ("junk for a mesh", mesh("junk.ply"), None, ["junk.ply", "no Gmsh file"]),
    ("NaN in a mesh", mesh("nan.msh"), None, ["nan.msh", "nan"]),
    ("mesh without one of its nodes", mesh("no_node.msh"), None, ["no_node.msh", "a node that is not in the file"]),
    ("tangled mesh", mesh("tangled.msh"), None,
     ["tangled.msh", "1 pair(s)", "same side"]),
    ("refinement of a mesh", ["Discretization/Method = tetrahedra", "Discretization/Refinement steps = 1"], None,
     ["Refinement steps = 1", "tetrahedra", "background grids"]),
    ("refinement of a higher degree", ["Discretization/Degree = 2", "Discretization/Refinement steps = 1"], None,
     ["Refinement steps = 1", "degree 2"]),
    ("motion without an end", [*DYNAMIC, "Dynamics/End time = 0"], None, ["dynamic", "Dynamics/End time"]),
    ("motion of Saint-Venant-Kirchhoff", [*DYNAMIC, "Material/Model = Saint-Venant-Kirchhoff"], None,
     ["dynamic", "Material/Model"]),
    ("motion without a mass", [*DYNAMIC, "Material/Density = 0"], None, ["dynamic", "Material/Density"]),
    ("motion held by Nitsche", [*DYNAMIC, "Loads/Imposed displacement = Nitsche"], None, ["dynamic", "penalty"]),
    ("motion to a known solution", [*DYNAMIC, "Loads/Manufactured solution = sine"], None,
     ["dynamic", "Manufactured solution"]),
    ("motion on several grids", [*DYNAMIC, "Solver/Coarse grids = 1"], None, ["dynamic", "Coarse grids"]),
    ("motion under a pressure", [*DYNAMIC, "Loads/top = pressure 100"], None, ["dynamic", "pressure 100"]),
    ("penalty that changes in a motion", [*DYNAMIC, "Loads/Penalty = 100 * t"], None, ["dynamic", "100 * t"]),
    ("springs that change in a motion", [*DYNAMIC, "Loads/top = springs 100 * t"], None, ["dynamic", "100 * t"]),
    ("motion that jumps", [*DYNAMIC, "Loads/top = displacement 0, 0, 0.01"], None, ["dynamic", "0, 0, 0.01", "path"]),
    ("motion of a higher degree", [*DYNAMIC, "Discretization/Degree = 2"], None, ["dynamic", "Degree = 1"]),
    ("no recorded path", TOOL, None, ["displacement path", "Loads/Path"]),
    ("missing path", [*TOOL, "Loads/Path = nowhere.csv"], None, ["Loads/Path", "/nowhere.csv"]),
    ("junk for a path", [*TOOL, "Loads/Path = good.off"], None, ["good.off", "Line 2"]),
    ("path that goes back in time", [*TOOL, "Loads/Path = back.csv"], None, ["back.csv", "Line 3", "later"]),
    ("path without a record", [*TOOL, "Loads/Path = names.csv"], None, ["names.csv"]),
    ("multigrid of finite cells of degree 2", [*MULTIGRID, "Discretization/Degree = 2"], None,
     ["geometric multigrid", "Degree = 1"]),
    ("multigrid of tetrahedra", [*MULTIGRID, "Discretization/Method = tetrahedra"], None,
     ["geometric multigrid", "Discretization/Method = tetrahedra", "weighted cell"]),
    ("motion of tetrahedra", [*DYNAMIC, "Discretization/Method = tetrahedra"], None,
     ["dynamic", "Discretization/Method = tetrahedra", "weighted cell"]),
    ("multigrid on a refined grid", [*MULTIGRID, "Discretization/Cells = 8", "Discretization/Surface refinement = 1"], None,
     ["geometric multigrid", "Surface refinement = 0"]),
    ("multigrid with a fictitious material", [*MULTIGRID, "Discretization/Alpha = 1e-6"], None,
     ["geometric multigrid", "Alpha = 0"]),
    ("multigrid with a ghost penalty", [*MULTIGRID, "Discretization/Ghost penalty = 0.1"], None,
     ["geometric multigrid", "Ghost penalty = 0"]),
    ("multigrid with a projection", [*MULTIGRID, "Discretization/Volumetric projection = true"], None,
     ["geometric multigrid", "Volumetric projection = false"]),
    ("multigrid under a pressure", [*MULTIGRID, "Loads/top = pressure 100"], None,
     ["geometric multigrid", "pressure"]),
    ("multigrid of two materials", image("two.nrrd", *MULTIGRID, "Regions/base = nz < -0.5", "Regions/top = nz > 0.5",
                                                "Probes/tip = 0.03, 0.03, 0.03"), None,
     ["geometric multigrid", "one material"]),
    ("grid too coarse", ["Discretization/Cells = 1", "Discretization/Smallest volume fraction = 0.9"], None,
     ["Discretization/Cells = 1", "coarse"]),
    ("material of no part of the surface", surface("good.off"),
     "@BAR@subsection Material 9\n  set Density = 1\nend\n", ["good.off", "9", "are: 0"]),
    ("material of no label", [], "@BAR@subsection Material 9\n  set Density = 1\nend\n", ["Material 9"]),
    ("more memory than there is", ["Discretization/Cells = 1200"], None, ["Cells = 1200", "memory", "free"]),
    ("more memory for a degree", ["Discretization/Cells = 150", "Discretization/Degree = 6"], None,
     ["Cells = 150", "Degree = 6", "lower degree"]),
    ("more memory for tetrahedra", ["Discretization/Method = tetrahedra", "Discretization/Mesh size = 1e-6"], None,
     ["Mesh size = 1e-06", "memory"]),
    ("more memory for hexahedra", ["Discretization/Method = hexahedra", "Discretization/Cells = 2000"], None,
     ["Cells = 2000", "memory"]),
    ("more memory for refinement", ["Discretization/Cells = 300", "Discretization/Surface refinement = 4"], None,
     ["Surface refinement = 4", "memory"]),
    ("more memory for factors", ["Discretization/Cells = 150", "Solver/Linear solver = direct"], None,
     ["Cells = 150", "Linear solver = CG"]),
    ("more memory for the last case of a study", ["Study/Cells = 2, 3, 1200"], None, ["Cells = 1200", "memory"]),
]
