"""What the program writes: output that cannot be written, folders of others, runs that are killed or interrupted. Usage:
output_test.py VANTAGE [unittest options]"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

VANTAGE = sys.argv.pop(1)
SMALL = ["--voxel", "0.08", "--scene", "51,51,51", "--enclosure", "13,13,13", "--camera", "45x45:60x60",
         "--candidates", "sphere:20:2"]
BOX = "--box=0,0,0,1.04,1.04,1.04"


def run(*arguments, **keywords):
    keywords = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **keywords}
    return subprocess.run([VANTAGE, *map(str, arguments)], text=True, timeout=240, **keywords)


class Output(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.scratch.name)
        result = run("reconstruct", "mug", "--out", cls.root / "mug", "--no-report", "--max-views", "3", *SMALL)
        if result.returncode != 0:
            raise AssertionError(result.stderr)
        cls.scans = cls.root / "mug" / "scans"
        cls.plan = ["plan", cls.scans, "--config", cls.scans / "scans.yaml", BOX, "--views", "20", "--registration",
                    "none"]

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def reconstruct(self, name, *options, **keywords):
        return run("reconstruct", "sphere", *SMALL, "--max-views", "2", "--out", self.root / name, *options, **keywords)


class Results(Output):
    def commands(self):
        session = self.root / "s"
        if not session.exists():
            self.assertEqual(run("session", "new", session, BOX, "--views", "20").returncode, 0)
        return [self.plan, [*self.plan, "--json"], ["session", "status", session], ["session", "status", session, "--json"],
                ["session", "next", session], ["doctor", self.scans, "--config", self.scans / "scans.yaml", "--json"],
                ["objects"], ["config"], ["--version"], ["--help"],
                ["evaluate", self.root / "mug" / "map.nrrd", "--candidates", "sphere:20:2", "--json"]]

    def test_results_that_cannot_be_written_are_failures(self):
        for command in self.commands():
            with self.subTest(command=command[:2]), open("/dev/full", "w") as full:
                result = run(*command, stdout=full)
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertRegex(result.stderr, "No space left|cannot be written")

    def test_so_are_those_that_nobody_reads_or_that_have_no_place(self):
        for command in self.commands():
            with self.subTest(command=command[:2]):
                read, write = os.pipe()
                os.close(read)
                result = run(*command, stdout=write)
                os.close(write)
                self.assertEqual(result.returncode, 1, result.stderr)
                closed = subprocess.run(["sh", "-c", '"$@" >&-', "sh", VANTAGE, *map(str, command)],
                                        capture_output=True, text=True, timeout=240)
                self.assertEqual(closed.returncode, 1, closed.stderr)


class Progress(Output):
    def test_progress_that_cannot_be_written_ends_nothing(self):
        for number, keywords in enumerate([{"stderr": "/dev/full"}, {"stderr": None}, {"stderr": "closed"}]):
            with self.subTest(keywords=keywords):
                out = self.root / f"progress{number}"
                commands = [["reconstruct", "sphere", *SMALL, "--max-views", "2", "--out", out],
                            [*self.plan, "--out", self.root / f"planned{number}"]]
                for command in commands:
                    text = [VANTAGE, *map(str, command)]
                    if keywords["stderr"] == "closed":
                        result = subprocess.run(["sh", "-c", '"$@" 2>&-', "sh", *text], stdout=subprocess.PIPE, timeout=240)
                    elif keywords["stderr"] is None:  # a pipe that nobody reads
                        read, write = os.pipe()
                        os.close(read)
                        result = subprocess.run(text, stdout=subprocess.PIPE, stderr=write, timeout=240)
                        os.close(write)
                    else:
                        with open(keywords["stderr"], "w") as file:
                            result = subprocess.run(text, stdout=subprocess.PIPE, stderr=file, timeout=240)
                    self.assertEqual(result.returncode, 0)
                for folder in (out, self.root / f"planned{number}"):
                    for file in folder.rglob("*"):
                        if file.suffix in (".json", ".csv", ".yaml", ".html"):
                            self.assertNotIn(b"\nscan ", file.read_bytes(), f"{file}: no line of progress")
                    json.loads((folder / "summary.json").read_text())


class Folders(Output):
    def test_a_run_owns_what_it_writes(self):
        out = self.root / "twice"
        self.assertEqual(run("reconstruct", "mug", *SMALL, "--max-views", "4", "--out", out).returncode, 0)
        (out / "notes.txt").write_text("mine")
        (out / "scans" / "scan-1.png").write_text("mine")
        self.assertEqual(self.reconstruct("twice", "--no-report").returncode, 0)
        self.assertEqual(len(list((out / "scans").glob("*.depth.png"))), 2)
        self.assertFalse((out / "report.html").exists() or (out / "mesh.ply").exists())
        self.assertEqual((out / "notes.txt").read_text() + (out / "scans" / "scan-1.png").read_text(), "minemine")

    def test_folders_of_others_are_refused(self):
        out = self.root / "foreign"
        out.mkdir()
        (out / "config.yaml").write_text("settings of another program")
        for command in (["reconstruct", "sphere", *SMALL, "--out", out], [*self.plan, "--out", out],
                        ["experiment", "table1", "--out", out]):
            result = run(*command)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertRegex(result.stderr, r"is not empty, and no (run|experiment) made it \(there is config.yaml\)")
        self.assertEqual([file.name for file in out.iterdir()], ["config.yaml"])
        self.assertEqual((out / "config.yaml").read_text(), "settings of another program")
        self.assertEqual(self.reconstruct("foreign", "--overwrite").returncode, 0)
        self.assertTrue((out / "config.yaml").read_text().startswith("# vantage reconstruct"))

    def test_the_scans_that_are_read_are_not_removed(self):
        before = sorted(self.scans.iterdir())
        for out in (self.root / "mug", self.scans):
            result = run(*self.plan, "--out", out)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("holds the scans that are read", result.stderr)
        self.assertEqual(sorted(self.scans.iterdir()), before)

    def test_a_session_keeps_files_that_it_did_not_write(self):
        folder = self.root / "mixed"
        self.assertEqual(run("session", "new", str(folder) + "/", BOX, "--views", "20").returncode, 0)
        self.assertEqual(run("session", "add", folder, sorted(self.scans.glob("*.depth.png"))[0], "--config",
                             self.scans / "scans.yaml").returncode, 0)
        (folder / "summary.json").write_text("mine")
        refused = run("session", "finish", folder)
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("summary.json: would be overwritten", refused.stderr)
        self.assertEqual(run("session", "finish", f"{folder}/", "--overwrite").returncode, 0)
        self.assertEqual(json.loads((folder / "summary.json").read_text())["object"], "mixed")
        self.assertEqual(run("session", "finish", folder).returncode, 0, "its own files by now")
        self.assertIn("is the folder of a session", self.reconstruct("mixed").stderr)


class Killed(Output):
    def test_what_a_killed_run_left_is_removed_by_the_next(self):
        if subprocess.run(["strace", "-o", "/dev/null", "true"], capture_output=True).returncode != 0:
            self.skipTest("needs strace")
        out = self.root / "killed"
        command = [VANTAGE, "reconstruct", "mug", *SMALL, "--max-views", "2", "--quiet", "--out", str(out)]
        left = 0
        for sync in range(1, 30, 4):
            subprocess.run(["strace", "-f", "-o", "/dev/null", "-e", "trace=fsync", "-e",
                            f"inject=fsync:signal=KILL:when={sync}", *command], capture_output=True, timeout=240)
            left += len(list(out.rglob(".*.tmp")))
        self.assertGreater(left, 3)
        result = subprocess.run(command, capture_output=True, text=True, timeout=240)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(list(out.rglob("*.tmp")), [])

    def test_interrupted_plans_say_so(self):
        scans = self.root / "many"
        self.assertEqual(run("reconstruct", "mug", "--out", scans, "--no-report", "--max-views", "12", "--voxel", "0.02",
                             "--camera", "45x45:640x640").returncode, 0)
        options = ["--config", scans / "scans" / "scans.yaml", "--box=0,0,0,1.04,1.04,1.04"]
        session = self.root / "interrupted"
        self.assertEqual(run("session", "new", session, *options).returncode, 0)
        for command, stream in ((["plan", scans / "scans", *options], "stderr"),
                                (["session", "add", session, scans / "scans"], "stdout")):
            process = subprocess.Popen([VANTAGE, *map(str, command)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       text=True)
            getattr(process, stream).readline()
            process.send_signal(signal.SIGINT)
            stdout, stderr = process.communicate(timeout=240)
            self.assertEqual(process.returncode, 1, stdout)
            self.assertIn("interrupted", stderr)
            self.assertNotIn("next best view", stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
