"""A reader of DualSPHysics' particle files for ParaView 5.10 and later: Case.bi4 of fppg and GenCase, and the
solver's outputs Part_0000.bi4, Part_0001.bi4, ... as one series in time.

In ParaView: Tools > Manage Plugins > Load New, this file; then File > Open takes .bi4. With pvpython:

    from paraview import simple
    simple.LoadPlugin("tools/paraview/fppg_reader.py", ns=globals())
    particles = fppgParticles(FileNames=["Part_0000.bi4", "Part_0001.bi4"])

Every particle is a vertex with all arrays of the file, and Mk and Type (0 fixed, 1 moving, 2 floating, 3 fluid) where
Case.xml lies beside the file or, for outputs of the solver, one folder above. Times are read without the
particles. Needs particle_files.py of the folder above, or beside this file.
"""

import os
import sys

import numpy as np

_HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [_HERE, os.path.dirname(_HERE)]
from particle_files import particle_arrays, read_bi4  # noqa: E402

from paraview.util.vtkAlgorithm import VTKPythonAlgorithmBase, smdomain, smhint, smproperty, smproxy  # noqa: E402
from vtkmodules.util.numpy_support import numpy_to_vtk  # noqa: E402
from vtkmodules.vtkCommonCore import vtkPoints  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkMultiBlockDataSet, vtkPolyData  # noqa: E402

def poly_data(positions, data):
    """Particles as vertices. Arrays are copied: VTK may share their memory further than Python sees."""
    count = len(positions)
    out = vtkPolyData()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(positions, deep=1))
    out.SetPoints(points)
    index = np.int32 if count < 2 ** 31 - 1 else np.int64
    vertices = vtkCellArray()
    vertices.SetData(*(numpy_to_vtk(np.arange(n, dtype=index), deep=1) for n in (count + 1, count)))
    out.SetVerts(vertices)
    for name, array in data.items():
        vtk_array = numpy_to_vtk(array, deep=1)
        vtk_array.SetName(name)
        out.GetPointData().AddArray(vtk_array)
    return out


def time_of(path):
    return float(read_bi4(path, is_mapped=True)[0].get("TimeStep", 0))


@smproxy.reader(name="fppgParticles", label="fppg Particles", extensions="bi4",
                file_description="DualSPHysics particles")
class FppgParticles(VTKPythonAlgorithmBase):
    """Reads one .bi4 or a series of them."""

    def __init__(self):
        VTKPythonAlgorithmBase.__init__(self, nInputPorts=0, nOutputPorts=1, outputType="vtkDataObject")
        self._files = []
        self._times = None
        self._is_in_blocks = False

    @smproperty.stringvector(name="FileNames", label="File Names", number_of_elements="1", repeat_command="1",
                             command="AddFileName", clean_command="RemoveAllFileNames", animateable="1",
                             panel_visibility="never")
    @smdomain.filelist()
    @smhint.filechooser(extensions="bi4", file_description="DualSPHysics particles")
    def AddFileName(self, name):
        if name and name != "None":
            self._files.append(name)
            self._times = None
            self.Modified()

    def RemoveAllFileNames(self):
        self._files = []
        self._times = None
        self.Modified()

    @smproperty.intvector(name="BlocksOfMk", label="Blocks Of Mk", default_values=0)
    @smdomain.xml('<BooleanDomain name="bool"/>')
    def SetBlocksOfMk(self, value):
        if bool(value) != self._is_in_blocks:
            self._is_in_blocks = bool(value)
            self.Modified()

    @smproperty.doublevector(name="TimestepValues", information_only="1", si_class="vtkSITimeStepsProperty")
    def GetTimestepValues(self):
        return [time for time, _ in self._series()]

    def _series(self):
        """Times and files, by time."""
        if self._times is None:
            self._times = sorted((time_of(name), name) for name in self._files)
        return self._times

    def _file_at(self, information):
        series = self._series()
        if not series:
            raise RuntimeError("no file was named")
        executive = self.GetExecutive()
        if not information.Has(executive.UPDATE_TIME_STEP()):
            return series[0]
        wanted = information.Get(executive.UPDATE_TIME_STEP())
        return min(series, key=lambda step: abs(step[0] - wanted))

    def RequestDataObject(self, request, inputs, outputs):
        information = outputs.GetInformationObject(0)
        wanted = vtkMultiBlockDataSet if self._is_in_blocks else vtkPolyData
        out = wanted.GetData(information)
        if out is None or not out.IsA(wanted.__name__):
            information.Set(vtkPolyData.DATA_OBJECT(), wanted())
        return 1

    def RequestInformation(self, request, inputs, outputs):
        information = outputs.GetInformationObject(0)
        executive = self.GetExecutive()
        times = self.GetTimestepValues()
        information.Remove(executive.TIME_STEPS())
        information.Remove(executive.TIME_RANGE())
        for time in times:
            information.Append(executive.TIME_STEPS(), time)
        if times:
            information.Append(executive.TIME_RANGE(), times[0])
            information.Append(executive.TIME_RANGE(), times[-1])
        return 1

    def RequestData(self, request, inputs, outputs):
        information = outputs.GetInformationObject(0)
        time, name = self._file_at(information)
        positions, data, of_block, blocks = particle_arrays(name)
        out = information.Get(vtkPolyData.DATA_OBJECT())
        if not self._is_in_blocks:
            out.ShallowCopy(poly_data(positions, data))
        else:
            self._fill_blocks(out, positions, data, of_block, blocks)
        out.GetInformation().Set(out.DATA_TIME_STEP(), time)
        return 1

    @staticmethod
    def _fill_blocks(out, positions, data, of_block, blocks):
        """A block for every mk, named as "mkbound 0"; the rest, if any, as "others"."""
        out.Initialize()
        names = [f"mk{'fluid' if b['type'] == 'fluid' else 'bound'} {b['mk_type']}" for b in blocks] + ["others"]
        if of_block is None:
            of_block = np.full(len(positions), -1)
        for i in [*range(len(blocks)), -1]:
            chosen = np.flatnonzero(of_block == i)
            if len(chosen) == 0:
                continue
            block = out.GetNumberOfBlocks()
            out.SetBlock(block, poly_data(positions[chosen], {key: a[chosen] for key, a in data.items()}))
            out.GetMetaData(block).Set(out.NAME(), names[i])
