#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""From a recording of each kind to an evaluated model, with one command line each.

  bench/input_kinds/drives.py PROGRAM REAL_DATA OUT [--only NAME...]

Writes the first scans of kitti-0005 (of pandaset-002 for PandaSet's own kind and for points with
times) as each kind of recording with the writers of recordings.py, makes a model of every other scan
and casts the held-out ones in it: the command lines of docs/formats.md. The same scans should give
the same figures in every kind, except for labels, which only some kinds have (they remove moving
objects). Captures and KITTI's raw drive are made of simulated scans.

Writes OUT/drives.json (for bench/results) and prints a Markdown table. Requirements: as
input_kinds.py.
"""
import argparse
import json
import pathlib
import shlex
import shutil
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
import recordings  # noqa: E402
from provenance import provenance_of  # noqa: E402

SCANS = 12


class Drives:
    def __init__(self, program, real, out):
        self.program, self.out = program, out
        self.kitti = real / "kitti-0005" / "sequences" / "00"
        self.panda = real / "pandaset-002"

    def table(self):
        """Yields (kind, source of the scans, writer of the input, reader options)."""
        kitti, out = self.kitti, self.out
        yield ("SemanticKITTI sequence", "KITTI",
               lambda: recordings.part_of(kitti, SCANS, out / "sequence"), [])
        yield ("MCAP", "KITTI",
               lambda: recordings.write_mcap(kitti, SCANS, out / "drive.mcap", "zstd"), [])
        yield ("ROS 1 bag", "KITTI",
               lambda: recordings.write_rosbag(kitti, SCANS, out / "drive.bag", "lz4"), [])
        yield "ROS 2 bag", "KITTI", lambda: recordings.write_db3(kitti, SCANS, out / "bag"), []
        yield ("PCD a scan, poses as TUM", "KITTI", lambda: self.scans("tum"),
               ["--trajectory", out / "tum" / "poses.tum"])
        yield ("PCD a scan, poses as EuRoC's CSV", "KITTI", lambda: self.scans("csv"),
               ["--trajectory", out / "csv" / "poses.csv"])
        yield "nuScenes scene", "KITTI", self.nuscenes, ["--scene", "scene-0061"]
        yield "PandaSet sequence", "PandaSet", self.pandaset, []
        yield ("LAS with GPS times and a trajectory", "PandaSet", self.timed,
               ["--trajectory", out / "part.csv", "--mount", "0.019,0.725,1.887"])
        yield "PTX stations", "KITTI", self.stations, []
        yield "KITTI raw drive", "simulated", lambda: self.simulated("kitti-raw", "*/*_sync"), []
        capture = out / "pcap"
        yield ("PCAP", "simulated", lambda: self.simulated("pcap", "drive.pcap"),
               ["--packet-sensor", capture / "calibration-s3.yaml", "--trajectory", capture / "poses.csv"])

    def scans(self, form):
        return recordings.write_scans_and_trajectory(self.kitti, SCANS, self.out / form, form) / "scans"

    def nuscenes(self):
        part = recordings.part_of(self.kitti, SCANS, self.out / "for_nuscenes")
        recordings.tree("nuscenes", part, self.out / "nuscenes", "--every", 2)
        return self.out / "nuscenes"

    def frames(self):
        return [self.panda / "frames" / f"{k:03d}.ply" for k in range(40, 40 + SCANS)]

    def pandaset(self):
        frames = self.out / "frames"
        frames.mkdir()
        for file in self.frames():
            (frames / file.name).symlink_to(file)
        recordings.tree("pandaset", frames, self.panda / "vehicle_trajectory.csv",
                        self.panda / "classes.csv", self.out / "panda")
        return self.out / "panda"

    def timed(self):
        """Two files, of the even and the odd frames: --scans does not apply to points with times."""
        parts = [recordings.pandaset_frame(file) for file in self.frames()]
        begin_s, end_s = parts[0][1].min(), parts[-1][1].max()
        head, *rows = (self.panda / "vehicle_trajectory.csv").read_text(encoding="ascii").split()
        near = [r for r in rows if begin_s - 0.15 < float(r.split(",")[0]) < end_s + 0.15]
        (self.out / "part.csv").write_text("\n".join([head, *near]) + "\n", encoding="ascii")
        return tuple(recordings.write_las_with_times(
            *(np.concatenate(p) for p in zip(*parts[first::2])), self.out / name)
            for first, name in enumerate(("even.las", "odd.las")))

    def stations(self):
        """Every other scan as a station; the scans between are simulated (`--at`)."""
        for k in range(0, SCANS, 2):
            recordings.write_station(self.kitti, k, self.out / f"station{k}.ptx")
        held_out = recordings.write_station(self.kitti, 5, self.out / "station5.ptx")
        position = recordings.kitti_poses(self.kitti)[5][:3, 3]
        return [self.out / f"station{k}.ptx" for k in range(0, SCANS, 2)], held_out, position

    def simulated(self, form, pattern):
        """Scans of an HDL-64E every metre, simulated in a model of the drive."""
        model = self.out / "model.ply"
        if not model.exists():
            self.run(["model", self.kitti, "--scans", f"0:{SCANS}", "-o", model])
        poses = recordings.kitti_poses(self.kitti)[:SCANS]
        lines = ["time,x,y,z,qw,qx,qy,qz"]
        for k, pose in enumerate(poses):
            x, y, z, w = recordings.quaternion(pose[:3, :3])
            lines.append(",".join(repr(float(v)) for v in (0.5 + 0.103 * k, *pose[:3, 3], w, x, y, z)))
        (self.out / "poses.csv").write_text("\n".join(lines) + "\n", encoding="ascii")
        sensor = "velodyne-hdl-64e-kitti" if form == "kitti-raw" else "velodyne-hdl-64e-s3"
        self.run(["simulate", model, "--trajectory", self.out / "poses.csv", "--rolling-shutter",
                  "--sensor", sensor, "--format", form, "-o", self.out / form])
        found, = (self.out / form).glob(pattern)
        return found

    def run(self, words):
        done = subprocess.run([str(self.program), *map(str, words)], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, encoding="utf-8", check=False)
        if done.returncode:
            raise RuntimeError(done.stderr.strip().split("\n")[-1])

    def evaluated(self, path, options):
        """The command line, and its figures for the held-out scans."""
        model, report = self.out / "m.ply", self.out / "held_out.json"
        model.unlink(missing_ok=True)
        if isinstance(path, tuple):
            return self.evaluated_by_simulation(path, options, model, report)
        commands = [["model", path, *options, "--scans", f"0:{SCANS}:2", "-o", model],
                    ["evaluate", "resimulate", model, path, *options, "--scans", f"1:{SCANS}:2",
                     "--report", report]]
        line, found = self.measured(commands, report)
        return {"command": line, "rays": found["rays"],
                "median_m": found["range_error_m"]["median"],
                "within_10cm": found["within"]["0.10"], "no_hit": found["no_hit"]}

    def evaluated_by_simulation(self, paths, options, model, report):
        """Figures for points with unknown beams: scans simulated along the trajectory, compared with the
        points of the other file."""
        scans = self.out / f"simulated{len(paths)}"
        if len(paths) == 3:  # stations
            inputs = paths[0]
            source = ["--at", ",".join(f"{v:.3f}" for v in paths[2]), "--sensor",
                      "velodyne-hdl-64e-kitti"]
        else:
            inputs, source = [paths[0]], [*options, "--sensor", "hesai-pandar64"]
        commands = [["model", *inputs, *options, "-o", model], ["simulate", model, *source, "-o", scans],
                    ["evaluate", "c2c", scans / "sequences" / "00", paths[1], "--report", report]]
        line, found = self.measured(commands, report)
        return {"command": line, "c2c_m": found["c2c_m"]}

    def measured(self, commands, report):
        for words in commands:
            self.run(words)
        line = " && ".join(shlex.join(["adasplats", *map(str, w)]) for w in commands)
        return line.replace(f"{self.out}/", ""), json.loads(report.read_text(encoding="utf-8"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    for name in ("program", "real", "out"):
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--only", nargs="*")
    words = parser.parse_args()
    shutil.rmtree(words.out, ignore_errors=True)
    words.out.mkdir(parents=True)
    drives = Drives(words.program.resolve(), words.real, words.out)
    rows = []
    print("| recording | scans of | beams | median | within 10 cm | no hit |\n|---|---|--:|--:|--:|--:|")
    for kind, scans, make, options in drives.table():
        if words.only and kind not in words.only:
            continue
        try:
            row = drives.evaluated(make(), options)
            if "rays" in row:
                print(f"| {kind} | {scans} | {row['rays']:,} | {100 * row['median_m']:.2f} cm | "
                      f"{row['within_10cm']:.1%} | {row['no_hit']:.1%} |", flush=True)
            else:
                print(f"| {kind} | {scans} | C2C {100 * row['c2c_m']:.2f} cm |", flush=True)
        except Exception as error:  # Continue with the next kind; the row reports the error.
            row = {"error": f"{type(error).__name__}: {error}"}
            print(f"| {kind} | {scans} | {row['error']} |", flush=True)
        rows.append({"name": kind, "scans_of": scans, **row})
    provenance = {**provenance_of(words.program), "command": "drives.py PROGRAM REAL_DATA OUT"}
    report = {"drives": rows, "provenance": provenance}
    (words.out / "drives.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    return 1 if any("error" in row for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
