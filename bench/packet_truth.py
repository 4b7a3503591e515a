#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Points of packets against a cloud that another program decoded from them.

  bench/packet_truth.py build/release/bin/adasplats CAPTURE SENSOR TRUTH.pcd RESULTS.json

CAPTURE, SENSOR: as for 'export' and its --packet-sensor. TRUTH.pcd: binary, x y z in the sensor frame,
m; optionally channel and time_stamp (ns), such as tier4/nebula's decoder_ground_truth or that of
bench/ouster_truth.py. Every point is compared with the one of the same revolution, range (to 1.5 mm) and
elevation (to 0.1 degrees) whose azimuth is nearest. Adds the figures to RESULTS.json (for bench/results):
matched points; median and 99th percentile of absolute differences (of times relative to the others of the
cloud, or of the packet if they start from 0 there); the share of points whose channel is the one that
their laser mostly has.
"""
import bisect
import collections
import json
import math
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile

from provenance import provenance_of

RANGE_M, ELEVATION_RAD, AZIMUTH_RAD = 0.0015, math.radians(0.1), math.radians(1)
SAME_AZIMUTH_RAD, TURN_S, EDGE_S = math.radians(0.02), 0.1, 0.01
TYPES = {"F4": "f", "F8": "d", "U1": "B", "U2": "H", "U4": "I", "I4": "i", "float": "f",
         "double": "d", "uchar": "B", "ushort": "H", "uint": "I", "int": "i"}


def records(body, count, fields):
    """The records of a binary file as dicts of their fields (name, type)."""
    layout = struct.Struct("<" + "".join(TYPES[kind] for _, kind in fields))
    names = [name for name, _ in fields]
    return [dict(zip(names, values)) for values in layout.iter_unpack(body[:count * layout.size])]


def read_pcd(path):
    head, body = pathlib.Path(path).read_bytes().split(b"DATA binary\n", 1)
    words = {line.split()[0]: line.split()[1:] for line in head.decode().splitlines()}
    kinds = [a + b for a, b in zip(words["TYPE"], words["SIZE"])]
    return records(body, int(words["POINTS"][0]), list(zip(words["FIELDS"], kinds)))


def read_ply(path):
    head, body = pathlib.Path(path).read_bytes().split(b"end_header\n", 1)
    lines = [line.split() for line in head.decode().splitlines()]
    count = next(int(line[2]) for line in lines if line[:2] == ["element", "vertex"])
    return records(body, count, [(line[2], line[1]) for line in lines if line[0] == "property"])


def decoded(program, capture, sensor):
    """The points of all revolutions, in the sensor frame."""
    with tempfile.TemporaryDirectory() as folder:
        poses, points = pathlib.Path(folder) / "still.csv", pathlib.Path(folder) / "points.ply"
        poses.write_text("time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n4000000000,0,0,0,1,0,0,0\n")
        subprocess.run([program, "export", capture, "--packet-sensor", sensor, "--trajectory", poses,
                        "--own-body", "0", "--driven-path", "0", "-o", points], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return read_ply(points)


def spherical(point):
    x, y, z = point["x"], point["y"], point["z"]
    distance = math.sqrt(x * x + y * y + z * z)
    return distance, math.atan2(y, x), math.asin(z / distance)


def cell_of(distance, azimuth, elevation):
    return (math.floor(distance / RANGE_M), math.floor(azimuth / AZIMUTH_RAD),
            math.floor(elevation / ELEVATION_RAD))


def matches(truth, own):
    """Yields (point of the truth, of the program, differences of range, azimuth, elevation)."""
    cells = collections.defaultdict(list)
    for point in own:
        at = spherical(point)
        cells[cell_of(*at)].append((at, point))
    around = [(a, b, c) for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1)]
    for point in truth:
        at = spherical(point)
        here, best = cell_of(*at), None
        for step in around:
            for other, candidate in cells.get(tuple(map(sum, zip(here, step))), ()):
                difference = [abs(a - b) for a, b in zip(at, other)]
                if (difference[0] < RANGE_M and difference[2] < ELEVATION_RAD and
                        (best is None or difference[1] < best[1][1])):
                    best = candidate, difference
        if best is not None:
            yield point, best[0], best[1]


def spread(values):
    ordered = sorted(values)
    return {"median": statistics.median(ordered), "p99": ordered[int(0.99 * (len(ordered) - 1))]}


def revolution(found):
    """Begin and end of the revolution with most of the matches, by the program's times, s."""
    times = sorted(candidate["timestamp"] for _, candidate, difference in found
                   if difference[1] < SAME_AZIMUTH_RAD)
    count, begin = max((bisect.bisect(times, time + TURN_S) - k, time)
                       for k, time in enumerate(times))
    return begin, times[times.index(begin) + count - 1]


def time_differences(found):
    """Differences of the times, s, less the median of each run of ascending times: some programs
    count times from each packet, in the order of the packets."""
    runs, last = [], math.inf
    for point, candidate, _ in found:
        if point["time_stamp"] < last:
            runs.append([])
        last = point["time_stamp"]
        runs[-1].append(candidate["timestamp"] - 1e-9 * point["time_stamp"])
    middles = [statistics.median(run) for run in runs]
    return [lag - middle for run, middle in zip(runs, middles) for lag in run]


def compare(truth, own):
    begin, end = revolution(list(matches(truth[::7], own)))
    found = list(matches(truth, [point for point in own
                                 if begin - EDGE_S <= point["timestamp"] <= end + EDGE_S]))
    figures = {"truth": len(truth), "matched": len(found),
               "range_m": spread(difference[0] for *_, difference in found),
               "azimuth_deg": spread(math.degrees(difference[1]) for *_, difference in found),
               "elevation_deg": spread(math.degrees(difference[2]) for *_, difference in found)}
    if "time_stamp" in truth[0]:
        figures["time_us"] = spread(1e6 * abs(lag) for lag in time_differences(found))
    if "channel" in truth[0]:
        channels = collections.defaultdict(collections.Counter)
        for point, candidate, _ in found:
            channels[candidate["laser"]][point["channel"]] += 1
        figures["rings"] = sum(max(count.values()) for count in channels.values()) / len(found)
    return figures


def main():
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    program, capture, sensor, truth, out = sys.argv[1:]
    out = pathlib.Path(out)
    results = json.loads(out.read_text()) if out.exists() else {}
    path = pathlib.Path(capture)
    name = "/".join(path.parts[-2:]) if path.is_dir() else path.name
    results[name] = {"provenance": provenance_of(program),
                     **compare(read_pcd(truth), decoded(program, capture, sensor))}
    out.write_text(json.dumps(results, indent=1) + "\n")
    print(json.dumps({name: {key: value for key, value in results[name].items()
                             if key != "provenance"}}))


if __name__ == "__main__":
    main()
