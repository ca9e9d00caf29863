"""Sheet, tools and contact of a run in ParaView with one click.

    pvpython scripts/paraview_macro.py FOLDER [PICTURE.png]     a picture of the deepest state and no window
    paraview, then Macros > Import new macro...           a button: open fields.vtkhdf of a run first, and click it

Needs ParaView 5.12 or newer for the steps in time; older ones show the undeformed sheet only. The sheet is coloured by the
equivalent plastic strain, the tools are lines, and the dots are contact points that carry a force, coloured by their pressure.
"""
import os
import sys

from paraview import simple

# Distance between the sheet and the edge of the picture, mm, the size of a contact point, and the share of the height for the scales.
MARGIN, POINT, SCALES = 4.0, 0.6, 0.14
INK = [0.1, 0.13, 0.17]
# From light to strong: the tools are dark, and so is the sheet where it stays elastic.
PRESSURE = [0.0, 1.0, 0.85, 0.35, 0.5, 0.95, 0.45, 0.15, 1.0, 0.75, 0.0, 0.15]
SHEET, TOOLS, CONTACT = "fields.vtkhdf", "tools.vtkhdf", "contact.vtkhdf"


def opened(folder, name):
    """The deformed data of one file."""
    reader = simple.VTKHDFReader(registrationName=name, FileName=os.path.join(folder, name))
    reader.UpdatePipeline()
    deformed = simple.WarpByVector(registrationName=f"deformed {name}", Input=reader)
    deformed.Vectors = ["POINTS", "displacement"]
    return deformed


def folder_of_selection():
    """The folder of the file that is selected in ParaView's list."""
    source = simple.GetActiveSource()
    while source is not None and not hasattr(source, "FileName"):
        source = getattr(source, "Input", None)
    if source is None:
        raise SystemExit("open fields.vtkhdf of a run and select it first")
    return os.path.dirname(str(source.FileName).strip("[]'"))


def deepest(tools):
    """The last time before the punch turns: where it is lowest."""
    lowest, at = 0.0, 0.0
    for time in tools.TimestepValues or [0.0]:
        tools.UpdatePipeline(time)
        low = tools.GetDataInformation().GetPointDataInformation().GetArrayInformation("displacement").GetComponentRange(1)[0]
        if low < lowest:
            lowest, at = low, time
    return at


def show(folder):
    """Fills the active view; returns it and the time of the deepest state."""
    view = simple.GetActiveViewOrCreate("RenderView")
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    view.ViewSize = [1600, 1000]

    sheet = opened(folder, SHEET)
    shown = simple.Show(sheet, view)
    simple.ColorBy(shown, ("POINTS", "equivalent_plastic_strain"))
    strain = simple.GetColorTransferFunction("equivalent_plastic_strain")
    strain.ApplyPreset("Viridis (matplotlib)", True)

    outlines = opened(folder, TOOLS)
    time = deepest(outlines.Input)
    tools = simple.Show(outlines, view)
    tools.ColorArrayName = ["POINTS", ""]
    tools.AmbientColor = tools.DiffuseColor = INK
    tools.LineWidth = 2.0

    closed = simple.Threshold(registrationName="points in contact", Input=opened(folder, CONTACT))
    closed.Scalars = ["POINTS", "contact_status"]
    closed.LowerThreshold, closed.UpperThreshold = 1, 3
    dots = simple.Glyph(registrationName="contact", Input=closed, GlyphType="Sphere")
    dots.ScaleArray = dots.OrientationArray = ["POINTS", "No scale array"]
    dots.ScaleFactor, dots.GlyphMode = POINT, "All Points"
    marked = simple.Show(dots, view)
    simple.ColorBy(marked, ("POINTS", "contact_pressure"))
    pressure = simple.GetColorTransferFunction("contact_pressure")
    pressure.RGBPoints, pressure.ColorSpace = PRESSURE, "RGB"

    view.ViewTime = time
    simple.GetAnimationScene().AnimationTime = time
    # Ranges of colours and what is framed are those of the time that was asked for last.
    for filtered in [sheet, dots]:
        filtered.UpdatePipeline(time)
    for coloured, name, place in [(shown, "equivalent plastic strain", 0.05), (marked, "contact pressure, MPa", 0.55)]:
        coloured.RescaleTransferFunctionToDataRange(False, True)
        coloured.SetScalarBarVisibility(view, True)
        bar = simple.GetScalarBar(coloured.LookupTable, view)
        bar.Title, bar.ComponentTitle = name, ""
        bar.TitleColor = bar.LabelColor = INK
        bar.TitleFontSize, bar.LabelFontSize = 14, 12
        bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%g", "%.3g"
        bar.Orientation, bar.WindowLocation = "Horizontal", "Any Location"
        bar.Position, bar.ScalarBarLength = [place, 0.03], 0.35
    frame(view, sheet)
    return view, time


def frame(view, sheet):
    """Looks along the width at the sheet, whatever the tools do beyond it."""
    # The first picture of a view chooses its own frame.
    simple.Render(view)
    left, right, low, high = sheet.GetDataInformation().GetBounds()[:4]
    view.InteractionMode = "2D"
    half = (max(high - low, (right - left) * 0.75) / 2 + MARGIN) / (1 - SCALES)
    middle = [(left + right) / 2, (low + high) / 2 - SCALES * half]
    view.CameraFocalPoint = [*middle, 0.0]
    view.CameraPosition = [*middle, 1000.0]
    view.CameraViewUp = [0.0, 1.0, 0.0]
    view.CameraParallelProjection = 1
    view.CameraParallelScale = half
    simple.Render(view)


def main():
    words = sys.argv[1:]
    if words and words[0].startswith("-"):
        print(__doc__)
        return
    folder = words[0] if words else folder_of_selection()
    for name in [SHEET, TOOLS, CONTACT]:
        if not os.path.isfile(os.path.join(folder, name)):
            raise SystemExit(f"{folder} holds no {name}: specify the output folder of a run")
    view, time = show(folder)
    if len(words) > 1:
        simple.SaveScreenshot(words[1], view, ImageResolution=[1600, 1000])
        print(f"{words[1]}: the sheet at t = {time:g} ms")


main()
