# SPDX-License-Identifier: Apache-2.0
"""sac view, asked as a browser asks: the page, the clip whole and in parts, and what it does not give.

usage: view_test.py SAC
"""

import http.client
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

SAC = sys.argv.pop() if len(sys.argv) == 2 else "sac"
CLIP = bytes([0x53, 0x41, 0x43, 0x1A]) + bytes(range(256)) * 1000


class View(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "page").mkdir()
        (self.folder / "page/index.html").write_text("<p>the page</p>")
        (self.folder / "page/sac.wasm").write_bytes(b"\0asm")
        (self.folder / "a walk & more.sac").write_bytes(CLIP)
        (self.folder / "secret").write_text("secret")

    def run_view(self, *options):
        return subprocess.run(
            [SAC, "view", *options, "--no-browser"], capture_output=True, text=True, cwd=self.folder, timeout=60
        )

    def start(self, *options):
        command = [SAC, "view", "a walk & more.sac", "--page", "page", "--no-browser", *options]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=self.folder)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        said = process.stdout.readline()
        address = re.search(r"http://127\.0\.0\.1:(\d+)/\?clip=(\S+)", said)
        self.assertTrue(address, said)
        self.port, self.clip = int(address[1]), address[2]
        return process

    def get(self, path, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        self.addCleanup(connection.close)
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        return answer, answer.read()

    def test_the_page_and_its_clip(self):
        process = self.start()
        answer, body = self.get("/")
        self.assertEqual((answer.status, body), (200, b"<p>the page</p>"))
        answer, body = self.get("/sac.wasm")
        self.assertEqual((answer.status, answer.getheader("Content-Type")), (200, "application/wasm"))
        # The page decodes the query, and asks for what it says.
        self.assertEqual(self.clip, "clip/a%2520walk%2520%2526%2520more.sac")
        answer, body = self.get("/clip/a%20walk%20%26%20more.sac")
        self.assertEqual((answer.status, body), (200, CLIP))
        self.assertEqual(answer.getheader("Cache-Control"), "no-store")
        answer, body = self.get("/clip/x", Range="bytes=70000-200000")
        self.assertEqual((answer.status, body), (206, CLIP[70000:200001]))
        answer, body = self.get("/clip/x", Range="bytes=-8")
        self.assertEqual((answer.status, body), (206, CLIP[-8:]))
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(60), -signal.SIGINT)

    def test_nothing_else(self):
        self.start()
        for path in ("/secret", "/../secret", "/%2e%2e/secret", "/clip/../../secret/", "/other.html"):
            answer, body = self.get(path)
            self.assertNotIn(b"secret", body, path)
            self.assertTrue(answer.status == 404 or body == CLIP, path)
        for host in ("evil.example", f"evil.example:{self.port}", "127.0.0.1.evil.example"):
            self.assertEqual(self.get("/", Host=host)[0].status, 403)
        self.assertEqual(self.get("/", Host=f"localhost:{self.port}")[0].status, 200)
        # Other machines do not reach it.
        others = {a[4][0] for a in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)} - {"127.0.0.1"}
        for other in others:
            if other.startswith("127."):
                continue
            with self.assertRaises(OSError):
                socket.create_connection((other, self.port), timeout=1).close()

    def test_what_cannot_be_shown_is_told(self):
        said = self.run_view("gone.sac", "--page", "page")
        self.assertEqual((said.returncode, said.stdout), (1, ""))
        self.assertIn("gone.sac", said.stderr)
        said = self.run_view("page/index.html", "--page", "page")
        self.assertEqual((said.returncode, "not a .sac stream" in said.stderr), (1, True))
        said = self.run_view("page", "--page", "page")
        self.assertEqual(said.returncode, 1)
        said = self.run_view("a walk & more.sac", "--page", "nowhere")
        self.assertEqual((said.returncode, "nowhere: has no index.html" in said.stderr), (1, True))
        self.start()
        said = self.run_view("a walk & more.sac", "--page", "page", "--port", str(self.port))
        self.assertEqual((said.returncode, f"port {self.port} is taken" in said.stderr), (1, True))


if __name__ == "__main__":
    unittest.main()
