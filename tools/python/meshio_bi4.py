"""Lets meshio read DualSPHysics' particle files: Case.bi4 of fppg and GenCase, and the solver's Part_NNNN.bi4.

    import meshio, meshio_bi4                # PYTHONPATH=tools/python
    particles = meshio.read("Case.bi4")      # particles.points, particles.point_data["Vel"], ...

Every particle is a vertex with all arrays of the file, and Mk and Type (0 fixed, 1 moving, 2 floating, 3 fluid)
where Case.xml lies beside the file or one folder above. Writing is not there: `fppg` writes what the solver reads.
Needs particle_files.py of the folder above, or beside this file.
"""

import os
import sys

import meshio
import numpy as np

_HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [_HERE, os.path.dirname(_HERE)]
from particle_files import particle_arrays  # noqa: E402


def read(path):
    """The particles of a .bi4 as a meshio.Mesh: points in double, a vertex each, and their arrays as point data."""
    positions, data, _, _ = particle_arrays(os.fspath(path))
    vertices = np.arange(len(positions))[:, None]
    return meshio.Mesh(np.asarray(positions, np.float64), [("vertex", vertices)], point_data=data)


meshio.register_format("bi4", [".bi4"], read, {})
