"""Sessions as a robot uses them: processes that are killed at any moment, full disks, two processes at once, and the same
answer as `plan`. Usage: session_test.py VANTAGE SHARED_DATA KILLS [unittest options]"""
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

VANTAGE, DATA = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()
KILLS = int(sys.argv.pop(1))
SMALL = ["--voxel", "0.08", "--scene", "51,51,51", "--enclosure", "13,13,13", "--camera", "45x45:80x80",
         "--candidates", "sphere:20:2"]
STORED = re.compile(r"^stored scan +(\d+) ", re.MULTILINE)
BOX = "--box=0,0,0,1.04,1.04,1.04"


def run(*arguments, **keywords):
    return subprocess.run([VANTAGE, *map(str, arguments)], capture_output=True, text=True, timeout=600, **keywords)


def succeed(*arguments, **keywords):
    result = run(*arguments, **keywords)
    if result.returncode != 0:
        raise AssertionError(f"{arguments}: exit {result.returncode}: {result.stderr}")
    return result.stdout


class Sessions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.scratch.name)
        succeed("reconstruct", "mug", "--out", cls.root / "mug", "--no-report", "--quiet", "--max-views", "6", *SMALL)
        cls.frames = sorted((cls.root / "mug" / "scans").glob("*.depth.png"))

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def new(self, name, *options):
        folder = self.root / name
        shutil.rmtree(folder, ignore_errors=True)
        succeed("session", "new", folder, BOX, "--views", "20", "--config", self.root / "mug" / "scans" / "scans.yaml",
                *options)
        return folder

    def status(self, folder):
        return json.loads(succeed("session", "status", folder, "--json"))

    def assert_same_as_plan(self, scans, frames, name, options):
        """The scans at once by plan, and one by one by a process each, with verdicts forgotten on the way."""
        folder = self.root / name
        succeed("session", "new", folder, *options)
        for number, frame in enumerate(frames):
            succeed("session", "add", folder, frame)
            if number == len(frames) // 2:
                (folder / "session" / f"{number:06}.located").unlink()
        planned = json.loads(succeed("plan", scans, *options, "--json", "--out", self.root / (name + ".plan")))
        self.assertEqual(json.loads(succeed("session", "next", folder, "--json")), planned)
        self.assertIsNotNone(planned["next"])
        succeed("session", "finish", folder)
        for file in ["map.nrrd", "map.ply", "model.ply", "mesh.ply", "views.csv"]:
            self.assertEqual((folder / file).read_bytes(), (self.root / (name + ".plan") / file).read_bytes(), file)


class Kills(Sessions):
    def kill_once(self, folder, generator, seconds):
        """Adds all frames and kills that: after a while, or while a file is being written. Numbers that were acknowledged."""
        process = subprocess.Popen([VANTAGE, "session", "add", str(folder), *map(str, self.frames)],
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        end = time.monotonic() + generator.uniform(0, seconds)
        if generator.random() < 0.5:
            while time.monotonic() < end and process.poll() is None:
                time.sleep(0.0005)
        else:
            writes = generator.randrange(1, 12)
            while writes > 0 and process.poll() is None:
                writes -= any(file.suffix == ".tmp" for file in (folder / "session").iterdir())
        process.kill()
        output, _ = process.communicate()
        return [int(number) for number in STORED.findall(output)]

    def test_no_acknowledged_scan_is_lost(self):
        generator = random.Random(5)
        killed = unfinished = lost = 0
        for round_ in range(KILLS):
            if round_ % 8 == 0:
                folder = self.new("killed", "--registration", ["none", "icp"][round_ // 8 % 2])
                start = time.monotonic()
                succeed("session", "add", folder, *self.frames)
                seconds = 1.2 * (time.monotonic() - start)
                acknowledged = set(range(len(self.frames)))
            numbers = self.kill_once(folder, generator, seconds)
            acknowledged.update(numbers)
            killed += len(numbers) < len(self.frames)
            result = run("session", "status", folder, "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            unfinished += "never finished" in result.stderr
            status = json.loads(result.stdout)
            stored = {int(file.stem) for file in (folder / "session").glob("*.scan")}
            lost += len(acknowledged - stored)
            self.assertEqual(status["stored"], len(stored))
            self.assertEqual(status["integrated"], len(stored))
        self.assertEqual(lost, 0)
        self.assertGreater(killed, KILLS // 2, "the kills came too late to show anything")
        print(f"{KILLS} runs: {killed} killed before their end, {unfinished} left an unfinished file, {lost} lost",
              file=sys.stderr)


class FullDisk(Sessions):
    def check_full(self, folder, add):
        stored = self.status(folder)["stored"]
        result = add()
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertRegex(result.stderr, r"\.scan: .*(No space left|File too large)")
        acknowledged = stored + len(STORED.findall(result.stdout))
        self.assertEqual(self.status(folder)["stored"], acknowledged)
        self.assertFalse([file for file in (folder / "session").iterdir() if file.suffix == ".tmp"])

    def test_file_too_large(self):
        folder = self.new("limited")
        succeed("session", "add", folder, self.frames[0])

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        # Python ignores SIGXFSZ, and without restore_signals so does the program.
        self.check_full(folder, lambda: run("session", "add", folder, self.frames[1], preexec_fn=limit,
                                            restore_signals=False))
        succeed("session", "add", folder, self.frames[1])
        self.assertEqual(self.status(folder)["stored"], 2)

    def test_no_space(self):
        disk = self.root / "disk"
        disk.mkdir(exist_ok=True)
        if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=100k", "none", disk],
                                               capture_output=True).returncode != 0:
            self.skipTest("needs to mount a small disk")
        try:
            folder = self.new("disk/session")
            self.check_full(folder, lambda: run("session", "add", folder, *self.frames))
            self.assertGreater(self.status(folder)["stored"], 0)
        finally:
            subprocess.run(["umount", disk], check=True)


class DiskErrors(Sessions):
    """A disk that cannot sync, as strace makes it up."""

    def setUp(self):
        if subprocess.run(["strace", "-o", "/dev/null", "true"], capture_output=True).returncode != 0:
            self.skipTest("needs strace")

    def traced(self, options, *arguments):
        trace = self.root / "trace"
        result = subprocess.run(["strace", "-f", "-y", "-o", trace, *options, VANTAGE, *map(str, arguments)],
                                capture_output=True, text=True, timeout=600)
        return result, trace.read_text()

    def test_a_scan_that_is_not_stored_does_not_come_back(self):
        folder = self.new("unsynced")
        # The first sync is that of the scan's file, the second that of its folder, when the file has its name.
        failing = ["-e", "trace=fsync,unlink", "-e", "inject=fsync:error=EIO:when=2"]
        result, _ = self.traced(failing, "session", "add", folder, self.frames[0])
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("000000.scan: its folder cannot be synced: Input/output error", result.stderr)
        self.assertEqual(self.status(folder)["stored"], 0)
        self.assertIn("stored scan   0 ", succeed("session", "add", folder, self.frames[1]))

    def test_one_that_cannot_be_taken_back_is_not_denied(self):
        folder = self.new("unsynced")
        failing = ["-e", "trace=fsync,unlink", "-e", "inject=fsync:error=EIO:when=2", "-e", "inject=unlink:error=EROFS"]
        result, _ = self.traced(failing, "session", "add", folder, self.frames[0])
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("it may be there when the session is opened again", result.stderr)
        self.assertEqual(self.status(folder)["stored"], 1)
        self.assertIn("stored scan   1 ", succeed("session", "add", folder, self.frames[1]))

    def test_new_folders_are_synced_into_those_above_them(self):
        root = self.root / "synced"
        root.mkdir()
        result, trace = self.traced(["-e", "trace=fsync"], "session", "new", root / "a" / "b", BOX)
        self.assertEqual(result.returncode, 0, result.stderr)
        synced = set(re.findall(r"fsync\(\d+<([^>]*)>\)", trace))
        for folder in (root, root / "a", root / "a" / "b", root / "a" / "b" / "session"):
            self.assertIn(str(folder.resolve()), synced)


class OneAtATime(Sessions):
    def test_the_second_process_is_refused(self):
        folder = self.new("shared")
        import fcntl
        with open(folder / "session" / ".lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            result = run("session", "status", folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("another process has this session open", result.stderr)
        succeed("session", "status", folder)


class Misuse(Sessions):
    def test_errors(self):
        folder = self.new("misused")
        for arguments, text in [
                (["new", folder, BOX], "already is a session"),
                (["new", self.root / "boxless"], "box: a session needs"),
                (["status", self.root / "mug"], "is no session"),
                (["add", folder, self.root / "none.depth.png"], "no such file"),
                (["add", folder, self.root / "mug" / "summary.json"], "is no scan"),
                (["next", folder, "--skip", "20", "--reason", "far"], "must be one of the views 0 .. 19"),
                (["next", folder, "--skip", "3"], "reason: must say why"),
                (["next", folder, "--unskip", "3"], "was not skipped")]:
            with self.subTest(arguments=arguments):
                result = run("session", *arguments)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(text, result.stderr)
        self.assertIn("there is no scan yet", succeed("session", "next", folder))


class Answers(Sessions):
    def test_a_skipped_view_stays_skipped(self):
        folder = self.new("skipping")
        succeed("session", "add", folder, self.frames[0])
        first = json.loads(succeed("session", "next", folder, "--json"))
        best, second = first["ranking"][0]["index"], first["ranking"][1]["index"]
        succeed("session", "next", folder, "--skip", best, "--reason", "a cable is in the way")
        after = json.loads(succeed("session", "next", folder, "--json"))
        self.assertEqual(after["next"]["index"], second)
        self.assertIn({"index": best, "reason": "a cable is in the way"}, after["infeasible"])
        self.assertEqual(self.status(folder)["skipped"], [{"index": best, "reason": "a cable is in the way"}])
        succeed("session", "next", folder, "--unskip", best)
        self.assertEqual(json.loads(succeed("session", "next", folder, "--json")), first)

    def test_a_scan_can_be_taken_out_and_is_not_added_twice(self):
        folder = self.new("changed", "--registration", "icp")
        succeed("session", "add", folder, *self.frames[:3])
        whole = self.status(folder)
        result = run("session", "add", folder, *self.frames[:4], "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count("which is there already as scan"), 3)
        answer = json.loads(result.stdout)
        self.assertEqual([each["number"] for each in answer["already_there"]], [0, 1, 2])
        self.assertEqual([each["number"] for each in answer["scans"]], [3])
        self.assertIn("took out scan 3", succeed("session", "remove", folder, "3"))
        after = self.status(folder)
        self.assertEqual((after["stored"], after["removed"]), (3, [3]))
        self.assertEqual(after["labels"], whole["labels"])
        for number, why in [("3", "it was taken out before"), ("9", "is not in the session"), ("x", "number")]:
            result = run("session", "remove", folder, number)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(why, result.stderr)
        succeed("session", "restore", folder, "3")
        self.assertEqual(self.status(folder)["stored"], 4)
        succeed("session", "add", folder, self.frames[0], "--again")
        self.assertEqual(self.status(folder)["stored"], 5)

    def test_a_damaged_scan_is_left_out_and_kept(self):
        folder = self.new("damaged")
        succeed("session", "add", folder, *self.frames[:3])
        file = folder / "session" / "000001.scan"
        data = bytearray(file.read_bytes())
        data[len(data) // 2] ^= 1
        file.write_bytes(data)
        result = run("session", "status", folder, "--json")
        self.assertEqual(result.returncode, 0)
        self.assertIn("left out scan 1", result.stderr)
        self.assertEqual(json.loads(result.stdout)["stored"], 2)
        self.assertTrue(file.with_suffix(".damaged").exists())
        self.assertIn("stored scan   3 ", succeed("session", "add", folder, self.frames[3]), "numbers are not used twice")

    def test_mug(self):
        part = self.root / "mug" / "part"
        shutil.copytree(self.root / "mug" / "scans", part)
        for frame in self.frames[3:]:
            (part / frame.name).unlink()
        self.assert_same_as_plan(part, sorted(part.glob("*.depth.png")), "mug.session",
                                 [BOX, "--views", "20", "--config", part / "scans.yaml"])


def grey_png(columns, rows, value):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    pixels = zlib.compress(b"".join(b"\0" + bytes([value] * columns) for _ in range(rows)))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0)) +
            chunk(b"IDAT", pixels) + chunk(b"IEND", b""))


class Reading(Sessions):
    """The options of reading through plan, session and doctor; what each does to a scan is tested in C++."""

    def setUp(self):
        self.scans = self.root / "mug" / "scans"
        self.options = [BOX, "--views", "20", "--registration", "none", "--config", self.scans / "scans.yaml"]
        self.other = self.root / "other"
        shutil.rmtree(self.other, ignore_errors=True)
        shutil.copytree(self.scans, self.other)

    def plan(self, scans, *options):
        return json.loads(succeed("plan", scans, *self.options, "--json", *options))

    def by_session(self, scans, *options):
        folder = self.root / "reading"
        shutil.rmtree(folder, ignore_errors=True)
        succeed("session", "new", folder, *self.options, *options)
        for frame in sorted(scans.glob("*.depth.png")):
            succeed("session", "add", folder, frame, cwd="/")  # what it was given must hold from anywhere
        return json.loads(succeed("session", "next", folder, "--json"))

    def doctor(self, scans, *options):
        result = run("doctor", scans, "--config", self.scans / "scans.yaml", "--json", *options)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        return json.loads(result.stdout)

    def test_poses_of_the_hand_in_millimetres(self):
        # The sensor sits 100 mm ahead of the hand (its z axis), which is what the poses are of then.
        for file in self.other.glob("*.pose.txt"):
            rows = [[float(word) for word in line.split()] for line in file.read_text().splitlines()]
            for row in rows[:3]:
                row[3] = 1000 * (row[3] - 0.1 * row[2])
            file.write_text("\n".join(" ".join(map(repr, row)) for row in rows) + "\n")
        (self.root / "hand_eye.txt").write_text("1 0 0 0\n0 1 0 0\n0 0 1 100\n0 0 0 1\n")
        options = ["--unit", "mm", "--hand-eye", os.path.relpath(self.root / "hand_eye.txt")]
        expected, planned = self.plan(self.scans), self.plan(self.other, *options)
        self.assertEqual(planned["next"]["index"], expected["next"]["index"])
        for scan, wanted in zip(planned["scans"], expected["scans"]):
            for value, other in zip(scan["believed"], wanted["believed"]):
                self.assertAlmostEqual(value, other, delta=1e-9)
        self.assertEqual(self.by_session(self.other, *options), planned)
        self.assertAlmostEqual(self.doctor(self.other, *options)["agreement"], self.doctor(self.scans)["agreement"],
                               delta=0.01)
        by_numbers = self.plan(self.other, "--unit", "mm", "--hand-eye=0,0,100,0,0,0,1")
        self.assertEqual(by_numbers, planned)

    def test_masks_and_crop(self):
        columns, rows = 80, 80
        expected = self.plan(self.scans)
        for frame in self.other.glob("*.depth.png"):
            frame.with_name(frame.name.replace(".depth", ".mask")).write_bytes(grey_png(columns, rows, 255))
        self.assertEqual(self.plan(self.other), expected)
        self.assertEqual(self.plan(self.scans, "--masks", self.other), expected)
        self.assertEqual(self.plan(self.scans, "--crop=0,0,0,1.04,1.04,1.04"), expected, "nothing is outside of the box")
        self.assertEqual(self.by_session(self.other, "--crop=0,0,0,1.04,1.04,1.04"), expected)
        first = sorted(self.other.glob("*.mask.png"))[0]
        first.write_bytes(grey_png(columns, rows, 0))
        self.assertNotEqual(self.plan(self.other), expected, "the first scan says nothing now")
        first.write_bytes(grey_png(columns, rows + 1, 0))
        for command in (["plan", self.other, *self.options], ["doctor", self.other, "--config", self.scans / "scans.yaml"]):
            result = run(*command)
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"{first.name}: has 80x81 pixels, the depth image 80x80; a mask must have the same", result.stderr)

    def test_errors_name_the_value_and_what_is_right(self):
        for options, text in [(["--unit", "feet"], "unit = 'feet': must be m, cm, mm or inch"),
                              (["--crop=0,0,0,1,1,0"], "crop: must be cx,cy,cz,sx,sy,sz with positive sizes"),
                              (["--cloud-frame", "map"], "cloud-frame = 'map': must be sensor or world"),
                              (["--hand-eye=1,2,3"], "hand-eye: '1,2,3' has 3 numbers; must have 7"),
                              (["--hand-eye", self.root / "none.txt"], "none.txt: cannot be read"),
                              (["--masks", "nowhere"], ".mask.png: there is no such file; with --masks each frame")]:
            for command in (["plan", self.scans, *self.options], ["doctor", self.scans]):
                with self.subTest(command=command[0], options=options):
                    result = run(*command, *options)
                    self.assertEqual(result.returncode, 2, result.stdout)
                    self.assertIn(text, result.stderr)


class RealScans(Sessions):
    """Slow: only where many kills are asked for."""

    def setUp(self):
        if KILLS < 100 or not DATA.is_dir():
            self.skipTest("slow, and needs the real scans")

    def test_ur5_tray(self):
        scans = DATA / "scans" / "ur5_tray"
        self.assert_same_as_plan(scans, sorted(scans.glob("*.depth.png")), "tray",
                                 ["--box=-0.11,-0.29,0.09,0.36,0.24,0.12", "--depth-range", "0.25,1.5",
                                  "--workspace=-1,-1.2,0.1,1,0.6,1.5"])

    def test_apc_shelf(self):
        scans = DATA / "scans" / "apc_shelf"
        self.assert_same_as_plan(scans, sorted(scans.glob("*.depth.png")), "shelf",
                                 ["--box=1.683,-0.003,1.142,0.425,0.327,0.27", "--depth-range", "0.15,1.2", "--depth-scale", "0.0001",
                                  "--poses", "pose_robot"])


if __name__ == "__main__":
    unittest.main()
