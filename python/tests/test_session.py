"""Sessions through Python: the same as the program's, over restarts, from arrays and from files."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import vantage

PROGRAM = os.environ.get("VANTAGE_PROGRAM")
DATA = pathlib.Path(os.environ.get("VANTAGE_SHARED_DATA", ""), "scans")
FILES = ["map.nrrd", "map.ply", "model.ply", "mesh.ply", "views.csv"]  # the same bytes whoever made them
INTRINSICS = np.array([[95.0, 0, 39.5], [0, 95.0, 29.5], [0, 0, 1]])
OPTIONS = dict(box=[0, 0, 0, 1.1, 1.1, 1.1], voxel=0.05, views=20, no_return=65535, radius=2)


def flags(options):
    """The keywords as the command line writes them."""
    return ["--" + key.replace("_", "-") + "=" + (",".join(map(str, value)) if isinstance(value, list) else str(value))
            for key, value in options.items()]


def program(*arguments):
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=1200)
    if result.returncode != 0:
        raise AssertionError(f"{arguments}: exit {result.returncode}: {result.stderr}")
    return result.stdout


def mug_frames():
    """Depths in millimetres and poses, as a driver gives them."""
    scanner = vantage.RangeScanner(vantage.make_object("mug"))
    camera = vantage.RangeCamera.from_intrinsics(95, 95, 39.5, 29.5, (80, 60))
    for position in ([2, 0, 0.5], [0.5, 1.9, 0.4], [-1.6, 1, 0.8], [-0.5, -1.8, 0.9]):
        pose = vantage.look_at(position, [0, 0, 0])
        metres = scanner.scan(camera, pose).depth
        yield np.where(np.isfinite(metres), np.round(1000 * metres), 65535).astype(np.uint16), pose


class InAFolder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def assert_same_files(self, first, second):
        for name in FILES:
            self.assertEqual((self.folder / first / name).read_bytes(), (self.folder / second / name).read_bytes(), name)


class Sessions(InAFolder):
    def write_frames(self):
        """The frames as files, in a folder; their paths."""
        scans = self.folder / "scans"
        scans.mkdir()
        np.savetxt(scans / "camera-intrinsics.txt", INTRINSICS)
        camera = vantage.RangeCamera.from_intrinsics(95, 95, 39.5, 29.5, (80, 60))
        for number, (depth, pose) in enumerate(mug_frames()):
            image = vantage.RangeImage(camera, depth, no_return=65535)
            vantage.write_depth_png(scans / f"{number}.depth.png", image)
            vantage.write_pose(scans / f"{number}.pose.txt", pose)
        return sorted(scans.glob("*.depth.png"))

    def test_arrays_files_and_the_program_give_the_same(self):
        frames = self.write_frames()
        with vantage.Session.new(self.folder / "arrays", **OPTIONS) as session:
            for number, (depth, pose) in enumerate(mug_frames()):
                record = session.add_depth(depth, INTRINSICS, pose, name=str(number))
                self.assertTrue(record.merged)
            plan = session.next()
            session.finish()
        with vantage.Session.new(self.folder / "files", **OPTIONS) as session:
            self.assertEqual([len(session.add_files(frame)) for frame in frames], [1, 1, 1, 1])
            session.finish()
        program("session", "new", self.folder / "program", *flags(OPTIONS))
        program("session", "add", self.folder / "program", *frames)
        by_program = json.loads(program("session", "next", self.folder / "program", "--json"))
        program("session", "finish", self.folder / "program")
        self.assertEqual(plan.best.candidate, by_program["next"]["index"])
        self.assertEqual([each.utility for each in plan.ranking[:10]], [v["utility"] for v in by_program["ranking"]])
        self.assertEqual([(each.candidate, each.reason) for each in plan.infeasible],
                         [(each["index"], each["reason"]) for each in by_program["infeasible"]])
        self.assert_same_files("arrays", "files")
        self.assert_same_files("arrays", "program")

    def test_one_session_goes_on_in_the_program_and_in_python(self):
        frames = self.write_frames()
        vantage.Session.new(self.folder / "s", **OPTIONS).close()
        program("session", "add", self.folder / "s", frames[0])
        with vantage.Session(self.folder / "s") as session:
            self.assertEqual(session.status().merged, 1)
            session.add_files(frames[1])
            self.assertEqual([record.reason for record in session.scans], ["0", "1"])
            with self.assertRaisesRegex(vantage.Error, "another process has this session open"):
                vantage.Session(self.folder / "s")
        self.assertEqual(json.loads(program("session", "status", self.folder / "s", "--json"))["merged"], 2)

    def test_a_skipped_view_stays_skipped(self):
        depth, pose = next(mug_frames())
        with vantage.Session.new(self.folder / "s", **OPTIONS) as session:
            self.assertIsNone(session.next())
            self.assertIn("there is no scan yet", session.why_finished)
            session.add_depth(depth, INTRINSICS, pose, candidate=3)
            plan = session.next()
            self.assertEqual(session.why_finished, "")
            session.skip(plan.best.candidate, "a cable is in the way")
        with vantage.Session(self.folder / "s") as session:
            after = session.next()
            self.assertEqual(after.best.candidate, plan.ranking[1].candidate)
            self.assertIn("a cable is in the way", [each.reason for each in after.infeasible])
            self.assertEqual(session.status().skipped, {plan.best.candidate: "a cable is in the way"})
            session.unskip(plan.best.candidate)
            self.assertEqual(session.next().best.candidate, plan.best.candidate)

    def test_scans_are_taken_out_and_files_not_added_twice(self):
        with vantage.Session.new(self.folder / "s", **OPTIONS) as session:
            self.write_frames()
            path = self.folder / "scans"
            session.add_files(path)
            stored = session.status().stored
            self.assertGreater(stored, 1)
            with self.assertWarnsRegex(UserWarning, "which is there already as scan 0"):
                self.assertEqual(session.add_files(path), [])
            session.remove(0)
            self.assertEqual(session.status().removed, {0})
            self.assertEqual(session.status().stored, stored - 1)
            session.restore(0)
            self.assertEqual(session.status().stored, stored)
            with self.assertRaisesRegex(ValueError, "scan 0: was not taken out"):
                session.restore(0)

    def test_the_error_is_learned_from_where_the_robot_ends_up(self):
        scanner = vantage.RangeScanner(vantage.make_object("mug"))
        camera = vantage.RangeCamera.from_intrinsics(95, 95, 39.5, 29.5, (80, 60))
        errors = np.array([[0.1, 0, -0.1], [-0.1, 0.2, 0.1], [0.3, 0.1, 0]])
        options = dict(OPTIONS, registration="none", convolve="samples", believed_error="learn:0.1,0.1,0.2")
        with vantage.Session.new(self.folder / "s", **options) as session:
            self.assertEqual(session.status().learned_error["observations"], 0)
            depth, pose = next(mug_frames())
            session.add_depth(depth, INTRINSICS, pose)
            for error in errors:
                best = session.next().best
                reached = best.view.copy()
                reached[:3, 3] += error
                scan = vantage.Scan(vantage.RangeImage(camera, scanner.scan(camera, reached).depth))
                session.add(scan, reached, candidate=best.candidate, commanded=best.view)
            learned = session.status().learned_error
        self.assertEqual(learned["observations"], 3)
        # docs/positioning-error.md with kappa_0 = 1: the mean of three shrunk by 3/4; scatter and prior over 4.
        mean = errors.mean(axis=0)
        scatter = (errors - mean).T @ (errors - mean)
        expected = (np.diag([0.01, 0.01, 0.04]) + scatter + 0.75 * np.outer(mean, mean)) / 4
        np.testing.assert_allclose(learned["mean"][:3], 0.75 * mean, atol=1e-9)
        np.testing.assert_allclose(learned["covariance"][:3, :3], expected, atol=1e-9)
        with vantage.Session(self.folder / "s") as session:
            np.testing.assert_array_equal(session.status().learned_error["covariance"], learned["covariance"])

    def test_threads_may_ask_while_scans_are_added(self):
        session = vantage.Session.new(self.folder / "s", **OPTIONS)
        frames, answers = list(mug_frames()), []

        def ask():
            while len(answers) < 20:
                answers.append(session.next() is not None or session.why_finished != "")

        asking = threading.Thread(target=ask)
        asking.start()
        for depth, pose in frames:
            session.add_depth(depth, INTRINSICS, pose)
        asking.join(timeout=120)
        session.close()
        self.assertGreaterEqual(sum(answers), 20)
        self.assertFalse(session.is_open)
        with self.assertRaisesRegex(vantage.InputError, "session: is closed"):
            session.next()

    def test_a_map_is_a_copy_of_what_the_session_has(self):
        depth, pose = next(mug_frames())
        with vantage.Session.new(self.folder / "s", **OPTIONS) as session:
            session.add_depth(depth, INTRINSICS, pose)
            kept = session.map
            self.assertEqual(kept.labels().shape, (22, 22, 22))
            occupied = kept.count(vantage.Label.occupied)
            kept.set_labels(np.zeros((22, 22, 22), np.uint8))
            self.assertEqual(session.map.count(vantage.Label.occupied), occupied)
            self.assertGreater(occupied, 20)
            self.assertGreater(len(session.cloud()), 20)
            np.testing.assert_allclose(session.current, pose, atol=1e-12)

    def test_errors_have_the_texts_of_the_program(self):
        depth, pose = next(mug_frames())
        with self.assertRaisesRegex(vantage.InputError, "is no session; make one with"):
            vantage.Session(self.folder)
        with self.assertRaisesRegex(vantage.InputError, "box: a session needs"):
            vantage.Session.new(self.folder / "s")
        with self.assertRaisesRegex(vantage.InputError, "Session.new: unknown option 'boks'; did you mean 'box'"):
            vantage.Session.new(self.folder / "s", boks=1)
        with vantage.Session.new(self.folder / "s", **OPTIONS) as session:
            with self.assertRaisesRegex(vantage.InputError, "already is a session"):
                vantage.Session.new(self.folder / "s", **OPTIONS)
            with self.assertRaisesRegex(vantage.InputError, r"depth: has the type int64; must be uint16"):
                session.add_depth(depth.astype(np.int64), INTRINSICS, pose)
            with self.assertRaisesRegex(vantage.InputError, r"intrinsics: has the shape \(2, 2\); must be \(3, 3\)"):
                session.add_depth(depth, INTRINSICS[:2, :2], pose)
            with self.assertRaisesRegex(vantage.InputError, r"mask: has the shape \(60, 79\); must be \(60, 80\)"):
                session.add_depth(depth, INTRINSICS, pose, mask=np.ones((60, 79), bool))
            with self.assertRaisesRegex(vantage.InputError, "pose"):
                session.add_depth(depth, INTRINSICS, np.diag([1.0, 1, -1, 1]))
            with self.assertRaisesRegex(vantage.InputError, "reason: must say why"):
                session.skip(3, "")
            with self.assertRaisesRegex(vantage.InputError, "there is no such file"):
                session.add_files(self.folder / "none.depth.png")
            self.assertEqual(session.status().stored, 0)


class Depths(InAFolder):
    def test_options_of_reading_count_for_arrays(self):
        # A wall 2 m in front of a camera at (1, 2, 3) that looks along z; its hand is 0.5 m behind it.
        hand = np.eye(4)
        hand[:3, 3] = 1000, 2000, 2500
        inches = np.full((60, 80), 2 / 0.0254, np.float32)
        mask = np.ones((60, 80), bool)
        mask[:, 40:] = False
        scan, pose = vantage.scan_from_depth(np.full((60, 80), 2000, np.float32), INTRINSICS, hand, mask=mask, unit="mm",
                                             hand_eye=[0, 0, 500, 0, 0, 0, 1], crop=[1, 2, 5, 10, 0.1, 0.1])
        np.testing.assert_allclose(pose[:3, 3], [1, 2, 3])
        depth = scan.image.depth
        # The crop box keeps y within 0.05 m of the axis: (row - 29.5) / 95 * 2 in -0.05 .. 0.05, rows 28 to 31.
        rows, columns = np.nonzero(depth)
        self.assertEqual((rows.min(), rows.max(), columns.min(), columns.max()), (28, 31, 0, 39))
        self.assertEqual(len(rows), 4 * 40)
        np.testing.assert_allclose(depth[rows, columns], 2, rtol=1e-6)
        scan, _ = vantage.scan_from_depth(inches, INTRINSICS, np.eye(4), unit="inch", depth_range=[0.1, 1.9])
        self.assertTrue(np.isinf(scan.image.depth).all())
        units = np.full((60, 80), 20000, np.uint16)
        scan, _ = vantage.scan_from_depth(units, INTRINSICS, np.eye(4), depth_scale=0.0001)
        np.testing.assert_allclose(scan.image.depth, 2, rtol=1e-6)

    def test_what_numpy_has_masked_is_unknown(self):
        hidden = np.zeros((60, 80), bool)
        hidden[:, :30] = True
        for depth in (np.full((60, 80), 2.0, np.float32), np.full((60, 80), 2000, np.uint16)):
            scan, _ = vantage.scan_from_depth(np.ma.masked_array(depth, hidden), INTRINSICS, np.eye(4))
            np.testing.assert_array_equal(scan.image.depth == 0, hidden)
            counts = np.ma.masked_array(np.ones((60, 80), bool), hidden)  # a mask with masked elements: they do not count
            scan, _ = vantage.scan_from_depth(depth, INTRINSICS, np.eye(4), mask=counts)
            np.testing.assert_array_equal(scan.image.depth == 0, hidden)
            image = vantage.RangeImage(scan.image.camera, np.ma.masked_array(depth, hidden))
            np.testing.assert_array_equal(image.depth == 0, hidden)
        with vantage.Session.new(self.folder / "masked", box=[0, 0, 2, 1, 1, 1], registration="none") as session:
            record = session.add_depth(np.ma.masked_array(depth, np.ones_like(hidden)), INTRINSICS, np.eye(4))
            self.assertEqual(record.new_occupied, 0)

    def test_distortion_is_taken_out(self):
        # k1 = -0.2: the ideal pixel (row 29 + 20, column 39 + 30) has x = 30/95, y = 20/95, r^2 = 0.14404, and lies
        # in the distorted image at 1 - 0.2 r^2 = 0.97119 times these: column 39 + 29.136, row 29 + 19.424.
        depth = np.tile(np.arange(1, 81, dtype=np.float32)[None], (60, 1)) + 100 * np.arange(60, dtype=np.float32)[:, None]
        intrinsics = np.array([[95.0, 0, 39], [0, 95.0, 29], [0, 0, 1]])
        scan, _ = vantage.scan_from_depth(depth, intrinsics, np.eye(4), distortion=[-0.2, 0, 0, 0, 0], depth_range=[0, 1e6])
        x, y = 30 / 95, 20 / 95
        shrunk = 1 - 0.2 * (x * x + y * y)
        column, row = round(39 + 30 * shrunk), round(29 + 20 * shrunk)
        self.assertEqual((column, row), (68, 48))
        self.assertEqual(scan.image.depth[29 + 20, 39 + 30], depth[48, 68])
        self.assertEqual(scan.image.depth[29, 39], depth[29, 39])


@unittest.skipUnless((DATA / "ur5_tray").exists(), "needs the shared scans")
class RealScans(InAFolder):
    """`plan` on the folder, `session add` and Python frame by frame: the same bytes and the same views."""

    def check(self, name, box, **options):
        options["box"] = box
        frames = sorted((DATA / name).glob("*.depth.png"))
        planned = json.loads(program("plan", DATA / name, *flags(options), "--json", "--out", self.folder / "plan"))
        with vantage.Session.new(self.folder / "python", **options) as session:
            for frame in frames:
                session.add_files(frame)
            plan = session.next()
            session.finish()
        self.assertEqual(plan.best.candidate, planned["next"]["index"])
        self.assertEqual([(each.candidate, each.utility) for each in plan.ranking[:10]],
                         [(view["index"], view["utility"]) for view in planned["ranking"]])
        self.assert_same_files("plan", "python")
        program("session", "new", self.folder / "program", *flags(options))
        for frame in frames:
            program("session", "add", self.folder / "program", frame)
        self.assertEqual(json.loads(program("session", "next", self.folder / "program", "--json")), planned)
        program("session", "finish", self.folder / "program")
        self.assert_same_files("plan", "program")
        print(f"{name}: {len(frames)} frames, next view {plan.best.candidate} and the same files three times",
              file=sys.stderr)

    def test_ur5_tray(self):
        self.check("ur5_tray", [-0.11, -0.29, 0.09, 0.36, 0.24, 0.12], depth_range=[0.25, 1.5],
                   workspace=[-1, -1.2, 0.1, 1, 0.6, 1.5])

    def test_apc_shelf(self):
        self.check("apc_shelf", [1.683, -0.003, 1.142, 0.425, 0.327, 0.27], depth_range=[0.15, 1.2], depth_scale=0.0001,
                   poses="pose_robot")


if __name__ == "__main__":
    unittest.main()
