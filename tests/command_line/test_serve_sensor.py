# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""serve-sensor: a car with two LiDARs and a camera behind the HTTP API, and what it rejects."""
import json
import signal
import socket
import subprocess
import sys
import unittest
from pathlib import Path
from urllib.error import HTTPError
from urllib.request import Request, urlopen

from support import PROGRAM, ProgramTest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "drive_live.py"
RIG = """[[sensors]]
name = "top"
sensor = "velodyne-vlp-16"
mount = [0, 0, 0.2]
[[sensors]]
name = "front"
sensor = "velodyne-vlp-16"
mount = [1, 0, -0.5]
[[camera]]
name = "windscreen"
width = 64
height = 48
fx = 40
fy = 40
cx = 32
cy = 24
mount = [0.5, 0, 0]
"""


class ServeSensorTest(ProgramTest):
    def serve(self, *arguments):
        process = subprocess.Popen(
            [PROGRAM, "serve-sensor", *map(str, arguments), "--paused", "--device", "cpu"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8")
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        url = process.stdout.readline().strip()
        errors = "" if url else process.stderr.read()
        if "libboost" in errors:
            self.skipTest(errors)
        self.assertTrue(url.startswith("http://127.0.0.1:"), url + errors)
        return process, url

    def ask(self, url, path, body=None, method=None):
        data = None if body is None else json.dumps(body).encode()
        with urlopen(Request(url + path, data, method=method), timeout=60) as answer:
            return answer.read()

    def test_a_car(self):
        (self.folder / "car.toml").write_text(RIG)
        process, url = self.serve(self.model(), "--rig", self.folder / "car.toml", "--trajectory",
                                  self.poses, "--no-noise")
        state = json.loads(self.ask(url, "step", {"count": 2}))
        self.assertEqual([sensor["name"] for sensor in state["sensors"]], ["top", "front"])
        self.assertEqual(state["cameras"], ["windscreen"])
        self.assertEqual(state["steps"], 2)
        for name in ("top", "front"):
            self.assertIn(b"POINTS", self.ask(url, f"scans/{name}.pcd"))
        self.assertEqual(self.ask(url, "images/windscreen.png")[:4], b"\x89PNG")
        with self.assertRaises(HTTPError) as found:
            self.ask(url, "images/other.png")
        self.assertEqual(found.exception.code, 404)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=20), 130)

    def test_the_example_brakes(self):
        # The first Python of PATH may lack NumPy, as in python/CMakeLists.txt.
        python = next((one for one in (sys.executable, "/usr/bin/python3") if Path(one).exists() and
                       subprocess.run([one, "-c", "import numpy"], stderr=subprocess.DEVNULL).returncode == 0),
                      None)
        if python is None:
            self.skipTest("no Python with NumPy")
        model = self.model()
        (self.folder / "world.toml").write_text(
            f'model = "{model.name}"\n[[object]]\nname = "car"\ngeometry = "{model.name}"\n'
            'position = [500, 500, 0]\n')
        _, url = self.serve(self.folder / "world.toml", "--trajectory", self.poses,
                            "--sensor", "velodyne-vlp-16")
        result = subprocess.run([python, EXAMPLE, url, "car"], stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, encoding="utf-8", timeout=100)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("m ahead", result.stdout)

    def test_bad_input(self):
        model = self.model()
        words = ["serve-sensor", model, "--trajectory", self.poses, "--sensor", "velodyne-vlp-16"]
        self.run_bad(66, "serve-sensor", self.folder / "none.ply", says=["none.ply"])
        self.run_bad(66, *words[:2], "--trajectory", self.folder / "none.csv", says=["none.csv"])
        self.run_bad(64, *words, "--returns", "2", "--packets", "127.0.0.1", says=["--returns 1"])
        self.run_bad(64, *words, "--no-noise", "--packets", "127.0.0.1:0", says=["HOST:PORT"])
        self.run_bad(66, *words, "--no-noise", "--packets", "no.such.host.invalid",
                     says=["no.such.host.invalid"])
        self.run_bad(64, *words, "--address", "nowhere", says=["nowhere"])
        self.run_bad(64, *words, "--token", "a/b", says=["a/b"])
        self.run_bad(64, *words, "--at", "0,0", says=["exactly one"])
        self.run_bad(64, *words, "--rig", self.folder / "car.toml", says=["--rig"])
        with socket.socket() as busy:
            busy.bind(("127.0.0.1", 0))
            busy.listen()
            port = str(busy.getsockname()[1])
            self.run_bad(69, *words, "--port", port, says=[port])
        far = self.folder / "far.csv"
        far.write_text("time,x,y,z,qw,qx,qy,qz\n0,9000,0,2,1,0,0,0\n1,9001,0,2,1,0,0,0\n")
        self.run_bad(65, *words[:3], far, says=["same frame"])
        late = self.folder / "late.csv"
        late.write_text("time,x,y,z,qw,qx,qy,qz\n-5,0,0,2,1,0,0,0\n-4,1,0,2,1,0,0,0\n")
        self.run_bad(64, *words[:3], late, says=["before 0"])


if __name__ == "__main__":
    unittest.main()
