#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws bodies at rest and deformed, coloured by displacement.

usage: picture.py SURFACE.vtp...     writes SURFACE.png beside each surface; needs a display (or xvfb-run)

The surface stands at its deformed place and has the point data `displacement`, all in metres.
"""
import csv
import os
import pathlib
import sys

import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import numpy as np

WIDTH, HEIGHT = 1800, 1000
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
    """A copy of the surface with other points, coloured by the magnitude, with normals to shade it."""
    copy = vtk.vtkPolyData()
    vtk_points = vtk.vtkPoints()
    vtk_points.SetData(numpy_to_vtk(points, deep=True))
    copy.SetPoints(vtk_points)
    copy.SetPolys(surface.GetPolys())
    colour = numpy_to_vtk(magnitude, deep=True)
    colour.SetName("magnitude")
    copy.GetPointData().SetScalars(colour)
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(copy)
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


def text(string, size, x, y, bold=False):
    actor = vtk.vtkTextActor()
    actor.SetInput(string)
    style = actor.GetTextProperty()
    style.SetFontSize(size)
    style.SetColor(INK)
    style.SetBold(bold)
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


def point_camera(renderers, points, displacement):
    """The same camera for both pictures, so that the body fits at rest and deformed, with room for a title."""
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
    aspect = WIDTH / 2 / (HEIGHT * 0.8)
    half = 0.5 * max(np.ptp(along) / 0.8, np.ptp(across) / aspect / 0.9)
    distance = 20 * half + np.ptp(points @ sight)
    for renderer in renderers:
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetParallelScale(half)
        camera.SetFocalPoint(*centre)
        camera.SetPosition(*(centre - sight * distance))
        camera.SetViewUp(*up)
        renderer.ResetCameraClippingRange()


def colour_bar(table, name):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle(f"displacement in {name}\n ")
    bar.SetNumberOfLabels(6)
    bar.SetLabelFormat("%.4g")
    bar.SetOrientationToHorizontal()
    bar.SetTextPositionToSucceedScalarBar()
    bar.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    bar.SetPosition(0.28, 0.06)
    bar.SetPosition2(0.44, 0.84)
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


def load_reached(file):
    """What results.csv says of the surface's case where it did not converge: the part of the load; else None."""
    folder = pathlib.Path(file).resolve().parent
    for table in (folder / "results.csv", folder.parent / "results.csv"):
        if table.exists():
            with open(table, newline="") as stream:
                rows = list(csv.DictReader(stream))
            for row in rows:
                if (row["case"] == folder.name or len(rows) == 1) and row["converged"] == "false":
                    return float(row["load_factor"])
            return None
    return None


def draw(file):
    surface = read(file)
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    displacement = vtk_to_numpy(surface.GetPointData().GetArray("displacement")).astype(float)
    magnitude = np.linalg.norm(displacement, axis=1)
    name, factor = unit(magnitude.max() if magnitude.max() > 1e-12 else 1.0)
    magnitude *= factor
    table = colours(top_of_scale(max(magnitude.max(), 1e-6)))

    reached = load_reached(file)
    title = "deformed" if reached is None else f"not converged: at {reached:.3g} of the load"
    rest = moved(surface, points - displacement, magnitude)
    deformed = moved(surface, points, magnitude)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(8)
    window.SetSize(WIDTH, HEIGHT)
    window.SetNumberOfLayers(2)
    renderers = []
    # The shadow lies a layer deeper, so that it never covers the body.
    for layer, left, actors in ((0, 0.5, [outline(rest)]),
                                (0, 0.0, [body(rest), text("at rest", 34, 0.5, 0.93)]),
                                (1, 0.5, [body(deformed, table), text(title, 34, 0.5, 0.93)])):
        renderer = vtk.vtkRenderer()
        renderer.SetLayer(layer)
        renderer.SetViewport(left, 0.2, left + 0.5, 1)
        renderer.SetBackground(1, 1, 1)
        lights(renderer)
        for actor in actors:
            renderer.AddActor(actor)
        window.AddRenderer(renderer)
        renderers.append(renderer)

    foot = vtk.vtkRenderer()
    foot.SetViewport(0, 0, 1, 0.2)
    foot.SetBackground(1, 1, 1)
    foot.AddActor2D(colour_bar(table, name))
    window.AddRenderer(foot)
    point_camera(renderers, points - displacement, displacement)

    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    writer = vtk.vtkPNGWriter()
    target = os.path.splitext(file)[0] + ".png"
    writer.SetFileName(target)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()
    print(target)


for argument in sys.argv[1:] or sys.exit(__doc__):
    draw(argument)
