# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Readers that share no code with the project: Open3D, Assimp, pandas, python3-rosbag, npm packages
(laz-perf, copc, loaders.gl, mcap), and NumPy code from the specifications where no reader is
packaged.

Each returns points as an (N, 3) array of float64, metres, in world coordinates, in file order.
"""
import json
import pathlib
import sqlite3
import struct
import subprocess
import xml.etree.ElementTree

import numpy as np

NODE = pathlib.Path(__file__).with_name("read_points.mjs")


def open3d_points(path):
    import open3d

    return np.asarray(open3d.t.io.read_point_cloud(str(path)).point.positions.numpy(), float)


def open3d_legacy_points(path):
    import open3d

    return np.asarray(open3d.io.read_point_cloud(str(path)).points)


def open3d_triangles(path):
    import open3d

    mesh = open3d.io.read_triangle_mesh(str(path))
    return np.asarray(mesh.vertices)[np.asarray(mesh.triangles)].reshape(-1, 3)


def node_points(kind, path):
    """Reads with npm packages from ADASPLATS_NODE_MODULES: laz, copc or mcap."""
    found = subprocess.run(["node", str(NODE), kind, str(path)], check=True, stdout=subprocess.PIPE,
                           stderr=subprocess.DEVNULL)
    return np.frombuffer(found.stdout, "<f8").reshape(-1, 3)


def las_points(path):
    """LAS points from the LAS specification 1.4 R15, tables 3, 7 and 14."""
    data = pathlib.Path(path).read_bytes()
    assert data[:4] == b"LASF"
    minor = data[25]
    begin, = struct.unpack_from("<I", data, 96)
    size, count = struct.unpack_from("<HI", data, 105)
    if minor == 4:
        count, = struct.unpack_from("<Q", data, 247)
    scale, offset = np.frombuffer(data, "<f8", 6, 131).reshape(2, 3)
    records = np.frombuffer(data, np.dtype((np.void, size)), count, begin)
    rows = np.frombuffer(records.tobytes(), np.uint8).reshape(count, size)
    steps = np.ascontiguousarray(rows[:, :12]).view("<i4")
    is_withheld = rows[:, 15] & (4 if data[104] >= 6 else 128)
    return (steps * scale + offset)[is_withheld == 0]


def rotation_of(w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def _e57_field(node, data, count):
    """A field of a packed stream, ASTM E2807 section 9.7."""
    kind = node.get("type")
    if kind == "Float":
        return np.frombuffer(data, "<f4" if node.get("precision") == "single" else "<f8", count)
    low, high = int(node.get("minimum")), int(node.get("maximum"))
    bits = int(high - low).bit_length()
    flags = np.unpackbits(np.frombuffer(data, np.uint8), bitorder="little")[:count * bits]
    steps = flags.reshape(count, bits) @ (1 << np.arange(bits, dtype=np.int64)) + low
    return steps * float(node.get("scale", 1)) + float(node.get("offset", 0))


def e57_points(path):
    """E57 points from ASTM E2807: pages without their checksums, then the streams of every scan."""
    whole = pathlib.Path(path).read_bytes()
    page, = struct.unpack_from("<Q", whole, 40)
    xml_at, xml_size = struct.unpack_from("<QQ", whole, 24)
    data = b"".join(whole[k:k + page - 4] for k in range(0, len(whole), page))

    def logical(physical):
        return physical // page * (page - 4) + physical % page

    text = data[logical(xml_at):logical(xml_at) + xml_size].decode().rstrip("\0")
    root = xml.etree.ElementTree.fromstring(text)
    names = {"": root.tag[1:root.tag.index("}")]}
    parts = []
    for scan in root.findall("data3D/vectorChild", names) or root.findall(
            f"{{{names['']}}}data3D/{{{names['']}}}vectorChild"):
        points = scan.find(f"{{{names['']}}}points")
        prototype = [n for n in points.find(f"{{{names['']}}}prototype")]
        count = int(points.get("recordCount"))
        at = logical(int(points.get("fileOffset")))
        _, size, packets, _ = struct.unpack_from("<B7xQQQ", data, at)
        place, end = logical(packets), at + size
        streams = [b""] * len(prototype)
        while place < end:
            assert data[place] in (0, 1)
            length = struct.unpack_from("<H", data, place + 2)[0] + 1
            if data[place] == 1:
                number, = struct.unpack_from("<H", data, place + 4)
                sizes = struct.unpack_from(f"<{number}H", data, place + 6)
                begin = place + 6 + 2 * number
                for k, one in enumerate(sizes):
                    streams[k] += data[begin:begin + one]
                    begin += one
            place += length
        have = {n.tag.split("}")[1]: _e57_field(n, s, count) for n, s in zip(prototype, streams)}
        if "sphericalRange" in have:
            r, a, e = (have["spherical" + n] for n in ("Range", "Azimuth", "Elevation"))
            local = np.stack([r * np.cos(e) * np.cos(a), r * np.cos(e) * np.sin(a), r * np.sin(e)], 1)
            good = have.get("sphericalInvalidState", np.zeros(count)) == 0
        else:
            local = np.stack([have["cartesian" + n] for n in "XYZ"], 1).astype(float)
            good = have.get("cartesianInvalidState", np.zeros(count)) == 0
        pose = scan.find(f"{{{names['']}}}pose")
        if pose is not None:
            def numbers(name, keys, otherwise):
                node = pose.find(f"{{{names['']}}}{name}")
                if node is None:
                    return otherwise
                return [float(node.find(f"{{{names['']}}}{k}").text or 0) for k in keys]
            local = local @ rotation_of(*numbers("rotation", "wxyz", [1, 0, 0, 0])).T
            local = local + numbers("translation", "xyz", [0, 0, 0])
        parts.append(local[good])
    return np.concatenate(parts)


def ptx_points(path):
    """Leica's PTX: columns, rows, the scanner, its axes, a matrix for rows of numbers."""
    lines = pathlib.Path(path).read_text(encoding="ascii").split("\n")
    parts, place = [], 0
    while place < len(lines) and lines[place].strip():
        count = int(lines[place]) * int(lines[place + 1])
        matrix = np.array([line.split() for line in lines[place + 6:place + 10]], float)
        rows = np.array([line.split()[:3] for line in lines[place + 10:place + 10 + count]], float)
        rows = rows[(rows != 0).any(axis=1)]
        parts.append(np.hstack([rows, np.ones((len(rows), 1))]) @ matrix[:, :3])
        place += 10 + count
    return np.concatenate(parts)


def text_points(path, skip=0, columns=(0, 1, 2), delimiter=None):
    return np.loadtxt(path, skiprows=skip, usecols=columns, delimiter=delimiter, ndmin=2)


def float_rows(path, columns):
    return np.fromfile(path, "<f4").reshape(-1, columns)[:, :3].astype(float)


def placed(points, pose):
    return points @ pose[:3, :3].T + pose[:3, 3]


def kitti_poses(sequence):
    calib = dict(line.split(":", 1) for line in open(sequence / "calib.txt", encoding="ascii"))
    tr = np.vstack([np.array(calib["Tr"].split(), float).reshape(3, 4), [0, 0, 0, 1]])
    poses = np.loadtxt(sequence / "poses.txt").reshape(-1, 3, 4)
    return [np.linalg.inv(tr) @ np.vstack([p, [0, 0, 0, 1]]) @ tr for p in poses]


def sequence_points(sequence):
    files = sorted((sequence / "velodyne").glob("*.bin"))
    return np.concatenate([placed(float_rows(f, 4), p)
                           for f, p in zip(files, kitti_poses(sequence), strict=True)])


def kitti_raw_points(drive, calib):
    """Points as in the devkit of KITTI's raw data: Mercator's projection at the first latitude."""
    def matrix(rotation, translation):
        out = np.eye(4)
        out[:3, :3], out[:3, 3] = rotation, translation
        return out

    rows = dict(line.split(":", 1) for line in open(calib, encoding="ascii") if ":" in line)
    velo_from_imu = matrix(np.array(rows["R"].split(), float).reshape(3, 3),
                           np.array(rows["T"].split(), float))
    poses = []
    for file in sorted((drive / "oxts" / "data").glob("*.txt")):
        lat, lon, alt, roll, pitch, yaw = np.loadtxt(file)[:6]
        scale = np.cos(np.radians(lat if not poses else first_lat))
        first_lat = lat if not poses else first_lat
        radius = 6378137.0
        place = [scale * np.radians(lon) * radius,
                 scale * radius * np.log(np.tan(np.radians(90 + lat) / 2)), alt]
        (cr, sr), (cp, sp), (cy, sy) = ((np.cos(v), np.sin(v)) for v in (roll, pitch, yaw))
        turn = (np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
                @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
                @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]]))
        poses.append(matrix(turn, place))
    poses = [pose @ np.linalg.inv(velo_from_imu) for pose in poses]
    start = poses[0][:3, 3].copy()  # The position of the first scan is the origin.
    for pose in poses:
        pose[:3, 3] -= start
    files = sorted((drive / "velodyne_points" / "data").glob("*.bin"))
    return np.concatenate([placed(float_rows(f, 4), p) for f, p in zip(files, poses, strict=True)])


def pandaset_points(sequence):
    import pandas

    frames = [pandas.read_pickle(f) for f in sorted((sequence / "lidar").glob("*.pkl.gz"))]
    return np.concatenate([f[f.d == 0][["x", "y", "z"]].to_numpy() for f in frames])


def nuscenes_points(root, version="v1.0-mini"):
    tables = {name: json.loads((root / version / f"{name}.json").read_text())
              for name in ("sample_data", "ego_pose", "calibrated_sensor", "sensor")}
    by_token = {name: {row["token"]: row for row in rows} for name, rows in tables.items()}

    def pose_of(row):
        out = np.eye(4)
        out[:3, :3], out[:3, 3] = rotation_of(*row["rotation"]), row["translation"]
        return out

    parts = []
    for row in sorted(tables["sample_data"], key=lambda r: r["timestamp"]):
        mount = by_token["calibrated_sensor"][row["calibrated_sensor_token"]]
        if by_token["sensor"][mount["sensor_token"]]["channel"] != "LIDAR_TOP":
            continue
        pose = pose_of(by_token["ego_pose"][row["ego_pose_token"]]) @ pose_of(mount)
        parts.append(placed(float_rows(root / row["filename"], 5), pose))
    return np.concatenate(parts)


def cloud_values(message):
    """x, y, z of a sensor_msgs/PointCloud2 of any fields."""
    at = {f.name: f.offset for f in message.fields}
    count = message.width * message.height
    rows = np.frombuffer(bytes(message.data), np.uint8).reshape(count, message.point_step)
    return np.stack([np.ascontiguousarray(rows[:, at[n]:at[n] + 4]).view("<f4")[:, 0]
                     for n in "xyz"], 1).astype(float)


def rosbag_points(path):
    """Clouds placed by the odometry with the same stamp, both from python3-rosbag."""
    import rosbag

    with rosbag.Bag(str(path)) as bag:
        poses, parts = {}, []
        for _, message, _ in bag.read_messages(topics=["/odom"]):
            place, turn = message.pose.pose.position, message.pose.pose.orientation
            pose = np.eye(4)
            pose[:3, :3] = rotation_of(turn.w, turn.x, turn.y, turn.z)
            pose[:3, 3] = place.x, place.y, place.z
            poses[message.header.stamp.to_nsec()] = pose
        for _, message, _ in bag.read_messages(topics=["/points"]):
            parts.append(placed(cloud_values(message), poses[message.header.stamp.to_nsec()]))
    return np.concatenate(parts)


def db3_points(path):
    """The clouds of a ROS 2 bag, read with SQLite and decoded by an npm package."""
    with sqlite3.connect(path) as base:
        topics = dict(base.execute("select id, name from topics"))
        rows = [[topics[t], bytes(d).hex()] for t, d in base.execute(
            "select topic_id, data from messages order by timestamp")]
    found = subprocess.run(["node", str(NODE), "cdr"], check=True, stdout=subprocess.PIPE,
                           input=json.dumps(rows).encode())
    return np.frombuffer(found.stdout, "<f8").reshape(-1, 3)


def vlp16_points(capture):
    """In the frame of its ROS driver (x at azimuth 0), VLP-16 manual 63-9243, figures 9-1 and
    table 9-1 (the vertical correction in mm included)."""
    from packet_parser import VLP_16

    elevations = np.radians([-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15])
    rows = np.array(VLP_16.returns(capture))
    laser, azimuth, distance = rows[:, 1].astype(int), np.radians(rows[:, 2]), rows[:, 3]
    flat = distance * np.cos(elevations[laser])
    return np.stack([flat * np.cos(azimuth), -flat * np.sin(azimuth),
                     distance * np.sin(elevations[laser])], 1)


def ouster_points(capture, metadata):
    """In the frame of the sensor, Ouster Software User Manual 2.0, "Range to XYZ"."""
    from packet_parser import ouster_returns

    about = json.loads(pathlib.Path(metadata).read_text(encoding="utf-8"))
    about = {**about, **about.get("beam_intrinsics", {}), **about.get("lidar_intrinsics", {})}
    channels = len(about["beam_altitude_angles"])
    rows = np.array(ouster_returns(capture, channels))
    channel, column, distance = rows[:, 1].astype(int), rows[:, 2], rows[:, 4]
    lever = about["lidar_origin_to_beam_origin_mm"] / 1000
    columns = int(about["lidar_mode"].split("x")[0])
    encoder = 2 * np.pi * (1 - column / columns)
    azimuth = encoder - np.radians(about["beam_azimuth_angles"])[channel]
    elevation = np.radians(about["beam_altitude_angles"])[channel]
    far = distance - lever
    local = np.stack([far * np.cos(azimuth) * np.cos(elevation) + lever * np.cos(encoder),
                      far * np.sin(azimuth) * np.cos(elevation) + lever * np.sin(encoder),
                      far * np.sin(elevation)], 1)
    transform = np.array(about["lidar_to_sensor_transform"], float).reshape(4, 4)
    return local @ transform[:3, :3].T + transform[:3, 3] / 1000
