"""Planning, registration and whole runs through Python."""

import json
import os
import pathlib
import subprocess
import tempfile
import threading
import unittest

import numpy as np

import vantage

PROGRAM = os.environ.get("VANTAGE_PROGRAM")
DATA = pathlib.Path(os.environ.get("VANTAGE_SHARED_DATA", ""), "scans")


def sphere_run(**options):
    """A scanned sphere with the planner that goes with it."""
    scanner = vantage.RangeScanner(vantage.make_object("mug"))
    camera = vantage.RangeCamera.from_text("45x45:160x160")
    candidates = vantage.Candidates.sphere(80, 2.0)
    scene_map = vantage.VoxelMap(vantage.SceneOptions())
    view = candidates.views[0]
    vantage.integrate(scene_map, scanner.scan(camera, view), view)
    return scene_map, view, vantage.Planner(candidates, camera, **options), camera


class Planning(unittest.TestCase):
    def test_ranking_follows_from_factors(self):
        scene_map, view, planner, camera = sphere_run()
        plan = planner.next_best_view(scene_map, view)
        self.assertEqual(len(plan.ranking) + len(plan.infeasible), 80)
        utilities = [each.utility for each in plan.ranking]
        self.assertEqual(utilities, sorted(utilities, reverse=True))
        f = plan.best.factors
        self.assertAlmostEqual(plan.best.utility, f.f_area * (f.f_navigation + f.f_quality + f.f_occlusion))
        evaluator = vantage.VisibilityEvaluator(scene_map)
        self.assertEqual(plan.best.seen, evaluator.see(camera, plan.best.view, plan.best.resolution))

    def test_a_utility_in_python_decides(self):
        asked = []

        def fewest_rays_wasted(seen, factors):
            asked.append(factors.f_occlusion)
            return seen.occplane / seen.rays

        scene_map, view, _, camera = sphere_run()
        planner = vantage.Planner(vantage.Candidates.sphere(80, 2.0), camera, utility=fewest_rays_wasted)
        plan = planner.next_best_view(scene_map, view)
        self.assertGreaterEqual(len(asked), 80)
        self.assertEqual(plan.best.seen.occplane, max(each.seen.occplane for each in plan.ranking))
        self.assertEqual(plan.best.utility, plan.best.seen.occplane / 160**2)

    def test_errors_of_a_utility_come_through(self):
        scene_map, view, _, camera = sphere_run()
        candidates = vantage.Candidates.sphere(20, 2.0)

        def broken(seen, factors):
            raise KeyError("nothing here")

        with self.assertRaises(KeyError):
            vantage.Planner(candidates, camera, utility=broken).next_best_view(scene_map, view)
        with self.assertRaises(TypeError):
            vantage.Planner(candidates, camera, utility=lambda *_: "high").next_best_view(scene_map, view)
        with self.assertRaisesRegex(vantage.Error, "finite"):
            vantage.Planner(candidates, camera, utility=lambda *_: float("nan")).next_best_view(scene_map, view)

    def test_a_utility_of_all_views_looks_at_the_voxels(self):
        kept = []

        def unknown_neighbours(choice):
            kept.append(choice)
            labels = choice.map.labels()
            scores = []
            for i, each in enumerate(choice.views):
                voxels = choice.visible_voxels(i) - choice.map.enclosure[0]
                scores.append((labels[tuple(voxels.T)] == int(vantage.Label.occplane)).sum())
                self.assertEqual(scores[-1], each.seen.occplane)
            return np.array(scores)

        scene_map, view, _, camera = sphere_run()
        candidates = vantage.Candidates.sphere(80, 2.0)
        planner = vantage.Planner(candidates, camera, utility=vantage.SetUtility(unknown_neighbours))
        plan = planner.next_best_view(scene_map, view)
        self.assertEqual(plan.best.utility, max(each.seen.occplane for each in plan.ranking))
        with self.assertRaisesRegex(vantage.InputError, "choice: is over"):
            kept[0].views
        never_twice = vantage.SetUtility(unknown_neighbours, skips_scanned_views=True)
        planner = vantage.Planner(candidates, camera, utility=never_twice)
        planner.scanned(plan.best.view, plan.best.candidate)
        other = planner.next_best_view(scene_map, view)
        self.assertEqual(other.best.candidate, plan.ranking[1].candidate)
        self.assertIn("has been scanned from", [each.reason for each in other.infeasible])
        for wrong, error in ((lambda choice: [1.0], vantage.InputError), (lambda choice: "high", TypeError),
                             (lambda choice: [float("nan")] * len(choice.views), vantage.Error)):
            with self.assertRaises(error):
                vantage.Planner(candidates, camera, utility=vantage.SetUtility(wrong)).next_best_view(scene_map, view)
        with self.assertRaisesRegex(vantage.InputError, "compares all views"):
            vantage.Planner(candidates, camera, search="multi-resolution",
                            utility=vantage.SetUtility(unknown_neighbours, needs_all_views=True))

    def test_other_threads_run_while_a_view_is_planned(self):
        scene_map, view, planner, _ = sphere_run()
        plans = []
        threads = [threading.Thread(target=lambda: plans.append(
            vantage.Planner(planner.candidates, planner.camera, utility=lambda s, f: s.occplane)
            .next_best_view(scene_map, view))) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(timeout=60)
        self.assertEqual(len({plan.best.candidate for plan in plans}), 1)
        self.assertEqual(len(plans), 4)

    def test_options_by_keyword(self):
        scene_map, view, planner, camera = sphere_run(workspace=[-3, -3, 0, 3, 3, 3], body_radius=0.1)
        plan = planner.next_best_view(scene_map, view)
        below = [i for i, each in enumerate(planner.candidates.views) if each[2, 3] < 0]
        self.assertEqual([each.candidate for each in plan.infeasible], below)
        self.assertTrue(all("workspace" in each.reason for each in plan.infeasible))
        planner.discard(plan.best.candidate, "a chair stands there")
        other = planner.next_best_view(scene_map, view)
        self.assertEqual(other.best.candidate, plan.ranking[1].candidate)
        self.assertIn("a chair stands there", [each.reason for each in other.infeasible])
        with self.assertRaisesRegex(vantage.InputError, "must be"):
            vantage.Planner(planner.candidates, camera, search="fast")

    def test_convolution_of_one_peak_is_the_kernel(self):
        cube = vantage.Candidates.cube(9, [4, 4, 4], 0.5, 1.9)
        utilities = np.zeros(len(cube))
        utilities[100] = 1
        expected = vantage.convolve(utilities, cube, sigma=[0.2, 0.3, 0.4])
        offsets = cube.views[100, :3, 3] - cube.views[:, :3, 3]
        by_hand = np.exp(-0.5 * np.sum((offsets / [0.2, 0.3, 0.4]) ** 2, axis=1))
        np.testing.assert_allclose(expected, by_hand, rtol=1e-9, atol=1e-300)


class Registration(unittest.TestCase):
    def test_a_moved_scan_is_put_back(self):
        scanner = vantage.RangeScanner(vantage.make_object("mug"))
        camera = vantage.RangeCamera.from_text("45x45:160x160")
        model = vantage.ModelSurface(0.005, depth_noise=(0.001, 0))
        first, second = vantage.look_at([2, 0, 0.5], [0, 0, 0]), vantage.look_at([1.9, 0.6, 0.5], [0, 0, 0])
        model.merge(vantage.Scan(scanner.scan(camera, first)), first)
        believed = second.copy()
        believed[:3, 3] += [0.02, -0.03, 0.01]
        found = vantage.register_scan(model, vantage.Scan(scanner.scan(camera, second)), believed,
                                      pose_error=0.1)
        self.assertEqual((found.verdict, found.succeeded), ("registered", True))
        np.testing.assert_allclose(found.world_from_sensor, second, atol=2e-3)


class Simulation(unittest.TestCase):
    def test_a_run_is_that_of_the_program(self):
        seen = []
        options = dict(camera="45x45:80x80", max_views=3, seed=4, initial_view=7)
        run = vantage.simulate("pear", on_scan=lambda record, scene_map: seen.append(record.candidate), **options)
        self.assertEqual(seen, [record.candidate for record in run.scans])
        self.assertEqual(run.stop_reason, "the budget of 3 views is used up")
        out = subprocess.run([PROGRAM, "reconstruct", "pear", "--json", "--quiet", "--camera", "45x45:80x80",
                              "--max-views", "3", "--seed", "4", "--initial-view", "7", "--no-report"],
                             capture_output=True, text=True, check=True, cwd=self.folder)
        summary = json.loads(out.stdout)
        self.assertEqual(summary["occupied"], run.map.count(vantage.Label.occupied))
        self.assertEqual([scan["candidate"] for scan in summary["scans"]], seen)
        self.assertEqual(summary["coverage"], run.scans[-1].coverage)

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def test_a_run_with_a_utility_of_ones_own(self):
        options = dict(camera="45x45:80x80", max_views=4)
        own = vantage.simulate("mug", utility=lambda seen, factors: vantage.gua_utility(factors), **options)
        named = vantage.simulate("mug", utility="gua", **options)
        self.assertEqual(len(own.scans), 4)
        self.assertEqual([record.candidate for record in own.scans], [record.candidate for record in named.scans])

    def test_an_error_in_a_callback_ends_the_run(self):
        def stop(record, scene_map):
            raise InterruptedError("enough")
        with self.assertRaises(InterruptedError):
            vantage.simulate("sphere", on_scan=stop, camera="45x45:40x40")


@unittest.skipUnless((DATA / "ur5_tray").exists(), "needs the shared scans")
class RealScans(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def agrees_with_the_program(self, name, box, **options):
        """The program on the folder and Python frame by frame: the same map and next view."""
        flags = [text for key, value in options.items() for text in
                 ("--" + key.replace("_", "-"), ",".join(map(str, value)) if isinstance(value, list) else str(value))]
        box_text = ",".join(repr(float(number)) for number in box)
        out = subprocess.run([PROGRAM, "plan", DATA / name, "--box=" + box_text, *flags, "--json", "--quiet",
                              "--no-report", "--out", self.folder / "run"],
                             capture_output=True, text=True, check=True)
        by_program = json.loads(out.stdout)
        center, half = np.array(box[:3]), 0.5 * np.array(box[3:])
        model = vantage.ScanModel([center - half, center + half], **options)
        reading = {key: options[key] for key in ("depth_scale", "depth_range", "poses") if key in options}
        for file in vantage.open_scans(DATA / name, **reading).scans:
            model.add(file.read(), file.view, file.name)
        self.assertEqual([record.merged for record in model.scans],
                         [scan["verdict"] in ("first", "registered", "believed") for scan in by_program["scans"]])
        plan = model.next_best_view()
        self.assertEqual(plan.best.candidate, by_program["next"]["index"])
        self.assertEqual([each.utility for each in plan.ranking[:10]],
                         [view["utility"] for view in by_program["ranking"]])
        written = vantage.VoxelMap.read(self.folder / "run" / "map.nrrd")
        np.testing.assert_array_equal(written.labels(), model.map.labels())
        np.testing.assert_allclose(written.origin, model.map.origin, rtol=0, atol=1e-12)  # the file holds it rounded

    def test_apc_shelf(self):
        self.agrees_with_the_program("apc_shelf", [1.68, 0.0, 1.14, 0.44, 0.34, 0.28], depth_range=[0.15, 1.2],
                                     depth_scale=0.0001, poses="pose_robot")


if __name__ == "__main__":
    unittest.main()
