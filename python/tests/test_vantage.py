"""The Python module against hand calculations and against the program itself."""

import math
import pathlib
import tempfile
import unittest

import numpy as np

import vantage


def small_scene():
    return vantage.SceneOptions(voxel_length=0.05, scene_size=[80, 80, 80], enclosure_size=[20, 20, 20])


def camera(columns=80, rows=80):
    return vantage.RangeCamera.from_apertures(math.radians(45), math.radians(45), (columns, rows))


def scanned_sphere():
    """A map after one scan of the built-in sphere, with the view and the image."""
    scanner = vantage.RangeScanner(vantage.make_object("sphere"))
    view = vantage.look_at([2, 0, 0], [0, 0, 0])
    image = scanner.scan(camera(), view)
    scene_map = vantage.VoxelMap(small_scene())
    vantage.integrate(scene_map, image, view)
    return scene_map, view, image


class Geometry(unittest.TestCase):
    def test_look_at_has_the_axes_that_the_documents_promise(self):
        pose = vantage.look_at([2, 0, 0], [0, 0, 0])
        # Seen along -x with z up: right is +y, down is -z.
        expected = [[0, 0, -1, 2], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]]
        np.testing.assert_allclose(pose, expected, atol=1e-12)

    def test_camera_and_ideal_resolution(self):
        self.assertAlmostEqual(camera().horizontal_aperture, math.radians(45))
        self.assertEqual(camera().ideal_resolution(0.02, 2.0), (79, 79))  # the paper's example


class Images(unittest.TestCase):
    def test_depth_is_a_view_and_not_a_copy(self):
        image = vantage.RangeImage(camera(4, 3), np.full((3, 4), 1.5, np.float32))
        first, second = image.depth, image.depth
        self.assertEqual((first.shape, first.dtype), ((3, 4), np.float32))
        self.assertTrue(np.shares_memory(first, second))
        del image
        self.assertEqual(first[2, 3], 1.5)  # the array keeps the image alive

    def test_raw_pixels_become_metres(self):
        pixels = np.array([[0, 1500, 4600], [65535, 7, 2000]], np.uint16)
        image = vantage.RangeImage(camera(3, 2), pixels, depth_scale=0.001, no_return=65535)
        np.testing.assert_allclose(image.depth, [[0, 1.5, np.inf], [np.inf, 0.007, 2]], rtol=1e-6)
        strided = np.zeros((2, 6), np.uint16)
        strided[:, ::2] = pixels
        other = vantage.RangeImage(camera(3, 2), strided[:, ::2], depth_scale=0.001, no_return=65535)
        np.testing.assert_array_equal(image.depth, other.depth)

    def test_whole_numbers_of_other_types_are_refused(self):
        with self.assertRaisesRegex(vantage.InputError, "int64; must be floating-point numbers in metres, or uint16"):
            vantage.RangeImage(camera(3, 2), np.ones((2, 3), np.int64))

    def test_normals_of_a_wall_face_the_sensor(self):
        normals = vantage.RangeImage(camera(8, 6), np.full((6, 8), 2, np.float32)).normals()
        self.assertEqual(normals.shape, (6, 8, 3))
        np.testing.assert_allclose(normals.reshape(-1, 3), np.tile([0, 0, -1], (48, 1)), atol=1e-6)


class Maps(unittest.TestCase):
    def test_a_scan_labels_what_it_sees(self):
        scene_map, view, image = scanned_sphere()
        labels = scene_map.labels()
        self.assertEqual((labels.shape, labels.dtype), ((20, 20, 20), np.uint8))
        self.assertTrue(labels.flags.f_contiguous)
        occupied = np.argwhere(labels == int(vantage.Label.occupied))
        self.assertEqual(len(occupied), scene_map.count(vantage.Label.occupied))
        # The voxels that hold a point of the image, counted here with numpy alone.
        hit = np.isfinite(image.depth) & (image.depth > 0)
        rows, columns = np.nonzero(hit)
        tangent = math.tan(math.radians(22.5))
        z = image.depth[hit].astype(float)
        in_sensor = np.c_[tangent * ((2 * columns + 1) / 80 - 1) * z, tangent * ((2 * rows + 1) / 80 - 1) * z, z]
        in_world = in_sensor @ view[:3, :3].T + view[:3, 3]
        voxels = np.unique(np.floor((in_world - scene_map.origin) / scene_map.voxel_length).astype(int), axis=0)
        self.assertEqual(set(map(tuple, occupied)), set(map(tuple, voxels)))

    def test_surface_belongs_to_the_occupied_voxels(self):
        scene_map, _, _ = scanned_sphere()
        surface = scene_map.surface()
        first, _ = scene_map.enclosure
        np.testing.assert_array_equal(surface["voxels"] - first, np.argwhere(scene_map.labels().T == 1)[:, ::-1])
        seen = np.linalg.norm(surface["normals"], axis=1) > 0
        outwards = np.sum(surface["normals"] * surface["centers"], axis=1)[seen]
        self.assertGreater(seen.sum(), 50)
        self.assertTrue((outwards > 0).all())  # of a sphere around the origin

    def test_given_normals_and_scans_give_the_same_map(self):
        scene_map, view, image = scanned_sphere()
        for scan in (lambda m: vantage.integrate(m, image, view, normals=image.normals()),
                     lambda m: vantage.integrate(m, vantage.Scan(image), view)):
            other = vantage.VoxelMap(small_scene())
            scan(other)
            self.assertTrue(other == scene_map)
            np.testing.assert_array_equal(other.surface()["quality"], scene_map.surface()["quality"])

    def test_files_and_labels_give_the_map_back(self):
        scene_map, _, _ = scanned_sphere()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "map.nrrd"
            scene_map.write(path)
            self.assertTrue(vantage.VoxelMap.read(path) == scene_map)
        other = vantage.VoxelMap(small_scene())
        other.set_labels(scene_map.labels())
        self.assertTrue(other == scene_map)

    def test_fast_visibility_is_the_exact_one(self):
        scene_map, _, _ = scanned_sphere()
        evaluator = vantage.VisibilityEvaluator(scene_map)
        views = vantage.Candidates.sphere(20, 2.0).views
        seen = evaluator.see_all(camera(), views, (40, 40))
        self.assertEqual(seen, [vantage.see_exactly(scene_map, camera(), view, (40, 40)) for view in views])
        voxels = evaluator.visible_voxels(camera(), views[0], (40, 40))
        labels = scene_map.labels()[tuple((voxels - scene_map.enclosure[0]).T)]
        self.assertEqual([(labels == 1).sum(), (labels == 4).sum(), (labels == 0).sum()],
                         [seen[0].occupied, seen[0].occplane, seen[0].unmarked])


class Errors(unittest.TestCase):
    def test_texts_are_those_of_the_library(self):
        with self.assertRaises(ValueError) as caught:
            vantage.Candidates.sphere(81, 2.0)
        self.assertIsInstance(caught.exception, vantage.InputError)
        self.assertIsInstance(caught.exception, vantage.Error)
        self.assertIsInstance(caught.exception, RuntimeError)
        self.assertIn("81", str(caught.exception))
        with self.assertRaisesRegex(vantage.InputError, "there is no such file or folder"):
            vantage.open_scans("no-such-folder")
        with self.assertRaisesRegex(vantage.InputError, r"did you mean 'max_views'"):
            vantage.simulate("sphere", max_view=3)
        with self.assertRaisesRegex(vantage.InputError, r"pose: has the shape \(3, 4\); must be \(4, 4\)"):
            vantage.write_pose("unused", np.eye(4)[:3])
        mirrored = np.diag([-1.0, 1, 1, 1])
        with self.assertRaisesRegex(vantage.InputError, "pose"):
            vantage.write_pose("unused", mirrored)
        with self.assertRaises(TypeError):
            vantage.Candidates.sphere("many", 2.0)


if __name__ == "__main__":
    unittest.main()
