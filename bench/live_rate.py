#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Whether `serve-sensor` holds its rate: packets of LiDARs over UDP for a minute each.

  bench/live_rate.py ADASPLATS WORLD TRAJECTORY OUT.json [--seconds 60] [--device cpu]

For each sensor and rotation rate: steps a second, steps that were late, packets sent and received,
and how late packets and messages were sent (median, 99 %, most of the last 100,000; ms). `arrival`:
the deviation of the arrivals from even intervals, of consecutive packets, ms. Packets of a
revolution have equal intervals, but a step that is late makes a gap.
"""
import argparse
import json
import pathlib
import signal
import socket
import statistics
import subprocess
import threading
import time
from urllib.request import Request, urlopen

from provenance import publish

RUNS = [("velodyne-hdl-64e-s3", 10), ("velodyne-hdl-64e-s3", 20), ("ouster-os1-128", 10),
        ("ouster-os1-128", 20)]


class Receiver(threading.Thread):
    """Counts datagrams and notes when they came."""

    def __init__(self):
        super().__init__(daemon=True)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 26)
        self.socket.bind(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.times = []

    def run(self):
        buffer = bytearray(65536)
        while True:
            self.socket.recv_into(buffer)
            self.times.append(time.monotonic())


def ask(url, path, body=None):
    data = None if body is None else json.dumps(body).encode()
    with urlopen(Request(url + path, data), timeout=60) as answer:
        return json.load(answer)


def measure(arguments, sensor, rate):
    receiver = Receiver()
    command = [arguments.program, "serve-sensor", arguments.world, "--trajectory",
               arguments.trajectory, "--sensor", sensor, "--no-noise", "--rotation-rate", rate,
               "--packets", f"127.0.0.1:{receiver.port}", "--device", arguments.device,
               "--paused"]
    with subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, encoding="utf-8") as server:
        url = server.stdout.readline().strip()
        if not url:
            raise RuntimeError(f"no server: {command}")
        receiver.start()
        begin = ask(url, "run", {"on": True})
        started = time.monotonic()
        time.sleep(arguments.seconds)
        end, elapsed = ask(url, "state"), time.monotonic() - started
        ask(url, "run", {"on": False})
        time.sleep(1)  # what was made is sent
        sent = ask(url, "state")["streams"]["packets"]
        server.send_signal(signal.SIGINT)
    gaps = [b - a for a, b in zip(receiver.times, receiver.times[1:])]
    usual = statistics.median(gaps)
    errors = sorted(abs(gap - usual) * 1000 for gap in gaps)
    streams = end["streams"]
    return {"sensor": sensor, "rotation_hz": rate, "seconds": elapsed,
            "steps_per_second": (end["steps"] - begin["steps"]) / elapsed,
            "late_steps": streams["late_steps"], "packets_sent": sent,
            "packets_received": len(receiver.times), "late_ms": streams["late_ms"],
            "arrival_ms": {"median": statistics.median(errors),
                           "p99": errors[int(0.99 * (len(errors) - 1))], "max": errors[-1]}}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("world")
    parser.add_argument("trajectory")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--device", default="cpu")
    arguments = parser.parse_args()
    runs = [measure(arguments, sensor, rate) for sensor, rate in RUNS]
    publish({"runs": runs}, arguments.program, arguments.output)


if __name__ == "__main__":
    main()
