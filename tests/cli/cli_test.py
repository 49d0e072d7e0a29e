"""Runs the program as a user would and checks exit codes, messages and files. Usage: cli_test.py VANTAGE [unittest options]"""
import csv
import json
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import unittest

VANTAGE = sys.argv.pop(1)
SMALL = ["--voxel", "0.08", "--scene", "51,51,51", "--enclosure", "13,13,13", "--camera", "45x45:80x80",
         "--candidates", "sphere:20:2"]


def run(*arguments, **keywords):
    return subprocess.run([VANTAGE, *map(str, arguments)], capture_output=True, text=True, timeout=120, **keywords)


def tetrahedron_ply(vertices=((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)),
                    faces=((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))):
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", "property float x", "property float y",
             "property float z", f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(str, v)) for v in vertices]
    lines += [" ".join(map(str, (len(f), *f))) for f in faces]
    return "\n".join(lines) + "\n"


class CommandLine(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def assert_refused(self, result, text, code=2):
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn(text, result.stderr)
        self.assertEqual(result.stdout, "")

    def file(self, name, content):
        path = self.folder / name
        if isinstance(content, str):
            path.write_text(content)
        else:
            path.write_bytes(content)
        return path


class Misuse(CommandLine):
    def test_options(self):
        cases = [
            (["--camera", "45x0:320x320"], "aperture = 0 degrees"),
            (["--camera", "45x180:320x320"], "aperture = 180 degrees"),
            (["--camera", "45x45:0x320"], "must be a whole number in 1..16384"),
            (["--candidates", "sphere:81:2"], "must be 20*4^k"),
            (["--candidates", "sphere:80:-2"], "radius = -2 m: must be positive"),
            (["--candidates", "cube:0:4.1:0.82:1.9"], "n = 0"),
            (["--candidates", "ring:8"], "must begin with sphere: or cube:"),
            (["--voxel", "0"], "voxel length = 0"),
            (["--voxel", "nan"], "voxel"),
            (["--enclosure", "300,55,55"], "must fit into the scene"),
            (["--scene", "9999,9999,9999", "--enclosure", "9999,9999,9999"], "does not fit in memory"),
            (["--positioning-error", "0.1,-0.1,0"], "positioning-error"),
            (["--utility", "best"], "utility 'best' is unknown"),
            (["--search", "random"], "exhaustive, multi-resolution"),
            (["--positioning-error", "1e20,0,0"], "positioning-error"),
            (["--error-mean", "1e9,0,0,0,0,0"], "error-mean"),
            (["--robot", "/dev/null"], "/dev/null"),
            (["--registration", "magic"], "truth, none, icp"),
            (["--initial-view", "80"], "must be one of the candidates 0 .. 79"),
            (["--max-views", "0"], "max-views = 0"),
            (["--depth-range", "3,1"], "max_depth = 1"),
            (["--size", "0"], "size = 0"),
            (["--size", "1e9"], "size"),
            (["--threads", "-1"], "threads = -1"),
            (["--no-such-option"], "no-such-option"),
        ]
        for arguments, text in cases:
            with self.subTest(arguments=arguments):
                self.assert_refused(run("reconstruct", "mug", "--out", self.folder / "out", *arguments), text)

    def test_objects_and_commands(self):
        self.assert_refused(run("reconstruct", "teapot"), "neither a built-in one (sphere")
        self.assert_refused(run("reconstruct", self.folder / "none.ply"), "none.ply")
        self.assert_refused(run("reconstuct", "mug"), "'reconstuct' is no command; did you mean 'reconstruct'?")
        alone = run()
        self.assertEqual(alone.returncode, 0, alone.stderr)
        self.assertIn("Try this first: vantage reconstruct mug", alone.stdout)

    def test_meshes(self):
        header_only = tetrahedron_ply(faces=())
        cases = [
            ("empty.ply", "", "empty"),
            ("text.ply", "this is no mesh\n", "text.ply"),
            ("truncated.ply", tetrahedron_ply()[:-20], "truncated.ply"),
            ("nan.ply", tetrahedron_ply(vertices=(("nan", 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))), "nan.ply"),
            ("no_faces.ply", header_only, "no_faces.ply"),
            ("range.ply", tetrahedron_ply(faces=((0, 1, 9),)), "range.ply"),
            ("flat.ply", tetrahedron_ply(vertices=((0, 0, 0),) * 4), "flat.ply"),
            ("huge.ply", tetrahedron_ply(vertices=((0, 0, 0), (1e30, 0, 0), (0, 1e30, 0), (0, 0, 1e30))), "huge.ply"),
            ("cut.stl", b"\0" * 80 + struct.pack("<I", 1000), "cut.stl"),
        ]
        for name, content, text in cases:
            with self.subTest(name=name):
                result = run("reconstruct", self.file(name, content), "--out", self.folder / "out")
                self.assert_refused(result, text)

    def test_maps(self):
        good = run("reconstruct", "sphere", *SMALL, "--max-views", "1", "--no-report", "--quiet", "--out", self.folder / "run")
        self.assertEqual(good.returncode, 0, good.stderr)
        nrrd = (self.folder / "run" / "map.nrrd").read_bytes()
        head, _, voxels = nrrd.partition(b"\n\n")
        cases = {
            "short.nrrd": nrrd[:-100],
            "sizes.nrrd": nrrd.replace(b"sizes: 51 51 51", b"sizes: 51 51 52"),
            "label.nrrd": head + b"\n\n" + b"\x09" + voxels[1:],
            "zero.nrrd": nrrd.replace(b"sizes: 51 51 51", b"sizes: 0 51 51"),
            "no.nrrd": b"NRRD0005\n\n",
        }
        for name, content in cases.items():
            with self.subTest(name=name):
                self.assertNotEqual(content, nrrd)
                self.assert_refused(run("evaluate", self.file(name, content)), name)
        self.assert_refused(run("evaluate", self.folder / "missing.nrrd"), "missing.nrrd")
        self.assert_refused(run("export", self.folder / "run" / "map.nrrd", self.folder / "out.xyz"), "must end in .bt")

    def test_configuration(self):
        config = self.file("config.yaml", "max-viws: 3\n")
        result = run("reconstruct", "mug", "--config", config)
        self.assert_refused(result, "max-viws")
        self.assertIn("max-views", result.stderr)
        self.assert_refused(run("reconstruct", "mug", "--config", self.file("bad.yaml", "voxel: [1, 2\n")), "bad.yaml")
        self.assert_refused(run("reconstruct", "mug", "--config", self.file("type.yaml", "max-views: many\n")), "type.yaml")

    def test_empty_files_are_no_configuration(self):
        empty = self.file("empty.yaml", "")
        self.assert_refused(run("reconstruct", "sphere", *SMALL, "--robot", empty), "empty.yaml: says nothing")
        self.assert_refused(run("reconstruct", "sphere", *SMALL, "--config", empty), "empty.yaml: is empty")

    def test_search_is_checked_by_every_command(self):
        bad = ["--search", "exhaustiv"]
        out = self.folder / "run"
        self.assertEqual(run("reconstruct", "sphere", *SMALL, "--max-views", "1", "--no-report", "--out", out).returncode, 0)
        for command in (["reconstruct", "sphere"], ["evaluate", out / "map.nrrd"], ["plan", out / "scans"],
                        ["session", "new", self.folder / "s", "--box=0,0,0,1,1,1"]):
            self.assert_refused(run(*command, *bad), "search = 'exhaustiv': must be one of: exhaustive, multi-resolution")

    def test_unwritable_output(self):
        self.assert_refused(run("reconstruct", "sphere", *SMALL, "--out", "/proc/vantage"), "/proc/vantage", code=1)

    def test_plan_without_scans(self):
        self.assert_refused(run("plan", self.folder), str(self.folder))
        self.assert_refused(run("plan", self.folder / "nowhere"), "nowhere")


class Reconstruction(CommandLine):
    def test_folder_holds_what_the_documents_promise(self):
        out = self.folder / "run"
        result = run("reconstruct", "sphere", *SMALL, "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("finished: no feasible view meets an occplane voxel any more", result.stdout)
        summary = json.loads((out / "summary.json").read_text())
        with open(out / "views.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(summary["views"], len(summary["scans"]))
        self.assertEqual(summary["views"], len(rows))
        self.assertEqual(result.stderr.count("scan "), summary["views"], "one line of progress per scan")
        self.assertGreater(summary["coverage"], 0.9)
        for scan, row in zip(summary["scans"], rows):
            self.assertEqual(float(row["coverage"]), scan["coverage"])
            self.assertEqual(row["reason"], scan["reason"])
            self.assertAlmostEqual(sum(float(row[f"registered_q{a}"]) ** 2 for a in "xyzw"), 1, 9)
        for name in ("config.yaml", "map.nrrd", "map.ply", "model.ply", "mesh.ply", "timings.json", "report.html"):
            self.assertGreater((out / name).stat().st_size, 0, name)
        self.assertEqual(len(list((out / "scans").glob("*.depth.png"))), summary["views"])
        report = (out / "report.html").read_text()
        for address in ("src=\"http", "href=\"http", "url(http", "@import"):
            self.assertNotIn(address, report, "the report asks for nothing")

    def test_a_run_is_repeated_by_its_configuration_to_the_last_byte(self):
        first, second = self.folder / "first", self.folder / "second"
        options = [*SMALL, "--no-report", "--quiet", "--depth-noise", "0.002,0.001", "--positioning-error", "0.02,0.02,0.02",
                   "--seed", "7", "--initial-view", "3"]
        self.assertEqual(run("reconstruct", "mug", *options, "--threads", "1", "--out", first).returncode, 0)
        repeated = run("reconstruct", "mug", "--config", first / "config.yaml", "--no-report", "--quiet", "--threads", "2",
                       "--out", second)
        self.assertEqual(repeated.returncode, 0, repeated.stderr)
        names = sorted(p.relative_to(first) for p in first.rglob("*") if p.is_file())
        self.assertEqual(names, sorted(p.relative_to(second) for p in second.rglob("*") if p.is_file()))
        for name in names:
            if name.name != "timings.json":
                self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), name)

    def test_json_and_quiet(self):
        result = run("reconstruct", "sphere", *SMALL, "--no-report", "--json", "--quiet", "--out", self.folder / "run")
        self.assertEqual(result.stderr, "")
        self.assertEqual(json.loads(result.stdout), json.loads((self.folder / "run" / "summary.json").read_text()))

    def test_frames_are_scans_that_plan_reads(self):
        out = self.folder / "run"
        run("reconstruct", "sphere", *SMALL, "--no-report", "--quiet", "--max-views", "2", "--out", out)
        result = run("plan", out / "scans", "--config", out / "scans" / "scans.yaml", "--box", "0,0,0,1.04,1.04,1.04",
                     "--voxel", "0.08", "--views", "20", "--radius", "2", "--registration", "none", "--json", "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        plan = json.loads(result.stdout)
        self.assertEqual(len(plan["scans"]), 2)
        self.assertGreater(plan["next"]["n_op"], 0)
        self.assertEqual(plan["next"]["index"], plan["ranking"][0]["index"])
        missed = run("plan", out / "scans", "--config", out / "scans" / "scans.yaml", "--box", "9,9,9,1,1,1")
        self.assert_refused(missed, "none of the 2 scans has a point in the box")

    def test_interrupted_runs_keep_what_was_scanned(self):
        out = self.folder / "run"
        process = subprocess.Popen([VANTAGE, "reconstruct", "sgi_logo", "--no-report", "--candidates", "sphere:1280:2",
                                    "--camera", "45x45:640x640", "--out", out],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for _ in range(2):  # two scans are done
            process.stderr.readline()
        process.send_signal(signal.SIGINT)
        stdout, _ = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0)
        self.assertIn("kept what was scanned: interrupted", stdout)
        summary = json.loads((out / "summary.json").read_text())
        self.assertEqual(summary["stop_reason"], "interrupted")
        self.assertGreaterEqual(summary["views"], 2)

    def test_other_commands(self):
        self.assertIn("sgi_logo", run("objects").stdout)
        self.assertRegex(run("--version").stdout, r"\d+\.\d+\.\d+")
        config = run("config").stdout
        for key in ("candidates:", "positioning-error:", "box:", "depth-scale:"):
            self.assertIn(key, config)
        out = self.folder / "run"
        run("reconstruct", "sphere", *SMALL, "--no-report", "--quiet", "--max-views", "1", "--out", out)
        exported = run("export", out / "map.nrrd", self.folder / "map.bt")
        self.assertEqual(exported.returncode, 0, exported.stderr)
        self.assertTrue((self.folder / "map.bt").read_bytes().startswith(b"# Octomap OcTree binary file"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
