"""The same scans in every form give the same map and the same next view: same_plan_test.py VANTAGE DATA [EVERY].

Frames of a real robot (every EVERY-th of DATA/scans/ur5_tray, all by default) are written as TUM RGB-D, BOP, Open3D,
transforms.json, COLMAP, MCAP with three compressions, sqlite3, and bags of ROS 1 with three, and planned on from each.
"""

import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import frames as frame_files
import ros_writers

VANTAGE, DATA = sys.argv[1], pathlib.Path(sys.argv[2])
EVERY = int(sys.argv[3]) if len(sys.argv) > 3 else 1
del sys.argv[1:]
OPTIONS = ["--box=-0.11,-0.29,0.09,0.36,0.24,0.12", "--depth-range", "0.25,1.5", "--views", "320", "--no-report"]
START_NS, STEP_NS = frame_files.START_NS, frame_files.STEP_NS


def png_bytes(width, height, depths, factor):
    """A grey PNG of 16 bits of the depths (little-endian uint16) times a whole number."""
    values = struct.unpack(f"<{width * height}H", depths)
    rows = struct.pack(f">{width * height}H", *(min(65535, factor * value) for value in values))
    packed = zlib.compress(b"".join(b"\0" + rows[2 * width * row:2 * width * (row + 1)] for row in range(height)), 1)

    def part(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    return (b"\x89PNG\r\n\x1a\n" + part(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0))
            + part(b"IDAT", packed) + part(b"IEND", b""))


def inverse(m):
    """Of a rigid motion, rows."""
    r = [[m[j][i] for j in range(3)] for i in range(3)]
    return [[*r[i], -sum(r[i][j] * m[j][3] for j in range(3))] for i in range(3)]


def rigid(q, t):
    x, y, z, w = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), t[0]],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), t[1]],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), t[2]]]


class SamePlan(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scans = DATA / "scans" / "ur5_tray"
        if not scans.is_dir():
            raise unittest.SkipTest(f"{scans} is not there")
        cls.temporary = tempfile.TemporaryDirectory(prefix="vantage-forms-")
        cls.folder = pathlib.Path(cls.temporary.name)
        plain = cls.folder / "plain"
        plain.mkdir()
        shutil.copy(scans / "camera-intrinsics.txt", plain)
        for depth in sorted(scans.glob("*.depth.png"))[::EVERY]:
            shutil.copy(depth, plain)
            shutil.copy(scans / depth.name.replace(".depth.png", ".pose.txt"), plain)
        cls.names = [path.name for path in sorted(plain.glob("*.depth.png"))]
        cls.width, cls.height, cls.k, frames = frame_files.folder_frames(plain)
        cls.frames = [(START_NS + i * STEP_NS, pose, depths) for i, (depths, pose) in enumerate(frames)]
        cls.matrices = [rigid(pose[3:], pose[:3]) for _, pose, _ in cls.frames]
        cls.plain = cls.plan(plain)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def plan(cls, path, *options):
        """What is printed of the next views, the labels of the map, and what was recognised."""
        out = cls.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        done = subprocess.run([VANTAGE, "plan", path, *OPTIONS, "--out", out, "--json", *options],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout), (out / "map.nrrd").read_bytes(), done.stderr

    def expect_same(self, path, recognised, *options):
        (views, labels, said), (plain_views, plain_labels, _) = self.plan(path, *options), self.plain
        self.assertIn(recognised, said)
        self.assertIn(f"{len(self.frames)} depth images", said)
        self.assertNotIn("left out", said)
        self.assertEqual(labels, plain_labels, "the maps differ")
        self.assertEqual([view["index"] for view in views["ranking"]],
                         [view["index"] for view in plain_views["ranking"]])
        for view, plain in zip(views["ranking"], plain_views["ranking"]):
            for key in ("position", "utility"):
                got, expected = view[key], plain[key]
                for a, b in zip(got if isinstance(got, list) else [got], expected if isinstance(got, list) else [expected]):
                    self.assertAlmostEqual(a, b, delta=1e-9 * max(1, abs(b)))

    def made(self, name):
        folder = self.folder / name
        (folder / "depth").mkdir(parents=True)
        return folder

    def copy_images(self, folder, pattern="{:06}.png"):
        for i, name in enumerate(self.names):
            shutil.copy(self.folder / "plain" / name, folder / "depth" / pattern.format(i))

    def intrinsics_json(self):
        k = self.k
        return {"width": self.width, "height": self.height,
                "intrinsic_matrix": [k[0], 0, 0, 0, k[4], 0, k[2], k[5], 1]}

    def test_tum(self):
        folder, depths, poses = self.made("tum"), "# time file\n", "# time x y z qx qy qz qw\n"
        for ns, pose, pixels in self.frames:
            name = f"depth/{ns / 1e9:.6f}.png"
            (folder / name).write_bytes(png_bytes(self.width, self.height, pixels, 5))
            depths += f"{ns / 1e9:.6f} {name}\n"
            poses += f"{ns / 1e9 + 0.004:.6f} {' '.join(map(repr, pose))}\n"
        (folder / "depth.txt").write_text(depths, encoding="utf-8")
        (folder / "groundtruth.txt").write_text(poses, encoding="utf-8")
        shutil.copy(self.folder / "plain" / "camera-intrinsics.txt", folder)
        self.expect_same(folder, "TUM RGB-D")

    def test_bop(self):
        folder, cameras = self.made("bop"), {}
        self.copy_images(folder)
        for i, matrix in enumerate(self.matrices):
            m = inverse(matrix)
            cameras[str(i)] = {"cam_K": self.k, "depth_scale": 1.0, "cam_R_w2c": [v for row in m for v in row[:3]],
                               "cam_t_w2c": [1000 * row[3] for row in m]}
        (folder / "scene_camera.json").write_text(json.dumps(cameras), encoding="utf-8")
        self.expect_same(folder, "BOP")

    def test_open3d(self):
        folder = self.made("open3d")
        self.copy_images(folder)
        (folder / "intrinsic.json").write_text(json.dumps(self.intrinsics_json()), encoding="utf-8")
        text = ""
        for i, matrix in enumerate(self.matrices):
            rows = [*matrix, [0, 0, 0, 1]]
            text += f"{i} {i} {i + 1}\n" + "".join(" ".join(map(repr, row)) + "\n" for row in rows)
        (folder / "trajectory.log").write_text(text, encoding="utf-8")
        self.expect_same(folder, "Open3D")

    def test_transforms_json(self):
        folder, k = self.made("nerf"), self.k
        self.copy_images(folder, "frame_{:05}.png")
        entries = []
        for i, matrix in enumerate(self.matrices):
            turned = [[row[0], -row[1], -row[2], row[3]] for row in matrix]
            entries.append({"file_path": f"images/frame_{i:05}.png", "transform_matrix": [*turned, [0, 0, 0, 1]]})
        (folder / "transforms.json").write_text(json.dumps(
            {"fl_x": k[0], "fl_y": k[4], "cx": k[2], "cy": k[5], "w": self.width, "h": self.height, "frames": entries}),
            encoding="utf-8")
        self.expect_same(folder, "NeRF transforms.json")

    def messages(self, cdr):
        return ros_writers.messages(self.width, self.height, self.k, self.frames, cdr)

    def test_mcap(self):
        for compression in ("", "zstd", "lz4"):
            with self.subTest(compression=compression):
                path = self.folder / f"a{compression}.mcap"
                ros_writers.write_mcap(path, self.messages(True), compression)
                self.expect_same(path, f"MCAP ({compression}): " if compression else "MCAP: ")

    def test_sqlite(self):
        ros_writers.write_sqlite(self.folder / "a.db3", self.messages(True))
        self.expect_same(self.folder / "a.db3", "sqlite3")

    def test_ros1(self):
        for compression in ("none", "bz2", "lz4"):
            with self.subTest(compression=compression):
                path = self.folder / f"{compression}.bag"
                ros_writers.write_ros1(path, self.messages(False), compression)
                self.expect_same(path, "ROS 1 bag: " if compression == "none" else f"ROS 1 bag ({compression}): ")


if __name__ == "__main__":
    unittest.main()
