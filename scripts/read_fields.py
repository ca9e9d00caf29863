#!/usr/bin/env python3
"""Read the field files of a run the way ParaView does, and check that everything is there.

    scripts/read_fields.py FOLDER...      (needs: pip install vtk)

Opens fields.vtkhdf, tools.vtkhdf and contact.vtkhdf with VTK's own reader (vtkHDFReader), goes through all time steps
and checks that every array is present, has the right number of components and is finite, and that states of contact are
those that there are. Prints one table per file.
Exit code 0 if all is well; otherwise 1 with a sentence for each thing that is not.
"""

import sys
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader

VERTEX, POLY_LINE, QUADRATIC_QUAD = 1, 4, 23

# contact_status: 0 open, 1 stick, 2 slip forward, 3 slip backward; in the sheet -1 at nodes that no tool can touch.
HIGHEST_STATE = 3
LOWEST_STATE = {"fields.vtkhdf": -1}

# File: cell type, point arrays and cell arrays with their number of components.
EXPECTED = {
    "fields.vtkhdf": (
        QUADRATIC_QUAD,
        {
            "displacement": 3,
            "stress": 6,
            "von_mises_stress": 1,
            "equivalent_plastic_strain": 1,
            "contact_pressure": 1,
            "gap": 1,
            "contact_status": 1,
        },
        {"rank": 1},
    ),
    "tools.vtkhdf": (POLY_LINE, {"displacement": 3}, {"tool": 1}),
    "contact.vtkhdf": (
        VERTEX,
        {"displacement": 3, "contact_pressure": 1, "friction_traction": 1, "gap": 1, "contact_status": 1},
        {},
    ),
}


def parts_of(data):
    """The unstructured grids in what the reader returns: one grid, or a collection of one per rank."""
    if data.IsA("vtkUnstructuredGrid"):
        return [data]
    if data.IsA("vtkPartitionedDataSet"):
        return [data.GetPartition(i) for i in range(data.GetNumberOfPartitions()) if data.GetPartition(i)]
    raise TypeError(f"unexpected {data.GetClassName()}")


class File:
    """One file, its problems and what was seen in it."""

    def __init__(self, path):
        self.path, self.problems, self.errors = path, [], []
        self.cell_type, self.point_arrays, self.cell_arrays = EXPECTED[path.name]
        self.ranges = {}

    def complain(self, sentence):
        if sentence not in self.problems:
            self.problems.append(sentence)

    def check_arrays(self, attributes, expected, count, where, step):
        for name, components in expected.items():
            array = attributes.GetArray(name)
            if array is None:
                self.complain(f"{where} array {name} is missing in step {step}")
                continue
            if array.GetNumberOfComponents() != components:
                self.complain(f"{where} array {name} has {array.GetNumberOfComponents()} components, not {components}")
            if array.GetNumberOfTuples() != count:
                self.complain(f"{where} array {name} has {array.GetNumberOfTuples()} rows for {count}, step {step}")
            values = vtk_to_numpy(array)
            if not values.size:
                continue
            if not np.isfinite(values).all():
                self.complain(f"{where} array {name} is not finite in step {step}")
            low, high = self.ranges.get((where, name), (np.inf, -np.inf))
            self.ranges[where, name] = (min(low, values.min()), max(high, values.max()))

    def check(self):
        if not self.path.is_file():
            return self.complain("the file does not exist")
        reader = vtkHDFReader()
        # VTK would only print its errors and go on.
        reader.AddObserver("ErrorEvent", lambda *_: self.complain("VTK's reader reports an error"))
        reader.GetExecutive().AddObserver("ErrorEvent", lambda *_: self.complain("VTK's reader reports an error"))
        if not reader.CanReadFile(str(self.path)):
            return self.complain("VTK's reader does not take it for a VTKHDF file")
        reader.SetFileName(str(self.path))
        reader.UpdateInformation()
        information = reader.GetOutputInformation(0)
        times = information.Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or ()
        if not times and reader.GetNumberOfSteps() == 1:
            # VTK takes a single step for a file without time.
            reader.Update()
            times = (reader.GetTimeValue(),)
        if not times:
            return self.complain("there is no time step")
        if any(b <= a for a, b in zip(times, times[1:])):
            self.complain("the times do not increase")
        if reader.GetNumberOfSteps() != len(times):
            self.complain(f"{reader.GetNumberOfSteps()} steps but {len(times)} times")
        sizes = set()
        for step, time in enumerate(times):
            reader.UpdateTimeStep(time)
            grids = parts_of(reader.GetOutputDataObject(0))
            sizes.add(tuple((g.GetNumberOfPoints(), g.GetNumberOfCells()) for g in grids))
            for grid in grids:
                kinds = {grid.GetCellType(cell) for cell in range(grid.GetNumberOfCells())}
                if kinds - {self.cell_type}:
                    self.complain(f"cells of type {sorted(kinds)}, expected {self.cell_type} only")
                if grid.GetNumberOfPoints() and not np.isfinite(vtk_to_numpy(grid.GetPoints().GetData())).all():
                    self.complain(f"the points are not finite in step {step}")
                # A rank without points has nothing to check; VTK may leave out its arrays altogether.
                if grid.GetNumberOfPoints():
                    self.check_arrays(grid.GetPointData(), self.point_arrays, grid.GetNumberOfPoints(), "point", step)
                if grid.GetNumberOfCells():
                    self.check_arrays(grid.GetCellData(), self.cell_arrays, grid.GetNumberOfCells(), "cell", step)
        low, high = self.ranges.get(("point", "contact_status"), (0, 0))
        lowest = LOWEST_STATE.get(self.path.name, 0)
        if not lowest <= low <= high <= HIGHEST_STATE:
            self.complain(f"contact_status goes from {low} to {high}, allowed is {lowest} to {HIGHEST_STATE}")
        if len(sizes) != 1:
            self.complain("the mesh changes between the steps")
        grids = next(iter(sizes))
        points, cells = (sum(column) for column in zip(*grids))
        if not cells:
            self.complain("there is not a single cell")
        print(f"{self.path.name}: {len(times)} steps, t = {times[0]:g} ... {times[-1]:g} ms, "
              f"{len(grids)} part(s), {points} points, {cells} cells")
        for (where, name), (low, high) in self.ranges.items():
            expected = self.point_arrays if where == "point" else self.cell_arrays
            print(f"  {where:5}  {name:26}  x{expected[name]}  {low:>14.6g} ... {high:<14.6g}")
        return None


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 0 if sys.argv[1:] in (["-h"], ["--help"]) else 2
    vtkObject.GlobalWarningDisplayOff()
    failed = False
    for path in [Path(folder) / name for folder in sys.argv[1:] for name in EXPECTED]:
        file = File(path)
        file.check()
        for problem in file.problems:
            print(f"{file.path}: {problem}", file=sys.stderr)
        failed = failed or bool(file.problems)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
