#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Scans per second that `adasplats view` sends to one page that drives a LiDAR.

usage: bench_live.py PROGRAM MODEL [--sensor NAME] [--seconds S] [--runs N] [--json FILE]

Starts the program, drives the sensor in a circle of 10 m next to its start, receives every scan and
answers "ready" as the page does, and prints the median over the runs as JSON. Needs only the
standard library.
"""
import argparse
import base64
import json
import math
import os
import socket
import statistics
import struct
import subprocess
import sys
import time
import urllib.parse
import urllib.request

from provenance import provenance_of


class Live:
    """The WebSocket of a page (RFC 6455, as a client)."""

    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.socket = socket.create_connection((parts.hostname, parts.port), timeout=30)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET {parts.path}live HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
            f"Origin: {parts.scheme}://{parts.netloc}\r\n\r\n".encode())
        self.stream = self.socket.makefile("rb", buffering=1 << 20)
        if b" 101 " not in self.stream.readline():
            sys.exit("bench_live: the server rejected the WebSocket")
        while self.stream.readline() != b"\r\n":
            pass

    def send(self, message):
        body = json.dumps(message).encode()
        mask = os.urandom(4)
        head = struct.pack(">BB", 0x81, 0x80 | len(body)) if len(body) < 126 else \
            struct.pack(">BBH", 0x81, 0x80 | 126, len(body))
        self.socket.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(body)))

    def receive(self):
        """Returns (is binary, bytes) of the next complete message."""
        first, length = struct.unpack(">BB", self.stream.read(2))
        if length == 126:
            (length,) = struct.unpack(">H", self.stream.read(2))
        elif length == 127:
            (length,) = struct.unpack(">Q", self.stream.read(8))
        body = self.stream.read(length)
        if not first & 0x80:
            more = self.receive()
            return first & 15 == 2 or more[0], body + more[1]
        return first & 15 == 2, body


def drive(live, start, seconds):
    """Returns scans per second, points per scan and the server's seconds per scan."""
    live.send({"type": "run", "on": True})
    points, simulated, begin = [], [], None
    while begin is None or time.perf_counter() - begin < seconds:
        is_scan, body = live.receive()
        if not is_scan:
            continue
        if begin is None:
            begin = time.perf_counter()  # the first scan includes computing the sensor's rays
        else:
            points.append(struct.unpack_from("<I", body, 12)[0])
            simulated.append(struct.unpack_from("<f", body, 60)[0])
        angle = 0.05 * len(points)
        pose = [start[0] + 10 * math.sin(angle), start[1] + 10 - 10 * math.cos(angle), start[2],
                0, 0, math.sin(angle / 2), math.cos(angle / 2)]
        live.send({"type": "pose", "pose": pose})
        live.send({"type": "ready"})
    elapsed = time.perf_counter() - begin
    live.send({"type": "run", "on": False})
    return len(points) / elapsed, statistics.median(points), statistics.median(simulated)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("model")
    arguments.add_argument("--sensor", default="hdl-64-paper")
    arguments.add_argument("--seconds", type=float, default=10)
    arguments.add_argument("--runs", type=int, default=3)
    arguments.add_argument("--json", help="write the figures to a file, too")
    given = arguments.parse_args()
    server = subprocess.Popen([given.program, "view", given.model, "--no-browser", "--sensor",
                               given.sensor], stdout=subprocess.PIPE, text=True)
    try:
        url = server.stdout.readline().strip()
        with urllib.request.urlopen(url + "scene.json") as answer:
            scene = json.load(answer)
        runs = [drive(Live(url), scene["start_pose"], given.seconds) for _ in range(given.runs)]
    finally:
        server.terminate()
        server.wait()
    rate, points, seconds = (statistics.median(values) for values in zip(*runs))
    text = json.dumps({"provenance": provenance_of(given.program),
                       "splats": scene["layers"][0]["count"], "sensor": given.sensor,
                       "device": scene["device"], "scans_per_s": round(rate, 1),
                       "points_per_scan": points, "simulation_s": round(seconds, 5),
                       "runs": [round(run[0], 1) for run in runs]}, indent=2)
    print(text)
    if given.json:
        with open(given.json, "w", encoding="ascii") as file:
            file.write(text + "\n")


if __name__ == "__main__":
    main()
