"""Shows the frames that furrow.open(folder).write_vtk(FOLDER) has written, in ParaView: tires coloured by the force of
the terrain, arrows of these forces, grains as spheres of their own size coloured by speed.

In ParaView's window: View, Python Shell, Run Script, with the folder in the variable FURROW_VTK. From a shell, and on a
machine without a screen (without -noreset the X server restarts between two looks that ParaView takes at it):

    pvpython paraview_run.py FOLDER [--picture FILE.png]
    xvfb-run -a -s -noreset pvpython paraview_run.py FOLDER --picture FILE.png
"""
import os
import pathlib
import sys

from paraview import simple as pv

SMALLEST_FORCE = 1.0  # N, of nodes that get an arrow
ARROW = 0.25  # m, of the largest force


def colour(display, view, array, title, colours, place):
    """Colours by an array of the points, with a small bar at a place of the window."""
    pv.ColorBy(display, ("POINTS", *array))
    display.RescaleTransferFunctionToDataRange(True)
    display.SetScalarBarVisibility(view, True)
    table = pv.GetColorTransferFunction(array[0])
    table.ApplyPreset(colours, True)
    bar = pv.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle, bar.TitleFontSize, bar.LabelFontSize = title, "", 12, 12
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", place, 0.3


def show_tire(reader, view):
    display = pv.Show(reader, view)
    display.Opacity = 0.6  # the arrows are inside
    colour(display, view, ("force", "Magnitude"), "force of the terrain, N", "Cool to Warm", (0.9, 0.55))
    show_forces(reader, view)


def show_forces(reader, view):
    """Arrows of the nodes that the terrain pushes at."""
    reader.UpdatePipeline()
    size = pv.Calculator(Input=reader, ResultArrayName="size", Function="mag(force)")
    pushed = pv.Threshold(Input=size, Scalars=["POINTS", "size"], ThresholdMethod="Above Upper Threshold",
                          UpperThreshold=SMALLEST_FORCE)
    largest = reader.PointData["force"].GetRange(-1)[1]
    arrows = pv.Glyph(Input=pushed, GlyphType="Arrow", OrientationArray=["POINTS", "force"],
                      ScaleArray=["POINTS", "size"],
                      ScaleFactor=ARROW / max(largest, SMALLEST_FORCE), GlyphMode="All Points")
    pv.ColorBy(pv.Show(arrows, view), None)


def show_grains(reader, view):
    display = pv.Show(reader, view)
    display.SetRepresentationType("Point Gaussian")
    display.ScaleByArray = 1
    display.SetScaleArray = ["POINTS", "radius"]
    display.UseScaleFunction = 0
    display.GaussianRadius = 1.0  # times the array
    colour(display, view, ("speed",), "speed of the grains, m/s", "Viridis (matplotlib)", (0.9, 0.1))


def show(folder):
    """Opens all lists of frames in a folder; at the last instant, from the side."""
    files = sorted(folder.glob("*.pvd"))
    if not files:
        raise SystemExit(f"{folder}: holds no .pvd, expected what write_vtk wrote")
    view = pv.GetActiveViewOrCreate("RenderView")
    readers = [pv.PVDReader(registrationName=path.stem, FileName=str(path)) for path in files]
    scene = pv.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()
    for path, reader in zip(files, readers):
        (show_grains if path.stem == "terrain" else show_tire)(reader, view)
    view.ViewSize = (1400, 800)
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (-3.0, -5.0, 2.5), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    pv.ResetCamera(view)
    pv.GetActiveCamera().Zoom(1.3)
    pv.Render(view)
    return view


def main(arguments):
    folder = arguments[0] if arguments and not arguments[0].startswith("-") else os.environ.get("FURROW_VTK", ".")
    view = show(pathlib.Path(folder))
    if "--picture" in arguments:
        pv.SaveScreenshot(arguments[arguments.index("--picture") + 1], view, ImageResolution=(1400, 800))


main(sys.argv[1:])
