"""Frames of a real set come in whatever order they come: order_test.py VANTAGE DATA [SEEDS].

DATA/scans/ur5_tray is planned with its frames shuffled. Some orders begin with a frame that shows little but the table.
Prints how many frames are merged, and how far the surface in the box ends from where it is in the order of the files,
after the best common motion.
"""

import csv
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import numpy as np

VANTAGE, DATA = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
SEEDS = int(sys.argv[3]) if len(sys.argv) > 3 else 3
del sys.argv[1:]
SET = DATA / "scans" / "ur5_tray"
CENTER, SIZES = np.array([-0.11, -0.29, 0.09]), np.array([0.36, 0.24, 0.12])
BOX = "--box=" + ",".join(map(str, [*CENTER, *SIZES]))


def rotation(x, y, z, w):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def poses_of(names, folder):
    """{name: (rotation, position)} of the merged frames that are planned in this order."""
    scans = folder / "scans"
    scans.mkdir()
    (scans / "camera-intrinsics.txt").symlink_to(SET / "camera-intrinsics.txt")
    for number, name in enumerate(names):
        for ending in (".depth.png", ".pose.txt"):
            (scans / f"{number:03}{ending}").symlink_to(SET / (name + ending))
    subprocess.run([VANTAGE, "plan", scans, BOX, "--depth-range", "0.25,1.5", "--out", folder / "out", "--no-report",
                    "--conclude", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    poses = {}
    with open(folder / "out" / "views.csv", encoding="utf-8") as table:
        for row in csv.DictReader(table):
            position = np.array([float(row["registered_" + axis]) for axis in "xyz"])
            turn = rotation(*(float(row["registered_q" + axis]) for axis in "xyzw"))
            if row["merged"] == "true":
                poses[names[int(row["reason"])]] = (turn, position)
    return poses


def displacements(first, second):
    """Mean displacement of points in the box that move with each frame, millimetres, after the best common motion."""
    grid = CENTER + SIZES * np.array([(a, b, c) for a in (-.4, 0, .4) for b in (-.4, 0, .4) for c in (-.4, .4)])
    common = [name for name in first if name in second]
    there = [((grid - first[name][1]) @ first[name][0]) @ second[name][0].T + second[name][1] for name in common]
    here, all_there = np.tile(grid, (len(common), 1)), np.concatenate(there)
    u, _, vt = np.linalg.svd((all_there - all_there.mean(0)).T @ (here - here.mean(0)))
    turn = vt.T @ np.diag([1, 1, np.linalg.det(vt.T @ u.T)]) @ u.T
    moved = [(each - all_there.mean(0)) @ turn.T + here.mean(0) for each in there]
    return 1000 * np.array([np.linalg.norm(each - grid, axis=1).mean() for each in moved])


@unittest.skipUnless(SET.exists(), f"{SET} is not there")
class Order(unittest.TestCase):
    def test_any_first_frame_will_do(self):
        names = sorted(file.name.removesuffix(".depth.png") for file in SET.glob("*.depth.png"))
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "files").mkdir()
            as_files = poses_of(names, folder / "files")
            for seed in range(1, SEEDS + 1):
                (folder / str(seed)).mkdir()
                shuffled = names[:]
                random.Random(seed).shuffle(shuffled)
                poses = poses_of(shuffled, folder / str(seed))
                off = displacements(as_files, poses)
                print(f"seed {seed}: {len(poses)} of {len(names)} merged; surface off by {np.median(off):.1f} mm "
                      f"(median), {off.max():.1f} mm at most", file=sys.stderr)
                self.assertGreaterEqual(len(poses), 22)
                self.assertLess(np.median(off), 4)


if __name__ == "__main__":
    unittest.main()
