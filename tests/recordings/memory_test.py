"""Memory does not grow with the length of a recording: memory_test.py VANTAGE DATA [EVERY] [FRAMES...].

Frames of DATA/scans/ur5_tray (640x480), every EVERY-th and repeated, are written as an MCAP file of FRAMES (100 and 400
by default) and read by `doctor` and `plan`, whose peak memory is compared.
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import frames as frame_files
import ros_writers

VANTAGE, DATA = sys.argv[1], pathlib.Path(sys.argv[2])
EVERY = int(sys.argv[3]) if len(sys.argv) > 3 else 3
COUNTS = [int(count) for count in sys.argv[4:]] or [100, 400]
del sys.argv[1:]
OPTIONS = ["--box=-0.11,-0.29,0.09,0.36,0.24,0.12", "--depth-range", "0.25,1.5"]
PLAN = [*OPTIONS, "--registration", "none", "--views", "80", "--voxel", "0.01"]
MOST_MB = 400


def peak_mb(*arguments):
    """Of the program's memory; a process of its own measures it, because the peak of children only ever grows."""
    code = ("import resource, subprocess, sys\n"
            "done = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL)\n"
            "print(done.returncode, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
    said = subprocess.run([sys.executable, "-c", code, VANTAGE, *arguments], stdout=subprocess.PIPE, check=True, text=True)
    status, kilobytes = said.stdout.split()
    assert status in ("0", "1"), said.stdout  # 1: the doctor found something
    return int(kilobytes) / 1024


class Memory(unittest.TestCase):
    def setUp(self):
        self.scans = DATA / "scans" / "ur5_tray"
        if not self.scans.is_dir():
            self.skipTest(f"{self.scans} is not there")

    def test_it_does_not_grow(self):
        with tempfile.TemporaryDirectory(prefix="vantage-memory-") as name:
            folder = pathlib.Path(name)
            plain = folder / "plain"
            plain.mkdir()
            for path in [self.scans / "camera-intrinsics.txt", *sorted(self.scans.glob("*.depth.png"))[::EVERY]]:
                (plain / path.name).symlink_to(path)
                pose = path.name.replace(".depth.png", ".pose.txt")
                if pose != path.name:
                    (plain / pose).symlink_to(self.scans / pose)
            width, height, k, some = frame_files.folder_frames(plain)
            peaks = {"doctor": [], "plan": []}
            for count in COUNTS:
                path = folder / "long.mcap"
                many = ((frame_files.START_NS + i * frame_files.STEP_NS, some[i % len(some)][1], some[i % len(some)][0])
                        for i in range(count))
                ros_writers.write_mcap(path, ros_writers.messages(width, height, k, many, True))
                peaks["doctor"].append(peak_mb("doctor", path, *OPTIONS, "--quiet"))
                peaks["plan"].append(peak_mb("plan", path, *PLAN, "--quiet"))
            for command, found in peaks.items():
                print(command, ", ".join(f"{count} frames: {peak:.0f} MB" for count, peak in zip(COUNTS, found)))
                self.assertLess(max(found), MOST_MB, command)
            # A frame takes 600 kB as it is recorded, and 5 MB with its normals.
            self.assertLess(peaks["plan"][-1] - peaks["plan"][0], 0.1 * (COUNTS[-1] - COUNTS[0]))


if __name__ == "__main__":
    unittest.main()
