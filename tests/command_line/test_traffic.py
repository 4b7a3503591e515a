# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""model --traffic: a car that drives through a simulated recording is found without labels, drives
again in the world that is written, and is gone where its entry is removed."""
import csv
import json
import struct
import tomllib
import unittest

from support import LARGE_CELLS, ProgramTest
from test_packets import ply_rows

SCANS = 16
CAR_MPS = 12.0
MOVING_CAR = 252
SENSOR = "velodyne-hdl-64e-s3"


def boxes_obj(*boxes):
    """An OBJ of boxes (low corner, high corner)."""
    text, corners = "", 0
    for low, high in boxes:
        for k in range(8):
            text += "v " + " ".join(str((low, high)[k >> axis & 1][axis]) for axis in range(3)) + "\n"
        for quad in ((1, 2, 4, 3), (5, 6, 8, 7), (1, 2, 6, 5), (3, 4, 8, 7), (1, 3, 7, 5),
                     (2, 4, 8, 6)):
            a, b, c, d = (corners + corner for corner in quad)
            text += f"f {a} {b} {c}\nf {a} {c} {d}\n"
        corners += 8
    return text


def car_x(time_s):
    return -12 + CAR_MPS * time_s


def poses(height, x_of, y, scans=SCANS, step_s=0.1, begin_s=0.0):
    times = [begin_s + step_s * k for k in range(scans)]
    return "\n".join(["time,x,y,z,qw,qx,qy,qz"] +
                     [f"{t:.3f},{x_of(t)},{y},{height},1,0,0,0" for t in times]) + "\n"


class Traffic(ProgramTest):
    def setUp(self):
        super().setUp()
        # Few points for the model; what is compared with it has all beams of SENSOR.
        self.sensor.write_text(f'like = "{SENSOR}"\ncolumns = 600\n')

    def write_street(self):
        """A street between walls, a parked car and one that overtakes."""
        write = lambda name, text: (self.folder / name).write_text(text)
        write("street.obj", boxes_obj(((-40, -9, 0), (60, 9, 8)), ((6, -6, 0), (10, -4, 1.5))))
        write("car.obj", boxes_obj(((-2.2, -0.9, 0), (2.2, 0.9, 1.5))))
        write("car.csv", poses(0.2, car_x, 3.5, step_s=0.05, scans=2 * SCANS + 4, begin_s=-0.1))
        write("ego.csv", poses(1.8, lambda t: 5 * t, 0))
        write("held_out.csv", poses(1.8, lambda t: 5 * t, 0, scans=6, begin_s=0.35, step_s=0.1))
        write("drive.toml", 'model = "street.obj"\n[[object]]\ngeometry = "car.obj"\n'
                            f'class = {MOVING_CAR}\ntrajectory = "car.csv"\n')

    def record(self):
        """Scans of the street without labels, and held-out ones with labels."""
        self.write_street()
        for sensor, poses_file, output in ((self.sensor, "ego.csv", "drive"),
                                           (SENSOR, "held_out.csv", "held-out")):
            self.run_good("simulate", self.folder / "drive.toml", "--sensor", sensor,
                          "--trajectory", self.folder / poses_file, "-o", self.folder / output)
        # Labels would reveal the moving car.
        drive = self.folder / "drive" / "sequences" / "00"
        for label in (drive / "labels").iterdir():
            label.unlink()
        (drive / "labels").rmdir()
        return drive

    def test_a_car_is_found_drives_again_and_can_be_removed(self):
        drive = self.record()
        place = self.folder / "place"
        result = self.run_good("model", drive, "--traffic", *LARGE_CELLS, "-o", place, "--report",
                               self.folder / "report.json")
        self.assertIn("1 moving objects and 0 at rest; 0 left out", result.stdout)
        car, = json.loads((self.folder / "report.json").read_text())["objects"]
        self.assertEqual((car["label"], car["name"], car["class"]), ("car", "001-car", MOVING_CAR))
        self.assertAlmostEqual(car["size_m"][0], 4.4, delta=0.4)
        self.assertAlmostEqual(car["size_m"][1], 1.8, delta=0.3)
        world = tomllib.loads((place / "world.toml").read_text())
        self.assertEqual([entry["name"] for entry in world["object"]], ["001-car"])
        with open(place / "objects" / "001-car.csv", newline="", encoding="utf-8") as file:
            rows = [{key: float(value) for key, value in row.items()}
                    for row in csv.DictReader(file)]
        self.assertGreaterEqual(len(rows), SCANS - 4)
        for row in rows:
            self.assertAlmostEqual(row["x"], car_x(row["time"]), delta=0.3)
            self.assertAlmostEqual(row["y"], 3.5, delta=0.2)

        self.run_good("evaluate", "resimulate", place / "world.toml",
                      self.folder / "held-out" / "sequences" / "00", "--keep-moving", "--report",
                      self.folder / "held-out.json")
        motion = json.loads((self.folder / "held-out.json").read_text())["by_motion"]
        self.assertGreater(motion["moving"]["rays"], 1000)
        self.assertGreater(motion["moving"]["within"]["0.10"], 0.8)
        self.assertGreater(motion["still"]["within"]["0.10"], 0.95)

        text = (place / "world.toml").read_text()
        (place / "empty.toml").write_text(text[:text.index("[[object]]")])
        counts = {}
        for name in ("world", "empty"):
            self.run_good("simulate", place / f"{name}.toml", "--trajectory",
                          self.folder / "held_out.csv", "--sensor", SENSOR, "-o",
                          self.folder / name)
            counts[name] = self.points_on_car(self.folder / name)
        self.assertGreater(counts["world"], 500)
        self.assertEqual(counts["empty"], 0)

    def test_labelled_and_parked_cars_are_objects(self):
        self.write_street()
        (self.folder / "street.obj").write_text(boxes_obj(((-40, -9, 0), (60, 9, 8))))
        (self.folder / "drive.toml").write_text(
            'model = "street.obj"\n[[object]]\ngeometry = "car.obj"\n'
            f'class = {MOVING_CAR}\ntrajectory = "car.csv"\n'
            '[[object]]\ngeometry = "car.obj"\nclass = 10\nposition = [8, -5, 0.2]\n')
        self.run_good("simulate", self.folder / "drive.toml", "--sensor", self.sensor,
                      "--trajectory", self.folder / "ego.csv", "-o", self.folder / "drive")
        place = self.folder / "place"
        result = self.run_good("model", self.folder / "drive" / "sequences" / "00", "--traffic",
                               *LARGE_CELLS, "-o", place)
        self.assertIn("1 moving objects and 1 at rest; 0 left out", result.stdout)
        moving, parked = tomllib.loads((place / "world.toml").read_text())["object"]
        self.assertEqual((moving["name"], moving["class"]), ("001-car", MOVING_CAR))
        self.assertEqual((parked["name"], parked["class"]), ("002-car", 10))
        for value, expected in zip(parked["position"][:2], (8, -5)):
            self.assertAlmostEqual(value, expected, delta=0.2)
        counts = {}
        for name, x in (("here", 8), ("there", 16)):
            text = (place / "world.toml").read_text().replace(
                f"position = [{parked['position'][0]}", f"position = [{x}")
            (place / f"{name}.toml").write_text(text)
            self.run_good("simulate", place / f"{name}.toml", "--trajectory",
                          self.folder / "held_out.csv", "--sensor", SENSOR, "-o",
                          self.folder / name)
            file = self.folder / name / "sequences" / "00" / "velodyne" / "000000.bin"
            points = list(struct.iter_unpack("<4f", file.read_bytes()))
            counts[name] = [sum(abs(px + 5 * 0.35 - at) < 2 and abs(py + 5) < 1 and pz > -1.3
                                for px, py, pz, _ in points) for at in (8, 16)]
        self.assertGreater(counts["here"][0], 300)
        self.assertEqual(counts["here"][1], 0)
        self.assertEqual(counts["there"][0], 0)
        self.assertGreater(counts["there"][1], 50)

    def points_on_car(self, scans):
        """Points of the first scan above the ground where the car is then."""
        file = scans / "sequences" / "00" / "velodyne" / "000000.bin"
        time_s, count = 0.35, 0
        for x, y, z, _ in struct.iter_unpack("<4f", file.read_bytes()):
            count += (abs(x + 5 * time_s - car_x(time_s)) < 2.2 and abs(y - 3.5) < 0.9
                      and 0.4 < z + 1.8 < 1.6)
        return count

    def test_points_have_the_velocity_of_their_object(self):
        self.write_street()
        self.run_good("simulate", self.folder / "drive.toml", "--sensor", SENSOR,
                      "--trajectory", self.folder / "held_out.csv", "--rolling-shutter", "--format",
                      "ply", "--velocities", "--no-noise", "-o", self.folder / "flow")
        for number in range(6):
            rows = ply_rows(self.folder / "flow" / f"{number:06d}.ply")
            car = [row for row in rows if row["label"] == MOVING_CAR]
            self.assertGreater(len(car), 300)
            for row in rows:
                expected = CAR_MPS if row["label"] == MOVING_CAR else 0
                self.assertAlmostEqual(row["vx"], expected, delta=0.01)
                self.assertAlmostEqual(row["vy"], 0, delta=0.01)
                self.assertAlmostEqual(row["vz"], 0, delta=0.01)
            # Where the velocity leads within a scan's time, the car has a surface.
            begin_s = 0.35 + 0.1 * number
            off_m = []
            for row in car:
                at_s = begin_s + row["time"]  # relative to the scan's pose
                x = row["x"] + 5 * at_s + 0.1 * row["vx"] - car_x(at_s + 0.1)
                z = row["z"] + 1.8 - 0.2
                off_m.append(min(abs(abs(x) - 2.2), abs(abs(row["y"] - 3.5) - 0.9), abs(z - 1.5)))
            self.assertLess(sorted(off_m)[len(off_m) // 2], 0.03)

    def test_velocities_need_a_format_with_columns(self):
        self.write_street()
        self.run_bad(64, "simulate", self.folder / "drive.toml", "--trajectory",
                     self.folder / "held_out.csv", "--velocities", "-o", self.folder / "flow",
                     says=["velocities", "ply"])
        self.assertFalse((self.folder / "flow").exists())

    def test_errors_leave_nothing(self):
        place = self.folder / "place"
        self.run_bad(64, "model", self.folder / "cloud.ply", "--traffic", "-o", place,
                     says=["traffic"])
        self.run_bad(64, "model", self.folder / "cloud.ply", "--traffic", "--tile", "20", "-o",
                     place, says=["--tile", "--traffic"])
        self.assertFalse(place.exists())


if __name__ == "__main__":
    unittest.main()
