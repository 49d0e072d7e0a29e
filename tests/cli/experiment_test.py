"""Sweeps as a user meets them: over ranks of MPI, and killed. Usage: experiment_test.py VANTAGE [unittest options]"""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

VANTAGE = sys.argv.pop(1)
# Open MPI refuses to run as root, as in containers, unless a flag says that this is meant.
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
KILLS = 10


def files(folder, *names):
    """Every file below the folder, or below its subfolders of these names, with its content."""
    roots = [folder / name for name in names] or [folder]
    found = {}
    for root in roots:
        for path in sorted(root.rglob("*")):
            if path.is_file():
                found[str(path.relative_to(folder))] = path.read_bytes()
    return found


def results(folder):
    """What has to be the same bytes for every way to the same sweep: everything but the times."""
    return {name: content for name, content in files(folder).items()
            if not name.startswith(("times", "timings", ".lock")) and not name.endswith("-times.csv")}


class Sweep(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def command(self, out, *arguments):
        return [VANTAGE, "experiment", *arguments, "--out", str(self.folder / out), "--quiet"]

    def run_to_the_end(self, out, *arguments, launcher=()):
        result = subprocess.run([*launcher, *self.command(out, *arguments)], capture_output=True, text=True, timeout=600,
                                env=ENVIRONMENT)
        self.assertEqual(result.returncode, 0, result.stderr)
        return results(self.folder / out)


class Compare(Sweep):
    def test_the_same_call_twice_gives_the_same_files(self):
        compare = ["compare", "--utilities", "gain,oa,pc,random,uniform,known-greedy,known-optimum", "--shapes", "sphere,mug",
                   "--starts", "3", "--protocol", "coarse", "--compare-max-views", "8", "--compare-depth-noise", "0.002,0.001",
                   "--compare-positioning-error", "0.05,0.05,0.05", "--compare-registration", "icp"]
        first = self.run_to_the_end("first", *compare)
        self.assertEqual(sum(name.startswith("runs/") for name in first), 8 * 2 * 3)
        for name in ("report.html", "report.json", "compare.csv", "compare-sphere.csv", "compare-mug.csv", "compare-curves.csv"):
            self.assertIn(name, first)
        self.assertEqual(first, self.run_to_the_end("second", *compare, "--threads", "1"))

    def test_published_protocols_count_points(self):
        files = self.run_to_the_end("pb-nbv", "compare", "--utilities", "gain", "--shapes", "sphere", "--starts", "2",
                                    "--protocol", "pb-nbv")
        for name, content in files.items():
            if not name.startswith("runs/"):
                continue
            run = json.loads(content)["outcome"]
            covered = run["lists"]["point_coverage"]
            self.assertEqual(len(covered), run["numbers"]["views"])
            self.assertEqual(covered, sorted(covered))
            self.assertGreater(covered[-1], 0.98)


@unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed")
class Ranks(Sweep):
    def mpirun(self, ranks):
        return ["mpirun", "--oversubscribe", "-n", str(ranks)]

    def test_any_number_of_ranks_and_threads_gives_the_same_files(self):
        experiment = ["table2", "--starts", "2"]
        plain = self.run_to_the_end("plain", *experiment)
        self.assertGreaterEqual(sum(name.startswith("runs/") for name in plain), 10)
        self.assertIn("report.json", plain)
        self.assertEqual(plain, self.run_to_the_end("one-thread", *experiment, "--threads", "1"))
        for ranks in (1, 2, 3):
            self.assertEqual(plain, self.run_to_the_end(f"ranks-{ranks}", *experiment, launcher=self.mpirun(ranks)), ranks)

    def test_bad_options_are_refused_by_all_ranks(self):
        result = subprocess.run([*self.mpirun(2), *self.command("out", "table1", "--starts", "0")], capture_output=True,
                                text=True, timeout=120, env=ENVIRONMENT)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("starts = 0: must be in 2..80", result.stderr)


class Kills(Sweep):
    experiment = ["figure9"]

    def stored(self):
        """Finished runs by name; every file must be whole."""
        folder = self.folder / "killed" / "runs"
        stored = {}
        for path in folder.glob("[!.]*.json") if folder.exists() else []:
            content = path.read_bytes()
            self.assertIn("outcome", json.loads(content), path.name)
            stored[path.name] = content
        return stored

    def test_no_finished_run_is_lost(self):
        start = time.monotonic()
        whole = self.run_to_the_end("whole", *self.experiment)
        runs = sum(name.startswith("runs/") for name in whole)
        between_runs = (time.monotonic() - start) / runs
        seed = random.randrange(2**32)
        moments = random.Random(seed)
        before = {}
        for kill in range(KILLS):
            sweep = subprocess.Popen(self.command("killed", *self.experiment), stdout=subprocess.DEVNULL,
                                     stderr=subprocess.DEVNULL)
            # Each start gets on by a run at least, then ends at any moment of the next ones.
            while len(self.stored()) <= len(before) and sweep.poll() is None:
                time.sleep(0.01)
            time.sleep(moments.uniform(0, 2 * between_runs))
            self.assertIsNone(sweep.poll(), f"seed {seed}: finished before kill {kill + 1}")
            sweep.send_signal(signal.SIGKILL)
            sweep.wait()
            after = self.stored()
            for name, content in before.items():
                self.assertEqual(after.get(name), content, f"{name} after kill {kill + 1}, seed {seed}")
            before = after
        print(f"{KILLS} kills, seed {seed}, {len(before)} of {runs} runs stored")
        self.assertEqual(self.run_to_the_end("killed", *self.experiment), whole, f"seed {seed}")

    def test_ctrl_c_keeps_what_is_finished_and_says_how_to_go_on(self):
        sweep = subprocess.Popen(self.command("killed", *self.experiment), stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE, text=True)
        while not self.stored() and sweep.poll() is None:
            time.sleep(0.05)
        sweep.send_signal(signal.SIGINT)
        _, message = sweep.communicate(timeout=120)
        self.assertEqual(sweep.returncode, 1, message)
        self.assertIn("the same command goes on", message)
        self.assertTrue(self.stored())


class Failures(Sweep):
    def test_two_sweeps_do_not_share_a_folder(self):
        first = subprocess.Popen(self.command("out", "figure9"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (self.folder / "out" / ".lock").exists() and first.poll() is None:
            time.sleep(0.01)
        time.sleep(0.1)
        second = subprocess.run(self.command("out", "figure9"), capture_output=True, text=True, timeout=120)
        first.kill()
        first.wait()
        self.assertEqual(second.returncode, 1)
        self.assertIn("another experiment is writing there", second.stderr)

    def test_bad_options(self):
        mesh = self.folder / "objects" / "mug.ply"
        mesh.parent.mkdir()
        mesh.write_text("ply\n")
        cases = [(["table9"], "'table9' is unknown; must be one of: table1"),
                 (["table1", "--starts", "-3"], "starts = -3: must be in 2..80"),
                 (["table1", "--starts", "many"], "--starts = 'many'"),
                 (["figure11", "--seeds", "1"], "seeds = 1: must be in 2..10000"),
                 (["table1", "--objects", "/nowhere"], "objects = '/nowhere': must be a folder"),
                 (["table1", "--objects", str(mesh.parent)], "mug.ply"),
                 (["table1", "--threads", "-1"], "threads = -1"),
                 (["table1", "--no-such-option"], "no-such-option")]
        for arguments, text in cases:
            with self.subTest(arguments=arguments):
                result = subprocess.run(self.command("out", *arguments), capture_output=True, text=True, timeout=120)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(text, result.stderr)
        result = subprocess.run([VANTAGE, "experiment", "table1", "--out", "/proc/nowhere"], capture_output=True, text=True,
                                timeout=120)
        self.assertEqual(result.returncode, 1)
        self.assertIn("/proc/nowhere", result.stderr)


if __name__ == "__main__":
    unittest.main()
