"""A session over HTTP as a robot uses it, against docs/openapi.yaml. Usage:
http_test.py VANTAGE OPENAPI SOURCE SHARED_DATA SECONDS_OF_LOAD [unittest options]"""
import http.client
import json
import random
import re
import statistics
import subprocess
import sys
import threading
import time
import unittest

from served import (BOUNDARY, BOX, DATA, LOAD, SOURCE, TOKEN, VANTAGE, OpenApi, OverHttp, Server, form, frame_parts,
                    succeed)


class Description(OverHttp):
    """Every path, method and status of docs/openapi.yaml is asked for, and every answer is as it says."""

    # A minute of a slow body, no memory, 16 uploads at a time, 32 listeners: the C++ tests of the server.
    NOT_PROVOKED = {"408", "503"}

    def ask_all(self, api, server, requests, headers=None):
        for method, path, body, more, expected in requests:
            with self.subTest(method=method, path=path, expected=expected):
                status, content_type, answer = server.ask(method, path, body, {**more, **(headers or {})})
                self.assertEqual(status, expected, answer[:300])
                api.check(self, method, path, status, content_type, answer)

    def test_the_server_does_what_the_description_says(self):
        api = OpenApi()
        multipart = {"Content-Type": "multipart/form-data; boundary=" + BOUNDARY}
        as_json = {"Content-Type": "application/json"}
        scans, session = "/api/session/scans", "/api/session/"
        posts = [session + name for name in ["next", "skip", "unskip", "remove", "restore", "finish"]]
        files = [session + name for name in ["map.nrrd", "map.ply", "model.ply", "mesh.ply"]]
        one = b'{"candidate": 3}'
        everything = [(method.upper(), path, b"{}" if method == "post" else None,
                       as_json if method == "post" else {}) for path, method in sorted(api.operations())]
        learning = ["--views", "20", "--convolve", "samples", "--believed-error", "learn:0.05,0.05,0.05"]
        with Server(self.new("described", *learning)) as server:
            self.ask_all(api, server, [
                ("GET", "/", None, {}, 200),
                ("GET", "/api/run", None, {}, 200),
                ("GET", "/api/session", None, {}, 200),
                ("GET", session + "next", None, {}, 200),
                ("POST", session + "next", b"{}", as_json, 409),
                ("POST", session + "finish", b"{}", as_json, 409),
                ("GET", session + "model.ply", None, {}, 409),
                ("GET", session + "mesh.ply", None, {}, 409),
                ("POST", scans, form(self.parts[0]), multipart, 201),
                ("POST", scans + "?wait=no", form(self.parts[1]), multipart, 202),
                ("POST", scans, form({"pose": "1"}), multipart, 400),
                ("POST", scans, b"{}", as_json, 415),
                ("POST", scans, b"--x\r\n" + bytes(65 << 20), multipart, 413),
                ("GET", session + "next?top=3", None, {}, 200),
                ("GET", session + "next?top=-1", None, {}, 400),
                ("GET", "/api/session?x=1", None, {}, 400),
                ("POST", session + "next", b"", as_json, 200),
                ("GET", "/api/session", None, {}, 200),
                ("POST", scans, form({**self.parts[2], "candidate": "3"}), multipart, 201),
                ("POST", session + "skip", b'{"candidate": 3, "reason": "far"}', as_json, 200),
                ("POST", session + "next", one, as_json, 409),
                ("POST", session + "unskip", one, as_json, 200),
                ("POST", session + "remove", b'{"number": 1}', as_json, 200),
                ("POST", session + "remove", b'{"number": 1}', as_json, 400),
                ("POST", session + "restore", b'{"number": 1}', as_json, 200),
                ("POST", scans, form(self.parts[1]), multipart, 201),
                ("POST", session + "remove", b'{"number": 3}', as_json, 200),
                ("POST", session + "finish", b"{}", as_json, 200),
                ("GET", "/api/run", None, {}, 200),
                *(("GET", path, None, {}, 200) for path in files),
                *(("GET", path + "?x=1", None, {}, 400) for path in files),
                *(("POST", path, b'{"x": 1}', as_json, 400) for path in posts),
                *(("POST", path, b"{}", {"Content-Type": "text/plain"}, 415) for path in posts),
                *(("POST", path, bytes(65 << 10), as_json, 413) for path in posts)])
            learned = server.get_json("/api/session")["learned_error"]
            self.assertEqual(learned["observations"], 1, "the scan of the view that was taken")
            self.ask_all(api, server, [(*each, 403) for each in everything], {"Host": "elsewhere.example"})
            connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
            connection.request("GET", "/api/events")
            events = connection.getresponse()
            self.assertEqual(events.readline(), b"event: hello\n")
            api.check(self, "GET", "/api/events", events.status, events.getheader("Content-Type"), b"")
            connection.close()
            self.assertEqual(server.ask("GET", "/api/nothing")[0], 404)
            self.assertEqual(server.ask("PUT", "/api/session", b"{}", as_json)[0], 405)
        with Server(self.root / "described", "--token", TOKEN) as server:
            self.ask_all(api, server, [(*each, 401) for each in everything], {"Authorization": "Bearer " + TOKEN[:-1]})
        with Server(self.new("full"), file_size=30000) as server:
            self.ask_all(api, server, [("POST", scans, form(self.parts[0]), multipart, 507)])
            self.assertEqual(server.get_json("/api/session")["stored"], 0)
        folder = self.root / "described"
        (folder / "map.nrrd").unlink()
        (folder / "map.nrrd").mkdir()
        with Server(folder) as server:
            self.ask_all(api, server, [("POST", session + "finish", b"{}", as_json, 500)])
        missed = {each for each in api.answers() - api.seen if each[2] not in self.NOT_PROVOKED}
        self.assertEqual(missed, {(scans, "post", "500")}, "only for want of memory")
        in_source = set(re.findall(r'"(/api/session[^"]*)"', SOURCE.read_text()))
        self.assertEqual(in_source, {path for path, _ in api.operations() if path.startswith("/api/session")})


class Safety(OverHttp):
    def test_bad_scans_are_refused_with_the_field(self):
        good = self.parts[0]
        cases = [({**good, "depth": b"\x89PNG"}, "depth"), ({**good, "pose": "1 2 3"}, "pose"),
                 ({key: good[key] for key in good if key != "pose"}, "'pose' is missing"),
                 ({key: good[key] for key in good if key != "intrinsics"}, "'intrinsics' is missing"),
                 ({**good, "intrinsics": "0 0 0\n0 0 0\n0 0 1"}, "intrinsics"), ({**good, "candidate": "x"}, "candidate"),
                 ({**good, "candidate": "20"}, "candidate = 20: must be one of the views 0 .. 19"),
                 ({**good, "name": "x" * 201}, "'name': has 201 bytes"),
                 ({**good, "surprise": "x"}, "'surprise': is not known"),
                 ({**good, "cloud": ("a.ply", b"ply")}, "either the field 'depth' or the field 'cloud'")]
        with Server(self.new("refusing")) as server:
            for parts, text in cases:
                status, _, body = server.add(parts)
                self.assertEqual(status, 400, body)
                self.assertIn(text, json.loads(body)["error"])
            self.assertEqual(server.get_json("/api/session")["stored"], 0)

    def test_nothing_of_the_host_is_reached(self):
        with Server(self.new("closed")) as server:
            for path in ["/../../../etc/passwd", "/api/session/../../etc/passwd", "/api/session/%2e%2e/session/options.yaml",
                         "/api/session/options.yaml", "/session/options.yaml", "//etc/passwd", "/api/session/map.nrrd/.."]:
                self.assertEqual(server.ask("GET", path)[0], 404, path)
            # Names of files in a form are names only.
            status, _, body = server.add({**self.parts[0], "depth": ("../../../escaped", self.parts[0]["depth"][1])})
            self.assertEqual(status, 201, body)
            self.assertFalse(list(self.root.glob("**/escaped*")))
            status, _, body = server.add({**self.parts[0], "intrinsics": "/etc/passwd"})
            self.assertEqual(status, 400, body)
            status, _, body = server.add(self.parts[0], headers={"Origin": "http://elsewhere.example"})
            self.assertEqual(status, 403, body)

    def test_other_machines_need_the_token(self):
        folder = self.new("open")
        result = subprocess.run([VANTAGE, "serve", folder, "--port", "0", "--bind", "0.0.0.0"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("token: must be given where --bind = 0.0.0.0 lets other machines in", result.stderr)
        with Server(folder, "--bind", "0.0.0.0", "--token", TOKEN) as server:
            status, _, body = server.ask("GET", "/api/session")
            self.assertEqual(status, 401)
            self.assertIn("token: is missing or wrong", json.loads(body)["error"])
            self.assertEqual(server.add(self.parts[0])[0], 401)
            self.assertEqual(server.add(self.parts[0], headers={"Authorization": "Bearer " + TOKEN})[0], 201)
            self.assertEqual(server.ask("GET", "/api/session?token=" + TOKEN)[0], 200)

    def test_a_backlog_is_limited(self):
        """Scans sent faster than they are merged: 503 says so, and what was acknowledged is on disk."""
        with Server(self.new("backlog", "--voxel", "0.02", "--views", "20")) as server:
            answers, mutex = [], threading.Lock()

            def send():
                for turn in range(100):
                    status, _, body = server.add(self.parts[turn % len(self.parts)], "?wait=no")
                    with mutex:
                        answers.append((status, json.loads(body)))
                        if any(each != 202 for each, _ in answers):
                            return

            threads = [threading.Thread(target=send) for _ in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            refused = [body for status, body in answers if status != 202]
            self.assertIn({"error": "32 scans wait to be merged; try again later"}, refused)
            numbers = [body["number"] for status, body in answers if status == 202]
            self.assertEqual(sorted(numbers), list(range(len(numbers))))
            self.assertEqual(server.get_json("/api/session")["stored"], len(numbers))
        # Ended by now, without having merged them all first; they are on disk.
        self.assertEqual(len(list((self.root / "backlog" / "session").glob("*.scan"))), len(numbers))

    def test_the_command_line_is_told_that_the_session_is_served(self):
        folder = self.new("served")
        with Server(folder):
            result = subprocess.run([VANTAGE, "session", "status", folder], capture_output=True, text=True)
            self.assertEqual(result.returncode, 1)
            self.assertIn("another process has this session open", result.stderr)


class Kills(OverHttp):
    def test_what_was_acknowledged_is_there_after_a_kill(self):
        folder = self.new("killed")
        acknowledged, generator = set(), random.Random(7)
        for _ in range(3):
            with Server(folder) as server:
                threading.Timer(generator.uniform(0.3, 1.5), server.process.kill).start()
                turn = 0
                try:
                    while True:
                        status, _, body = server.add(self.parts[turn % len(self.parts)], ["", "?wait=no"][turn % 2])
                        self.assertIn(status, (201, 202), body)
                        acknowledged.add(json.loads(body)["number"])
                        turn += 1
                except (ConnectionError, http.client.HTTPException):
                    pass
        with Server(folder) as server:
            state = server.get_json("/api/session")
            self.assertEqual(state["stored"], state["integrated"])
            stored = {int(file.stem) for file in (folder / "session").glob("*.scan")}
            self.assertEqual(acknowledged - stored, set())
            self.assertGreater(len(acknowledged), 0)


class SameAsPlan(OverHttp):
    """Frames one by one over HTTP, by `session add`, and all at once by `plan`: the same map and next view to the last bit."""

    def check(self, name, scans, frames, intrinsics, options, poses=None):
        over_http, by_hand, at_once = (self.root / (name + ending) for ending in [".http", ".session", ".plan"])
        planned = json.loads(succeed("plan", scans, *options, "--json", "--out", at_once))
        self.assertIsNotNone(planned["next"])
        succeed("session", "new", by_hand, *options)
        succeed("session", "add", by_hand, *frames)
        self.assertEqual(json.loads(succeed("session", "next", by_hand, "--json")), planned)
        succeed("session", "finish", by_hand)
        succeed("session", "new", over_http, *options)
        with Server(over_http) as server:
            for frame in frames:
                status, _, body = server.add(frame_parts(frame, intrinsics, poses))
                self.assertEqual(status, 201, body)
            self.assertEqual(server.get_json("/api/session/next"), planned)
            for file in ["map.nrrd", "map.ply", "model.ply", "mesh.ply"]:
                expected = (at_once / file).read_bytes()
                self.assertEqual(server.ask("GET", "/api/session/" + file)[2], expected, file)
                self.assertEqual((by_hand / file).read_bytes(), expected, file)

    def real(self, name):
        scans = DATA / "scans" / name
        if not scans.is_dir():
            self.skipTest(f"needs the real scans in {scans}")
        if LOAD < 10:
            self.skipTest("takes minutes")
        return scans, sorted(scans.glob("*.depth.png")), scans / "camera-intrinsics.txt"

    def test_mug(self):
        self.check("mug", self.scans, self.frames, self.intrinsics, [BOX, "--views", "20", "--config", self.scans / "scans.yaml"])

    def test_ur5_tray(self):
        self.check("tray", *self.real("ur5_tray"),
                   ["--box=-0.11,-0.29,0.09,0.36,0.24,0.12", "--depth-range", "0.25,1.5", "--workspace=-1,-1.2,0.1,1,0.6,1.5"])

    def test_apc_shelf(self):
        scans, *rest = self.real("apc_shelf")
        self.check("shelf", scans, *rest,
                   ["--box=1.683,-0.003,1.142,0.425,0.327,0.27", "--depth-range", "0.15,1.2", "--depth-scale", "0.0001",
                    "--poses", "pose_robot"], scans / "pose_robot")


class Load(OverHttp):
    def test_eight_clients(self):
        folder = self.new("loaded", "--voxel", "0.02", "--views", "80", "--radius", "2")
        added, answers, errors, mutex = [], [], [], threading.Lock()
        with Server(folder) as server:
            server.add(self.parts[0])
            end = time.monotonic() + LOAD

            def client(number):
                turn = number
                while time.monotonic() < end:
                    status, _, body = server.add(self.parts[turn % len(self.parts)])
                    with mutex:
                        (added if status == 201 else errors).append(json.loads(body).get("number", body))
                    for _ in range(3):
                        start = time.monotonic()
                        status, _, body = server.ask("GET", "/api/session/next")
                        seconds = time.monotonic() - start
                        with mutex:
                            (answers if status == 200 else errors).append(seconds)
                    turn += 1

            threads = [threading.Thread(target=client, args=(i,)) for i in range(8)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            status = server.get_json("/api/session")
        median = statistics.median(answers)
        print(f"8 clients, {LOAD:g} s: {len(added)} scans, {len(answers)} answers, median {1000 * median:.1f} ms, "
              f"longest {1000 * max(answers):.0f} ms, {len(errors)} errors", file=sys.stderr)
        self.assertEqual(errors, [])
        self.assertEqual(sorted(added), list(range(1, len(added) + 1)), "every scan has its number, once")
        self.assertEqual(status["stored"], len(added) + 1)
        self.assertEqual(len(list((folder / "session").glob("*.scan"))), len(added) + 1)
        self.assertGreaterEqual(len(added), 8)
        self.assertLess(median, 0.1)


if __name__ == "__main__":
    unittest.main()
