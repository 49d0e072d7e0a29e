#!/usr/bin/env python3
"""How well registration puts scans back whose poses were disturbed.

    disturbed_poses.py PROGRAM SCANS CM DEGREES SEED [OPTIONS OF vantage plan, with --box]

SCANS has NAME.depth.png and NAME.pose.txt (camera to world, 4x4). Plans on the frames as they are, and with every pose moved by CM in a
random direction and turned by DEGREES about a random axis. Prints how many frames are merged, and how far the points of the box are
from where the undisturbed plan puts them, after the best common rigid motion: mean per frame, then median and worst of the frames.
--pose-error and --pose-angle-error go to the disturbed plan alone.
"""
import csv
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np


def rotation(axis, angle):
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def disturbed(pose, shift, angle, random):
    result = pose.copy()
    direction, axis = random.normal(size=3), random.normal(size=3)
    result[:3, 3] += shift * direction / np.linalg.norm(direction)
    result[:3, :3] = rotation(axis, angle) @ pose[:3, :3]
    return result


def registered_poses(program, scans, options, change):
    """Poses of the merged frames by name, and the number of all frames."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for file in sorted(scans.iterdir()):
            if file.name.endswith(".pose.txt"):
                np.savetxt(folder / file.name, change(np.loadtxt(file)), fmt="%.9f")
            elif file.is_file():
                shutil.copy(file, folder)
        subprocess.run([program, "plan", folder, "--quiet", "--top", "1", "--out", folder / "run", *options], check=True,
                       stdout=subprocess.DEVNULL)
        with open(folder / "run" / "views.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        merged = {row["reason"]: np.loadtxt(folder / "run" / "scans" / f"scan-{int(row['scan']):03}.pose.txt")
                  for row in rows if row["merged"].lower() in ("1", "true")}
        return merged, len(rows)


def points_of_box(options):
    numbers = next(o.split("=", 1)[1] for o in options if o.startswith("--box="))
    box = np.array([float(n) for n in numbers.split(",")])
    steps = np.linspace(-0.4, 0.4, 4)
    return np.array([box[:3] + box[3:] * (x, y, z) for x in steps for y in steps for z in steps])


def mean_distances(moved, points):
    """Of each frame's points from their common place; frames that lie elsewhere hardly count for it."""
    weights = np.ones(len(moved))
    for _ in range(10):
        each = np.repeat(weights, len(points))[:, None]
        before, after = np.tile(points, (len(moved), 1)), np.concatenate(moved)
        centres = (each * before).sum(0) / each.sum(), (each * after).sum(0) / each.sum()
        u, _, vt = np.linalg.svd(((before - centres[0]) * each).T @ (after - centres[1]))
        turn = vt.T @ np.diag([1, 1, np.linalg.det(vt.T @ u.T)]) @ u.T
        off = np.linalg.norm(after - centres[1] - (before - centres[0]) @ turn.T, axis=1)
        distances = off.reshape(len(moved), -1).mean(1)
        weights = 1 / (1 + (distances / 0.003) ** 2)
    return distances


def main():
    program, scans, shift, angle, seed, *options = sys.argv[1:]
    scans = pathlib.Path(scans)
    plain = [o for o in options if not o.startswith("--pose-")]
    reference, _ = registered_poses(program, scans, plain, lambda pose: pose)
    random = np.random.default_rng(int(seed))
    found, frames = registered_poses(
        program, scans, options, lambda pose: disturbed(pose, float(shift) / 100, math.radians(float(angle)), random))
    points = points_of_box(options)
    names = [name for name in found if name in reference]
    moved = []
    for name in names:
        motion = found[name] @ np.linalg.inv(reference[name])
        moved.append(points @ motion[:3, :3].T + motion[:3, 3])
    off = 1000 * mean_distances(moved, points)
    print(f"{shift} cm, {angle} degrees, seed {seed}: merged {len(found)} of {frames} (undisturbed {len(reference)}), "
          f"median {np.median(off):.2f} mm, worst {off.max():.2f} mm, beyond 10 mm: {(off > 10).sum()}")


if __name__ == "__main__":
    main()
