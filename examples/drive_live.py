# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""An emergency brake against a simulated LiDAR (docs/live.md). First, in another terminal:

  adasplats serve-sensor world.toml --paused --port 8765 --token bench
  python3 examples/drive_live.py http://127.0.0.1:8765/bench/ 005-car
"""
import io
import json
import sys
from urllib.request import Request, urlopen

import numpy

server, like = sys.argv[1:]


def ask(path, body=None, method=None):
    data = None if body is None else json.dumps(body).encode()
    with urlopen(Request(server + path, data, method=method)) as answer:
        return answer.read()


state = json.loads(ask("state"))
x, y, _, qx, qy, qz, qw = state["ego"]
z = next(one["pose"][2] for one in state["objects"] if one["name"] == like)
ahead = [x + 40 * (1 - 2 * (qy**2 + qz**2)), y + 40 * 2 * (qx * qy + qw * qz), z, qx, qy, qz, qw]
obstacle = json.loads(ask("objects", {"like": like, "pose": ahead}))["id"]
speed = 12.0
for _ in range(60):
    state = json.loads(ask("state"))
    ask("ego", {"pose": state["ego"], "velocity_m_s": [speed, 0, 0]})
    ask("step", {"count": 1})
    points = numpy.load(io.BytesIO(ask("scans/lidar.npz")))["points"]
    in_lane = points[(abs(points[:, 1]) < 1) & (points[:, 0] > 2) & (points[:, 2] > -1.2)]
    gap_m = in_lane[:, 0].min(initial=100)
    print(f"{state['time_s']:6.1f} s  {speed:5.1f} m/s  {gap_m:6.2f} m ahead")
    if gap_m < 5 + speed**2 / 12:  # braking with 6 m/s2
        speed = max(0, speed - 6 * state["step_s"])
    if speed == 0:
        break
ask(f"objects/{obstacle}", method="DELETE")
