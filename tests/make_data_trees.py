#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Makes trees of PandaSet and nuScenes of other recordings, without any code of the project: with
pandas, NumPy and json, as the tools of these data sets would.

    make_data_trees.py pandaset FRAMES POSES.csv CLASSES.csv OUT
        of PLY files (x y z time as double, intensity and class as uchar; world coordinates) and
        poses by time; OUT-shares/ has the same files with intensities divided by 255
    make_data_trees.py nuscenes SEQUENCE OUT [--every N]
        of a sequence of SemanticKITTI; every N-th scan is a keyframe with labels
"""

import argparse
import csv
import json
from pathlib import Path

import numpy as np

PLY = np.dtype([("x", "<f8"), ("y", "<f8"), ("z", "<f8"), ("time", "<f8"), ("intensity", "u1"),
                ("class", "u1")])
# From the axes of SemanticKITTI (x forward, y left) to those of the data sets (x right, y forward).
RIGHT_FORWARD = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def read_ply(file):
    data = file.read_bytes()
    begin = data.index(b"end_header\n") + len(b"end_header\n")
    return np.frombuffer(data, PLY, offset=begin)


def write_ply_with_shares(file, points):
    dtype = np.dtype([(n, PLY[n]) if n != "intensity" else (n, "<f4") for n in PLY.names])
    out = np.empty(len(points), dtype)
    for name in PLY.names:
        out[name] = points[name]
    out["intensity"] = points["intensity"].astype(np.float32) / np.float32(255)
    kinds = {"<f8": "double", "<f4": "float", "|u1": "uchar"}
    header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(points)
    header += "".join(f"property {kinds[dtype[n].str]} {n}\n" for n in dtype.names)
    file.write_bytes(header.encode() + b"end_header\n" + out.tobytes())


def make_pandaset(frames, poses, classes, out):
    import pandas

    files = sorted(frames.glob("*.ply"))
    with open(poses, encoding="ascii") as file:
        rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    # A pose a frame: the nearest to the end of its points.
    chosen = []
    shares = out.with_name(out.name + "-shares")
    for folder in (out / "lidar", out / "annotations" / "semseg", shares):
        folder.mkdir(parents=True)
    for number, file in enumerate(files):
        points = read_ply(file)
        chosen.append(min(rows, key=lambda r: abs(r["time"] - points["time"].max())))
        frame = pandas.DataFrame({"x": points["x"], "y": points["y"], "z": points["z"],
                                  "i": points["intensity"].astype(np.float64),
                                  "t": points["time"], "d": np.zeros(len(points), np.int64)})
        frame.to_pickle(out / "lidar" / f"{number:02d}.pkl.gz")
        labels = pandas.DataFrame({"class": points["class"].astype(np.int64)})
        labels.to_pickle(out / "annotations" / "semseg" / f"{number:02d}.pkl.gz")
        write_ply_with_shares(shares / f"{number:03d}.ply", points)
    (out / "lidar" / "poses.json").write_text(json.dumps(
        [{"position": {k: r[k] for k in "xyz"}, "heading": {k: r["q" + k] for k in "wxyz"}}
         for r in chosen]))
    (out / "lidar" / "timestamps.json").write_text(json.dumps([r["time"] for r in chosen]))
    lines = ["time,x,y,z,qw,qx,qy,qz"]
    lines += [",".join(repr(r[k]) for k in lines[0].split(",")) for r in chosen]
    shares.with_suffix(".csv").write_text("\n".join(lines) + "\n")
    with open(classes, encoding="ascii") as file:
        names = {row["id"]: row["name"] for row in csv.DictReader(file)}
    (out / "annotations" / "semseg" / "classes.json").write_text(json.dumps(names))


def quaternion(rotation):
    """w, x, y, z: the eigenvector of Bar-Itzhack's matrix."""
    m = rotation
    k = np.array([
        [m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]],
        [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
        [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
        [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m.trace()]]) / 3
    x, y, z, w = np.linalg.eigh(k)[1][:, -1]
    return [w, x, y, z] if w >= 0 else [-w, -x, -y, -z]


def sensor_poses(sequence):
    """world_from_velodyne of every scan."""
    calib = dict(line.split(":", 1) for line in open(sequence / "calib.txt", encoding="ascii"))
    tr = np.vstack([np.fromstring(calib["Tr"], sep=" ").reshape(3, 4), [0, 0, 0, 1]])
    poses = np.loadtxt(sequence / "poses.txt").reshape(-1, 3, 4)
    return [np.linalg.inv(tr) @ np.vstack([p, [0, 0, 0, 1]]) @ tr for p in poses]


def make_nuscenes(sequence, out, every):
    tables = {name: [] for name in ("scene", "sample", "sample_data", "ego_pose", "sensor",
                                    "calibrated_sensor", "category", "lidarseg", "log", "map")}
    for folder in ("samples/LIDAR_TOP", "sweeps/LIDAR_TOP", "sweeps/CAM_FRONT", "v1.0-mini",
                   "lidarseg/v1.0-mini"):
        (out / folder).mkdir(parents=True)
    mount = np.array([0.9, 0.0, 1.8])
    tables["sensor"] = [{"token": "s0", "channel": "CAM_FRONT", "modality": "camera"},
                        {"token": "s1", "channel": "LIDAR_TOP", "modality": "lidar"}]
    tables["calibrated_sensor"] = [
        {"token": "c1", "sensor_token": "s1", "translation": list(mount),
         "rotation": quaternion(RIGHT_FORWARD.T), "camera_intrinsic": []},
        {"token": "c0", "sensor_token": "s0", "translation": [0, 0, 0], "rotation": [1, 0, 0, 0],
         "camera_intrinsic": []}]
    tables["scene"] = [{"token": "scene", "name": "scene-0061"}]
    tables["category"] = [{"token": f"k{k}", "name": name, "index": k} for k, name in
                          enumerate(["noise", "animal"])]
    times = np.loadtxt(sequence / "times.txt")
    for k, pose in enumerate(sensor_poses(sequence)):
        points = np.fromfile(sequence / "velodyne" / f"{k:06d}.bin", "<f4").reshape(-1, 4)
        is_key = k % every == 0
        file = f"{'samples' if is_key else 'sweeps'}/LIDAR_TOP/n{k:06d}.pcd.bin"
        rows = np.zeros((len(points), 5), "<f4")
        rows[:, 0], rows[:, 1], rows[:, 2:4] = -points[:, 1], points[:, 0], points[:, 2:4]
        (out / file).write_bytes(rows.tobytes())
        stamp = round(1e6 * (1.5e9 + times[k]))
        sample = f"sample{k - k % every}"
        ego = pose[:3, :3], pose[:3, 3] - pose[:3, :3] @ mount
        tables["ego_pose"].append({"token": f"e{k}", "timestamp": stamp,
                                   "rotation": quaternion(ego[0]), "translation": list(ego[1])})
        tables["sample_data"].append({
            "token": f"d{k}", "sample_token": sample, "ego_pose_token": f"e{k}",
            "calibrated_sensor_token": "c1", "timestamp": stamp, "fileformat": "pcd",
            "is_key_frame": is_key, "filename": file})
        if is_key:
            tables["sample"].append({"token": sample, "timestamp": stamp, "scene_token": "scene"})
            name = f"lidarseg/v1.0-mini/d{k}_lidarseg.bin"
            (out / name).write_bytes(bytes(len(points)))
            tables["lidarseg"].append({"token": f"d{k}", "sample_data_token": f"d{k}",
                                       "filename": name})
    for name, rows in tables.items():
        # Later scans first: nothing says that tables are in the order of times.
        (out / "v1.0-mini" / f"{name}.json").write_text(json.dumps(rows[::-1], indent=0))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(dest="kind", required=True)
    pandaset = kinds.add_parser("pandaset")
    for name in ("frames", "poses", "classes", "out"):
        pandaset.add_argument(name, type=Path)
    nuscenes = kinds.add_parser("nuscenes")
    for name in ("sequence", "out"):
        nuscenes.add_argument(name, type=Path)
    nuscenes.add_argument("--every", type=int, default=10)
    given = parser.parse_args()
    if given.kind == "pandaset":
        make_pandaset(given.frames, given.poses, given.classes, given.out)
    else:
        make_nuscenes(given.sequence, given.out, given.every)


if __name__ == "__main__":
    main()
