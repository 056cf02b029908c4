import os
import struct
import sys
import tempfile
import unittest
import zlib

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
import particle_files  # noqa: E402 (found by the path above)
import plot_particles  # noqa: E402


def write_vtk(path, points, mk):
    n = len(points)
    with open(path, "wb") as file:
        file.write(b"# vtk DataFile Version 3.0\nvtk output\nBINARY\nDATASET POLYDATA\n")
        file.write(b"POINTS %d float\n" % n + points.astype(">f4").tobytes() + b"\n")
        cells = np.stack([np.ones(n), np.arange(n)], axis=1)
        file.write(b"VERTICES %d %d\n" % (n, 2 * n) + cells.astype(">i4").tobytes() + b"\n")
        file.write(b"POINT_DATA %d\nSCALARS Idp unsigned_int\nLOOKUP_TABLE default\n" % n)
        file.write(np.arange(n).astype(">u4").tobytes() + b"\n")
        file.write(b"FIELD FieldData 1\nMk 1 %d unsigned_char\n" % n)
        file.write(mk.astype(">u1").tobytes() + b"\n")


class PlotParticles(unittest.TestCase):
    def test_a_vtk_file_reads_back_even_with_line_ends_among_its_bytes(self):
        points = np.frombuffer(b"\x0a" * 12 * 20, ">f4").reshape(20, 3)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.vtk")
            write_vtk(path, points, np.full(20, 10))
            positions, mk = particle_files.read_particles(path)
        np.testing.assert_array_equal(positions, points)
        np.testing.assert_array_equal(mk, np.full(20, 10))

    def test_the_nearest_ball_is_the_one_seen(self):
        positions = np.array([[0, 0, 0], [0, 1, 0.0]])
        red, green = [255.0, 0, 0], [0, 255.0, 0]
        for view, colour in (("front", 0), ("back", 1)):
            image = plot_particles.draw(positions, np.array([red, green]), 0.5,
                                        plot_particles.view_axes(view), 64)
            middle = image[image.shape[0] // 2, 32]
            self.assertGreater(middle[colour], 100)
            self.assertEqual(middle[1 - colour], 0)

    def test_a_cut_keeps_the_side_it_names(self):
        positions = np.array([[0, 0, 0], [1, 0, 0.0]])
        self.assertEqual(plot_particles.kept(["x>0.5"], positions).tolist(), [False, True])
        self.assertEqual(plot_particles.kept(["x<1", "z<1"], positions).tolist(), [True, True])

    def test_the_png_holds_the_image(self):
        image = np.arange(5 * 7 * 3, dtype=np.uint8).reshape(5, 7, 3)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.png")
            plot_particles.write_png(path, image)
            with open(path, "rb") as file:
                data = file.read()
        self.assertEqual(struct.unpack(">II", data[16:24]), (7, 5))
        size, = struct.unpack(">I", data[33:37])
        rows = np.frombuffer(zlib.decompress(data[41:41 + size]), np.uint8).reshape(5, 22)
        np.testing.assert_array_equal(rows[:, 1:].reshape(5, 7, 3), image)


if __name__ == "__main__":
    unittest.main()
