"""Field files of a run, read with VTK's own reader into NumPy arrays; needs scripts/requirements.txt."""
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader

# The parts of a file written by several ranks would have to be joined; a reference is made on one.
ONE_RANK = "field_files: {} was written by several ranks; make the run on one"


class Fields:
    """One file in time: `times` (ms), and what is saved at each of them."""

    def __init__(self, path):
        self.path = path
        self.reader = vtkHDFReader()
        if not path.is_file() or not self.reader.CanReadFile(str(path)):
            raise SystemExit(f"field_files: {path} is no field file of a run")
        self.reader.SetFileName(str(path))
        self.reader.UpdateInformation()
        information = self.reader.GetOutputInformation(0)
        self.times = list(information.Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or ())

    def at(self, time):
        """Reference coordinates (mm) and the point arrays by name at a saved time."""
        self.reader.UpdateTimeStep(time)
        data = self.reader.GetOutputDataObject(0)
        if not data.IsA("vtkUnstructuredGrid"):
            if data.GetNumberOfPartitions() != 1:
                raise SystemExit(ONE_RANK.format(self.path))
            data = data.GetPartition(0)
        arrays = data.GetPointData()
        found = {arrays.GetArrayName(k): vtk_to_numpy(arrays.GetArray(k)).copy() for k in range(arrays.GetNumberOfArrays())}
        return vtk_to_numpy(data.GetPoints().GetData()).astype(float), found

    def between(self, time, name):
        """Reference coordinates and an array at any time, linear between the saved ones."""
        later = next((k for k, saved in enumerate(self.times) if saved >= time - 1e-9), len(self.times) - 1)
        earlier = max(later - 1, 0)
        first, last = self.times[earlier], self.times[later]
        points, arrays = self.at(last)
        if abs(last - time) < 1e-6 or earlier == later:
            return points, arrays[name]
        share = (time - first) / (last - first)
        return points, (1.0 - share) * self.at(first)[1][name] + share * arrays[name]
