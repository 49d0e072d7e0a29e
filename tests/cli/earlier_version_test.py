"""Files that earlier versions wrote open today, and those of newer ones are refused untouched. Usage:
earlier_version_test.py VANTAGE DATA [unittest options]"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

VANTAGE, DATA = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()
BOX = ["--box=0,0,0,1.04,1.04,1.04", "--voxel", "0.08", "--views", "20"]
NEWER = re.compile(r": has format \d+; this program knows \d+, take the (program that wrote it|one that made)")


def run(*arguments):
    return subprocess.run([VANTAGE, *map(str, arguments)], capture_output=True, text=True, timeout=300, check=False)


def content(folder):
    """Names and bytes of everything below."""
    return {path.relative_to(folder): path.read_bytes() if path.is_file() else None for path in sorted(folder.rglob("*"))}


class Files(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name) / "files"
        shutil.copytree(DATA / "0.1", self.folder)
        self.run, self.tray = self.folder / "run", self.folder / "tray"

    def succeed(self, *arguments):
        result = run(*arguments)
        self.assertEqual(result.returncode, 0, f"{arguments}: {result.stderr}")
        return result


class Earlier(Files):
    def test_a_session_goes_on(self):
        before = content(self.tray)
        result = self.succeed("session", "status", self.tray, "--json")
        self.assertEqual(result.stderr, "", "nothing is dropped")
        status = json.loads(result.stdout)
        self.assertEqual((status["stored"], status["integrated"], status["merged"]), (2, 2, 2))
        self.assertEqual(status["skipped"], [{"index": 7, "reason": "a cable"}])
        after = content(self.tray)
        for name, data in before.items():
            if name.suffix in (".scan", ".yaml"):
                self.assertEqual(after[name], data, f"{name} stays as it was written")
        plan = json.loads(self.succeed("session", "next", self.tray, "--json").stdout)
        self.assertGreater(plan["next"]["n_op"], 0)
        self.assertIn("a cable", [each["reason"] for each in plan["infeasible"]])
        added = json.loads(self.succeed("session", "add", self.tray, self.run / "scans" / "scan-002.depth.png", "--json").stdout)
        self.assertEqual(added["scans"][0]["number"], 2)
        self.succeed("session", "finish", self.tray)
        self.assertEqual(json.loads((self.tray / "summary.json").read_text())["views"], 3)

    def test_a_run_is_read(self):
        views = len(json.loads(self.succeed("evaluate", self.run / "map.nrrd", "--candidates", "sphere:20:2",
                                            "--camera", "45x45:40x40", "--json").stdout)["views"])
        self.assertEqual(views, 20)
        self.succeed("view", self.run, "--png", self.folder / "picture.png")
        self.assertTrue((self.folder / "picture.png").read_bytes().startswith(b"\x89PNG"))
        self.succeed("export", self.run / "map.nrrd", self.folder / "map.bt")
        self.succeed("export", self.run, "--mesh", self.folder / "mesh.obj")
        plan = json.loads(self.succeed("plan", self.run / "scans", "--config", self.run / "scans" / "scans.yaml", *BOX,
                                       "--radius", "2", "--registration", "none", "--json").stdout)
        self.assertEqual(len(plan["scans"]), 3)

    def test_a_run_is_repeated_in_its_folder(self):
        for name in ("summary.json", "config.yaml"):
            self.assertTrue((self.run / name).exists(), name)
        candidates = [scan["candidate"] for scan in json.loads((self.run / "summary.json").read_text())["scans"]]
        config = shutil.copy(self.run / "config.yaml", self.folder / "config.yaml")
        self.succeed("reconstruct", "mug", "--config", config, "--out", self.run, "--quiet")
        summary = json.loads((self.run / "summary.json").read_text())
        self.assertEqual([scan["candidate"] for scan in summary["scans"]], candidates)


class Newer(Files):
    def raise_format(self, path, pattern, by=1):
        """Makes a file say that its format is a later one."""
        data = path.read_bytes()
        found = re.search(pattern, data)
        self.assertIsNotNone(found, f"{path} has no format")
        number = str(int(found[1]) + by).encode()
        path.write_bytes(data[:found.start(1)] + number + data[found.end(1):])

    def assert_refused(self, folder, *arguments):
        before = content(folder)
        result = run(*arguments)
        self.assertEqual(result.returncode, 2, f"{arguments}: {result.stdout}{result.stderr}")
        self.assertRegex(result.stderr, NEWER)
        self.assertEqual(result.stderr.count("\n"), 1, "one sentence")
        self.assertEqual(content(folder), before)

    def test_a_session_is_not_touched(self):
        self.raise_format(self.tray / "session" / "options.yaml", rb"^# vantage session, format (\d+)", by=9)
        (self.tray / "session" / ".000002.scan.1-0.tmp").write_bytes(b"half of a scan")
        for command in (["status"], ["next"], ["finish"]):
            self.assert_refused(self.tray, "session", command[0], self.tray)
        self.assert_refused(self.tray, "session", "add", self.tray, self.run / "scans" / "scan-002.depth.png")
        self.assert_refused(self.tray, "serve", self.tray, "--port", "0")

    def test_maps_and_summaries_are_refused(self):
        out = self.folder / "new"
        self.succeed("reconstruct", "mug", "--config", self.run / "config.yaml", "--out", out, "--quiet", "--max-views", "1")
        self.raise_format(out / "map.nrrd", rb"\nvantage-format:=(\d+)\n")
        self.assert_refused(out, "evaluate", out / "map.nrrd")
        self.assert_refused(out, "export", out / "map.nrrd", self.folder / "map.bt")
        self.raise_format(out / "map.nrrd", rb"\nvantage-format:=(\d+)\n", by=-1)
        self.raise_format(out / "summary.json", rb'"format": (\d+)')
        self.assert_refused(out, "view", out, "--png", self.folder / "picture.png")

    def test_run_folders_are_not_overwritten(self):
        out = self.folder / "new"
        self.succeed("reconstruct", "mug", "--config", self.run / "config.yaml", "--out", out, "--quiet", "--max-views", "1")
        self.raise_format(out / ".vantage-run", rb"^# vantage run, format (\d+)")
        self.assert_refused(out, "reconstruct", "mug", "--out", out)

    def test_configurations_are_refused(self):
        config = self.folder / "config.yaml"
        config.write_text(run("config").stdout.split("\n\n")[0] + "\nvoxel: 0.05\n")
        self.raise_format(config, rb"# configuration of vantage, format (\d+)")
        self.assert_refused(self.folder, "reconstruct", "mug", "--config", config, "--out", self.folder / "new")


if __name__ == "__main__":
    unittest.main(verbosity=2)
