"""tools/particle_files.py: blocks and Case.xml of particles, also of the solver's outputs."""

import os
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
import particle_files  # noqa: E402 (found by the path above)

BLOCKS = [{"begin": 10, "count": 5}, {"begin": 0, "count": 10}, {"begin": 20, "count": 1}]


class FindBlocks(unittest.TestCase):
    def test_ids_in_any_order_find_their_block_and_others_none(self):
        ids = np.array([14, 0, 9, 10, 15, 20, 21, 4000000000], np.uint32)
        found = particle_files.find_blocks(ids, BLOCKS)
        self.assertEqual(found.tolist(), [0, 1, 1, 0, -1, 2, -1, -1])

    def test_without_blocks_no_id_has_one(self):
        self.assertEqual(particle_files.find_blocks(np.arange(2), []).tolist(), [-1, -1])

    def test_more_ids_than_are_looked_up_at_once(self):
        ids = np.full((1 << 20) + 3, 12, np.uint32)
        ids[-1] = 3
        found = particle_files.find_blocks(ids, BLOCKS)
        self.assertEqual((found[0], found[-2], found[-1]), (0, 0, 1))


class FindCaseXml(unittest.TestCase):
    def test_it_lies_beside_the_file_or_one_folder_above(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "data"))
            part = os.path.join(folder, "data", "Part_0001.bi4")
            self.assertIsNone(particle_files.find_case_xml(part, "Case"))
            for name in ("Case.xml", os.path.join("data", "Part_0001.xml")):
                path = os.path.realpath(os.path.join(folder, name))
                with open(path, "w", encoding="utf-8") as file:
                    file.write("<case/>")
                self.assertEqual(os.path.realpath(particle_files.find_case_xml(part, "Case")), path)


if __name__ == "__main__":
    unittest.main()
