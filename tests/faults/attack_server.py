#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Attacks the servers of 'view' and 'serve-sensor' while a user works with them.

    ADASPLATS_PROGRAM=PROGRAM attack_server.py [--server view|serve-sensor] [--attacks NAME ...]
        [--seconds S] [--soak SECONDS] [--json FILE]

The server listens on 127.0.0.1 and has a small model. Each attack runs S seconds from two processes.
Meanwhile a user must get the right answer to every request within BOUND_S. Afterwards the server has
as many open files and threads as before, and its memory is at most GROWTH_KB above that of the start.
--soak: several users and random attacks instead, with the memory over time.
The exit code is 1 if anything failed. Times depend on the machine, so this is no test of CI;
tests/server/check_server.py is, and shares its attacks.
"""
import argparse
import atexit
import collections
import contextlib
import json
import multiprocessing
import os
import random
import shutil
import socket
import struct
import sys
import tempfile
import threading
import time
import traceback
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "server"), str(ROOT / "bench")]
import check_server  # noqa: E402
from provenance import publish  # noqa: E402
from raw_client import CLOSE, PING, PONG, TEXT, frame  # noqa: E402

BOUND_S = 3
GROWTH_KB = 64 << 10
SETTLE_S = 20
# Of clients with the token, which may take the 64 places of users: the rest is for the user.
HELD = 20
SILENT = 600  # more than the server keeps
USERS = 4  # in a soak
ROUND_S = 4  # of each attack in a soak
PICK = {"type": "pick", "id": 7, "origin": [0, 0, 50], "direction": [0, 0, -1]}


def check(condition, *what):
    if not condition:
        raise AssertionError(*what)


class View(check_server.Server):
    LARGE = ["app.js", "layers/0/nodes/0.bin", "scene.json"]
    READ = ["", "scene.json", "layers/0/table/0.bin"]
    QUESTION = json.dumps(PICK)

    def learn(self):
        self.right = {path: self.get(self.root + path) for path in self.READ}
        with self.live() as live:
            live.send_text(self.QUESTION)
            self.picked = live.next_json("picked")

    def visit(self, timed):
        """A user: every answer must be the right one. `timed` measures each."""
        with self.client(timeout=BOUND_S) as client:
            for path, right in self.right.items():
                check(timed(lambda: client.get(self.root + path)) == right, path)
        with timed(lambda: self.live(timeout=BOUND_S)) as live:
            live.send_text(self.QUESTION)
            check(timed(lambda: live.next_json("picked")) == self.picked, "pick")
            live.send_json(type="run", on=True)
            check_server.scan_points(timed(live.next_scan))

    def start_stream(self, live):
        live.send_json(type="run", on=True)
        for _ in range(50):
            live.send_json(type="ready")

    def next_answer(self, live):
        return live.next_json("picked")

    def reject_texts(self):
        case_of(self).wrong_messages()


class Sensor(check_server.Server):
    WORDS = ["serve-sensor", "place.ply", "--sensor", "velodyne-vlp-16", "--no-noise", "--device",
             "cpu"]
    MESSAGE_LIMIT = 64 << 10
    LARGE = ["scans/lidar.pcd", "scans/lidar.npz", "page.js"]
    QUESTION = '{"op": "fly"}'

    def learn(self):
        check(check_server.soon(lambda: self.get(self.root + self.LARGE[0])[0] == 200), "scans")
        self.page = self.get(self.root)

    def post(self, client, path, body, *lines):
        data = body if isinstance(body, bytes) else json.dumps(body).encode()
        client.request(self.root + path, f"Content-Length: {len(data)}", *lines, method="POST")
        client.send(data)
        return client.reply()

    def visit(self, timed):
        with self.client(timeout=BOUND_S) as client:
            check(timed(lambda: client.get(self.root)) == self.page, "page")
            status, _, body = timed(lambda: client.get(self.root + "state"))
            check(status == 200 and json.loads(body)["running"], status, body)
            status, _, body = timed(lambda: client.get(self.root + self.LARGE[0]))
            points = int(body.split(b"POINTS ")[1].split()[0])
            check(status == 200 and points > 100, status, points)
            status, _, body = timed(lambda: self.post(client, "ego", {"drive": True}))
            check(status == 200 and json.loads(body)["running"], status, body)
        with timed(lambda: self.live(timeout=BOUND_S)) as live:
            live.send_json(op="subscribe", subscriptions=[{"id": 5, "channelId": 0}])
            payload = timed(live.next_scan)
            while payload[0] != 1:  # the time, which every client gets
                payload = live.next_scan()
            check(struct.unpack_from("<I", payload, 1)[0] == 5, payload)

    def start_stream(self, live):
        live.send_json(op="subscribe",
                       subscriptions=[{"id": i, "channelId": i} for i in range(4)])

    def next_answer(self, live):
        while True:
            opcode, payload = live.message()
            check(opcode not in (None, CLOSE), "closed")
            if opcode == TEXT and b'"status"' in payload:
                return payload

    def reject_texts(self):
        pose = '{"pose": [0, 0, %s, 0, 0, 0, 1]}'
        subscribe = '{"op": "subscribe", "subscriptions": [{"id": %s, "channelId": 0}]}'
        deep = 30_000
        with self.client() as client:
            for body in ["", "{", "[]", "1", pose % "NaN", pose % "Infinity", pose % "1e999",
                         pose % "-1e300", pose % "null", pose % ("9" * 5000), '{"pose": 3}',
                         pose % ("[" * deep + "]" * deep), "[" * 2 * deep, '{"a":' * 12_000,
                         '{"pose": [0,0,0,0,0,0,1], "yaw_rate_rad_s": 1e9}', "\xff\xfe\0"]:
                for path in ["ego", "objects", "objects/1", "run", "step"]:
                    status, _, answer = self.post(client, path, body.encode("latin-1"))
                    check(status == 400 and "error" in json.loads(answer), path, body[:60], status)
        for path, lines, status in [("ego", [], 413), ("ego", ["Origin: http://evil.example"], 403)]:
            with self.client() as client:
                size = self.MESSAGE_LIMIT + 1 if status == 413 else 2
                check(self.post(client, path, b" " * size, *lines)[0] == status, status)
        with self.live() as live:
            for text in ["", "[]", "{", '{"op": NaN}', '{"op": "subscribe", "subscriptions": 1}',
                         *(subscribe % id for id in ["0.5", "1e10", "1e999", "[" * deep])]:
                live.send_text(text)
                self.next_answer(live)


def case_of(server):
    """The checks of CI, for this server."""
    case = check_server.Http()
    case.server, case.root = server, server.root
    return case


# Attacks: called again and again, each time until `end` or for one round. What a client must not get
# raises; that it is closed is right.

def reset(client):
    """Closes without reading what has come."""
    client.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    client.socket.close()


def open_all(count, opener):
    clients = []
    for _ in range(count):
        with contextlib.suppress(OSError):
            clients.append(opener())
    return clients


def flood_of_connections(server, end):
    held = collections.deque()
    while time.monotonic() < end:
        held.extend(open_all(1, lambda: server.client(timeout=1)))
        if len(held) > SILENT:
            reset(held.popleft())


def flood_of_requests(server, _):
    with server.client() as client:
        for _ in range(50):
            client.request(server.root + "nothing")
            client.request("/" + "0" * 32 + "/")
        check({client.reply()[0] for _ in range(100)} == {404}, "not 404")


def flood_of_handshakes(server, _):
    for opened in open_all(HELD // 2, server.live):
        reset(opened)
    with server.client() as client:
        client.request("/" + "0" * 32 + "/live", "Connection: Upgrade", "Upgrade: websocket",
                       "Sec-WebSocket-Version: 13", "Sec-WebSocket-Key: " + "A" * 22 + "==")
        check(client.reply()[0] == 404, "a handshake without the token")


def trickle(server, end, count, first):
    """Clients that send one byte at a time, and are replaced if they are closed."""
    clients = []
    while time.monotonic() < end:
        clients = [client for client in clients if client.send(b"a")]
        for client in open_all(count - len(clients), lambda: server.client(timeout=1)):
            client.send(first)
            clients.append(client)
        time.sleep(0.05)


def slow_heads(server, end):
    trickle(server, end, SILENT, f"GET {server.root} HTTP/1.1\r\nHost: x\r\nA: ".encode())


def slow_bodies(server, end):
    trickle(server, end, HELD, f"POST {server.root}ego HTTP/1.1\r\nHost: 127.0.0.1:{server.port}"
            f"\r\nContent-Length: 9999\r\n\r\n".encode())


def half_read_answers(server, end):
    clients = open_all(HELD // 2, lambda: server.client(receive_buffer=4096))
    for i, client in enumerate(clients):
        client.request(server.root + server.LARGE[i % len(server.LARGE)])
        client.socket.recv(1)
    streams = open_all(HELD // 4, lambda: server.live(receive_buffer=4096))
    for stream in streams:
        server.start_stream(stream)
    while time.monotonic() < end:
        for stream in streams:
            stream.send_text(server.QUESTION)
        time.sleep(0.01)


def killed_clients(server, _):
    for i in range(6):
        client, live = server.client(receive_buffer=4096), server.live()
        client.request(server.root + server.LARGE[i % len(server.LARGE)])
        server.start_stream(live)
        if i % 2:
            client.socket.recv(1)
            live.message()
        reset(client)
        reset(live)


def mutated_bytes(server, _):
    good = f"GET {server.root} HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nConnection: Upgrade\r\n" \
        "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nContent-Length: 0\r\n\r\n".encode()
    data = bytearray(good)
    for _ in range(random.randint(1, 8)):
        at = random.randrange(len(data))
        data[at:at + random.choice([0, 1, 5])] = random.randbytes(random.choice([0, 1, 3, 999]))
    with server.client() as client:
        client.send(bytes(data))
        client.socket.shutdown(socket.SHUT_WR)
        check(client.reply()[0] != 500, bytes(data))
    with server.live() as live:
        live.send(random.randbytes(random.randint(1, 300)))
        live.socket.shutdown(socket.SHUT_WR)
        live.close_code()


def malformed_heads(server, _):
    if server.WORDS[0] == "view":  # serve-sensor takes POST and DELETE
        case_of(server).malformed_requests()
    for lines in ["Content-Length: 2\r\nTransfer-Encoding: chunked", "Content-Length: -1",
                  "Content-Length: 99999999999999999999", "A: " + "x" * 9000, "A\0: b", ": b"]:
        with server.client() as client:
            client.request(server.root + "ego", lines, method="POST")
            status = client.reply()[0]
            check(status in (400, 405, 413, 431), lines[:50], status)


def malformed_frames(server, _):
    case_of(server).malformed_frames()


def fragments_and_compression(server, _):
    with server.live("Sec-WebSocket-Extensions: permessage-deflate") as live:
        text = server.QUESTION.encode()
        live.send(b"".join(frame(TEXT if i == 0 else 0, bytes([byte]), i == len(text) - 1)
                           for i, byte in enumerate(text)))
        server.next_answer(live)
        live.send(frame(PING, b"x") * 1000)
        pongs = 0
        while pongs < 1000:
            pongs += live.frame()[0] == PONG
        live.send(frame(TEXT, b"{", last=False) +
                  frame(0, b" " * 1000, last=False) * (server.MESSAGE_LIMIT // 1000 + 1))
        check(live.close_code() == 1009, "a message without end")
    with server.live("Sec-WebSocket-Extensions: permessage-deflate") as live:
        live.send(frame(TEXT, b"\x4a\x05\x00", reserved=4))  # compressed
        check(live.close_code() == 1002, "compressed frames")


def wrong_texts(server, _):
    server.reject_texts()


def paths_hosts_and_origins(server, _):
    case_of(server).test_traversal()
    case_of(server).test_other_hosts_and_origins()
    token = server.token
    for target in ["/", f"/{token}", f"/{token[:-1]}/", f"/{token}0/", f"//{token}/", "/live"]:
        check(server.get(target)[0] == 404, target)


ATTACKS = [flood_of_connections, flood_of_requests, flood_of_handshakes, slow_heads, slow_bodies,
           half_read_answers, killed_clients, mutated_bytes, malformed_heads, malformed_frames,
           fragments_and_compression, wrong_texts,
           paths_hosts_and_origins]


class User(threading.Thread):
    """Works until stop(), and notes how long each answer took and what was wrong."""

    def __init__(self, server):
        super().__init__()
        self.server, self.seconds, self.errors, self.stops = server, [], [], threading.Event()

    def timed(self, call):
        begin = time.monotonic()
        result = call()
        self.seconds.append(time.monotonic() - begin)
        if self.seconds[-1] > BOUND_S:
            self.errors.append(f"an answer after {self.seconds[-1]:.1f} s")
        return result

    def run(self):
        while not self.stops.wait(0.02):
            try:
                self.server.visit(self.timed)
            except Exception as error:  # pylint: disable=broad-except
                self.errors.append(f"{type(error).__name__}: {str(error)[:200]}")
            if self.server.process.poll() is not None:
                self.errors.append("the server has ended")
                return

    def stop(self):
        self.stops.set()
        self.join()


def attacker(server, attacks, end, errors):
    """The work of a process."""
    random.seed(os.getpid())
    while time.monotonic() < end:
        attack = random.choice(attacks)
        try:
            attack(server, end if len(attacks) == 1 else min(end, time.monotonic() + ROUND_S))
        except ConnectionError:
            pass  # it was closed or refused, among the others
        except Exception:  # pylint: disable=broad-except
            errors.put(f"{attack.__name__}: " + traceback.format_exc(limit=-2)[-600:])


def run(server, attacks, seconds, users):
    """Users and attackers at once; what the users saw."""
    before, samples, errors = server.cost(), [], multiprocessing.Queue()
    end = time.monotonic() + seconds
    attackers = [multiprocessing.Process(target=attacker, args=(server, attacks, end, errors))
                 for _ in range(2)]
    for process in attackers:  # before there are threads
        process.start()
    crowd = [User(server) for _ in range(users)]
    for user in crowd:
        user.start()
    found = []
    while any(process.is_alive() for process in attackers) or not errors.empty():
        time.sleep(0.1)
        while not errors.empty():
            found.append(errors.get())
        if server.process.poll() is None:
            samples.append(server.cost())
    for user in crowd:
        user.stop()
        found += user.errors
    quiet, after = time.monotonic() + SETTLE_S, before
    while server.process.poll() is None and time.monotonic() < quiet:
        after = server.cost()
        if after[1] <= before[1] and after[2] <= before[2] and after[0] <= server.first + GROWTH_KB:
            break
        time.sleep(0.1)
    else:
        found.append(f"memory, threads, files: {after}, before: {before}")
    times = sorted(second for user in crowd for second in user.seconds) or [0]
    result = {"attack": attacks[0].__name__ if len(attacks) == 1 else "all", "seconds": seconds,
              "answers": len(times), "median_ms": round(1000 * times[len(times) // 2], 1),
              "p99_ms": round(1000 * times[len(times) * 99 // 100], 1),
              "max_ms": round(1000 * times[-1], 1), "errors": found[:20], "error_count": len(found)}
    for name, i in [("memory_kb", 0), ("threads", 1), ("files", 2)]:
        result[name] = {"before": before[i], "after": after[i],
                        "max": max([before[i]] + [sample[i] for sample in samples])}
    if seconds > 10 * ROUND_S:
        step = len(samples) // 60 + 1
        result["memory_over_time_kb"] = [sample[0] for sample in samples[::step]]
    print(json.dumps(result), file=sys.stderr, flush=True)
    return result


def attack_server(kind, folder, arguments):
    server = kind(folder)
    atexit.register(server.process.kill)  # if this script fails
    server.learn()
    for attack in ATTACKS:  # what the first attack needs once, others do not need again
        attacker(server, [attack], time.monotonic() + 0.2, multiprocessing.Queue())
    server.first = server.cost()[0]
    if arguments.soak:
        results = [run(server, arguments.attacks, arguments.soak, USERS)]
    else:
        results = [run(server, [attack], arguments.seconds, 1) for attack in arguments.attacks]
    begin = time.monotonic()
    code, text = server.end()
    ended_s = time.monotonic() - begin
    fine = code == 130 and ended_s < BOUND_S and not any(one["error_count"] for one in results)
    return {"server": server.WORDS[0], "passed": fine, "exit_code": code,
            "end_s": round(ended_s, 2), "last_words": text[-300:], "runs": results}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--server", choices=["view", "serve-sensor"])
    by_name = {attack.__name__: attack for attack in ATTACKS}
    parser.add_argument("--attacks", nargs="+", choices=by_name, default=list(by_name),
                        metavar="NAME", help="some of: " + ", ".join(by_name))
    parser.add_argument("--seconds", type=float, default=5, help="of an attack")
    parser.add_argument("--soak", type=float, metavar="SECONDS")
    parser.add_argument("--json", type=Path, metavar="FILE")
    arguments = parser.parse_args()
    arguments.attacks = [by_name[name] for name in arguments.attacks]
    multiprocessing.set_start_method("fork")
    folder = Path(tempfile.mkdtemp(prefix="adasplats attack "))
    check_server.FOLDER = folder
    try:
        check_server.make_model(folder)
        results = [attack_server(kind, folder, arguments) for kind in (View, Sensor)
                   if arguments.server in (None, kind.WORDS[0])]
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    publish({"bound_s": BOUND_S, "servers": results}, check_server.PROGRAM, arguments.json)
    return 0 if all(one["passed"] for one in results) else 1


if __name__ == "__main__":
    sys.exit(main())
