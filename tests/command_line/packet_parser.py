# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Captures and the packets of LiDARs, parsed after the manuals of their makers alone: libpcap's file
format, RFC 791 and 768; VLP-16 63-9243 ("Packet Types"), HDL-32E 63-9113, HDL-64E S3 63-HDL64ES3
(appendix E), VLP-32C 63-9325, VLS-128 63-9483; Ouster Software User Manual 2.0 ("Lidar Data")."""
import struct

BLOCK_FLAGS = [0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF]


def ones_sum(data):
    """The sum of RFC 1071; 0xFFFF where a checksum within is right."""
    if len(data) % 2:
        data += b"\0"
    total = sum(struct.unpack(f">{len(data) // 2}H", data))
    while total >> 16:
        total = (total & 0xFFFF) + (total >> 16)
    return total


def frames(path):
    """(time in s, bytes) of every frame of a classic capture of Ethernet."""
    data = path.read_bytes()
    magic, major, minor, _, _, snap, link = struct.unpack_from("<IHHiIII", data)
    assert (magic, major, minor, link) == (0xA1B2C3D4, 2, 4, 1), "not a capture of Ethernet"
    place = 24
    while place < len(data):
        seconds, micros, size, whole = struct.unpack_from("<IIII", data, place)
        assert size == whole <= snap and micros < 1000000
        yield seconds + micros * 1e-6, data[place + 16:place + 16 + size]
        place += 16 + size
        assert place <= len(data), "a frame is cut"


def datagrams(path):
    """(time in s, port, payload) of every UDP datagram, fragments put together; all checksums are
    looked at."""
    open_parts = {}
    for time_s, frame in frames(path):
        assert frame[12:14] == b"\x08\x00" and len(frame) <= 1514
        head = frame[14:34]
        assert head[0] == 0x45 and head[9] == 17 and ones_sum(head) == 0xFFFF
        length, name, fragment = struct.unpack_from(">HHH", head, 2)
        part = frame[34:14 + length]
        key = (head[12:20], name)
        parts = open_parts.setdefault(key, [])
        assert sum(map(len, parts)) == (fragment & 0x1FFF) * 8, "fragments out of order"
        parts.append(part)
        if fragment & 0x2000:
            continue
        del open_parts[key]
        datagram = b"".join(parts)
        port, size = struct.unpack_from(">HH", datagram, 2)
        assert size == len(datagram)
        pseudo = head[12:20] + struct.pack(">HH", 17, size)
        assert ones_sum(pseudo + datagram) == 0xFFFF, "the checksum of UDP is wrong"
        yield time_s, port, datagram[8:]
    assert not open_parts, "fragments are missing"


class Velodyne:
    """lasers, firing time of a laser in us within a sequence of cycle_us, metres a count; the time of
    a packet is stamp_us after its first firing."""

    def __init__(self, lasers, time_us, cycle_us, quantum_m, factory=None, stamp_us=0):
        self.lasers, self.time_us, self.cycle_us = lasers, time_us, cycle_us
        self.stamp_us = stamp_us
        self.quantum_m, self.factory = quantum_m, factory

    def returns(self, path):
        """(time in s past the hour, laser, azimuth of the encoder in degrees, range in m, intensity)
        of all that came back, in the order of the packets."""
        found = []
        for _, port, packet in datagrams(path):
            assert port == 2368 and len(packet) == 1206
            if self.factory is not None:
                assert packet[1204:1206] == bytes([0x37, self.factory])
            micros, = struct.unpack_from("<I", packet, 1200)
            assert micros < 3600000000
            found += self.packet_returns(packet, micros)
        return found

    def azimuths(self, packet):
        """Of each firing sequence, degrees, and how far the head turns during one. Where a block has
        two sequences (VLP-16) the second is halfway to the next block's."""
        heads = [struct.unpack_from("<HH", packet, 100 * b) for b in range(12)]
        blocks = max(1, self.lasers // 32)
        for b, (flag, _) in enumerate(heads):
            assert flag == BLOCK_FLAGS[b % blocks]
        of_blocks = [heads[b][1] / 100 for b in range(0, 12, blocks)]
        assert all(0 <= a < 360 for a in of_blocks)
        gaps = [(b - a) % 360 for a, b in zip(of_blocks, of_blocks[1:])]
        gaps.append(gaps[-1])
        if self.lasers >= 32:
            return list(zip(of_blocks, gaps))
        return [(a + k * gap / 2, gap / 2) for a, gap in zip(of_blocks, gaps) for k in (0, 1)]

    def packet_returns(self, packet, micros):
        channels = [struct.unpack_from("<HB", packet, 100 * b + 4 + 3 * c)
                    for b in range(12) for c in range(32)]
        found = []
        for k, (azimuth, turn) in enumerate(self.azimuths(packet)):
            for laser in range(self.lasers):
                counts, intensity = channels[k * self.lasers + laser]
                late_us = self.time_us(laser)
                if counts == 0:
                    continue
                since_us = k * self.cycle_us + late_us - self.stamp_us
                found.append(((micros + since_us) * 1e-6, laser,
                              (azimuth + turn * late_us / self.cycle_us) % 360,
                              counts * self.quantum_m, intensity))
        return found


VLP_16 = Velodyne(16, lambda i: 2.304 * i, 55.296, 0.002, 0x22)
HDL_32E = Velodyne(32, lambda i: 1.152 * i, 46.08, 0.002, 0x21)
VLP_32C = Velodyne(32, lambda i: 2.304 * (i // 2), 55.296, 0.004, 0x28)
HDL_64E_S3 = Velodyne(64, lambda i: 7.2 * (i % 32 // 4) + (0, 1.3, 2.5, 3.7)[i % 4], 57.6, 0.002)
VLS_128 = Velodyne(128, lambda i: 2.665 * (i // 8 + i // 64), 53.3, 0.004, 0xA1, 8.7)


def ouster_returns(path, channels):
    """(time in s, channel, measurement id, frame id, range in m, reflectivity) of all that came
    back, of profile LEGACY."""
    found = []
    column_bytes = 16 + 12 * channels + 4
    for _, port, packet in datagrams(path):
        assert port == 7502 and len(packet) == 16 * column_bytes
        for k in range(16):
            place = k * column_bytes
            time_ns, column, frame, ticks = struct.unpack_from("<QHHI", packet, place)
            status, = struct.unpack_from("<I", packet, place + column_bytes - 4)
            assert status == 0xFFFFFFFF and ticks == column * 88
            for channel in range(channels):
                word, reflectivity = struct.unpack_from("<IH", packet, place + 16 + 12 * channel)
                if word & 0xFFFFF:
                    found.append((time_ns * 1e-9, channel, column, frame,
                                  (word & 0xFFFFF) * 1e-3, reflectivity))
    return found
