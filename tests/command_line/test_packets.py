# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated scans as packets, taken apart by a parser that was written from the makers' manuals."""
import json
import math
import re
import socket
import struct
import time
import unittest
from collections import defaultdict

import packet_parser
from support import LARGE_CELLS, ProgramTest, run, tree_digest

# Manual 63-9243, table "Vertical angles by laser id".
VLP_16_TILTS = [-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15]
BEGIN_S = 7250.2  # two hours and 50.2 s


def by_laser(rows):
    """Lists of rows by the laser, which is the second of each, in the order of their times."""
    lasers = defaultdict(list)
    for row in sorted(rows):
        lasers[row[1]].append(row)
    return lasers


def lasers_of_yaml(text):
    """The driver's calibration: a dictionary a laser, by its id."""
    lasers = {}
    for part in text.split("\n- ")[1:]:
        values = {key: float(value) for key, value in re.findall(r"(\w+): ([-\d.e]+)", part)}
        lasers[int(values["laser_id"])] = values
    return lasers


def driver_point(laser, azimuth_deg, range_m):
    """As velodyne_pointcloud has it, in ROS's axes: x forward, y left."""
    turn = math.radians(azimuth_deg) - laser["rot_correction"]
    range_m += laser["dist_correction"]
    tilt, up, left = (laser[key] for key in ("vert_correction", "vert_offset_correction",
                                             "horiz_offset_correction"))
    flat = range_m * math.cos(tilt) - up * math.sin(tilt)
    right = flat * math.sin(turn) - left * math.cos(turn)
    ahead = flat * math.cos(turn) + left * math.sin(turn)
    return ahead, -right, range_m * math.sin(tilt) + up * math.cos(tilt)


def ouster_point(metadata, channel, column, range_m):
    """As the manual has it ("Lidar Range to XYZ"), in the sensor's frame, m."""
    along = metadata["lidar_origin_to_beam_origin_mm"] / 1000
    turn = 2 * math.pi * (1 - column / metadata["data_format"]["columns_per_frame"])
    offset = -2 * math.pi * metadata["beam_azimuth_angles"][channel] / 360
    tilt = 2 * math.pi * metadata["beam_altitude_angles"][channel] / 360
    x = (range_m - along) * math.cos(turn + offset) * math.cos(tilt) + along * math.cos(turn)
    y = (range_m - along) * math.sin(turn + offset) * math.cos(tilt) + along * math.sin(turn)
    z = (range_m - along) * math.sin(tilt)
    rows = metadata["lidar_to_sensor_transform"]
    return [rows[4 * r] * x + rows[4 * r + 1] * y + rows[4 * r + 2] * z + rows[4 * r + 3] / 1000
            for r in range(3)]


def ply_rows(path):
    """The vertices of a binary PLY as dictionaries."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    kinds = {"float": "f", "double": "d", "uchar": "B", "ushort": "H", "uint": "I", "int": "i"}
    properties = [line.split()[1:] for line in head.decode().splitlines()
                  if line.startswith("property")]
    layout = struct.Struct("<" + "".join(kinds[kind] for kind, _ in properties))
    names = [name for _, name in properties]
    return [dict(zip(names, values)) for values in layout.iter_unpack(body)]


class Packets(ProgramTest):
    def setUp(self):
        super().setUp()
        self.place = self.model()
        self.write_poses([BEGIN_S + 0.1 * k for k in range(3)])

    def write_poses(self, times_s):
        rows = [f"{time_s:.6f},{4 + 0.2 * k},0,2,1,0,0,0" for k, time_s in enumerate(times_s)]
        self.poses.write_text("\n".join(["time,x,y,z,qw,qx,qy,qz", *rows]) + "\n")

    def both(self, sensor, *arguments):
        """The folder of the packets, and the same scans as rows of (time in s, ring, range, point,
        column). The sensor moves, as files of one that stood still have no times of points."""
        folders = {}
        for word in ("pcap", "ply"):
            folders[word] = self.folder / word
            self.run_good("simulate", self.place, "--trajectory", self.poses, "--sensor", sensor,
                          "-o", folders[word], "--format", word, "--rolling-shutter", "--overwrite",
                          *arguments)
        begins_s = [float(line.split(",")[0]) for line in
                    (folders["ply"] / "poses.csv").read_text().splitlines()[1:]]
        truth = []
        for begin_s, path in zip(begins_s, sorted(folders["ply"].glob("*.ply")), strict=True):
            truth += [(begin_s + row["time"], row["ring"], row["range"],
                       (row["x"], row["y"], row["z"]), row["column"]) for row in ply_rows(path)]
        return folders["pcap"], truth

    def check_velodyne(self, sensor, parser, calibration_name="calibration.yaml"):
        folder, truth = self.both(sensor)
        self.assertEqual(sorted(path.name for path in folder.iterdir()),
                         sorted(["adasplats.json", calibration_name, "drive.pcap", "poses.csv"]))
        lasers = lasers_of_yaml((folder / calibration_name).read_text())
        # Rings as the driver numbers them: by their angles, from the lowest.
        order = sorted(lasers, key=lambda i: lasers[i]["vert_correction"])
        ring_of_laser = {laser: ring for ring, laser in enumerate(order)}
        found = by_laser((t, ring_of_laser[laser], azimuth, range_m, laser) for
                         t, laser, azimuth, range_m, _ in parser.returns(folder / "drive.pcap"))
        top = parser.lasers - 1
        expected = by_laser((t, top - ring, range_m, tuple(point))
                            for t, ring, range_m, point, _ in truth)
        self.assertGreater(len(truth), 2000)
        self.assertEqual({ring: len(rows) for ring, rows in found.items()},
                         {ring: len(rows) for ring, rows in expected.items()})
        for ring, rows in found.items():
            for (t, _, azimuth, range_m, laser), (true_t, _, true_m, point) in \
                    zip(rows, expected[ring]):
                # Times of packets are cut to microseconds; 24 sequences take 0.3 us less by the
                # manual than those that fill a revolution.
                self.assertLess(t - true_t % 3600, 0.1e-6)
                self.assertGreater(t - true_t % 3600, -1.4e-6)
                self.assertAlmostEqual(range_m, true_m, delta=parser.quantum_m / 2 + 1e-5)
                place = driver_point(lasers[laser], azimuth, range_m)
                # A step of 0.01 degrees, and one more of what is between two blocks.
                allowed = math.radians(0.02) * true_m + parser.quantum_m
                self.assertLess(math.dist(place, point), allowed)
        return folder, found, lasers

    def test_vlp_16(self):
        folder, found, lasers = self.check_velodyne("velodyne-vlp-16", packet_parser.VLP_16)
        for laser, tilt in enumerate(VLP_16_TILTS):
            self.assertAlmostEqual(math.degrees(lasers[laser]["vert_correction"]), tilt)
        # All azimuths of points as the manual has them: no offsets, one point.
        self.assertTrue(all(value["rot_correction"] == 0 for value in lasers.values()))
        # 1808 sequences a revolution, 24 a packet, one stream without a gap but for the last packet.
        packets = list(packet_parser.datagrams(folder / "drive.pcap"))
        self.assertEqual(len(packets), math.ceil(3 * 1808 / 24))
        times = [int.from_bytes(packet[1200:1204], "little") for _, _, packet in packets]
        # The pose is of the middle of the revolution.
        self.assertEqual(times[0], round((BEGIN_S - 0.05) % 3600 * 1e6))
        steps = [b - a for a, b in zip(times, times[1:])]
        self.assertEqual((min(steps), max(steps)), (1327, 1328))  # 24 of 55.31 us
        # Sent when the last laser has fired.
        for captured_s, _, packet in packets:
            micros = int.from_bytes(packet[1200:1204], "little")
            self.assertAlmostEqual(captured_s % 3600, (micros + 1327.5) * 1e-6, delta=2e-6)
        self.assertEqual(sum(map(len, found.values())), len(packet_parser.VLP_16.returns(
            folder / "drive.pcap")))

    def test_others_of_velodyne(self):
        for sensor, parser, name in [
                ("velodyne-hdl-32e", packet_parser.HDL_32E, "calibration.yaml"),
                ("velodyne-vlp-32c", packet_parser.VLP_32C, "calibration.yaml"),
                ("velodyne-hdl-64e-s3", packet_parser.HDL_64E_S3, "calibration-s3.yaml"),
                ("velodyne-vls-128", packet_parser.VLS_128, "calibration.yaml")]:
            with self.subTest(sensor):
                self.check_velodyne(sensor, parser, name)

    def test_calibration_is_the_sensor(self):
        """The written file, read as a sensor, casts the rays of the sensor."""
        for sensor, name in [("velodyne-hdl-64e-s3", "calibration-s3.yaml"),
                             ("velodyne-vlp-32c", "calibration.yaml"),
                             ("ouster-os1-64", "metadata.json")]:
            with self.subTest(sensor):
                folder, truth = self.both(sensor, "--no-noise")
                keep = self.folder / name
                keep.write_text((folder / name).read_text())
                _, again = self.both(keep, "--no-noise")
                self.assertGreater(len(truth), 1000)
                self.assertAlmostEqual(len(again) / len(truth), 1, delta=0.01)
                places = {(round(t, 5), ring): point for t, ring, _, point, _ in again}
                near = [math.dist(point, places.get((round(t, 5), ring), (1e3, 0, 0))) < 0.01
                        for t, ring, _, point, _ in truth]
                self.assertGreater(sum(near) / len(near), 0.97)

    def test_ouster(self):
        for sensor, channels in (("ouster-os1-64", 64), ("ouster-os0-128", 128)):
            with self.subTest(sensor):
                folder, truth = self.both(sensor)
                metadata = json.loads((folder / "metadata.json").read_text())
                self.assertEqual(metadata["data_format"]["pixels_per_column"], channels)
                self.assertEqual(metadata["lidar_mode"], "1024x10")
                found = sorted(packet_parser.ouster_returns(folder / "drive.pcap", channels))
                truth.sort(key=lambda row: (row[0], row[1]))
                # The driver's ring is the channel, from the topmost, as ours is.
                found.sort(key=lambda row: (row[3], row[2], row[1]))
                truth.sort(key=lambda row: (round((row[0] - row[4] * 0.1 / 1024 + 0.05) * 10), row[4],
                                            row[1]))
                self.assertEqual(len(found), len(truth))
                self.assertGreater(len(found), 2000)
                along = metadata["lidar_origin_to_beam_origin_mm"] / 1000
                for row, (true_t, ring, true_m, point, true_column) in zip(found, truth):
                    t, channel, column, _, range_m, _ = row
                    self.assertEqual((channel, column), (ring, true_column))
                    self.assertAlmostEqual(t, true_t, delta=2e-6)
                    self.assertAlmostEqual(range_m - along, true_m, delta=0.00051)
                    self.assertLess(math.dist(ouster_point(metadata, channel, column, range_m),
                                              point), 0.002)
                self.assertEqual({row[3] for row in found}, {0, 1, 2})

    def test_rolling_shutter_and_gaps(self):
        """Poses are of the middles of revolutions; scans apart are packets apart."""
        self.write_poses([BEGIN_S + 0.25 * k for k in range(6)])
        folder = self.folder / "rolling"
        self.run_good("simulate", self.place, "--trajectory", self.poses, "--sensor",
                      "velodyne-vlp-16", "-o", folder, "--format", "pcap", "--rolling-shutter",
                      "--rate", "4")
        times = [float(line.split(",")[0]) for line in
                 (folder / "poses.csv").read_text().splitlines()[1:]]
        packets = list(packet_parser.datagrams(folder / "drive.pcap"))
        begins = []
        last_s = -1
        for captured_s, _, packet in packets:
            micros = int.from_bytes(packet[1200:1204], "little")
            if captured_s - last_s > 0.01:
                begins.append(7200 + micros * 1e-6)
            last_s = captured_s
        self.assertEqual(len(packets), len(times) * 76)
        for begin_s, time_s in zip(begins, times):
            self.assertAlmostEqual(begin_s + 0.05, time_s, delta=2e-6)
        self.assertEqual(len(begins), len(times))

    def test_threads_make_no_difference(self):
        digests = set()
        for threads in ("1", "3"):
            folder, _ = self.both("velodyne-vlp-16", "--threads", threads)
            digests.add(tree_digest(folder))
        self.assertEqual(len(digests), 1)

    def test_refused(self):
        simulate = ["simulate", self.place, "--trajectory", self.poses, "-o", self.folder / "no",
                    "--format", "pcap", "--sensor"]
        self.run_bad(64, *simulate, "hdl-64-paper", says=["its packet format is unknown",
                                                          "velodyne-vlp-16", "ouster-os1-64"])
        self.run_bad(64, *simulate, "velodyne-vlp-16", "--returns", "2", says=["--returns 1"])
        self.run_bad(64, *simulate, "velodyne-vlp-16", "--max-range", "200", says=["131.07"])
        self.run_bad(64, *simulate, "ouster-os1-64", "--rotation-rate", "9", says=["1024x10"])
        self.run_bad(64, *simulate, "velodyne-vlp-16", "--rotation-rate", "0.001",
                     says=["fires at fixed times"])
        self.write_poses([BEGIN_S + 0.05 * k for k in range(3)])
        self.run_bad(65, *simulate, "velodyne-vlp-16", says=["before the last one ended"])
        self.assertFalse((self.folder / "no").exists())


class Captures(ProgramTest):
    """What `simulate` sent, read as a drive, and sent again."""

    def setUp(self):
        super().setUp()
        rows = [f"{BEGIN_S + 0.1 * k:.6f},{4 + 0.4 * k},0,2,1,0,0,0" for k in range(10)]
        self.poses.write_text("\n".join(["time,x,y,z,qw,qx,qy,qz", *rows]) + "\n")
        self.place = self.model()

    def drive(self, name, sensor, *arguments):
        folder = self.folder / name
        self.run_good("simulate", self.place, "--trajectory", self.poses, "--sensor", sensor, "-o",
                      folder, "--format", "pcap", "--rolling-shutter", *arguments)
        return folder

    def test_drives_are_models(self):
        for sensor in ("velodyne-vlp-16", "ouster-os1-64", "velodyne-hdl-64e-s3",
                       "hesai-pandarxt-32", "hesai-ot128"):
            with self.subTest(sensor):
                folder = self.drive(sensor, sensor, "--no-noise")
                model = self.folder / f"{sensor}.ply"
                drive = [folder / "drive.pcap", "--trajectory", folder / "poses.csv", "--scans",
                         "0:4"]
                result = run("model", *drive, "-o", model, *LARGE_CELLS)
                self.assertEqual(result.returncode, 0, result.stderr)
                report = self.folder / "r.json"
                result = run("evaluate", "resimulate", self.place, *drive, "--report", report)
                self.assertEqual(result.returncode, 0, result.stderr)
                figures = json.loads(report.read_text())
                # The place that sent them has them at its surfaces, to the steps of packets.
                self.assertLess(figures["range_error_m"]["median"], 0.002)

    def test_missing_requirements_are_named(self):
        folder = self.drive("vlp", "velodyne-vlp-16")
        capture = folder / "drive.pcap"
        output = self.folder / "no.ply"
        self.run_bad(64, "model", capture, "-o", output, says=["--trajectory"])
        alone = self.folder / "alone.pcap"
        alone.write_bytes(capture.read_bytes())
        self.run_bad(64, "model", alone, "--trajectory", self.poses, "-o", output,
                     says=["--packet-sensor"])
        self.run_bad(65, "model", capture, "--trajectory", self.poses, "-o", output,
                     "--packet-sensor", "velodyne-hdl-32e", says=["0x22", "192.168.1.201:2368"])
        self.run_bad(64, "model", self.cloud, "-o", output, "--packet-sensor", "velodyne-vlp-16",
                     says=["--packet-sensor"])
        alone.write_bytes(capture.read_bytes()[:-5])
        self.run_bad(65, "model", alone, "--trajectory", self.poses, "-o", output,
                     "--packet-sensor", "velodyne-vlp-16", says=["alone.pcap", "cut off"])
        self.assertFalse(output.exists())

    def test_one_of_several_sensors(self):
        """Every command reads the sensor that --topic names."""
        folder = self.drive("vlp", "velodyne-vlp-16", "--no-noise")
        capture = folder / "drive.pcap"
        data = capture.read_bytes()
        both, place = [data[:24]], 24
        while place < len(data):
            end = place + 16 + struct.unpack_from("<I", data, place + 8)[0]
            both.append(data[place:end])
            address = place + 16 + 14 + 12  # of the sender
            both.append(data[place:address] + bytes([10, 0, 0, 7]) + data[address + 4:end])
            place = end
        capture.write_bytes(b"".join(both))
        poses = ["--trajectory", folder / "poses.csv"]
        for command, name in (("model", "m.ply"), ("export", "e.ply"), ("calibrate", "c")):
            chosen = [command, capture, *poses, "-o", self.folder / name]
            self.run_bad(64, *chosen, says=["several sensors", "--topic", "10.0.0.7:2368"])
            self.run_bad(64, *chosen, "--topic", "10.0.0.8:2368",
                         says=["10.0.0.8:2368", "192.168.1.201:2368"])
            result = run(*chosen, "--topic", "10.0.0.7:2368")
            if command == "calibrate":  # the street is too short for it
                self.assertIn("too few planes", result.stderr)
                continue
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue((self.folder / name).exists())
        report = self.folder / "r.json"
        result = run("evaluate", "resimulate", self.place, capture, *poses, "--topic",
                     "192.168.1.201:2368", "--report", report)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertLess(json.loads(report.read_text())["range_error_m"]["median"], 0.002)

    def test_info(self):
        folder = self.drive("vlp", "velodyne-vlp-16")
        text = run("info", folder / "drive.pcap").stdout
        self.assertIn("from 192.168.1.201:2368", text)
        self.assertIn("trajectory", text)
        self.assertIn("packets of the sensor, ", text)
        alone = self.folder / "alone.pcap"
        alone.write_bytes((folder / "drive.pcap").read_bytes())
        self.assertIn("velodyne-vlp-16 by their format", run("info", alone).stdout)
        text = run("info", folder / "drive.pcap", "--trajectory", folder / "poses.csv").stdout
        self.assertIn("as measured", text)

    def test_send(self):
        """What arrives are the datagrams of the capture, in about their time."""
        folder = self.drive("vlp", "velodyne-vlp-16")
        capture = folder / "drive.pcap"
        sent = [payload for _, _, payload in packet_parser.datagrams(capture)]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
            receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
            receiver.bind(("127.0.0.1", 0))
            receiver.settimeout(20)
            port = receiver.getsockname()[1]
            begin = time.monotonic()
            report = self.report("send", capture, "--to", f"127.0.0.1:{port}", "--speed", "2")
            seconds = time.monotonic() - begin
            received = [receiver.recv(65536) for _ in sent]
        self.assertEqual(received, sent)
        self.assertEqual(report["datagrams"], len(sent))
        captured_s = [time_s for time_s, _, _ in packet_parser.datagrams(capture)]
        self.assertGreater(seconds, 0.5 * (captured_s[-1] - captured_s[0]))
        self.run_bad(64, "send", capture, "--to", "127.0.0.1:0", says=["HOST:PORT"])
        self.run_bad(65, "send", capture, "--to", "127.0.0.1", "--port", "7", says=["port 7"])
        self.run_bad(66, "send", self.folder / "none.pcap", "--to", "127.0.0.1", says=["none.pcap"])


if __name__ == "__main__":
    unittest.main()
