# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""simulate --rig: the points of every sensor, put into the world by its mount and the vehicle's poses
with readers of our own, lie on the hall or on the vehicle's body, and none is behind the body."""
import csv
import math
import shlex
import shutil
import struct
import tomllib
import unittest
from collections import defaultdict

import packet_parser
from support import ProgramTest, run, tree_digest
from test_calibrate import hall
from test_packets import lasers_of_yaml, driver_point, ply_rows

POSES = 6
BEGIN_S = 7250.2
BODY = (0.2, 0, 0.75, 4.4, 1.8, 1.5)
NEEDLE = (1.6, -0.9, 1.7, 0.1, 0.1, 0.4)  # the housing of `right`
# Name: sensor, mount, yaw, pitch and roll in degrees, time offset.
SENSORS = {"top": ("velodyne-vlp-16", (0.5, 0.1, 1.9), (0, 0, 0), 0.0),
           "left": ("velodyne-vlp-16", (1.4, 0.8, 1.7), (35, 10, 180), 0.05),
           "right": ("small.toml", (1.6, -0.9, 1.7), (-80, 5, 3), -0.02)}
SMALL = """name = "small"
like = "velodyne-vlp-32c"
columns = 360
rotation_hz = 20
max_range_m = 60.0
"""
TOLERANCE_M = 0.004  # 1 mm counts; poses are interpolated between those of the file


def rotation(yaw, pitch, roll):
    """Rz(yaw) Ry(pitch) Rx(roll), degrees."""
    (cy, sy), (cp, sp), (cr, sr) = ((math.cos(math.radians(a)), math.sin(math.radians(a)))
                                    for a in (yaw, pitch, roll))
    return ((cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
            (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr), (-sp, cp * sr, cp * cr))


def rotation_of(w, x, y, z):
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))


def moved(pose, point):
    rows, at = pose
    return tuple(sum(r * p for r, p in zip(row, point)) + a for row, a in zip(rows, at))


def mount_of(name):
    _, at, turn, _ = SENSORS[name]
    return rotation(*turn), at


def vehicle_at(time_s):
    """The drive: straight ahead between the poses of the file, turning uniformly."""
    k = (time_s - BEGIN_S) / 0.1
    x, y, yaw = -6 + 0.8 * k, -2 + 0.3 * k, 3 * k
    return rotation(yaw, 0, 0), (x, y, 0.02)


def box_distance(point, box):
    """Of a point from the surface of a box; negative inside."""
    away = [abs(p - c) - s / 2 for p, c, s in zip(point, box[:3], box[3:])]
    outside = math.hypot(*(max(0, a) for a in away))
    return outside if outside > 0 else max(away)


HALL = [(0, 0, 5, 40, 28, 10), (6, 6.5, 2, 2, 3, 4)]


def share_inside(begin, end, box):
    """The shares of a line at which it enters and leaves a box."""
    low, high = 0.0, 1.0
    for b, e, c, s in zip(begin, end, box[:3], box[3:]):
        if abs(e - b) < 1e-12:
            if abs(b - c) > s / 2:
                return 1.0, 0.0
            continue
        t0, t1 = sorted(((c - s / 2 - b) / (e - b), (c + s / 2 - b) / (e - b)))
        low, high = max(low, t0), min(high, t1)
    return low, high


def cdr_reader(message):
    """Returns read(format): aligned values behind the encapsulation; read("s"): a text."""
    assert message[:4] == b"\0\1\0\0"
    place = 4

    def read(kind):
        nonlocal place
        if kind == "s":
            size = read("I")
            text = message[place:place + size - 1].decode()
            place += size
            return text
        if isinstance(kind, int):
            place += kind
            return message[place - kind:place]
        size = struct.calcsize(kind)
        place += -(place - 4) % size
        value, = struct.unpack_from("<" + kind, message, place)
        place += size
        return value
    return read


def mcap_messages(path):
    """(topic, type, log time in ns, message), after the MCAP specification: chunks are unpacked."""
    data = path.read_bytes()
    assert data[:8] == data[-8:] == b"\x89MCAP0\r\n"
    schemas, channels = {}, {}

    def text(bytes_, place):
        size, = struct.unpack_from("<I", bytes_, place)
        return bytes_[place + 4:place + 4 + size].decode(), place + 4 + size

    def records(bytes_):
        place = 0
        while place < len(bytes_):
            kind, size = struct.unpack_from("<BQ", bytes_, place)
            yield kind, bytes_[place + 9:place + 9 + size]
            place += 9 + size

    def messages(bytes_):
        for kind, record in records(bytes_):
            if kind == 3:
                schemas[struct.unpack_from("<H", record)[0]] = text(record, 2)[0]
            elif kind == 4:
                number, schema = struct.unpack_from("<HH", record)
                channels[number] = (text(record, 4)[0], schemas[schema])
            elif kind == 5:
                number, _, log_ns, _ = struct.unpack_from("<HIQQ", record)
                yield *channels[number], log_ns, record[22:]
            elif kind == 6:
                compression, place = text(record, 28)
                assert compression == ""
                yield from messages(record[place + 8:])
            elif kind == 15:
                return
    yield from messages(data[8:-8])


def transforms(message):
    """(time in s, parent, child, (rotation, translation)) of a TFMessage."""
    read = cdr_reader(message)
    for _ in range(read("I")):
        time_s = read("i") + read("I") * 1e-9
        parent, child = read("s"), read("s")
        at = tuple(read("d") for _ in range(3))
        x, y, z, w = (read("d") for _ in range(4))
        yield time_s, parent, child, (rotation_of(w, x, y, z), at)


def cloud_rows(message):
    """(time of the header in s, frame, points as dictionaries) of a PointCloud2."""
    read = cdr_reader(message)
    time_s = read("i") + read("I") * 1e-9
    frame = read("s")
    assert read("I") == 1
    count = read("I")
    kinds = {1: "b", 2: "B", 3: "h", 4: "H", 5: "i", 6: "I", 7: "f", 8: "d"}
    fields = [(read("s"), read("I"), kinds[read("B")], read("I")) for _ in range(read("I"))]
    assert read("B") == 0
    step, _, size = read("I"), read("I"), read("I")
    data = read(size)
    return time_s, frame, [{name: struct.unpack_from("<" + kind, data, k * step + offset)[0]
                            for name, offset, kind, _ in fields} for k in range(count)]


class Rig(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "hall.obj").write_text(hall())
        (self.folder / "car").mkdir()
        (self.folder / "car" / "small.toml").write_text(SMALL)
        self.motion = self.folder / "motion.csv"
        self.write_poses(self.poses, range(POSES))
        self.write_poses(self.motion, range(-1, POSES + 1))
        self.write_rig()

    def write_poses(self, path, steps):
        rows = ["time,x,y,z,qw,qx,qy,qz"]
        for k in steps:
            _, at = vehicle_at(BEGIN_S + 0.1 * k)
            half = math.radians(3 * k) / 2
            rows.append(f"{BEGIN_S + 0.1 * k:.9f},{at[0]!r},{at[1]!r},{at[2]!r},"
                        f"{math.cos(half)!r},0,0,{math.sin(half)!r}")
        path.write_text("\n".join(rows) + "\n")

    def write_rig(self, names=tuple(SENSORS), body=True, extra=None):
        text = f"body = [{list(BODY)}]\n" if body else ""
        for name in names:
            sensor, at, turn, offset_s = SENSORS[name]
            text += (f'[[sensors]]\nname = "{name}"\nsensor = "{sensor}"\nmount = {list(at)}\n'
                     f"mount_rotation_deg = {list(turn)}\ntime_offset_s = {offset_s}\n")
            if name == "right" and body:
                text += f"body = [{list(NEEDLE)}]\n"
            text += (extra or {}).get(name, "")
        self.rig = self.folder / "car" / "rig.toml"
        self.rig.write_text(text)

    def words(self, output="out", *arguments):
        return ["simulate", self.folder / "hall.obj", "--rig", self.rig, "--trajectory", self.poses,
                "-o", self.folder / output, "--no-noise", "--rolling-shutter", "--motion", self.motion,
                *arguments]

    def simulated(self, *arguments):
        out = self.folder / "out"
        self.run_good(*self.words("out", *arguments))
        return out

    def check_points(self, name, points, tolerance_m=TOLERANCE_M, names=tuple(SENSORS)):
        """points: (time in the sensor's clock, point in its frame at that time)."""
        mount, offset_s = mount_of(name), SENSORS[name][3]
        boxes = [BODY] + ([NEEDLE] if "right" in names and name != "right" else [])
        begin, hidden_m = mount[1], 0.01 + 4 * tolerance_m
        counts = defaultdict(int)
        for time_s, point in list(points)[::5]:
            on_car = moved(mount, point)
            world = moved(vehicle_at(time_s + offset_s), on_car)
            body_m = min(abs(box_distance(on_car, box)) for box in boxes)
            hall_m = min(abs(box_distance(world, box)) for box in HALL)
            self.assertLess(min(body_m, hall_m), tolerance_m, (name, time_s, point))
            counts["body" if body_m < hall_m else "hall"] += 1
            for box in boxes:
                low, high = share_inside(begin, on_car, [*box[:3], *(s - hidden_m for s in box[3:])])
                self.assertFalse(low < high and low < 1, f"{name} sees through the car at {on_car}")
        self.assertGreater(counts["hall"], 1000)
        return counts

    def check_vehicle(self, out):
        with (out / "poses.csv").open() as file:
            rows = list(csv.DictReader(file))
        self.assertLessEqual(float(rows[0]["time"]), BEGIN_S - 0.0499)
        for row in rows:
            time_s, x, y, z, qw, qx, qy, qz = map(float, row.values())
            rows_of, at = vehicle_at(time_s)
            self.assertLess(math.dist((x, y, z), at), 1e-6)
            for a, b in zip(rotation_of(qw, qx, qy, qz), rows_of):
                self.assertLess(math.dist(a, b), 1e-8)

    def check_rig(self, out, inputs):
        """rig.toml says where the data are, and everything else as the given rig."""
        rig = tomllib.loads((out / "rig.toml").read_text())
        self.assertEqual(rig["body"], [[float(v) for v in BODY]])
        self.assertEqual([sensor["name"] for sensor in rig["sensors"]], list(SENSORS))
        for sensor, reading in zip(rig["sensors"], inputs, strict=True):
            name, at, turn, offset_s = SENSORS[sensor["name"]]
            self.assertEqual(tuple(sensor["mount"]), at)
            self.assertEqual(tuple(sensor.get("mount_rotation_deg", (0, 0, 0))), turn)
            self.assertEqual((sensor["time_offset_s"], sensor["trajectory"]), (offset_s, "poses.csv"))
            self.assertEqual(sensor["sensor"], name if "." not in name else "../car/" + name)
            for key, value in reading.items():
                self.assertEqual(sensor[key], value)
                if key in ("input", "scan_times"):
                    self.assertTrue((out / value).exists())

    def ply_points(self, out, name):
        with (out / name / "poses.csv").open() as file:
            times = [float(row["time"]) for row in csv.DictReader(file)]
        for begin_s, path in zip(times, sorted((out / name).glob("*.ply")), strict=True):
            for row in ply_rows(path):
                yield begin_s + row["time"], (row["x"], row["y"], row["z"])

    def test_files(self):
        out = self.simulated("--format", "ply")
        self.check_vehicle(out)
        self.check_rig(out, [{"input": name, "scan_times": name + ".times"} for name in SENSORS])
        for name in SENSORS:
            counts = self.check_points(name, self.ply_points(out, name))
            self.assertGreater(counts["body"], 100, name)
            times = [float(line) for line in (out / (name + ".times")).read_text().split()]
            for k, time_s in enumerate(times):
                self.assertAlmostEqual(time_s, BEGIN_S + 0.1 * k - SENSORS[name][3], places=6)

    def test_each_sensor_is_that_of_a_run_of_its_own(self):
        """Oracle: the simulation of one sensor with a mount, in its own clock."""
        self.write_rig(body=False)
        out = self.simulated("--format", "pcd")
        for name, (sensor, at, turn, _) in SENSORS.items():
            one = self.folder / name
            path = self.folder / "car" / sensor
            self.run_good("simulate", self.folder / "hall.obj", "--sensor",
                          path if path.exists() else sensor, "--mount", ",".join(map(str, at)),
                          "--mount-rotation", ",".join(map(str, turn)), "--trajectory", self.poses,
                          "-o", one, "--no-noise", "--rolling-shutter", "--motion", self.motion,
                          "--format", "pcd")
            for k in range(POSES):
                self.assertEqual((out / name / f"{k:06}.pcd").read_bytes(),
                                 (one / f"{k:06}.pcd").read_bytes())

    def test_trees(self):
        """Each tree is one of its sensor; SemanticKITTI's and KITTI's files fit the rig."""
        for word, scans in (("semantickitti", "sequences/00/velodyne"),
                            ("kitti-raw", "1970_01_01/1970_01_01_drive_0001_sync/velodyne_points/data")):
            out = self.simulated("--format", word, "--overwrite")
            self.check_rig(out, [{"input": f"{name}/{scans}", "scan_times": name + ".times"}
                                 for name in SENSORS])
            self.assertEqual(len(list((out / "top" / scans).iterdir())), POSES)
        out = self.simulated("--format", "pandaset", "--overwrite")
        for sensor in tomllib.loads((out / "rig.toml").read_text())["sensors"]:
            self.assertEqual(set(sensor) - {"body"}, {"name", "input", "sensor"})
        self.assertEqual(len(list((out / "left" / "001" / "lidar").glob("*.pkl.gz"))), POSES)

    def test_mcap(self):
        out = self.simulated("--format", "mcap")
        self.check_vehicle(out)
        self.check_rig(out, [{"input": "scans.mcap", "topic": f"/{name}/points"}
                             for name in SENSORS])
        clouds, vehicle, mounts, before_ns, kinds = defaultdict(list), [], {}, 0, {}
        for topic, kind, log_ns, message in mcap_messages(out / "scans.mcap"):
            self.assertGreaterEqual(log_ns, before_ns)
            before_ns = log_ns
            if not kinds:
                self.assertEqual(topic, "/tf_static")
            kinds[topic] = kind
            if topic == "/tf_static":
                mounts = {child: (parent, pose) for _, parent, child, pose in transforms(message)}
            elif topic == "/tf":
                vehicle += transforms(message)
            else:
                time_s, frame, rows = cloud_rows(message)
                name = topic.split("/")[1]
                self.assertEqual((topic, frame), (f"/{name}/points", name))
                # The log has the vehicle's clock, the header that of the sensor.
                self.assertAlmostEqual(log_ns * 1e-9, time_s + SENSORS[name][3], places=6)
                clouds[name] += [(time_s + row["time"], (row["x"], row["y"], row["z"]))
                                 for row in rows]
        self.assertEqual(kinds["/top/points"], "sensor_msgs/msg/PointCloud2")
        self.assertEqual(set(clouds), set(SENSORS))
        for name in SENSORS:
            self.check_points(name, clouds[name])
            parent, (rows, at) = mounts[name]
            self.assertEqual(parent, "base_link")
            self.assertLess(math.dist(at, mount_of(name)[1]), 1e-12)
            for a, b in zip(rows, mount_of(name)[0]):
                self.assertLess(math.dist(a, b), 1e-12)
        for time_s, parent, child, (_, at) in vehicle:
            self.assertEqual((parent, child), ("map", "base_link"))
            self.assertLess(math.dist(at, vehicle_at(time_s)[1]), 1e-6)

    def test_packets(self):
        self.write_rig(("top", "left"), extra={"left": 'topic = "10.0.0.7:2369"\n'})
        out = self.simulated("--format", "pcap")
        self.check_vehicle(out)
        rig = tomllib.loads((out / "rig.toml").read_text())
        self.assertEqual([(sensor["input"], sensor["topic"]) for sensor in rig["sensors"]],
                         [("drive.pcap", "192.168.1.201:2368"), ("drive.pcap", "10.0.0.7:2369")])
        ports = {"top": 2368, "left": 2369}
        packets = list(packet_parser.datagrams(out / "drive.pcap"))
        times = [captured_s for captured_s, _, _ in packets]
        self.assertEqual(times, sorted(times))
        senders = {frame[26:30] for _, frame in packet_parser.frames(out / "drive.pcap")}
        self.assertEqual(senders, {bytes([192, 168, 1, 201]), bytes([10, 0, 0, 7])})
        for name, port in ports.items():
            lasers = lasers_of_yaml((out / name / "calibration.yaml").read_text())
            points = []
            for captured_s, to, packet in packets:
                if to != port:
                    continue
                micros, = struct.unpack_from("<I", packet, 1200)
                stamp_s = micros * 1e-6 + 3600 * (captured_s // 3600)
                self.assertAlmostEqual(captured_s, stamp_s + 1327.5e-6 + SENSORS[name][3],
                                       delta=3e-6)
                for t, laser, azimuth, range_m, _ in packet_parser.VLP_16.packet_returns(packet,
                                                                                         micros):
                    points.append((t + 7200, driver_point(lasers[laser], azimuth, range_m)))
            # Azimuths of 0.01 degrees, ranges of 2 mm.
            self.check_points(name, points, 0.02, tuple(ports))
        sensors = [line.split(",")[0] for line in (out / "left" / "poses.csv").read_text().split()]
        self.assertAlmostEqual(float(sensors[1]), BEGIN_S - 0.05, places=6)

    def test_packets_need_ports_and_near_clocks(self):
        for extra, says in (('topic = "front"\n', "ADDRESS:PORT"),
                            ('topic = "1.2.3.4:0"\n', "ADDRESS:PORT"),
                            ('topic = "1.2.3.256:2368"\n', "ADDRESS:PORT")):
            self.write_rig(("top",), extra={"top": extra})
            self.run_bad(64, *self.words("bad", "--format", "pcap"), says=["'top'", says])
        same = 'topic = "10.0.0.7:2369"\n'
        self.write_rig(("top", "left"), extra={"left": same, "top": same})
        self.run_bad(64, *self.words("bad", "--format", "pcap"), says=["'left'", "address and port"])
        self.write_rig(("top",))
        self.rig.write_text(self.rig.read_text().replace("time_offset_s = 0.0", "time_offset_s = 60"))
        self.run_bad(64, *self.words("bad", "--format", "pcap"), says=["'top'", "60", "minute"])

    def test_points_of_every_sensor_are_read_back(self):
        """Each part of rig.toml loads as a drive; the model of all has the hall's surfaces."""
        self.write_rig(body=False)
        for word, *driver in (["ply"], ["las"], ["mcap"], ["mcap", "--driver", "hesai"], ["pcap"]):
            if word == "pcap":
                self.write_rig(("top", "left"), body=False)
            out = self.simulated("--format", word, *driver, "--overwrite")
            for sensor in tomllib.loads((out / "rig.toml").read_text())["sensors"]:
                words = ["--trajectory", out / sensor["trajectory"], "--time-offset",
                         sensor["time_offset_s"], "--mount=" + ",".join(map(str, sensor["mount"]))]
                words += ["--mount-rotation=" + ",".join(map(str, sensor["mount_rotation_deg"]))] \
                    if "mount_rotation_deg" in sensor else []
                words += ["--topic", sensor["topic"]] if "topic" in sensor else []
                words += ["--scan-times", out / sensor["scan_times"]] if "scan_times" in sensor else []
                words += ["--points-in", sensor["points_in"]] if "points_in" in sensor else []
                words += ["--sweep-points", sensor["sweep_points"]] if "sweep_points" in sensor else []
                words += ["--packet-sensor", sensor["sensor"]] if word == "pcap" else []
                cloud = self.folder / "cloud.csv"
                done = run("export", out / sensor["input"], "-o", cloud, *words)
                self.assertEqual(done.returncode, 0, (word, sensor, done.stderr))
                with cloud.open() as file:
                    names, *rows = csv.reader(file)
                self.assertGreater(len(rows), 2000)
                self.assertEqual(names[:3], ["x", "y", "z"])
                rows = [tuple(map(float, row[:3])) for row in rows[::5]]
                far = sum(min(abs(box_distance(row, box)) for box in HALL) > 0.03 for row in rows)
                self.assertLess(far, 0.01 * len(rows), (word, sensor["name"]))

    def test_interrupted_and_planned_runs_are_those_of_one(self):
        whole = tree_digest(self.simulated("--format", "npy"))
        shutil.rmtree(self.folder / "out")
        words = self.words("out", "--format", "npy")
        if self.kill_behind(self.folder / ".out.unfinished" / "journal", 9, *words):
            self.assertFalse((self.folder / "out").exists())
        self.run_good(*words, "--overwrite")
        self.assertEqual(tree_digest(self.folder / "out"), whole)
        shutil.rmtree(self.folder / "out")
        lines = self.run_good(*words, "--plan", "4").stdout.splitlines()
        for line in reversed(lines[:-1]):
            self.run_good(*shlex.split(line)[1:])
        report = self.report(*words)
        self.assertEqual((report["scans"], report["scans_resumed"]), (3 * POSES, 3 * POSES))
        self.assertEqual(tree_digest(self.folder / "out"), whole)

    def test_noise_differs_between_sensors_of_a_type(self):
        self.rig.write_text("".join(f'[[sensors]]\nname = "{name}"\nsensor = "small.toml"\n'
                                    "mount = [0, 0, 2]\n" for name in "ab"))
        self.run_good("simulate", self.folder / "hall.obj", "--rig", self.rig, "--trajectory",
                      self.poses, "--range-noise", "0.02", "--format", "npy", "-o",
                      self.folder / "out")
        a, b = ((self.folder / "out" / name / "000000.npy").read_bytes() for name in "ab")
        self.assertEqual(len(a), len(b))
        self.assertNotEqual(a, b)

    def test_the_trajectory_of_the_rig_is_the_default(self):
        self.rig.write_text('trajectory = "../poses.csv"\n' + self.rig.read_text())
        words = [word for word in self.words("out", "--format", "npy")
                 if word not in ("--trajectory", self.poses)]
        self.run_good(*words)
        self.assertEqual(tree_digest(self.folder / "out" / "top"),
                         tree_digest(self.simulated("--format", "npy", "--overwrite") / "top"))

    def test_wrong_rigs_give_one_error(self):
        words = self.words("bad")
        self.run_bad(64, *words, "--sensor", "velodyne-vlp-16", says=["--sensor", "--rig"])
        self.run_bad(64, *words, "--mount", "0,0,1", says=["--mount", "--rig"])
        self.run_bad(64, *words, "--format", "nuscenes", says=["nuscenes", "LIDAR_TOP"])
        self.run_bad(64, *words, "--format", "argoverse2", says=["argoverse2", "up_lidar"])
        good = self.rig.read_text()
        for old, new, code, says in (
                ('sensor = "small.toml"\n', "", 64, ["'right'", "no key sensor"]),
                ('"small.toml"', '"velodyne-vlp-61"', 64, ["'right'", "velodyne-vlp-61"]),
                ("mount = [0.5, 0.1, 1.9]", "mount = [0.5, 0.1, 1.4]", 64,
                 ["'top'", "[0.5, 0.1, 1.4]", "[0.2, 0, 0.75, 4.4, 1.8, 1.5]"]),
                ("time_offset_s = 0.05", 'trajectory = "b.csv"', 64, ["'left'", "trajectory"]),
                ("mount_rotation_deg", "mount_rotation", 78, ["mount_rotation_deg"])):
            self.assertIn(old, good)
            self.rig.write_text(good.replace(old, new))
            self.run_bad(code, *words, says=["rig.toml", *says])
        self.rig.write_text(good.replace('name = "top"', 'name = "base_link"'))
        self.run_bad(64, *words, "--format", "mcap", says=["base_link"])
        self.rig.unlink()
        self.run_bad(66, *words, says=["rig.toml"])
        self.assertFalse((self.folder / "bad").exists())


if __name__ == "__main__":
    unittest.main()
