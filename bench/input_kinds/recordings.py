# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Writes scans of a sequence as files of many kinds, with writers that share no code with the project."""
import base64
import json
import os
import pathlib
import sqlite3
import subprocess
import sys

import numpy as np

from readers import NODE, float_rows, kitti_poses, placed

TREES = pathlib.Path(__file__).resolve().parents[2] / "tests" / "make_data_trees.py"
FLOAT32 = 7  # sensor_msgs/PointField


def world_of(sequence, scans):
    poses = kitti_poses(sequence)
    return np.concatenate([placed(float_rows(sequence / "velodyne" / f"{k:06d}.bin", 4), poses[k])
                           for k in range(scans)])


def part_of(sequence, scans, out):
    """Links the first scans as a new sequence."""
    for folder in ("velodyne", "labels"):
        (out / folder).mkdir(parents=True)
        for k in range(scans):
            for file in (sequence / folder).glob(f"{k:06d}.*"):
                (out / folder / file.name).symlink_to(file)
    for name in ("poses.txt", "times.txt"):
        lines = (sequence / name).read_text(encoding="ascii").split("\n")[:scans]
        (out / name).write_text("\n".join(lines) + "\n", encoding="ascii")
    (out / "calib.txt").write_bytes((sequence / "calib.txt").read_bytes())
    return out


def write_open3d(points, path, **options):
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    assert open3d.io.write_point_cloud(str(path), cloud, **options)
    return path


def write_big_endian_ply(points, path):
    header = (f"ply\nformat binary_big_endian 1.0\nelement vertex {len(points)}\nproperty double x\n"
              "property double y\nproperty double z\nend_header\n")
    path.write_bytes(header.encode() + points.astype(">f8").tobytes())
    return path


def write_csv(points, path):
    import pandas

    pandas.DataFrame({"Z [m]": points[:, 2], "X [m]": points[:, 0], "Y [m]": points[:, 1],
                      "Reflectivity": 7}).to_csv(path, sep=";", index=False)
    return path


def write_ptx(points, path):
    """Two stations with different axes and one missing return each."""
    with open(path, "w", encoding="ascii") as file:
        for k, part in enumerate(np.array_split(points, 2)):
            turn, place = 0.3 + k, np.array([10.0 * k, 2.0, 1.5])
            axes = np.array([[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0],
                             [0, 0, 1]])
            rows = np.vstack([(part - place) @ axes.T, [0, 0, 0]])
            print(len(rows), 1, sep="\n", file=file)
            for row in (place, *axes):
                print(*map(repr, row.tolist()), file=file)
            for row in (*axes, place):
                print(*map(repr, row.tolist()), int(row is place), file=file)
            for row in rows:
                print(*(f"{v:.6f}" for v in row), 0.5, file=file)
    return path


def write_station(sequence, scan, path):
    """A scan as the station of a scanner at its pose."""
    pose = kitti_poses(sequence)[scan]
    points = float_rows(sequence / "velodyne" / f"{scan:06d}.bin", 4)
    with open(path, "w", encoding="ascii") as file:
        print(len(points), 1, sep="\n", file=file)
        print(*map(repr, pose[:3, 3].tolist()), file=file)
        for axis in pose[:3, :3].T:
            print(*map(repr, axis.tolist()), file=file)
        for row in pose.T:
            print(*map(repr, row.tolist()), file=file)
        np.savetxt(file, np.hstack([points, np.full((len(points), 1), 0.5)]), fmt="%.5f")
    return path


def write_mesh(points, path):
    """A triangle fan over the first points."""
    import open3d

    count = min(len(points) // 3, 5000)
    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(points[:3 * count]),
        open3d.utility.Vector3iVector(np.arange(3 * count).reshape(-1, 3)))
    assert open3d.io.write_triangle_mesh(str(path), mesh)
    return path


def quaternion(rotation):
    """x, y, z, w of a rotation, computed from the largest component."""
    m = rotation
    four = np.array([[m[0, 0] - m[1, 1] - m[2, 2], 0, 0, 0],
                     [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], 0, 0],
                     [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], 0],
                     [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m.trace()]]) / 3
    return np.linalg.eigh(four, UPLO="L")[1][:, -1]


def messages_of(sequence, scans):
    """[topic, stamp in ns, message] of the clouds and the sensor's odometry."""
    times = np.loadtxt(sequence / "times.txt")
    out = []
    for k, pose in enumerate(kitti_poses(sequence)[:scans]):
        nanoseconds = round((1.5e9 + times[k]) * 1e6) * 1000
        stamp = {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}
        x, y, z, w = quaternion(pose[:3, :3])
        out.append(["/odom", str(nanoseconds), {
            "header": {"stamp": stamp, "frame_id": "odom"}, "child_frame_id": "velodyne",
            "pose": {"pose": {"position": dict(zip("xyz", pose[:3, 3].tolist())),
                              "orientation": dict(zip("xyzw", [x, y, z, w]))},
                     "covariance": [0.0] * 36},
            "twist": {"twist": {"linear": dict.fromkeys("xyz", 0.0),
                                "angular": dict.fromkeys("xyz", 0.0)}, "covariance": [0.0] * 36}}])
        rows = np.fromfile(sequence / "velodyne" / f"{k:06d}.bin", "<f4").reshape(-1, 4)
        out.append(["/points", str(nanoseconds), {
            "header": {"stamp": stamp, "frame_id": "velodyne"}, "height": 1, "width": len(rows),
            "fields": [{"name": n, "offset": 4 * i, "datatype": FLOAT32, "count": 1}
                       for i, n in enumerate(("x", "y", "z", "intensity"))],
            "is_bigendian": False, "point_step": 16, "row_step": 16 * len(rows),
            "data": base64.b64encode(rows.tobytes()).decode(), "is_dense": True}])
    return out


def node(words, messages):
    return subprocess.run(["node", str(NODE), *map(str, words)], check=True,
                          input=json.dumps(messages).encode(), stdout=subprocess.PIPE).stdout


def write_mcap(sequence, scans, path, compression):
    node(["write-mcap", path, compression], messages_of(sequence, scans))
    return path


def write_db3(sequence, scans, folder):
    """Writes a bag in the layout of rosbag2's SQLite storage."""
    folder.mkdir()
    rows = json.loads(node(["write-cdr"], messages_of(sequence, scans)))
    topics = {}
    with sqlite3.connect(folder / "drive_0.db3") as base:
        base.execute("create table topics(id integer primary key, name text not null, type text not"
                     " null, serialization_format text not null, offered_qos_profiles text not null)")
        base.execute("create table messages(id integer primary key, topic_id integer not null,"
                     " timestamp integer not null, data blob not null)")
        for topic, kind, stamp, data in rows:
            if topic not in topics:
                topics[topic] = (len(topics) + 1, kind)
                base.execute("insert into topics values(?, ?, ?, 'cdr', '')",
                             (topics[topic][0], topic, kind))
            base.execute("insert into messages(topic_id, timestamp, data) values(?, ?, ?)",
                         (topics[topic][0], int(stamp), bytes.fromhex(data)))
    lines = ["rosbag2_bagfile_information:", "  version: 5", "  storage_identifier: sqlite3",
             "  relative_file_paths:", "    - drive_0.db3", "  duration:", "    nanoseconds: 0",
             "  starting_time:", "    nanoseconds_since_epoch: 0",
             f"  message_count: {len(rows)}", "  topics_with_message_count:"]
    for topic, (_, kind) in topics.items():
        lines += ["    - topic_metadata:", f"        name: {topic}", f"        type: {kind}",
                  "        serialization_format: cdr", "        offered_qos_profiles: \"\"",
                  f"      message_count: {len(rows) // 2}"]
    lines += ["  compression_format: \"\"", "  compression_mode: \"\""]
    (folder / "metadata.yaml").write_text("\n".join(lines) + "\n", encoding="ascii")
    return folder


def write_ros2_mcap(sequence, scans, folder):
    folder.mkdir()
    write_mcap(sequence, scans, folder / "drive_0.mcap", "zstd")
    (folder / "metadata.yaml").write_text(
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
        "  relative_file_paths:\n    - drive_0.mcap\n  compression_format: \"\"\n"
        "  compression_mode: \"\"\n", encoding="ascii")
    return folder


def write_rosbag(sequence, scans, path, compression):
    import genpy
    import rosbag
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import PointCloud2, PointField

    with rosbag.Bag(str(path), "w", compression=compression) as bag:
        for topic, stamp, values in messages_of(sequence, scans):
            when = genpy.Time(int(stamp) // 10**9, int(stamp) % 10**9)
            message = PointCloud2() if topic == "/points" else Odometry()
            message.header.stamp, message.header.frame_id = when, values["header"]["frame_id"]
            if topic == "/points":
                for name in ("height", "width", "is_bigendian", "point_step", "row_step", "is_dense"):
                    setattr(message, name, values[name])
                message.fields = [PointField(**f) for f in values["fields"]]
                message.data = base64.b64decode(values["data"])
            else:
                message.child_frame_id = values["child_frame_id"]
                for part in ("position", "orientation"):
                    for axis, value in values["pose"]["pose"][part].items():
                        setattr(getattr(message.pose.pose, part), axis, value)
            bag.write(topic, message, when)
    return path


def write_scans_and_trajectory(sequence, scans, out, form):
    """PCD files in the sensor frame with timed poses in the TUM format (evo) or the CSV of EuRoC."""
    (out / "scans").mkdir(parents=True)
    times = np.loadtxt(sequence / "times.txt")
    lines = {"tum": ["# timestamp tx ty tz qx qy qz qw"],
             "csv": ["#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],"
                     "q_RS_y [],q_RS_z []"]}[form]
    for k, pose in enumerate(kitti_poses(sequence)[:scans]):
        points = float_rows(sequence / "velodyne" / f"{k:06d}.bin", 4)
        microseconds = round((1.5e9 + times[k]) * 1e6)
        write_open3d(points, out / "scans" / f"{microseconds / 1e6:.6f}.pcd")
        place, (x, y, z, w) = pose[:3, 3], quaternion(pose[:3, :3])
        words = ([f"{microseconds / 1e6:.6f}", *place, x, y, z, w] if form == "tum"
                 else [microseconds * 1000, *place, w, x, y, z])
        lines.append((" " if form == "tum" else ",").join(
            str(v) if isinstance(v, (int, str)) else repr(float(v)) for v in words))
    (out / f"poses.{form}").write_text("\n".join(lines) + "\n", encoding="ascii")
    return out


def write_las_with_times(points, times, path):
    """LAS 1.2, point format 1, millimetres, adjusted GPS time."""
    low = np.floor(points.min(0))
    steps = np.round((points - low) / 1e-3).astype("<i4")
    record = np.zeros(len(points), np.dtype([("xyz", "<i4", 3), ("rest", "V8"), ("time", "<f8")]))
    record["xyz"], record["time"] = steps, times
    header = bytearray(227)
    header[:4], header[24:26] = b"LASF", bytes([1, 2])
    header[6:8] = (1).to_bytes(2, "little")
    header[94:100] = (227).to_bytes(2, "little") + (227).to_bytes(4, "little")
    header[104:111] = bytes([1]) + (28).to_bytes(2, "little") + len(points).to_bytes(4, "little")
    real = steps * 1e-3 + low
    bounds = np.stack([real.max(0), real.min(0)], 1).reshape(-1)
    header[131:227] = np.array([1e-3] * 3 + list(low) + list(bounds), "<f8").tobytes()
    path.write_bytes(bytes(header) + record.tobytes())
    return path


def pandaset_frame(path):
    """Positions and times of a frame, read by tests/make_data_trees.py."""
    sys.path.insert(0, str(TREES.parent))
    from make_data_trees import read_ply

    rows = read_ply(path)
    return np.stack([rows[n] for n in "xyz"], 1), rows["time"]


def tree(kind, *words):
    subprocess.run([sys.executable, str(TREES), kind, *map(str, words)], check=True,
                   env={**os.environ, "PYTHONWARNINGS": "ignore"})
