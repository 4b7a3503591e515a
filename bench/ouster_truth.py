#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Decodes an Ouster capture after the Firmware User Manual, for bench/packet_truth.py.

  bench/ouster_truth.py CAPTURE.pcap METADATA.json DIGEST.json TRUTH.pcd

Profiles LEGACY, RNG19_RFL8_SIG16_NIR16 and its DUAL. DIGEST.json of ouster-sdk (tests/pcaps) has the
hashes of all ranges and column times that Ouster's SDK decodes: others are an error. TRUTH.pcd: x y z
(m, sensor frame), channel and time_stamp (ns since the first column).
"""
import collections
import hashlib
import json
import math
import pathlib
import struct
import sys

COLUMNS = 16
LIDAR_TO_SENSOR = [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1]


def datagrams(path):
    """Payloads of the UDP datagrams of a capture with Ethernet frames, fragments joined."""
    data, at, parts = pathlib.Path(path).read_bytes(), 24, collections.defaultdict(dict)
    order = "<" if data[0] in (0xd4, 0x4d) else ">"
    link = struct.unpack_from(order + "I", data, 20)[0]
    while at < len(data):
        size = struct.unpack_from(order + "I", data, at + 8)[0]
        packet = data[at + 16 + (16 if link == 113 else 14):at + 16 + size]
        at += 16 + size
        if len(packet) < 20 or packet[9] != 17:
            continue
        head, (total, number, fragment) = 4 * (packet[0] & 15), struct.unpack_from(">HHH", packet, 2)
        key = packet[12:20], number
        parts[key][8 * (fragment & 0x1fff)] = packet[head:total]
        whole = b"".join(part for _, part in sorted(parts[key].items()))
        if struct.unpack_from(">H", whole, 4)[0] == len(whole):
            yield whole[8:]
            del parts[key]


class Layout:
    """Where columns and channels are in a packet."""

    def __init__(self, metadata):
        formats = metadata.get("data_format") or metadata.get("lidar_data_format")
        self.lasers, self.columns = formats["pixels_per_column"], formats["columns_per_frame"]
        profile = formats.get("udp_profile_lidar", "LEGACY")
        self.legacy, dual = profile == "LEGACY", profile.endswith("DUAL")
        self.channel = 16 if dual else 12
        self.begin, self.head, self.tail = (0, 16, 4) if self.legacy else (32, 12, 0)
        self.column = self.head + self.channel * self.lasers + self.tail
        self.size = 2 * self.begin + COLUMNS * self.column
        self.mask = 0xfffff if self.legacy else 0x7ffff

    def ranges_mm(self, packet, at):
        return [struct.unpack_from("<I", packet, at + self.head + self.channel * i)[0] & self.mask
                for i in range(self.lasers)]

    def is_valid(self, packet, at):
        if self.legacy:
            return struct.unpack_from("<I", packet, at + self.column - 4)[0] == 0xffffffff
        return packet[at + 10] & 1


def point(metadata, layout, measurement, laser, range_mm):
    beams, lidar = metadata.get("beam_intrinsics", metadata), metadata.get("lidar_intrinsics", metadata)
    offset = beams.get("lidar_origin_to_beam_origin_mm", 12.163)
    to_sensor = lidar.get("lidar_to_sensor_transform", LIDAR_TO_SENSOR)
    encoder = 2 * math.pi * (1 - measurement / layout.columns)
    azimuth = encoder - math.radians(beams["beam_azimuth_angles"][laser])
    altitude = math.radians(beams["beam_altitude_angles"][laser])
    flat = (range_mm - offset) * math.cos(altitude)
    at = (flat * math.cos(azimuth) + offset * math.cos(encoder),
          flat * math.sin(azimuth) + offset * math.sin(encoder),
          (range_mm - offset) * math.sin(altitude), 1)
    return [sum(to_sensor[4 * row + k] * at[k] for k in range(4)) / 1000 for row in range(3)]


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    metadata = json.loads(pathlib.Path(sys.argv[2]).read_text())
    hashes = json.loads(pathlib.Path(sys.argv[3]).read_text())["packet_hash"]
    layout, points, first = Layout(metadata), [], None
    ranges_hash, times_hash = hashlib.md5(), hashlib.md5()
    for packet in datagrams(sys.argv[1]):
        if len(packet) != layout.size:
            continue
        begins = [layout.begin + k * layout.column for k in range(COLUMNS)]
        rows = [layout.ranges_mm(packet, at) for at in begins]
        for laser in range(layout.lasers):
            ranges_hash.update(struct.pack(f"<{COLUMNS}I", *(row[laser] for row in rows)))
        for at, row in zip(begins, rows):
            times_hash.update(packet[at:at + 8])
            time, measurement = struct.unpack_from("<QH", packet, at)
            first = time if first is None else first
            if layout.is_valid(packet, at):
                points += [(*point(metadata, layout, measurement, laser, range_mm), laser, time - first)
                           for laser, range_mm in enumerate(row) if range_mm > 0]
    if (ranges_hash.hexdigest(), times_hash.hexdigest()) != (hashes["RANGE"], hashes["TIMESTAMP"]):
        sys.exit(f"ouster_truth: {sys.argv[1]}: ranges or times differ from those of {sys.argv[3]}")
    head = (f"VERSION 0.7\nFIELDS x y z channel time_stamp\nSIZE 4 4 4 2 4\nTYPE F F F U U\n"
            f"COUNT 1 1 1 1 1\nWIDTH {len(points)}\nHEIGHT 1\nPOINTS {len(points)}\nDATA binary\n")
    with open(sys.argv[4], "wb") as file:
        file.write(head.encode())
        for values in points:
            file.write(struct.pack("<fffHI", *values))


if __name__ == "__main__":
    main()
