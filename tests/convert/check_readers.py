"""What the codes that fppg convert writes for read of its files.

check_readers.py READER FPPG    READER: vtk, meshio, h5py, pysph, lammps, paraview, sphinxsys; exit code 77 where it is missing
"""

import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))

SKIPPED = 77

DEFINITION = """<?xml version="1.0" encoding="UTF-8" ?>
<case><casedef>
  <constantsdef>
    <gravity x="0" y="0" z="-9.81" /> <rhop0 value="1000" /> <rhopgradient value="2" />
    <hswl value="0" auto="true" /> <gamma value="7" /> <speedsystem value="0" auto="true" />
    <coefsound value="20" /> <speedsound value="0" auto="true" /> <coefh value="1" /> <cflnumber value="0.2" />
  </constantsdef>
  <mkconfig boundcount="240" fluidcount="9" />
  <fppg> <bodyfitted mkbound="0" /> </fppg>
  <geometry>
    <definition dp="0.05"> <pointmin x="-0.5" y="-0.5" z="-0.5" /> <pointmax x="1.5" y="1.5" z="1" /> </definition>
    <commands><mainlist>
      <setdrawmode mode="full" />
      <setmkbound mk="0" />
      <drawbox objname="plate"> <boxfill>solid</boxfill> <point x="0" y="0" z="0" /> <size x="1" y="1" z="0.23" /> </drawbox>
      <setmkfluid mk="0" />
      <drawbox> <boxfill>solid</boxfill> <point x="0.2" y="0.2" z="0.4" /> <size x="0.4" y="0.4" z="0.3" /> </drawbox>
    </mainlist></commands>
  </geometry>
</casedef>
<execution><parameters><parameter key="TimeMax" value="1" /></parameters></execution></case>
"""
PLATE_VOLUME = 0.23


class Skip(Exception):
    """The reader is not installed."""


def module(name):
    try:
        return __import__(name)
    except ImportError as error:
        raise Skip(f"no Python module {name}: {error}") from error


def make_case(folder, fppg, formats, definition=DEFINITION):
    """A plate with fitted walls and some water, or another case, in these formats."""
    with open(os.path.join(folder, "Case_Def.xml"), "w", encoding="utf-8") as file:
        file.write(definition)
    subprocess.run([fppg, "Case_Def", "Case", "-save:bi", f"-to:{formats}", "-quiet"], cwd=folder, check=True)
    return os.path.join(folder, "Case")


def reference(case):
    from particle_files import read_bi4
    _, arrays = read_bi4(case + ".bi4")
    return arrays


def expect_equal(numpy, found, wanted, what):
    if not numpy.array_equal(found, wanted):
        raise AssertionError(f"{what} differs from Case.bi4")


def check_vtk(folder, fppg):
    module("vtk")
    import numpy
    from vtk.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    case = make_case(folder, fppg, "vtu,trixi")
    arrays = reference(case)
    for name, count in (("Case.vtu", len(arrays["Idp"])), ("Case_trixi_plate.vtu", None), ("Case_trixi_fluid0.vtu", 567)):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(os.path.join(folder, name))
        reader.Update()
        grid = reader.GetOutput()
        if count is not None and (grid.GetNumberOfPoints() != count or grid.GetNumberOfCells() != count):
            raise AssertionError(f"{name}: {grid.GetNumberOfPoints()} points, {grid.GetNumberOfCells()} cells, not {count}")
        if grid.GetFieldData().GetArray("ndims").GetTuple1(0) != 3:
            raise AssertionError(f"{name}: ndims is not 3")
        data = grid.GetPointData()
        for array in ("velocity", "density", "pressure", "particle_spacing", "mass", "volume", "mk", "normal", "kind"):
            if data.GetArray(array) is None:
                raise AssertionError(f"{name}: no array {array}")
        if name == "Case.vtu":
            expect_equal(numpy, vtk_to_numpy(grid.GetPoints().GetData()), arrays["Posd"], "the positions")
            expect_equal(numpy, vtk_to_numpy(data.GetArray("density")), arrays["Rhop"], "the density")
        if name == "Case_trixi_plate.vtu":
            volume = vtk_to_numpy(data.GetArray("volume")).sum()
            if abs(volume - PLATE_VOLUME) > 1e-6:
                raise AssertionError(f"the plate has the volume {volume}, not {PLATE_VOLUME}")


def check_meshio(folder, fppg):
    meshio = module("meshio")
    import numpy
    case = make_case(folder, fppg, "vtu,xdmf")
    arrays = reference(case)
    for ending in ("vtu", "xdmf"):
        if ending == "xdmf":
            module("h5py")
        mesh = meshio.read(f"{case}.{ending}")
        expect_equal(numpy, mesh.points, arrays["Posd"], f"the positions in .{ending}")
        expect_equal(numpy, mesh.point_data["density"].ravel(), arrays["Rhop"], f"the density in .{ending}")
        if sum(len(block.data) for block in mesh.cells) != len(arrays["Idp"]):
            raise AssertionError(f".{ending}: not a vertex a particle")
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/python"))
    import meshio_bi4  # noqa: F401 (meshio knows .bi4 from here on)
    mesh = meshio.read(f"{case}.bi4")
    expect_equal(numpy, mesh.points, arrays["Posd"], "the positions in .bi4")
    expect_equal(numpy, mesh.point_data["Rhop"], arrays["Rhop"], "the density in .bi4")
    if set(mesh.point_data["Type"].tolist()) != {0, 3}:
        raise AssertionError(".bi4: expected walls and fluid")


def check_h5py(folder, fppg):
    h5py = module("h5py")
    import numpy
    case = make_case(folder, fppg, "xdmf,pysph")
    arrays = reference(case)
    with h5py.File(case + ".h5", "r") as file:
        expect_equal(numpy, file["position"][:], arrays["Posd"], "the positions")
        expect_equal(numpy, file["id"][:], arrays["Idp"], "the ids")
        if file.attrs["dp"] != 0.05:
            raise AssertionError("dp is not 0.05")
    with h5py.File(case + ".hdf5", "r") as file:
        plate = file["particles/plate/arrays"]
        found = numpy.stack([plate[axis][:] for axis in "xyz"], axis=1)
        expect_equal(numpy, found, arrays["Posd"][:len(found)], "the places of the plate")
        if abs(plate["volume"][:].sum() - PLATE_VOLUME) > 1e-6:
            raise AssertionError("the volumes of the plate do not add up")
        if abs(plate["m"][:].sum() - 1000 * PLATE_VOLUME) > 1e-3:
            raise AssertionError("the masses of the plate do not add up")


def check_pysph(folder, fppg):
    module("pysph")
    module("h5py")
    case = make_case(folder, fppg, "pysph")
    # PySPH compiles its arrays when it is first used.
    script = """if 1:
        import sys
        from pysph.solver.utils import load
        data = load(sys.argv[1])
        plate, fluid = data["arrays"]["plate"], data["arrays"]["fluid0"]
        assert fluid.get_number_of_particles() == 567, fluid.get_number_of_particles()
        assert abs(plate.volume.sum() - 0.23) < 1e-6, plate.volume.sum()
        assert abs((plate.xn ** 2 + plate.yn ** 2 + plate.zn ** 2).max() - 1) < 1e-6
        assert abs(fluid.h[0] - 0.05 * 3 ** 0.5) < 1e-12, fluid.h[0]
        assert data["solver_data"]["t"] == 0
    """
    subprocess.run([sys.executable, "-c", script, case + ".hdf5"], check=True)
    # The water falls freely for 20 steps, above walls that PySPH takes as they are.
    tank = """if 1:
        import sys
        from pysph.solver.application import Application
        from pysph.solver.utils import load
        from pysph.sph.scheme import WCSPHScheme

        class Tank(Application):
            def create_particles(self):
                arrays = load(sys.argv[1])["arrays"]
                particles = [arrays["fluid0"], arrays["plate"]]
                self.scheme.setup_properties(particles, clean=False)
                return particles

            def create_scheme(self):
                h = 0.05 * 3 ** 0.5
                scheme = WCSPHScheme(["fluid0"], ["plate"], dim=3, rho0=1000.0, c0=20.0, h0=h, hdx=h / 0.05, gz=-9.81)
                scheme.configure_solver(dt=1e-4, tf=2e-3)
                return scheme

        app = Tank(output_dir=sys.argv[2])
        app.run(["--disable-output", "--max-steps", "20", "--no-adaptive-timestep"])
        fluid, plate = app.particles
        assert abs(app.solver.t - 2e-3) < 1e-9, app.solver.t
        assert abs(fluid.w.mean() + 9.81 * 2e-3) < 1e-4, fluid.w.mean()
    """
    subprocess.run([sys.executable, "-c", tank, case + ".hdf5", os.path.join(folder, "out")], check=True,
                   stdout=subprocess.DEVNULL)


LAMMPS_PERI = """units si
atom_style peri
atom_modify map array
neighbor 0.01 bin
boundary f f f
read_data Case_peri.data
group water type 2
delete_atoms group water
compute each all property/atom vfrac
compute v all reduce sum c_each
pair_style peri/pmb
pair_coeff * * 1e14 0.1501 0.001 0.25
fix 1 all nve
compute d all displace/atom
compute far all reduce max c_d[4]
timestep 1e-6
thermo 1000
thermo_style custom step c_far c_v
run 1000
variable far equal c_far
variable volume equal c_v
print "moved by ${far}, volume ${volume}" file result.txt
"""
LAMMPS_SPHERE = """units si
atom_style sphere
boundary f f f
read_data Case_sphere.data
variable n equal count(all)
print "${n}" file count.txt
"""


def check_lammps(folder, fppg):
    lammps = shutil.which("lmp")
    if lammps is None:
        raise Skip("no program lmp")
    case = make_case(folder, fppg, "lammps-peri,lammps-sphere")
    count = len(reference(case)["Idp"])

    def run(name, text):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
        done = subprocess.run([lammps, "-in", name, "-log", "none"], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(f"LAMMPS ends with {done.returncode}: {done.stdout[-800:]}{done.stderr[-800:]}")

    run("in.peri", LAMMPS_PERI)
    with open(os.path.join(folder, "result.txt"), encoding="utf-8") as file:
        words = file.read().replace(",", "").split()
    moved, volume = float(words[2]), float(words[4])
    print(f"1,000 steps: the plate moved by {moved} m, its volume is {volume} m^3")
    if moved > 1e-9:
        raise AssertionError(f"the plate moved by {moved} m at rest")
    if abs(volume - PLATE_VOLUME) > 1e-6:
        raise AssertionError(f"the plate has the volume {volume}")
    run("in.sphere", LAMMPS_SPHERE)
    with open(os.path.join(folder, "count.txt"), encoding="utf-8") as file:
        if float(file.read()) != count:
            raise AssertionError("LAMMPS reads another number of spheres")


BALL = """<drawsphere objname="ball" radius="1"> <point x="0" y="0" z="0" /> </drawsphere>"""


def check_sphinxsys(folder, fppg):
    """Its relaxation leaves the surface of a reloaded ball where it is."""
    module("numpy")
    import numpy
    program = os.environ.get("FPPG_SPHINXSYS_RELOAD") or shutil.which("sphinxsys_reload")
    if program is None:
        raise Skip("no program sphinxsys_reload; tests/convert/readers/sphinxsys_reload.cpp says how to build it")
    dp = 0.1
    text = DEFINITION[:DEFINITION.index("<drawbox")] + BALL + DEFINITION[DEFINITION.index("</mainlist>"):]
    for old, new in (('dp="0.05"', f'dp="{dp}"'), ('x="-0.5" y="-0.5" z="-0.5"', 'x="-1.5" y="-1.5" z="-1.5"'),
                     ('x="1.5" y="1.5" z="1"', 'x="1.5" y="1.5" z="1.5"'), ('mkbound="0" />', 'mkbound="0" place="inside" />')):
        text = text.replace(old, new, 1)
    case = make_case(folder, fppg, "sphinxsys", text)
    os.mkdir(os.path.join(folder, "reload"))
    shutil.copy(case + "_Reload.xml", os.path.join(folder, "reload", "Reload.xml"))
    done = subprocess.run([program, str(dp), "10"], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"SPHinXsys ends with {done.returncode}: {done.stdout[-800:]}{done.stderr[-800:]}")
    moved = numpy.loadtxt(os.path.join(folder, "moved.txt"))
    before, after = moved[:, :3], moved[:, 3:]
    expect_equal(numpy, before, reference(case)["Posd"], "the positions that SPHinXsys reloads")
    is_outer = numpy.linalg.norm(before, axis=1) > 1 - 0.75 * dp
    step = numpy.linalg.norm(after - before, axis=1)[is_outer].max() / dp
    if is_outer.sum() < 1000 or not step < 0.1:
        raise AssertionError(f"the surface of {is_outer.sum()} particles moves by up to {step:.3f} dp")


PARAVIEW = """
import inspect
import sys
if not hasattr(inspect, "getargspec"):  # which ParaView 5.11.0 still imports and Python 3.11 has no more
    inspect.getargspec = inspect.getfullargspec
from paraview import servermanager, simple
plugin, picture, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
simple.LoadPlugin(plugin, ns=globals())
series = fppgParticles(FileNames=["data/Part_0001.bi4", "data/Part_0000.bi4"])
series.UpdatePipelineInformation()
assert list(series.TimestepValues) == [0.0, 0.5], list(series.TimestepValues)
series.UpdatePipeline(0.5)
data = servermanager.Fetch(series)
arrays = data.GetPointData()
assert data.GetNumberOfPoints() == data.GetNumberOfCells() == count, data.GetNumberOfPoints()
assert abs(data.GetPoint(0)[0] - 0.25) < 1e-12, data.GetPoint(0)  # at the second time
assert arrays.GetArray("Mk").GetRange() == (1.0, 10.0), arrays.GetArray("Mk").GetRange()
assert arrays.GetArray("Type").GetRange() == (0.0, 3.0)
assert arrays.GetArray("Vel").GetNumberOfComponents() == 3 and arrays.GetArray("Rhop") is not None
parts = fppgParticles(FileNames=["Case.bi4"], BlocksOfMk=1)
parts.UpdatePipeline()
data = servermanager.Fetch(parts)
names = [data.GetMetaData(i).Get(data.NAME()) for i in range(data.GetNumberOfBlocks())]
assert names == ["mkbound 0", "mkfluid 0"], names
if picture:
    view = simple.CreateView("RenderView")
    view.ViewSize = [400, 300]
    simple.ColorBy(simple.Show(series, view), ("POINTS", "Type"))
    simple.ResetCamera(view)
    simple.SaveScreenshot(picture, view)
print("ParaView reads it")
"""


def write_series(folder):
    """Two outputs as the solver names them: Case.bi4 at 0 and, moved by 0.25 in x, at 0.5 s."""
    import numpy
    from particle_files import read_bi4
    case = os.path.join(folder, "Case.bi4")
    os.mkdir(os.path.join(folder, "data"))
    shutil.copy(case, os.path.join(folder, "data", "Part_0000.bi4"))
    _, arrays = read_bi4(case)
    with open(case, "rb") as file:
        data = file.read()
    places = numpy.array(arrays["Posd"])
    at = data.index(places.tobytes())
    places[:, 0] += 0.25
    name = b"\x08\0\0\0TimeStep\x0c\0\0\0"
    time = data.index(name) + len(name)
    data = data[:at] + places.tobytes() + data[at + places.nbytes:]
    data = data[:time] + numpy.float64(0.5).tobytes() + data[time + 8:]
    with open(os.path.join(folder, "data", "Part_0001.bi4"), "wb") as file:
        file.write(data)
    return len(places)


def check_paraview(folder, fppg):
    module("numpy")
    pvpython = os.environ.get("FPPG_PVPYTHON") or shutil.which("pvpython")
    if pvpython is None:
        raise Skip("no program pvpython")
    make_case(folder, fppg, "csv")
    count = write_series(folder)
    # Debian's ParaView draws on an X server only.
    screen = shutil.which("xvfb-run")
    picture = "picture.png" if screen else ""
    plugin = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/paraview/fppg_reader.py")
    with open(os.path.join(folder, "look.py"), "w", encoding="utf-8") as file:
        file.write(PARAVIEW)
    # Between two windows of ParaView the server would start anew, and refuse the second.
    words = ([screen, "-a", "-s", "-screen 0 640x480x24 -noreset"] if screen else []) + [pvpython, "--force-offscreen-rendering", "look.py"]
    done = subprocess.run([*words, os.path.normpath(plugin), picture, str(count)], cwd=folder,
                          capture_output=True, text=True)
    if done.returncode != 0 or "ParaView reads it" not in done.stdout:
        raise AssertionError(f"pvpython ends with {done.returncode}: {done.stdout[-1500:]}{done.stderr[-3000:]}")
    if picture and os.path.getsize(os.path.join(folder, picture)) < 2000:
        raise AssertionError("the picture is empty")


def main():
    reader, fppg = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        try:
            globals()["check_" + reader](folder, os.path.abspath(fppg))
        except Skip as reason:
            print(f"skipped: {reason}")
            return SKIPPED
    return 0


if __name__ == "__main__":
    sys.exit(main())
