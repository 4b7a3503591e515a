#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks every input format against a reader that shares no code with the project.

  bench/input_kinds/input_kinds.py build/release REAL_DATA FORMATS OUT [--only NAME...]

REAL_DATA: folder with kitti-0005 and pandaset-002, unpacked; FORMATS: small files from the tests of
other projects. Files of each kind are written to OUT by independent writers (recordings.py) or come
from FORMATS, and are read by adasplats.read (meshes by `Mesh.load`) and by an independent reader
(readers.py). Expected are equal numbers of points (except for points marked as deleted) in the same
order, and coordinates within 40 um plus the resolution of float32 in a cloud of that size. Captures
and KITTI's raw drive are written by the project (`simulate`), since no packaged program writes them;
their independent readers follow the manufacturers' manuals and the data set's devkit.

Writes OUT/input_kinds.json (for bench/results) and prints a Markdown table. Needs /usr/bin/python3
with NumPy, pandas, Open3D and rosbag (Debian: python3-pandas, python3-open3d, python3-rosbag,
python3-sensor-msgs, python3-nav-msgs), node with the packages of package.json in the folder
ADASPLATS_NODE_MODULES, lz4, and editcap (tshark). A missing reader is an error.
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parents[1] / "tests" / "command_line")]
import readers  # noqa: E402
import recordings  # noqa: E402
from provenance import provenance_of  # noqa: E402

SCANS = 4
# Clouds are float32 relative to their origin; azimuths and poses are rounded before.
STEP_OF_FLOAT32 = 2.0**-23
ROUNDING_M = 4e-5
AS_THEY_STAND = {"sweep_points": "compensated"}


class Kinds:
    """Functions that return (our points, their points), by the name of the kind."""

    def __init__(self, build, real, formats, out):
        sys.path.insert(0, str(build / "python"))
        import adasplats

        self.ours, self.build = adasplats, build
        self.formats, self.out = formats, out
        self.drive = real / "kitti-0005" / "sequences" / "01_raw"
        self.panda = real / "pandaset-002"
        self.world = recordings.world_of(self.drive, SCANS)
        self.some = self.world[::23]

    def read(self, path, **options):
        return self.ours.read(path, **options).world_positions

    def rejection(self, wanted, *paths, **options):
        """The error for files that must be rejected, as text."""
        try:
            self.ours.read(paths, **options)
        except self.ours.Error as error:
            if wanted in str(error):
                return str(error).replace(str(self.formats) + "/", "")
            raise
        raise AssertionError("the file was read, but an error was expected")

    def table(self):
        """Yields (kind, writer of the file, other reader, function that reads with both)."""
        yield from self.clouds()
        yield from self.survey()
        yield from self.scans_of_sensors()
        yield from self.bags()
        yield from self.drives()
        yield from self.captures()
        yield from self.meshes()

    def of(self, name):
        found = sorted(self.formats.glob(name))
        assert len(found) == 1, f"{name}: {len(found)} files"
        return found[0]

    def clouds(self):
        made = [("PLY, ascii", "a.ply", {"write_ascii": True}), ("PLY, little endian", "b.ply", {}),
                ("PCD, ascii", "a.pcd", {"write_ascii": True}), ("PCD, binary", "b.pcd", {}),
                ("PCD, binary_compressed", "c.pcd", {"compressed": True}), ("PTS", "a.pts", {}),
                ("XYZ", "a.xyz", {})]
        for kind, name, options in made:
            def both(name=name, options=options):
                path = recordings.write_open3d(self.some, self.out / name, **options)
                return self.read(path), readers.open3d_legacy_points(path)
            yield kind, "Open3D", "Open3D", both

        def big_endian():
            path = recordings.write_big_endian_ply(self.some, self.out / "big.ply")
            return self.read(path), readers.open3d_legacy_points(path)
        yield "PLY, big endian, doubles", "NumPy", "Open3D", big_endian

        def csv():
            path = recordings.write_csv(self.some, self.out / "named.csv")
            return self.read(path), readers.text_points(path, 1, (1, 2, 0), ";")
        yield "CSV with named columns, `;`", "pandas", "NumPy", csv
        for kind, name in (("PCD 0.5", "*bunny.pcd"), ("PCD 0.7 of PCL", "*lamppost.pcd")):
            def real(name=name):
                return self.read(self.of(name)), readers.open3d_legacy_points(self.of(name))
            yield kind, "PCL", "Open3D", real

        def pts():
            path = self.of("*site_56_8.pts")
            return self.read(path), readers.text_points(path, 1)
        yield "PTS of a survey", "Leica's, by PDAL", "NumPy", pts

        def stations():
            path = recordings.write_ptx(self.some, self.out / "stations.ptx")
            return self.read(path), readers.ptx_points(path)
        yield "PTX, two stations", "NumPy", "NumPy", stations

        def ptx():
            path = self.of("*complex-transform.ptx")
            return self.read(path), readers.ptx_points(path)
        yield "PTX with a matrix", "PDAL's tests", "NumPy", ptx

    def survey(self):
        las = (("LAS 1.0, format 1", "*lasR*Example.las"),
               ("LAS 1.2, format 3", "*test__data__las__simple.las"),
               ("LAS 1.4, format 6", "*wontcompress3.las"))
        for kind, name in las:
            def both(name=name):
                return self.read(self.of(name)), readers.las_points(self.of(name))
            yield kind, "others", "NumPy", both
        laz = (("LAZ 1.0, format 0", "*point10-1.0.laz"), ("LAZ 1.2, format 3", "laspy*simple.laz"),
               ("LAZ with extra bytes", "laspy*extra.laz"), ("LAZ 1.4, format 1", "*point-time-1.4.las.laz"),
               ("LAZ 1.4, format 8", "*pdrf8-1.4.laz"))
        for kind, name in laz:
            def both(name=name):
                return (self.read(self.of(name), max_distance_m=1e12),
                        readers.node_points("laz", self.of(name)))
            yield kind, "LASzip", "laz-perf", both

        def copc():
            path = self.of("*example.copc.laz")
            # The other reader returns nodes in another order.
            return tuple(p[np.lexsort(np.round(p, 4).T)]
                         for p in (self.read(path), readers.node_points("copc", path)))
        yield "COPC", "lasR", "copc.js", copc
        yield "LAS 1.4, format 7, heights in feet", "others", "", lambda: self.rejection(
            "its coordinates are not in metres", self.of("*autzen-bmx-2010.las"))
        e57 = (("E57, floats", "*tinyCartesianFloatRgb.e57"),
               ("E57, scaled integers, three scans with poses", "*las2e57_no_images_tag.e57"),
               ("E57, spherical", "*tiny_spherical.e57"))
        for kind, name in e57:
            def both(name=name):
                return self.read(self.of(name)), readers.e57_points(self.of(name))
            yield kind, "others", "NumPy", both

    def scans_of_sensors(self):
        scan = self.drive / "velodyne" / "000000.bin"

        def kitti():
            return self.read(scan), readers.float_rows(scan, 4)
        yield "KITTI .bin", "KITTI", "NumPy", kitti

        def nuscenes():
            rows = np.zeros((len(np.fromfile(scan, "<f4")) // 4, 5), "<f4")
            rows[:, :3], rows[:, 4] = readers.float_rows(scan, 4), np.arange(len(rows)) % 32
            path = self.out / "n.pcd.bin"
            rows.tofile(path)
            return self.read(path), readers.float_rows(path, 5)
        yield "nuScenes .pcd.bin", "NumPy", "NumPy", nuscenes

    def bags(self):
        def mcap(compression):
            path = recordings.write_mcap(self.drive, SCANS, self.out / f"{compression}.mcap", compression)
            return self.read(path), readers.node_points("mcap", path)
        for compression in ("none", "lz4", "zstd"):
            yield (f"MCAP, {compression}", "Foxglove's packages", "Foxglove's packages",
                   lambda c=compression: mcap(c))

        def rosbag(compression):
            path = recordings.write_rosbag(self.drive, SCANS, self.out / f"{compression}.bag", compression)
            return self.read(path), readers.rosbag_points(path)
        for compression in ("none", "bz2", "lz4"):
            yield (f"ROS 1 bag, {compression}", "rosbag", "rosbag", lambda c=compression: rosbag(c))

        def db3():
            folder = recordings.write_db3(self.drive, SCANS, self.out / "db3")
            return self.read(folder), readers.db3_points(folder / "drive_0.db3")
        yield "ROS 2 bag, SQLite", "SQLite, Foxglove's packages", "SQLite, Foxglove's packages", db3

        def ros2():
            folder = recordings.write_ros2_mcap(self.drive, SCANS, self.out / "ros2")
            return (self.read(folder),
                    readers.node_points("mcap", folder / "drive_0.mcap"))
        yield "ROS 2 bag, MCAP", "Foxglove's packages", "Foxglove's packages", ros2

    def drives(self):
        def sequence():
            folder = recordings.part_of(self.drive, SCANS, self.out / "sequence")
            return self.read(folder), readers.sequence_points(folder)
        yield "SemanticKITTI sequence", "KITTI", "NumPy", sequence
        for form, name in (("tum", "PCD a scan, poses as TUM"), ("csv", "PCD a scan, poses as EuRoC's CSV")):
            def scans(form=form):
                folder = recordings.write_scans_and_trajectory(self.drive, SCANS, self.out / form, form)
                return self.read(folder / "scans", trajectory=folder / f"poses.{form}"), self.world
            yield name, "Open3D, NumPy", "NumPy", scans

        def raw():
            folder = self.out / "raw"
            self.simulate(folder, "kitti-raw")
            drive, = folder.glob("*/*_sync")
            return (self.read(drive),
                    readers.kitti_raw_points(drive, drive.parent / "calib_imu_to_velo.txt"))
        yield "KITTI raw drive", "`simulate`", "NumPy, after the devkit", raw

        def panda():
            frames = self.out / "frames"
            frames.mkdir()
            for k in range(40, 40 + SCANS):
                (frames / f"{k:03d}.ply").symlink_to(self.panda / "frames" / f"{k:03d}.ply")
            recordings.tree("pandaset", frames, self.panda / "vehicle_trajectory.csv",
                            self.panda / "classes.csv", self.out / "panda")
            return (self.read(self.out / "panda"),
                    readers.pandaset_points(self.out / "panda"))
        yield "PandaSet sequence", "pandas", "pandas", panda

        def nuscenes():
            part = recordings.part_of(self.drive, SCANS, self.out / "for_nuscenes")
            recordings.tree("nuscenes", part, self.out / "nuscenes", "--every", 2)
            return (self.read(self.out / "nuscenes", scene="scene-0061"),
                    readers.nuscenes_points(self.out / "nuscenes"))
        yield "nuScenes scene", "NumPy, json", "NumPy, json", nuscenes

        def timed():
            places, times = recordings.pandaset_frame(self.panda / "frames" / "040.ply")
            las = recordings.write_las_with_times(places, times, self.out / "timed.las")
            return (self.read(las, trajectory=self.panda / "vehicle_trajectory.csv", trust_origins=True),
                    readers.las_points(las))
        yield "LAS with GPS times and a trajectory", "NumPy", "NumPy", timed

    def simulate(self, out, form, *options, sensor="velodyne-hdl-64e-kitti"):
        """Simulated scans of the drive's points."""
        program = self.build / "bin" / "adasplats"
        model = self.out / "model.ply"
        if not model.exists():
            self.run([program, "model", self.drive, "--scans", "0:2", "-o", model])
        poses = self.out / "poses.csv"
        lines = ["time,x,y,z,qw,qx,qy,qz"]
        step = 0.0 if form == "pcap" else 0.5  # Packets are placed in the frame of a stationary sensor.
        for k in range(SCANS):
            lines.append(f"{0.1 * k},{step * k},0,0,1,0,0,0")
        poses.write_text("\n".join(lines) + "\n", encoding="ascii")
        self.run([program, "simulate", model, "--trajectory", poses, "--sensor", sensor, "--format", form,
                  *options, "-o", out])

    @staticmethod
    def run(words):
        subprocess.run([str(w) for w in words], check=True, stdout=subprocess.DEVNULL)

    def still(self, capture, calibration):
        return self.read(capture, packet_sensor=calibration, trajectory=capture.with_name("poses.csv"),
                         **AS_THEY_STAND)

    def captures(self):
        def velodyne(convert):
            folder = self.out / ("pcapng" if convert else "pcap")
            self.simulate(folder, "pcap", sensor="velodyne-vlp-16")
            capture = folder / "drive.pcap"
            theirs = readers.vlp16_points(capture)
            if convert:
                capture = folder / "drive.pcapng"
                self.run(["editcap", folder / "drive.pcap", capture])
            return self.still(capture, folder / "calibration.yaml"), theirs
        yield "PCAP of a Velodyne", "`simulate`", "after the manual", lambda: velodyne(False)
        yield "PCAPNG of a Velodyne", "`simulate`, editcap", "after the manual", lambda: velodyne(True)

        def ouster():
            folder = self.out / "ouster"
            self.simulate(folder, "pcap", sensor="ouster-os1-64")
            theirs = readers.ouster_points(folder / "drive.pcap", folder / "metadata.json")
            return self.still(folder / "drive.pcap", folder / "metadata.json"), theirs
        yield "PCAP of an Ouster", "`simulate`", "after the manual", ouster

    def meshes(self):
        for kind, name in (("mesh as OBJ", "m.obj"), ("mesh as PLY", "m.ply")):
            def both(name=name):
                path = recordings.write_mesh(self.some, self.out / name)
                mesh = self.ours.Mesh.load(path)
                return mesh.vertices[mesh.triangles].reshape(-1, 3), readers.open3d_triangles(path)
            yield kind, "Open3D", "Open3D", both


def compared(ours, theirs):
    same = len(ours) == len(theirs)
    apart = float(np.abs(ours - theirs).max()) if same and len(ours) else None
    allowed = ROUNDING_M + STEP_OF_FLOAT32 * float(np.ptp(theirs, axis=0).max())
    return {"points": len(ours), "points_other_reader": len(theirs), "largest_difference_m": apart,
            "allowed_difference_m": allowed, "equal": bool(same and len(ours) and apart <= allowed),
            "shown": None if apart is None else f"{1e6 * apart:.2g} um"}


def shown(row):
    """Number of points and difference as text."""
    if "points" not in row:
        return "rejected" if "refused" in row else row["error"], "-"
    other = row["points_other_reader"]
    there = "" if row["points"] == other else f" ({other:,} in the other reader)"
    return f"{row['points']:,}{there}", row["shown"] or "-"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    for name in ("build", "real", "formats", "out"):
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--only", nargs="*")
    words = parser.parse_args()
    shutil.rmtree(words.out, ignore_errors=True)
    words.out.mkdir(parents=True)
    kinds = Kinds(words.build.resolve(), words.real, words.formats, words.out)
    rows = []
    print("| kind | written by | other reader | points | largest difference |\n|---|---|---|--:|--:|")
    for name, writer, reader, both in kinds.table():
        if words.only and name not in words.only:
            continue
        try:
            found = both()
            row = {"equal": True, "refused": found} if isinstance(found, str) else compared(*found)
        except Exception as error:  # Continue with the next kind; the row reports the error.
            row = {"equal": False, "error": f"{type(error).__name__}: {error}"}
        rows.append({"name": name, "written_by": writer, "other_reader": reader, **row})
        print("| " + " | ".join((name, writer, reader, *shown(row))) + " |", flush=True)
    good = sum(row["equal"] for row in rows)
    provenance = provenance_of(words.build / "bin" / "adasplats")
    provenance["command"] = "input_kinds.py BUILD REAL_DATA FORMATS OUT"
    report = {"kinds": rows, "provenance": provenance}
    (words.out / "input_kinds.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    print(f"{good} of {len(rows)} kinds agree with their other readers, or are rejected as "
          "expected")
    return 0 if good == len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
