"""What clients can do to the server of a session with bytes that no robot sends. Usage: as http_test.py."""
import json
import os
import resource
import signal
import socket
import struct
import subprocess
import threading
import time
import unittest
import zlib

from served import BOUNDARY, TOKEN, VANTAGE, OverHttp, Server, form

HEAD = b"GET /api/session HTTP/1.1\r\nHost: localhost\r\n"


def memory(server, key):
    """VmRSS or VmHWM of the server, megabytes."""
    with open(f"/proc/{server.process.pid}/status", encoding="ascii") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(key + ":")) / 1024


def connect(server):
    client = socket.create_connection(("127.0.0.1", server.port))
    client.settimeout(30)
    return client


def received(client):
    parts = []
    try:
        while part := client.recv(65536):
            parts.append(part)
    except OSError:
        pass
    return b"".join(parts)


def black_png(columns, rows):
    """A depth image without a measurement, packed a thousand times."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    packer, row = zlib.compressobj(9), bytes(1 + 2 * columns)
    packed = b"".join(packer.compress(row) for _ in range(rows)) + packer.flush()
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 16, 0, 0, 0, 0)) +
            chunk(b"IDAT", packed) + chunk(b"IEND", b""))


class Hostile(OverHttp):
    def test_a_range_is_not_heeded(self):
        with Server(self.new("ranges"), "--token", TOKEN) as server:
            bearer = {"Authorization": "Bearer " + TOKEN}
            server.add(self.parts[0], headers=bearer)
            cases = 0
            for path in ["/", "/api/run", "/api/session", "/api/session/map.nrrd", "/api/session/map.ply",
                         "/api/session/model.ply", "/api/session/mesh.ply", "/api/session/next?top=-1", "/nothing"]:
                for known in [bearer, {}]:
                    whole = server.ask("GET", path, headers=known)
                    for value in ["bytes=0-9", "bytes=5-", "bytes=-9", "bytes=100-4195", "bytes=99999999-100000009",
                                  "bytes=0-1,4-5,99999999-", "bytes=9-0", "bytes=x", "rows=1-2"]:
                        self.assertEqual(server.ask("GET", path, headers={**known, "Range": value}), whole, (path, value))
                        cases += 1
            self.assertEqual(cases, 9 * 2 * 9)

    def test_what_does_not_end_takes_no_memory(self):
        much = b"a" * (1 << 20)
        with Server(self.new("endless"), "--token", TOKEN) as server:
            for begin, more in [(b"GET /", much), (HEAD + b"X: ", much), (HEAD, (b"A: " + b"x" * 60 + b"\r\n") * 16000),
                                (b"POST /api/session/skip HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
                                 b"Transfer-Encoding: chunked\r\n\r\n", much)]:
                before, client = memory(server, "VmRSS"), connect(server)
                try:
                    client.sendall(begin)
                    for _ in range(60):
                        client.sendall(more)
                except OSError:
                    pass
                self.assertLess(memory(server, "VmRSS") - before, 20, begin)
                client.close()

    def test_slow_clients_keep_nobody_out_and_no_server_from_ending(self):
        server = Server(self.new("slow"), "--token", TOKEN)
        clients, ends = [], threading.Event()

        def drip():
            while not ends.wait(0.3):
                for client in clients:
                    try:
                        client.send(b"X: y\r\n")
                    except OSError:
                        pass

        dripping = threading.Thread(target=drip)
        dripping.start()
        try:
            for _ in range(400):
                clients.append(connect(server))
                clients[-1].sendall(HEAD)
            begin = time.monotonic()
            for _ in range(10):
                self.assertEqual(server.ask("GET", "/api/session", headers={"Authorization": "Bearer " + TOKEN})[0], 200)
            self.assertLess(time.monotonic() - begin, 3)
            begin = time.monotonic()
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(server.process.wait(timeout=20), 0)
            self.assertLess(time.monotonic() - begin, 8)
        finally:
            ends.set()
            dripping.join()
            for client in clients:
                client.close()
            if server.process.poll() is None:
                server.process.kill()
                server.process.wait()
            server.process.stderr.close()

    def test_small_uploads_take_little_memory(self):
        with Server(self.new("bombs")) as server:
            good = self.parts[0]
            cases = [({**good, "depth": ("a.png", black_png(8192, 8192)), "intrinsics": "4000 0 4096\n0 4000 4096\n0 0 1\n"},
                      "depth: has 8192x8192 pixels; must have at most"),
                     ({**good, "intrinsics": "a: [" + "x," * 1500000 + "]"}, "'intrinsics': has 3000005 bytes"),
                     ({**good, "pose": "[" * 3000000}, "'pose': has 3000000 bytes"),
                     ({"cloud": ("a.pcd", b"# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 100000000\nHEIGHT 1\n"
                                          b"DATA binary_compressed\n"), "pose": good["pose"]}, "must have at most")]
            for parts, text in cases:
                status, _, body = server.add(parts)
                self.assertEqual(status, 400, body)
                self.assertIn(text, json.loads(body)["error"])
            self.assertLess(memory(server, "VmHWM"), 300)
            # The size of the session's frames is known after the first one.
            self.assertEqual(server.add(good)[0], 201)
            status, _, body = server.add({**good, "depth": ("a.png", black_png(2048, 2048))})
            self.assertEqual(status, 400, body)
            self.assertIn(f"must have at most {4 * 640 * 480}", json.loads(body)["error"])

    def test_forms_as_libraries_send_them(self):
        with Server(self.new("forms")) as server:
            plain = form(self.parts[0])
            unquoted = plain.replace(b'name="', b"name=").replace(b'"; file', b"; file").replace(b'"\r\n', b"\r\n")
            boundary = BOUNDARY.encode()
            for body in [plain, unquoted, b"\r\n" + plain, b"This is a form.\r\n" + plain,
                         plain.replace(boundary + b"\r\n", boundary + b" \t\r\n"), plain.replace(b"; ", b";"),
                         plain + b"an epilogue"]:
                for boundary_value in [BOUNDARY, '"' + BOUNDARY + '"']:
                    status, _, answer = server.ask("POST", "/api/session/scans?wait=no", body,
                                                   {"Content-Type": "multipart/form-data; boundary=" + boundary_value})
                    self.assertEqual(status, 202, (body[:200], answer))

    def test_text_is_text_and_no_answer_names_a_folder(self):
        folder = self.new("texts")
        with Server(folder) as server:
            as_json = {"Content-Type": "application/json"}
            status, _, body = server.ask("POST", "/api/session/skip",
                                         b'{"candidate": 3, "reason": "\\u001b[2J\\nview 5 is skipped: never"}', as_json)
            self.assertEqual(status, 400, body)
            self.assertIn("reason: has control characters", json.loads(body)["error"])
            for field in ["name", "key"]:
                for value, text in [(b"Gr\xf6\xdfe", "is not UTF-8"), (b"\x1b[2J", "has control characters")]:
                    status, _, body = server.add({**self.parts[0], field: value})
                    self.assertEqual(status, 400, body)
                    self.assertIn(f"field '{field}': {text}", json.loads(body)["error"])
            good = {**self.parts[0], "key": "Größe"}
            self.assertEqual(server.add(good)[0], 201)
        with Server(folder) as server:
            self.assertEqual(json.loads(server.add(good)[2])["number"], 0, "known by its key")
            (folder / "map.nrrd").mkdir()
            for method, path, body in [("POST", "/api/session/finish", b"{}"), ("GET", "/api/session", None), ("GET", "/api/run", None)]:
                answer = server.ask(method, path, body, as_json)[2].decode()
                self.assertNotIn(str(self.root), answer)

    def test_few_threads_are_enough_or_said(self):
        folder = self.new("threads")
        if os.geteuid() != 0:
            self.skipTest("needs root, whose processes are not counted, to become another user")
        os.chmod(self.root, 0o755)
        for path in [folder, *folder.rglob("*")]:
            os.chown(path, 65534, 65534)
        for most in [1, 2, 4, 30]:
            def limit(most=most):
                resource.setrlimit(resource.RLIMIT_NPROC, (most, most))
                os.setgroups([])
                os.setgid(65534)
                os.setuid(65534)

            process = subprocess.Popen([VANTAGE, "serve", folder, "--port", "0"], stderr=subprocess.PIPE, text=True, preexec_fn=limit)
            try:
                _, errors = process.communicate(timeout=2)
                self.assertEqual(process.returncode, 1, errors)
                self.assertIn("cannot start the threads", errors)
            except subprocess.TimeoutExpired:
                process.terminate()
                _, errors = process.communicate(timeout=20)
                self.assertEqual(process.returncode, 0, errors)
                self.assertIn("the page is at", errors)

    def test_options_of_the_server_are_checked(self):
        folder, other = self.new("options"), self.new("other")
        for options, text in [(["--token", "short"], "token: has 5 characters; must have at least 16"),
                              (["--token", ""], "token: is empty"), (["--host", "0"], "host = '0': must be an address"),
                              (["--host", "127.1"], "host = '127.1': must be an address"),
                              (["--host", "localhost:80"], "host = 'localhost:80'"), (["--host", ""], "host = ''")]:
            result = subprocess.run([VANTAGE, "serve", folder, "--port", "0", *options], capture_output=True, text=True, timeout=20)
            self.assertEqual(result.returncode, 2, options)
            self.assertIn(text, result.stderr)
        with Server(folder) as server:
            result = subprocess.run([VANTAGE, "serve", other, "--port", str(server.port)], capture_output=True, text=True,
                                    timeout=20)
            self.assertEqual(result.returncode, 1)
            self.assertIn("cannot listen at", result.stderr)


if __name__ == "__main__":
    unittest.main()
