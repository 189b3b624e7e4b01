#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws bodies at rest and deformed, coloured by displacement.

usage: picture.py SURFACE.vtp...     writes SURFACE.png beside each surface: at rest and deformed; of a motion, at rest,
                                     at up to three states of solution.pvd on the way, and at the end
       picture.py --study DIR        writes tile.png beside the surfaces of a study's cases (12 at most, then the finest
                                     of each series), all to the same scale, which is DIR/scale.png
It needs a display (or xvfb-run).

The surface stands at its deformed place and has the point data `displacement`, all in metres.
"""
import copy
import csv
import os
import pathlib
import sys
import xml.etree.ElementTree

import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import numpy as np

from report_study import Study, number

WIDTH, HEIGHT = 1800, 1000
TILE = 520, 400
MOST_TILES = 12
INK = (0.12, 0.12, 0.14)


def read(file):
    """The surface with smooth normals (sharp edges kept), its deformed points and its displacement."""
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(file)
    reader.Update()
    surface = reader.GetOutput()
    if surface.GetNumberOfPoints() == 0 or surface.GetPointData().GetArray("displacement") is None:
        sys.exit(f"{file} holds no surface with the point data 'displacement'.")
    return surface


def moved(surface, points, magnitude):
    """The surface with other points, coloured by the magnitude, with normals to shade it."""
    result = vtk.vtkPolyData()
    vtk_points = vtk.vtkPoints()
    vtk_points.SetData(numpy_to_vtk(points, deep=True))
    result.SetPoints(vtk_points)
    result.SetPolys(surface.GetPolys())
    colour = numpy_to_vtk(magnitude, deep=True)
    colour.SetName("magnitude")
    result.GetPointData().SetScalars(colour)
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(result)
    normals.SetFeatureAngle(50)
    normals.Update()
    return normals.GetOutput()


def view(points, displacement):
    """Direction of sight, z up: from the front (-y), or from the side if an elongated body lies or bends along y."""
    size = np.sort(np.ptp(points, axis=0))
    if size[2] > 2 * size[1]:
        longest = np.ptp(points, axis=0).argmax()
        if longest == 1 or (longest == 2 and np.ptp(displacement[:, 1]) > np.ptp(displacement[:, 0])):
            return np.array([1.0, 0.25, -0.2])
    return np.array([0.25, 1.0, -0.2])


def unit(largest):
    """Name and factor of the unit of length in which the largest displacement reads well."""
    for name, factor, from_metres in (("m", 1.0, 1.0), ("cm", 1e2, 0.1), ("mm", 1e3, 1e-4)):
        if largest >= from_metres:
            return name, factor
    return "µm", 1e6


def top_of_scale(largest):
    """A number from which five equal steps to 0 are round, at least the largest."""
    power = 10.0 ** np.floor(np.log10(largest / 5))
    return 5 * power * next(step for step in (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10)
                            if 5 * step * power >= largest * (1 - 1e-9))


def text(string, size, x, y):
    actor = vtk.vtkTextActor()
    actor.SetInput(string)
    style = actor.GetTextProperty()
    style.SetFontSize(size)
    style.SetColor(INK)
    style.SetJustificationToCentered()
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(x, y)
    return actor


def colours(largest):
    """Viridis-like scale from dark blue over green to yellow, even to the eye and to the colour-blind."""
    table = vtk.vtkColorTransferFunction()
    for i, rgb in enumerate(((0.267, 0.005, 0.329), (0.283, 0.141, 0.458), (0.254, 0.265, 0.530),
                             (0.207, 0.372, 0.553), (0.164, 0.471, 0.558), (0.128, 0.567, 0.551),
                             (0.135, 0.659, 0.518), (0.267, 0.749, 0.441), (0.478, 0.821, 0.318),
                             (0.741, 0.873, 0.150), (0.993, 0.906, 0.144))):
        table.AddRGBPoint(largest * i / 10, *rgb)
    return table


def body(surface, table=None):
    """Coloured by its magnitude, or without a table in the colour of tissue."""
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.SetScalarVisibility(table is not None)
    if table is not None:
        mapper.SetLookupTable(table)
        mapper.SetUseLookupTableScalarRange(True)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    style = actor.GetProperty()
    style.SetColor(0.70, 0.38, 0.33)
    style.SetInterpolationToPhong()
    style.SetAmbient(0.2)
    style.SetDiffuse(0.82)
    style.SetSpecular(0.15)
    style.SetSpecularPower(20)
    return actor


def outline(surface):
    """The shape at rest as a faint shadow, to see the deformed one against."""
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.88, 0.89, 0.9)
    actor.GetProperty().LightingOff()
    return actor


def lights(renderer):
    kit = vtk.vtkLightKit()
    kit.SetKeyLightIntensity(0.92)
    kit.SetKeyLightAngle(40, -25)
    kit.SetKeyToFillRatio(2.2)
    kit.SetKeyToHeadRatio(3.0)
    kit.AddLightsToRenderer(renderer)


def point_camera(renderers, points, displacement, aspect, share):
    """The same camera for all, so that the body fits at rest and deformed into a share of the height."""
    sight, up = view(points, displacement), np.array([0.0, 0.0, 1.0])
    points = np.vstack([points, points + displacement])
    sight /= np.linalg.norm(sight)
    right = np.cross(sight, up)
    right /= np.linalg.norm(right)
    up = np.cross(right, sight)
    across, along = points @ right, points @ up
    centre = (points.max(0) + points.min(0)) / 2
    centre += right * ((across.max() + across.min()) / 2 - centre @ right)
    centre += up * ((along.max() + along.min()) / 2 - centre @ up)
    half = 0.5 * max(np.ptp(along) / share, np.ptp(across) / aspect / 0.9)
    distance = 20 * half + np.ptp(points @ sight)
    for renderer in renderers:
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetParallelScale(half)
        camera.SetFocalPoint(*centre)
        camera.SetPosition(*(centre - sight * distance))
        camera.SetViewUp(*up)
        renderer.ResetCameraClippingRange()


def colour_bar(table, name, width):
    """A horizontal scale in the middle, with its title; the width is a share of its viewport."""
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle(f"displacement in {name}\n ")
    bar.SetNumberOfLabels(6)
    bar.SetLabelFormat("%.4g")
    bar.SetOrientationToHorizontal()
    bar.SetTextPositionToSucceedScalarBar()
    bar.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    bar.SetPosition(0.5 - width / 2, 0.06)
    bar.SetPosition2(width, 0.84)
    bar.SetBarRatio(0.2)
    bar.UnconstrainedFontSizeOn()
    bar.SetTextPad(4)
    for style, size in ((bar.GetTitleTextProperty(), 28), (bar.GetLabelTextProperty(), 24)):
        style.SetColor(INK)
        style.SetFontSize(size)
        style.SetBold(False)
        style.SetItalic(False)
        style.SetShadow(False)
    return bar


def case_of(file):
    """What results.csv says of the surface's case; empty if nothing."""
    folder = pathlib.Path(file).resolve().parent
    for table in (folder / "results.csv", folder.parent / "results.csv"):
        if table.exists():
            with open(table, newline="") as stream:
                rows = list(csv.DictReader(stream))
            return next((row for row in rows if row["case"] == folder.name or len(rows) == 1), {})
    return {}


def new_window(size):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(8)
    window.SetSize(*size)
    window.SetNumberOfLayers(2)
    return window


def add_renderer(window, viewport, actors, layer=0):
    renderer = vtk.vtkRenderer()
    renderer.SetLayer(layer)
    renderer.SetViewport(*viewport)
    renderer.SetBackground(1, 1, 1)
    lights(renderer)
    for actor in actors:
        renderer.AddActor(actor)
    window.AddRenderer(renderer)
    return renderer


def write(window, target):
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(target))
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()
    print(target)


class Deformed:
    """A surface at its deformed place, its displacement, and where its points were at rest."""

    def __init__(self, file):
        self.surface = read(str(file))
        self.points = vtk_to_numpy(self.surface.GetPoints().GetData()).astype(float)
        self.displacement = vtk_to_numpy(self.surface.GetPointData().GetArray("displacement")).astype(float)
        self.magnitude = np.linalg.norm(self.displacement, axis=1)
        self.at_rest = self.points - self.displacement

    def largest(self):
        return max(self.magnitude.max(), 1e-12)

    def in_state(self, file):
        """The same surface in a state of the cells around it."""
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file))
        points, places = vtk.vtkPoints(), vtk.vtkPolyData()
        points.SetData(numpy_to_vtk(self.at_rest, deep=True))
        places.SetPoints(points)
        probe = vtk.vtkProbeFilter()
        probe.SetInputData(places)
        probe.SetSourceConnection(reader.GetOutputPort())
        probe.ComputeToleranceOff()
        probe.SetTolerance(1e-3 * np.ptp(self.at_rest, axis=0).max())
        probe.Update()
        state = copy.copy(self)
        state.displacement = vtk_to_numpy(probe.GetOutput().GetPointData().GetArray("displacement")).astype(float)
        state.magnitude = np.linalg.norm(state.displacement, axis=1)
        state.points = self.at_rest + state.displacement
        return state


def on_the_way(file):
    """Times and files of some states of a motion before its end, from solution.pvd beside the surface."""
    pvd = pathlib.Path(file).with_name("solution.pvd")
    if not pvd.exists():
        return []
    states = [(float(state.get("timestep")), pvd.with_name(state.get("file")))
              for state in xml.etree.ElementTree.parse(pvd).iter("DataSet")][:-1]
    return [states[(2 * k + 1) * len(states) // 6] for k in range(3)] if len(states) > 3 else states


def draw(file):
    """The body at rest and deformed, side by side over the scale of colours."""
    end, case = Deformed(file), case_of(file)
    bodies = [("deformed", end)]
    if case.get("time"):
        bodies = [*((f"{time:.3g} s", end.in_state(state)) for time, state in on_the_way(file)),
                  (f"{float(case['time']):.3g} s", end)]
    elif case.get("converged") == "false":
        bodies = [(f"not converged: at {float(case['load_factor']):.3g} of the load", end)]
    largest = max(one.largest() for _, one in bodies)
    name, factor = unit(largest)
    table = colours(top_of_scale(max(factor * largest, 1e-6)))
    rest = moved(end.surface, end.at_rest, factor * end.magnitude)
    window = new_window((WIDTH, HEIGHT))
    width = 1 / (1 + len(bodies))
    renderers = [add_renderer(window, (0, 0.2, width, 1), [body(rest), text("at rest", 34, 0.5, 0.93)])]
    # The shadow lies a layer deeper, so that it never covers the body.
    for i, (title, one) in enumerate(bodies, 1):
        deformed = moved(one.surface, one.points, factor * one.magnitude)
        for layer, actors in ((0, [outline(rest)]), (1, [body(deformed, table), text(title, 34, 0.5, 0.93)])):
            renderers.append(add_renderer(window, (i * width, 0.2, (i + 1) * width, 1), actors, layer))
    add_renderer(window, (0, 0, 1, 0.2), [colour_bar(table, name, 0.44)])
    at_rest = np.vstack([end.at_rest] * len(bodies))
    displacement = np.vstack([one.displacement for _, one in bodies])
    point_camera(renderers, at_rest, displacement, WIDTH * width / (HEIGHT * 0.8), 0.8)
    write(window, os.path.splitext(file)[0] + ".png")


def tiles(folder):
    """The cases to draw: all, or the finest of each series, or some of these."""
    study = Study(folder)
    rows = study.rows
    if len(rows) > MOST_TILES:
        rows = [max(curve, key=lambda row: number(row, "dofs") or 0)
                for curve in study.curves(study.finest_levels()[0], study.tells)]
    rows = rows[::-(-len(rows) // MOST_TILES)]
    return [file for row in rows for file in [folder / row["case"] / "surface.vtp"] if file.exists()]


def draw_study(folder):
    """A tile for each case with the body deformed, the same camera and scale for all."""
    for old in [*folder.glob("*/tile.png"), *folder.glob("scale.png")]:
        old.unlink()
    all_bodies = {file: Deformed(file) for file in tiles(folder)}
    if not all_bodies:
        return
    largest = max(one.largest() for one in all_bodies.values())
    at_rest = np.vstack([one.at_rest for one in all_bodies.values()])
    if largest < 1e-9 * np.ptp(at_rest, axis=0).max():
        return  # only the inside moves
    name, factor = unit(largest)
    table = colours(top_of_scale(factor * largest))
    displacement = np.vstack([one.displacement for one in all_bodies.values()])
    for file, one in all_bodies.items():
        window = new_window(TILE)
        renderers = [add_renderer(window, (0, 0, 1, 1), [actor], layer) for layer, actor in (
            (0, outline(moved(one.surface, one.at_rest, one.magnitude))),
            (1, body(moved(one.surface, one.points, factor * one.magnitude), table)))]
        point_camera(renderers, at_rest, displacement, TILE[0] / TILE[1], 0.94)
        write(window, file.parent / "tile.png")
    window = new_window((960, 170))
    add_renderer(window, (0, 0, 1, 1), [colour_bar(table, name, 0.92)])
    write(window, folder / "scale.png")


if len(sys.argv) == 3 and sys.argv[1] == "--study":
    draw_study(pathlib.Path(sys.argv[2]))
else:
    for argument in sys.argv[1:] or sys.exit(__doc__):
        draw(argument)
