#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The Python module: arrays and meshes of meshio and PyVista in, a Result out, an exception for each status.

usage: tests/python_test.py [BIN_DIR]     without BIN_DIR: the installed module with its own programs. 77: there is no numpy
"""
import os
import sys
import unittest

try:
    import numpy as np
except ImportError:
    print("numpy is not installed: skipped")
    sys.exit(77)

if len(sys.argv) > 1:
    os.environ["PATH"] = os.path.abspath(sys.argv.pop(1)) + ":" + os.environ["PATH"]
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts", "python"))
    sys.dont_write_bytecode = True
import meshpipe  # noqa: E402

# an octahedron, and its faces above as a patch of their own
POINTS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
FACES = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
PATCH = np.array([7, 7, 7, 7, 9, 9, 9, 9])


class Meshio:
    """A mesh as meshio has it."""
    points, cells_dict = POINTS, {"triangle": FACES, "line": np.array([[0, 1]])}


class PyVista:
    """A mesh as PyVista has it."""
    points, faces = POINTS, np.column_stack([np.full(8, 3), FACES]).ravel()

    def triangulate(self):
        return self


class Remesh(unittest.TestCase):
    def expect_octahedron(self, result):
        self.assertEqual(result.points.shape[1], 3)
        self.assertLess(np.abs(np.abs(result.points).sum(axis=1) - 1).max(), 1e-9)
        a, b, c = (result.points[result.faces[:, i]] for i in range(3))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
        self.assertAlmostEqual(volume, 4 / 3, 6)
        self.assertGreater(result.report["kappa_min"], 0.1)

    def test_arrays(self):
        result = meshpipe.remesh(POINTS, FACES, size=0.3, patch=PATCH)
        self.expect_octahedron(result)
        self.assertEqual(sorted(set(result.cell_data["patch"])), [7, 9])
        self.assertEqual(result.report["triangles"], len(result.faces))
        self.assertEqual(len(result.point_data["size"]), len(result.points))

    def test_quads_are_divided_and_other_cells_refused(self):
        class Quads:
            points, cells_dict = POINTS, {"quad": FACES[:, [0, 0, 1, 2]][:0], "triangle": FACES}

        self.expect_octahedron(meshpipe.remesh(Quads, size=0.3))
        cube = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
        Quads.points = cube
        Quads.cells_dict = {"quad": np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])}
        self.assertEqual(meshpipe.remesh(Quads, triangles=200).report["genus"], 0)
        Quads.cells_dict = {"tetra": FACES[:, [0, 1, 2, 0]]}
        with self.assertRaisesRegex(meshpipe.InputError, "tetra"):
            meshpipe.remesh(Quads)

    def test_what_is_not_returned_is_refused(self):
        for option in ("output", "help", "order"):
            with self.assertRaisesRegex(meshpipe.UsageError, option):
                meshpipe.remesh(POINTS, FACES, **{option: 2})

    def test_lists_and_options(self):
        result = meshpipe.remesh(POINTS.tolist(), FACES.tolist(), triangles=400, feature_angle="none", resolve=None)
        self.assertLess(abs(len(result.faces) - 400), 40)

    def test_size_at_points(self):
        result = meshpipe.remesh(POINTS, FACES, size=[0.1, 0.4, 0.4, 0.4, 0.4, 0.4])
        near = result.points[:, 0] > 0.7
        self.assertLess(result.point_data["size"][near].mean(), result.point_data["size"][~near].mean())

    def test_meshes(self):
        plain = meshpipe.remesh(POINTS, FACES, size=0.3)
        for mesh in (Meshio(), PyVista()):
            self.assertTrue(np.array_equal(meshpipe.remesh(mesh, size=0.3).points, plain.points))

    def test_accept(self):
        result = meshpipe.remesh(POINTS, FACES, size=0.5, max_error=1e-17, accept=True)
        self.assertGreater(len(result.faces), 8)

    def test_statuses(self):
        for error, status, arguments in (
                (meshpipe.UsageError, 2, {"no_such_option": 3}),
                (meshpipe.UsageError, 2, {"size": -1}),
                (meshpipe.UsageError, 2, {"size": [1, 2]}),
                (meshpipe.NotAdmissible, 4, {"faces": FACES[:0]}),
                (meshpipe.InputError, 3, {"faces": FACES + 1}),
                (meshpipe.InputError, 3, {"faces": FACES + 0.5}),
                (meshpipe.InputError, 3, {"faces": FACES[:, :2]}),
                (meshpipe.InputError, 3, {"points": POINTS * np.nan}),
                (meshpipe.InputError, 3, {"patch": [1]}),
                (meshpipe.NotAdmissible, 4, {"points": POINTS * 0}),
                (meshpipe.UsageError, 2, {"points": POINTS * 1e60}),
                (meshpipe.ContractMissed, 6, {"size": 0.5, "max_error": 1e-17}),
                (meshpipe.OutputError, 7, {"keep": "/dev/null/x"})):
            with self.subTest(arguments=arguments), self.assertRaises(error) as caught:
                meshpipe.remesh(**{"points": POINTS, "faces": FACES, "size": 0.5, **arguments})
            self.assertEqual(caught.exception.status, status, arguments)
            self.assertIsInstance(caught.exception, meshpipe.Error)
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaises(meshpipe.UsageError):
            meshpipe.remesh("part.stl")


if __name__ == "__main__":
    unittest.main(verbosity=0)
