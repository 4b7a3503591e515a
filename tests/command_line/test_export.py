# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""export: which input can become what; tests/exports reads the files with other programs."""
import csv
import json
import resource
import shutil
import struct
import unittest

from support import AV2_LOG, KNOWN_SENSOR, SENSOR, ProgramTest, run, tree_digest


class Export(ProgramTest):
    def export(self, input_path, name, *arguments):
        """Exports to a file of that name; gives back its path."""
        path = self.folder / name
        self.run_good("export", input_path, "-o", path, *arguments)
        return path

    def header(self, path):
        return path.read_bytes().partition(b"end_header\n")[0].decode().splitlines()

    def test_a_model(self):
        model = self.model()
        splats = next(line for line in self.header(model) if line.startswith("element vertex"))
        for kind, scales in [("gaussian-3d", 3), ("gaussian-2d", 2)]:
            lines = self.header(self.export(model, f"{kind}.ply", "--format", kind))
            self.assertIn(splats, lines)
            self.assertIn("comment adasplats.origin 0 0 0", lines)
            self.assertEqual(sum("property float scale_" in line for line in lines), scales)
        glb = self.export(model, "centers.glb")
        self.assertEqual(glb.read_bytes()[:4], b"glTF")
        report = self.report("export", model, "-o", self.folder / "again.glb")
        self.assertEqual(f"element vertex {report['splats']}", splats)
        self.assertEqual(report["bytes"], glb.stat().st_size)
        self.assertEqual((self.folder / "again.glb").read_bytes(), glb.read_bytes())

    def test_colors(self):
        model = self.model()
        by_class = self.export(model, "a.glb").read_bytes()
        self.assertEqual(self.export(model, "b.glb", "--color", "class").read_bytes(), by_class)
        self.assertNotEqual(self.export(model, "c.glb", "--color", "height").read_bytes(), by_class)
        self.run_bad(64, "export", model, "-o", self.folder / "d.glb", "--color", "intensity",
                     says=["color by intensity", "no intensities"])
        self.run_bad(64, "export", self.cloud, "-o", self.folder / "d.glb", "--color", "class",
                     says=["label scheme"])
        self.run_bad(64, "export", self.cloud, "-o", self.folder / "d.ply", "--color", "height",
                     says=["color has no effect on ply", "gaussian-3d"])
        self.assertNotIn("d.glb", self.names())

    def test_a_cloud_and_a_sequence(self):
        scans = self.simulate(self.model())
        for source in (self.cloud, scans, scans / "sequences" / "00"):
            points = self.report("export", source, "-o", self.folder / "points.ply")["points"]
            self.assertEqual(self.report("export", source, "-o", self.folder / "p.glb")["points"],
                             points)
            self.assertIn(f"element vertex {points}", self.header(self.folder / "points.ply"))
            sizes = []
            for name in ("p.las", "p.laz"):
                self.assertEqual(self.report("export", source, "-o", self.folder / name)["points"],
                                 points)
                self.assertEqual(self.report("info", self.folder / name)["files"][0]["points"], points)
                sizes.append((self.folder / name).stat().st_size)
            self.assertLess(sizes[1], 0.6 * sizes[0])
        both = [self.export(scans, "a.mcap"), self.export(scans / "sequences" / "00", "b.mcap")]
        self.assertEqual(both[0].read_bytes(), both[1].read_bytes())
        self.assertEqual(both[0].read_bytes()[:8], b"\x89MCAP0\r\n")
        self.assertEqual(both[0].read_bytes()[-8:], b"\x89MCAP0\r\n")
        report = self.report("export", scans, "-o", self.folder / "c.mcap", "--scans", "1:9")
        self.assertEqual(report["scans"], 2)
        self.run_bad(64, "export", scans, "-o", self.folder / "d.mcap", "--scans", "3:1")

    def test_columns_of_the_file_are_kept_or_listed(self):
        cloud = self.folder / "all.csv"
        cloud.write_text("x,y,z,intensity,classification,gps_time,return_number,"
                         "number_of_returns,user_data,red,green,blue,nx,ny,nz,echo\n" +
                         "".join(f"{k},{k % 3},{k / 9},{k},{k % 2},{k / 7},1,2,{k},{k},2,3,0,0,1,"
                                 f"{k / 3}\n" for k in range(20)))
        for name, fields in [("a.ply", ["gps_time f64", "return_number f64", "red u8", "nx f64"]),
                             ("a.las", ["gps_time f64", "return_number u8", "red u16", "nx f64"]),
                             ("a.laz", ["user_data u8", "number_of_returns u8", "blue u16"])]:
            path = self.export(cloud, name)
            found = self.report("info", path)["files"][0]["fields"]
            for field in fields + ["echo f64"]:
                self.assertIn(field, found, name)
            again = self.export(path, "b.ply")
            self.assertIn("echo f64", self.report("info", again)["files"][0]["fields"])
        whole = self.export(cloud, "whole.csv")
        for name in ("a.pcd", "a.csv"):
            again = self.export(self.export(whole, name), "again.csv")
            self.assertEqual(again.read_bytes(), whole.read_bytes(), name)
        said = self.run_warned("user_data", "export", cloud, "-o", self.folder / "a.glb").stderr
        for name in ("gps_time", "return_number", "nx", "echo"):
            self.assertIn(name, said)
        self.assertNotIn("red", said)

    def test_odd_names_of_columns(self):
        cloud = self.folder / "odd.csv"
        cloud.write_text('x;y;z;my,own;;"q"\n1;2;3;4;5;6\n2;3;4;5;6;7\n')
        for name in ("a.ply", "a.pcd", "a.csv", "a.las"):
            found = self.report("info", self.export(cloud, name))["files"][0]["fields"]
            self.assertIn("my", found, name)
            self.assertIn("column_5", found, name)

    def test_models_keep_colours(self):
        cloud = self.folder / "colored.csv"
        cloud.write_text("x,y,z,red,green,blue\n" + "".join(
            f"{k % 40 * 0.05},{k // 40 * 0.05},0,{200 if k % 40 < 20 else 10},60,70\n"
            for k in range(1600)))
        model = self.folder / "colored.ply"
        self.run_warned("sensor positions", "model", cloud, "-o", model)
        self.assertIn("property uchar red", self.header(model))
        self.run_good("render", model, "-o", self.folder / "a.png", "--width", "64", "--height", "48")
        for color in ("rgb", "height"):
            self.run_good("render", model, "-o", self.folder / f"{color}.png", "--width", "64", "--height", "48",
                          "--color", color)
        self.assertEqual((self.folder / "a.png").read_bytes(),
                         (self.folder / "rgb.png").read_bytes())
        self.assertNotEqual((self.folder / "a.png").read_bytes(),
                            (self.folder / "height.png").read_bytes())
        self.assertNotEqual(self.export(model, "a.glb").read_bytes(),
                            self.export(model, "b.glb", "--color", "height").read_bytes())
        self.run_bad(64, "render", self.model(), "-o", self.folder / "b.png", "--color", "rgb",
                     says=["has no colours", "'adasplats model'"])

    def test_label_schemes_are_kept(self):
        self.sensor.write_text(KNOWN_SENSOR)
        sequence = self.simulate(self.model()) / "sequences" / "00"
        for name in ("s.ply", "s.las", "s.laz", "s.pcd", "s.csv"):
            self.assertIn("40 road", self.run_good("info", self.export(sequence, name)).stdout)
        self.assertIn(b"semantickitti", self.export(sequence, "s.mcap").read_bytes())
        self.assertIn("40 road", self.run_warned("s.mcap", "info", self.folder / "s.mcap").stdout)

    def test_recorded_scans_become_trees_of_data_sets(self):
        """A folder of scans with a trajectory, in each tree, and back: the points and the poses."""
        self.sensor.write_text(KNOWN_SENSOR)
        frames = self.simulate(self.model(), "frames", "--format", "ply")
        options = ["--trajectory", frames / "poses.csv", "--points-in", "sensor", "--own-body", "0",
                   "--driven-path", "0"]
        whole = self.folder / "whole.csv"
        self.assertEqual(run("export", frames, "-o", whole, *options).returncode, 0)
        for kind, inside, kept in [
                ("semantickitti", "sequences/00", "positions, intensities, classes and instances"),
                ("kitti-raw", "1970_01_01/1970_01_01_drive_0001_sync", "positions and intensities"),
                ("nuscenes", "", "positions, intensities, rings and classes"),
                ("pandaset", "001", "positions, intensities and classes"),
                ("argoverse2", AV2_LOG, "positions, intensities and rings")]:
            tree = self.folder / kind
            said = run("export", frames, "-o", tree, "--format", kind, *options[:4]).stderr
            self.assertIn("not exported: fields of the points other than " + kept, said)
            self.assertNotIn("is not recognised", said)
            with_classes = kind in ("semantickitti", "pandaset")
            again = self.folder / f"{kind}.csv"
            done = run("export", tree / inside, "-o", again, "--own-body", "0", "--driven-path",
                       "0")
            self.assertEqual(done.returncode, 0, done.stderr)
            first, second = self.rows(whole), self.rows(again)
            self.assertEqual(len(first), len(second), kind)
            for a, b in zip(first, second):
                for name in ["scan_index"] + (["label"] if with_classes else []):
                    self.assertEqual(a.get(name), b.get(name), (kind, name))
                if kind != "kitti-raw":  # its first pose is at the origin
                    for name in "xyz":
                        self.assertAlmostEqual(float(a[name]), float(b[name]), delta=2e-5)
        self.assertIn("40 road", run("info", self.folder / "semantickitti").stdout)
        self.sensor.write_text(SENSOR)
        unknown = self.simulate(self.folder / "model.ply", "unknown", "--format", "ply")
        for kind, kept in [("nuscenes", "positions, intensities and classes"),
                           ("argoverse2", "positions and intensities")]:
            said = run("export", unknown, "-o", self.folder / f"unknown {kind}", "--format", kind,
                       *options[:4]).stderr
            self.assertIn("is not recognised", said)
            self.assertIn("not exported: fields of the points other than " + kept, said)
        self.run_bad(64, "export", frames, "-o", self.folder / "none", "--format", "nuscenes",
                     says=["--trajectory"])

    def test_times_of_points_of_a_drive_are_kept(self):
        """In files of points, and in MCAP, from which they are used again."""
        self.sensor.write_text(KNOWN_SENSOR)
        self.poses.write_text("time,x,y,z,qw,qx,qy,qz\n" + "".join(
            f"{100 + 0.1 * k},{4 + 0.5 * k},0,2,1,0,0,0\n" for k in range(4)))
        frames = self.simulate(self.model(), "frames", "--format", "ply", "--rolling-shutter",
                               "--no-noise")
        drive = ["--trajectory", self.poses, "--points-in", "sensor", "--sweep-points", "measured",
                 "--scan-times", self.folder / "times.txt"]
        (self.folder / "times.txt").write_text("".join(f"{100 + 0.1 * k}\n" for k in range(4)))
        keep = ["--own-body", "0", "--driven-path", "0"]
        done = run("export", frames, "-o", self.folder / "a.csv", *drive, *keep)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("times are exported", done.stderr)
        points = self.rows(self.folder / "a.csv")
        for point in points:
            late = float(point["timestamp"]) - 100 - 0.1 * int(point["scan_index"])
            self.assertLess(abs(late), 0.0501)
            # The sensor drives at 5 m/s.
            at = 4 + 5 * (float(point["timestamp"]) - 100)
            self.assertAlmostEqual(float(point["x_lidar_position"]), at, delta=1e-3)
        self.assertGreater(len({point["timestamp"] for point in points}), 100)
        done = run("export", frames, "-o", self.folder / "a.mcap", *drive)
        self.assertIn("intensities, times, classes", done.stderr)
        for source, name, options in [("a.mcap", "b.csv", ["--sweep-points", "compensated", *keep]),
                                      ("a.csv", "b.las", []), ("b.las", "c.csv", [])]:
            done = run("export", self.folder / source, "-o", self.folder / name, *options)
            self.assertEqual(done.returncode, 0, done.stderr)
        for name, column in [("b.csv", "timestamp"), ("c.csv", "gps_time")]:
            again = self.rows(self.folder / name)
            self.assertEqual(len(points), len(again))
            for a, b in zip(points, again):
                self.assertAlmostEqual(float(a["timestamp"]), float(b[column]), delta=1e-6)
                for axis in ("x", "x_lidar_position"):
                    self.assertAlmostEqual(float(a[axis]), float(b[axis]), delta=2e-3)

    def rows(self, path):
        with open(path, encoding="utf-8") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))

    def test_simulate_writes_the_same_format(self):
        model = self.model()
        scans = self.simulate(model, "scans", "--format", "mcap")
        again = self.simulate(model, "again", "--format", "mcap", "--threads", "1")
        self.assertEqual(sorted(path.name for path in scans.iterdir()),
                         ["adasplats.json", "poses.csv", "scans.mcap"])
        self.assertEqual(tree_digest(scans), tree_digest(again))
        self.run_bad(65, "export", scans, "-o", self.folder / "a.mcap", says=["scans.mcap"])

    def test_clouds_of_drivers_are_read_again(self):
        self.sensor.write_text(KNOWN_SENSOR)
        model = self.model()
        self.poses.write_text(self.poses.read_text().replace("\n0.", "\n7."))
        points = {}
        for driver in ("adasplats", "velodyne", "ouster", "hesai", "nebula"):
            scans = self.simulate(model, driver, "--format", "mcap", "--rolling-shutter", "--mount",
                                  "0,0,0.1", "--driver", driver)
            done = run("export", scans / "scans.mcap", "-o", self.folder / "out.csv", "--points-in",
                       "sensor", "--sweep-points", "measured")
            self.assertEqual(done.returncode, 0, done.stderr)
            rows = self.rows(self.folder / "out.csv")
            points[driver] = [sorted(float(row[axis]) for row in rows) for axis in "xyz"]
            for found, expected in zip(points[driver], points["adasplats"]):
                self.assertEqual(len(found), len(expected), driver)
                self.assertLess(max(abs(a - b) for a, b in zip(found, expected)), 1e-3, driver)

    def test_what_drivers_do_not_publish(self):
        model = self.model()
        before = self.names()
        bad = lambda *words, says: self.run_bad(64, "simulate", model, "--trajectory", self.poses,
                                                "-o", self.folder / "scans", *words, says=says)
        mcap = ["--format", "mcap", "--driver"]
        bad(*mcap, "ouster", "--sensor", "livox-mid-40", says=["livox-mid-40", "--driver adasplats"])
        bad("--driver", "ouster", says=["--driver", "--format mcap"])
        bad(*mcap, "velodyne", "--velocities", says=["--velocities", "--driver"])
        bad(*mcap, "hesai", "--rolling-shutter", "--points", "deskewed", says=["--points raw"])
        bad(*mcap, "ouster", "--returns", "2", says=["--returns 1"])
        bad(*mcap, "ouster", "--rotation-rate", "0.1", says=["4.29 s", "--rotation-rate"])
        self.assertEqual(self.names(), before)

    def test_times_that_messages_do_not_hold(self):
        self.poses.write_text("time,x,y,z,qw,qx,qy,qz\n-1,4,0,2,1,0,0,0\n")
        model = self.model()
        before = self.names()
        self.run_bad(65, "simulate", model, "--trajectory", self.poses, "--sensor", self.sensor,
                     "-o", self.folder / "scans", "--format", "mcap", says=["-1.0", "ROS"])
        self.assertEqual(self.names(), before)

    def test_what_cannot_be(self):
        model = self.model()
        bad = lambda source, name, *words, says: self.run_bad(64, "export", source, "-o",
                                                              self.folder / name, *words, says=says)
        bad(model, "out.ply", says=["splat model", "gaussian-3d, gaussian-2d, glb, usd or 3d-tiles",
                                      "give the format"])
        bad(model, "out.mcap", says=["splat model", "gaussian-3d, gaussian-2d, glb, usd or 3d-tiles"])
        bad(self.cloud, "out", says=["a name without an ending is none of them"])
        bad(model, "out.ply", "--format", "ply", says=["not as ply"])
        bad(self.cloud, "out.mcap", says=["point cloud", "glb, ply, las, laz, pcd or csv"])
        bad(self.cloud, "out.ply", "--format", "gaussian-3d", says=["not as gaussian-3d"])
        bad(self.cloud, "out.ply", "--format", "gausian-3d", says=["did you mean 'gaussian-3d'"])
        bad(model, "model.ply", "--format", "gaussian-3d", says=["is also an input"])
        (self.folder / "mesh.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        bad(self.folder / "mesh.obj", "out.glb", says=["triangle mesh"])
        self.run_bad(66, "export", self.folder / "lost.ply", "-o", self.folder / "out.glb",
                     says=["lost.ply"])
        self.run_bad(73, "export", self.cloud, "-o", self.folder / "no such" / "a.glb")
        self.assertFalse(any(name.startswith("out") for name in self.names()))

    def test_tiles_of_a_model_and_of_a_city(self):
        model, city = self.model(), self.folder / "city"
        self.run_good("model", self.cloud, "--labels", "semantickitti", "--tile", "6", "--halo", "20",
                      "-o", city)
        for source in (model, city):
            tiles = self.folder / f"tiles of {source.name}"
            report = self.report("export", source, "-o", tiles, "--format", "3d-tiles")
            root = json.loads((tiles / "tileset.json").read_text())["root"]
            self.assertEqual(root["refine"], "REPLACE")
            self.assertIn("not georeferenced: the model has no coordinate system", report["place"])
            again = self.folder / "again"
            self.run_bad(64, "export", source, "-o", again, says=["without an ending"])
            self.run_good("export", source, "-o", again, "--format", "3d-tiles", "--threads", "3")
            self.assertEqual(tree_digest(tiles), tree_digest(again))
            shutil.rmtree(again)
        splats = sum(tile["splats"] for tile in json.loads((city / "city.json").read_text())["tiles"])
        self.assertEqual(report["splats"], splats)

    def test_tiles_that_cannot_be_written(self):
        city = self.folder / "city"
        self.run_good("model", self.cloud, "--labels", "semantickitti", "--tile", "6", "--halo", "20",
                      "-o", city)
        empty, full = self.folder / "empty.ply", self.folder / "full"
        columns = "".join(f"property float {name}\n" for name in "x y z nx ny nz radius".split())
        empty.write_text(f"ply\nformat ascii 1.0\nelement vertex 0\n{columns}end_header\n")
        full.mkdir()
        (full / "mine.txt").write_text("mine")
        lost = max((city / "tiles").iterdir(), key=lambda path: path.stat().st_size)
        lost.unlink()
        before = self.names()
        tiles = ["-o", self.folder / "tiles", "--format", "3d-tiles"]
        self.run_bad(65, "export", empty, *tiles, says=["empty.ply: has no splats"])
        self.run_bad(64, "export", self.cloud, *tiles, says=["point cloud", "not as 3d-tiles"])
        self.run_bad(73, "export", city, "-o", full, "--format", "3d-tiles", says=["full"])
        self.run_bad(64, "export", city, "-o", city / "tiles", "--format", "3d-tiles", says=["city"])
        self.run_bad(66, "export", city, *tiles, says=[lost.name])
        self.assertEqual(self.names(), before)
        self.assertEqual([path.name for path in full.iterdir()], ["mine.txt"])

    def test_points_that_are_not_finite(self):
        sequence = self.simulate(self.model()) / "sequences" / "00"
        scan = sequence / "velodyne" / "000001.bin"
        content = bytearray(scan.read_bytes())
        struct.pack_into("<f", content, 16 * 7, float("nan"))
        scan.write_bytes(content)
        report = self.report("export", sequence, "-o", self.folder / "a.mcap")
        self.assertEqual((report["scans"], report["points_dropped"]), (3, 1))
        self.run_bad(65, "export", sequence, "-o", self.folder / "b.mcap", "--strict",
                     says=["000001.bin", "not finite"])
        self.assertNotIn("b.mcap", self.names())

    def test_no_points_and_one(self):
        cloud = self.folder / "few.csv"
        for rows, count in [("", 0), ("1,2,3\n", 1)]:
            cloud.write_text("x,y,z\n" + rows)
            for name in ["few.glb", "few.ply", "few.las", "few.laz"]:
                report = self.report("export", cloud, "-o", self.folder / name)
                self.assertEqual(report["points"], count)

    def test_disk_full(self):
        model = self.model()
        scans = self.simulate(model)
        before = self.names()
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2048, 2048))
        for source, name, words in [(model, "a.ply", ["--format", "gaussian-3d"]),
                                    (model, "a.glb", []), (scans, "a.mcap", [])]:
            self.run_bad(74, "export", source, "-o", self.folder / name, *words, preexec_fn=limit,
                         says=[name])
            self.assertEqual(self.names(), before)

    def test_far_from_zero(self):
        cloud = self.folder / "far.csv"
        cloud.write_text("x,y,z\n" + "".join(f"{448262 + k},5411932,{k}\n" for k in range(9)))
        glb = self.export(cloud, "far.glb").read_bytes()
        self.assertIn(b'"origin":[448000,5412000,0]', glb)

    def test_scans_as_las_keep_intensities_above_1(self):
        model = self.folder / "model.ply"
        header = ["ply", "format ascii 1.0", "element vertex 441"]
        header += [f"property float {name}" for name in "x y z nx ny nz radius intensity".split()]
        splats = [f"{x} {y} 0 0 0 1 0.8 {200 if x > 0 else 100}"
                  for x in range(-10, 11) for y in range(-10, 11)]
        model.write_text("\n".join([*header, "end_header", *splats, ""]))
        las = (self.simulate(model, "scans", "--format", "las") / "000000.las").read_bytes()
        start, = struct.unpack_from("<I", las, 96)
        size, = struct.unpack_from("<H", las, 105)
        found = {struct.unpack_from("<H", las, place + 12)[0]
                 for place in range(start, len(las) - size + 1, size)}
        self.assertGreater(len(found), 0)
        self.assertLessEqual(max(found), 200)


if __name__ == "__main__":
    unittest.main()
