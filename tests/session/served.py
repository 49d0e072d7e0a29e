"""What tests of a session over HTTP share: `vantage serve`, requests, docs/openapi.yaml. It takes its arguments off the
command line: VANTAGE OPENAPI SOURCE SHARED_DATA SECONDS_OF_LOAD (the environment's VANTAGE_LOAD_SECONDS goes before the last)."""
import http.client
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import jsonschema
import yaml

TOKEN = "0123456789-of-the-test"
VANTAGE, OPENAPI, SOURCE, DATA = (pathlib.Path(sys.argv.pop(1)) for _ in range(4))
LOAD = float(sys.argv.pop(1))
LOAD = float(os.environ.get("VANTAGE_LOAD_SECONDS", LOAD))
SMALL = ["--voxel", "0.08", "--scene", "51,51,51", "--enclosure", "13,13,13", "--candidates", "sphere:20:2"]
BOX = "--box=0,0,0,1.04,1.04,1.04"
BOUNDARY = "a-boundary-that-is-in-no-scan"


def succeed(*arguments):
    result = subprocess.run([VANTAGE, *map(str, arguments)], capture_output=True, text=True, timeout=1200)
    if result.returncode != 0:
        raise AssertionError(f"{arguments}: exit {result.returncode}: {result.stderr}")
    return result.stdout


def form(parts):
    """A multipart body of {name: bytes or text or (file name, bytes)}."""
    body = b""
    for name, value in parts.items():
        file_name, data = value if isinstance(value, tuple) else (None, value)
        data = data.encode() if isinstance(data, str) else data
        file = f'; filename="{file_name}"' if file_name else ""
        body += f'--{BOUNDARY}\r\nContent-Disposition: form-data; name="{name}"{file}\r\n\r\n'.encode() + data + b"\r\n"
    return body + f"--{BOUNDARY}--\r\n".encode()


def frame_parts(frame, intrinsics, poses=None):
    name = frame.name.removesuffix(".depth.png")
    return {"depth": ("depth.png", frame.read_bytes()), "name": name, "intrinsics": intrinsics.read_text(),
            "pose": ((poses or frame.parent) / (name + ".pose.txt")).read_text()}


class Server:
    """`vantage serve` on a session, ended with the block."""

    def __init__(self, folder, *options, file_size=None):
        """`file_size`: bytes that a file may have, as on a disk that is almost full."""
        def limit():
            if file_size is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (file_size, file_size))

        # Python ignores SIGXFSZ, and without restore_signals so does the program.
        self.process = subprocess.Popen([VANTAGE, "serve", folder, "--port", "0", *options], stderr=subprocess.PIPE,
                                        text=True, preexec_fn=limit, restore_signals=False)
        for line in self.process.stderr:
            match = re.search(r"http://\S+:(\d+)/(?:\?token=(\S+))?", line)
            if match:
                self.port, self.token = int(match[1]), match[2]
                break
        else:
            raise AssertionError("the server did not start")
        threading.Thread(target=self.process.stderr.read, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=60)
        self.process.stderr.close()

    def ask(self, method, path, body=None, headers=None):
        """(status, content type, body)"""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=300)
        try:
            connection.request(method, path, body, headers or {})
            answer = connection.getresponse()
            return answer.status, answer.getheader("Content-Type"), answer.read()
        finally:
            connection.close()

    def add(self, parts, query="", headers=None):
        return self.ask("POST", "/api/session/scans" + query, form(parts),
                        {"Content-Type": "multipart/form-data; boundary=" + BOUNDARY, **(headers or {})})

    def get_json(self, path):
        status, _, body = self.ask("GET", path)
        if status != 200:
            raise AssertionError(f"{path}: {status} {body[:200]}")
        return json.loads(body)


class OpenApi:
    """docs/openapi.yaml, and what of it was seen."""

    def __init__(self):
        self.document = yaml.safe_load(OPENAPI.read_text())
        self.seen = set()

    def operations(self):
        return {(path, method) for path, methods in self.document["paths"].items() for method in methods}

    def answers(self):
        return {(path, method, status) for path, method in self.operations()
                for status in self.document["paths"][path][method]["responses"]}

    def resolved(self, part):
        while "$ref" in part:
            target = self.document
            for key in part["$ref"].removeprefix("#/").split("/"):
                target = target[key]
            part = target
        return part

    def check(self, test, method, path, status, content_type, body):
        """That this answer is described as it is."""
        path = path.split("?")[0]
        responses = self.document["paths"][path][method.lower()]["responses"]
        test.assertIn(str(status), responses, f"{method} {path}: {body[:300]}")
        content = self.resolved(responses[str(status)])["content"]
        test.assertIn(content_type, content, f"{method} {path}: {status}")
        if content_type == "application/json":
            # The references of a schema point into the whole document.
            schema = {"components": self.document["components"], "allOf": [content[content_type]["schema"]]}
            problems = [f"{list(each.absolute_path)}: {each.message}"
                        for each in jsonschema.Draft202012Validator(schema).iter_errors(json.loads(body))]
            test.assertEqual(problems, [], f"{method} {path}: {status}")
        self.seen.add((path, method.lower(), str(status)))


class OverHttp(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.scratch.name)
        succeed("reconstruct", "mug", "--out", cls.root / "mug", "--no-report", "--quiet", "--max-views", "4",
                "--camera", "58x45:640x480", *SMALL)
        cls.scans = cls.root / "mug" / "scans"
        cls.frames = sorted(cls.scans.glob("*.depth.png"))
        cls.intrinsics = cls.scans / "camera-intrinsics.txt"
        cls.parts = [frame_parts(frame, cls.intrinsics) for frame in cls.frames]

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def new(self, name, *options):
        folder = self.root / name
        shutil.rmtree(folder, ignore_errors=True)
        succeed("session", "new", folder, BOX, "--config", self.scans / "scans.yaml", *(options or ["--views", "20"]))
        return folder
