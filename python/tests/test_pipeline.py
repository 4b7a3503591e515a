# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Every function against the command line on the same data: same bytes, same keys."""
import re
import struct
import warnings
import zlib

import numpy as np
import pytest
from conftest import report_of, run_program

import adasplats

# Keys of a report that describe the run, not the result.
OF_THE_RUN = {"program", "version", "command", "provenance", "parameters", "threads", "device", "warnings",
              "peak_memory_bytes", "seconds", "seconds_of_load"}


def without_times(report):
    return {key: value for key, value in report.items() if key not in OF_THE_RUN}


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()
            and path.name != "adasplats.json"}


def png_pixels(path):
    """A PNG of 8-bit RGB; oracle of the pictures. PNG specification, sections 5 and 9."""
    data = path.read_bytes()
    offset, packed = 8, b""
    while offset < len(data):
        length, kind = struct.unpack(">I4s", data[offset:offset + 8])
        body = data[offset + 8:offset + 8 + length]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
        if kind == b"IDAT":
            packed += body
        offset += 12 + length
    raw = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + 3 * width)
    pixels = np.zeros((height + 1, width + 1, 3), np.int64)
    for y in range(height):
        method, row = raw[y, 0], raw[y, 1:].reshape(width, 3).astype(np.int64)
        for x in range(width):
            left, up, corner = pixels[y + 1, x], pixels[y, x + 1], pixels[y, x]
            if method == 4:
                estimate = left + up - corner
                away = [np.abs(estimate - c) for c in (left, up, corner)]
                guess = np.where((away[0] <= away[1]) & (away[0] <= away[2]), left,
                                 np.where(away[1] <= away[2], up, corner))
            else:
                guess = [0 * left, left, up, (left + up) // 2][method]
            pixels[y + 1, x + 1] = (row[x] + guess) % 256
    return pixels[1:, 1:].astype(np.uint8)


def test_street(street, tmp_path):
    report = adasplats.synth_street(tmp_path / "s", points=20000, driving_spacing=10)
    assert files_of(tmp_path / "s") == files_of(street.folder / "street")
    assert report["mapping_points"] == len(adasplats.read(street.cloud, driven_path_m=0))


def test_read(street):
    cloud = adasplats.read(street.cloud)
    facts = report_of(street.folder, "info", street.cloud)
    assert str(len(cloud)) in str(facts)
    sequence = adasplats.read(street.sequence, first_scan=1, scan_count=2)
    assert len(np.unique(sequence.scan_indices)) == 2
    both = adasplats.read([street.cloud, str(street.cloud)])
    assert len(both) == 2 * len(cloud)
    assert len(adasplats.read(bytes(street.cloud))) == len(cloud)


def test_cloud_file(street, tmp_path):
    cloud = adasplats.read(street.cloud)
    cloud.save(tmp_path / "again.ply")
    again = adasplats.read(tmp_path / "again.ply")
    for name in ("positions", "sensor_positions", "intensities", "classes", "origin"):
        np.testing.assert_array_equal(getattr(again, name), getattr(cloud, name))


def quiet_model(points, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # labels without a scheme
        return adasplats.model(points, **options)


@pytest.mark.parametrize("options", [
    {"labels": "semantickitti"},
    {"method": "basic", "neighbors": 20, "remove": "none", "labels": "semantickitti"},
    {"method": "semantic", "labels": "semantickitti", "alpha": 0.3,
     "linear_scale": (0.5, 0.5, 0.5)},
    {"method": "descriptors", "resample": False, "threads": 1, "seed": 7},
])
def test_model(street, tmp_path, options):
    arguments = []
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        if isinstance(value, bool):
            arguments.append(flag if value else "--no-" + name)
        elif isinstance(value, tuple):
            arguments += [flag, ",".join(map(str, value))]
        else:
            arguments += [flag, value]
    # Points that reading leaves out are no part of the report of a model of read points.
    report = report_of(tmp_path, "model", street.cloud, "-o", tmp_path / "cli.ply",
                       "--driven-path", 0, *arguments)
    quiet_model(street.cloud, driven_path_m=0, **options).save(tmp_path / "files.ply")
    made = quiet_model(adasplats.read(street.cloud, driven_path_m=0), **options)
    made.save(tmp_path / "arrays.ply")
    expected = (tmp_path / "cli.ply").read_bytes()
    assert (tmp_path / "files.ply").read_bytes() == expected
    assert (tmp_path / "arrays.ply").read_bytes() == expected
    assert set(made.report) == set(report) - OF_THE_RUN | {"seconds"}
    assert without_times(made.report) == without_times(report)
    assert set(made.report["seconds"]) | {"save", "total"} == set(report["seconds"])


def test_cloud_from_numpy_gives_the_same_model(street, tmp_path):
    cloud = adasplats.read(street.cloud)
    copy = adasplats.PointCloud(cloud.world_positions, classes=cloud.classes,
                                intensities=cloud.intensities,
                                sensor_positions=cloud.sensor_positions + cloud.origin)
    adasplats.model(copy, labels="semantickitti").save(tmp_path / "numpy.ply")
    assert (tmp_path / "numpy.ply").read_bytes() == street.model.read_bytes()


def test_model_file(street, tmp_path):
    model = adasplats.Model.load(street.model)
    model.save(tmp_path / "again.ply")
    assert (tmp_path / "again.ply").read_bytes() == street.model.read_bytes()
    assert model.labels == "semantickitti" and model.report is None
    assert set(model.response) == {"ranges_m", "range_gains", "cos_incidences", "incidence_gains"}
    low, high = model.bounds
    assert np.all(model.centers + model.origin >= low) and np.all(model.centers <= high)
    copy = adasplats.Model(model.centers, model.normals, model.radii, classes=model.classes)
    np.testing.assert_array_equal(copy.centers, model.centers)
    np.testing.assert_array_equal(copy.normals, model.normals)


SIMULATIONS = [
    {},
    {"seed": 5, "noise": False},
    {"rolling_shutter": True, "points": "deskewed"},
    {"depth": 5, "sub_rays": 7, "returns": 2, "return_mode": "last", "sensor": "velodyne-vlp-16"},
    {"rain": 20.0, "fog": 100.0, "snow": 1.0, "range_noise": 0.05, "threads": 1},
    {"depth": 5, "depth_gap": 0.02, "sub_rays": 7, "separation": 0.2, "returns": 2,
     "sensor": "velodyne-vlp-16"},
    {"rain": 20.0, "white_intensity": 100.0},
    {"sensor": "livox"},
]


@pytest.mark.parametrize("options", SIMULATIONS)
def test_simulate(street, poses, tmp_path, options):
    options = dict(options)
    sensor = options.pop("sensor", street.sensor)
    if sensor == "livox":
        sensor = next(name for name in adasplats.sensors() if name.startswith("livox"))
    arguments = []
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        if value is True:
            arguments.append(flag)
        elif value is False:
            arguments.append("--no-" + name)
        else:
            arguments += [flag, value]
    model = street.model
    if "depth" in options:  # averages hits of opaque splats
        model = tmp_path / "opaque.ply"
        run_program("model", street.cloud, "-o", model, "--labels", "semantickitti", "--no-refine")
    run_program("simulate", model, "--sensor", sensor, "--trajectory", street.sequence, "-o",
                tmp_path / "cli", "--format", "npy", *arguments)
    scene = adasplats.Scene(model, device="cpu", threads=options.pop("threads", 0))
    scans = scene.simulate(sensor, poses, **options)
    scans.save(tmp_path / "python", format="npy")
    assert files_of(tmp_path / "python") == files_of(tmp_path / "cli")
    assert len(scans) == len(poses) and len(scans[0]) > 0
    one_by_one = list(scene.iter_scans(sensor, poses, **options))
    assert len(one_by_one) == len(scans)
    for a, b in zip(scans, one_by_one):
        for name in ("positions", "ranges", "intensities", "classes", "rings", "columns", "times",
                     "return_indices", "pose"):
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))


def test_batches_equal_scans(street, scene, poses):
    scans = scene.simulate(street.sensor, poses)
    names = ["positions", "intensities", "classes", "instances", "rings", "columns", "times",
             "ranges", "return_indices"]
    seen = 0
    for batch in scene.scan_batches(street.sensor, poses):
        assert batch.first == seen and batch.offsets[0] == 0
        for i in range(len(batch)):
            begin, end = batch.offsets[i:i + 2]
            for name in names:
                part, whole = getattr(batch, name), getattr(scans[batch.first + i], name)
                assert (part is None) == (whole is None)
                if part is not None:
                    np.testing.assert_array_equal(part[begin:end], whole)
        padded = batch.padded("positions", 50)
        assert padded.shape == (len(batch), 50, 3)
        np.testing.assert_array_equal(padded[0], batch.positions[:50])
        with pytest.raises(ValueError):
            batch.positions[0, 0] = 1
        seen += len(batch)
    assert seen == len(scans)
    positions = batch.positions.copy()
    view = batch.positions
    del batch
    np.testing.assert_array_equal(view, positions)  # the view holds the memory


def test_batches_of_some_fields(street, scene, poses):
    batch = next(scene.scan_batches(street.sensor, poses, fields=["positions", "rings"]))
    assert batch.positions is not None and batch.rings is not None
    assert batch.ranges is None and batch.classes is None
    with pytest.raises(ValueError, match="unknown field 'colour', expected some of positions"):
        scene.scan_batches(street.sensor, poses, fields=["colour"])
    with pytest.raises(TypeError, match="fields"):
        scene.scan_batches(street.sensor, poses, fields="rings")
    with pytest.raises(ValueError, match="has no 'ranges'"):
        batch.padded("ranges", 3)
    many = scene.scan_batches(street.sensor, poses)
    next(many)
    del many  # its thread ends
    if scene.device == "cpu":
        with pytest.raises(RuntimeError, match="GPU memory"):
            list(scene.scan_batches(street.sensor, poses, on_device=True))


def test_scans_as_a_sequence(street, scene, poses, tmp_path):
    scans = scene.simulate(street.sensor, poses)
    assert [scan.time for scan in scans] == list(poses.times)
    np.testing.assert_array_equal(scans[-1].pose, poses.poses[-1])
    assert len(scans[1:3]) == 2 and scans[1:3][0] is scans[1]
    with pytest.raises(IndexError):
        scans[len(scans)]
    from_two = scene.simulate(street.sensor, poses[2:], first_number=2)
    np.testing.assert_array_equal(from_two[0].ranges, scans[2].ranges)
    run_program("simulate", street.model, "--sensor", street.sensor, "--trajectory",
                street.sequence, "-o", tmp_path / "cli")
    scans.save(tmp_path / "python")
    assert files_of(tmp_path / "python") == files_of(tmp_path / "cli")


def test_every_format_of_the_program_can_be_saved(street, scene, poses, tmp_path):
    """Oracle: the command line's files, and the words of its help text."""
    text = run_program("simulate", "--help-all").stdout
    formats = re.search(r"--format (\S+)", text).group(1).split("|")
    assert {"semantickitti", "range-image", "mcap"} < set(formats)
    poses[:2].save(tmp_path / "poses.csv")
    scans = scene.simulate(street.sensor, adasplats.Trajectory.read(tmp_path / "poses.csv"))
    with pytest.raises(ValueError, match="packets need the sensor"):
        scans.save(tmp_path / "pcap", format="pcap")
    assert not (tmp_path / "pcap").exists()
    for format in [format for format in formats if format != "pcap"]:
        run_program("simulate", street.model, "--sensor", street.sensor, "--trajectory",
                    tmp_path / "poses.csv", "-o", tmp_path / ("cli-" + format), "--format", format)
        scans.save(tmp_path / format, format=format)
        assert files_of(tmp_path / format) == files_of(tmp_path / ("cli-" + format)), format
    with pytest.raises(ValueError, match="did you mean 'range-image'"):
        scans.save(tmp_path / "no", format="range_image")
    assert not (tmp_path / "no").exists()


def test_scene_of_a_model_in_memory(street, scene, poses):
    in_memory = adasplats.Scene(adasplats.Model.load(street.model), device="cpu")
    for a, b in zip(in_memory.simulate(street.sensor, poses), scene.simulate(street.sensor, poses)):
        np.testing.assert_array_equal(a.positions, b.positions)
    assert in_memory.labels.name == "semantickitti"
    mesh = adasplats.Scene(adasplats.Mesh.load(street.mesh), device="cpu", labels="semantickitti")
    assert len(mesh) == len(adasplats.Mesh.load(street.mesh))
    assert len(mesh.simulate(street.sensor, poses)[0]) > 0


def test_cast_equals_simulate(street, scene, poses):
    """Without noise a scan is the hits of its firings."""
    sensor = adasplats.Sensor(street.sensor)
    scan = scene.simulate(sensor, poses[:1], noise=False)[0]
    firings = sensor.firings()
    pose = poses.poses[0]
    hits = scene.cast(pose[:3, 3], firings.directions @ pose[:3, :3].T, t_max=sensor.max_range_m)
    assert abs(int(hits.valid.sum()) - len(scan)) <= 2  # directions are rounded in another order
    number = scan.rings.astype(int) * 180 + scan.columns
    close = np.abs(hits.ranges[number] - scan.ranges) < 1e-3
    assert close.mean() > 0.99
    np.testing.assert_array_equal(hits.classes[number][close], scan.classes[close])


VIEWS = [
    ({}, []),
    ({"eye": (0, 0, 20), "target": (30, 5, 0), "fov": 60, "color": "normal"},
     ["--eye", "0,0,20", "--target", "30,5,0", "--fov", 60, "--color", "normal"]),
    ({"color": "height"}, ["--color", "height"]),
    ({"birds_eye": True, "color": "shading", "samples": 1},
     ["--birds-eye", "--color", "shading", "--samples", 1]),
]


@pytest.mark.parametrize("options, arguments", VIEWS)
def test_render(street, scene, tmp_path, options, arguments):
    size = {"width": 64, "height": 40}
    run_program("render", street.model, "-o", tmp_path / "cli.png", "--width", 64, "--height", 40,
                "--no-captions", *arguments)
    picture = scene.render(**size, **options)
    assert picture.shape == (40, 64, 3) and picture.dtype == np.uint8
    np.testing.assert_array_equal(picture, png_pixels(tmp_path / "cli.png"))
    if not options:
        ahead = scene.render(trajectory=street.sequence, pose=1, **size)
        run_program("render", street.model, "-o", tmp_path / "cli.png", "--width", 64, "--height",
                    40, "--trajectory", street.sequence, "--pose", 1, "--no-captions")
        np.testing.assert_array_equal(ahead, png_pixels(tmp_path / "cli.png"))


CAMERA = {"width": 70, "height": 45}
MATRIX = [[50, 0, 33.1], [0, 51, 22.7], [0, 0, 1]]
LENSES = [("none", None), ("plumb_bob", [-0.3, 0.1, 0.01, -0.005, 0]),
          ("rational", [0.4, -0.1, 0.001, -0.002, 0.05, 0.7, -0.05, 0.01]),
          ("fisheye", [-0.03, 0.01, 0, 0])]
MOUNT = np.array([[0, -1, 0, 0.5], [1, 0, 0, -0.25], [0, 0, 1, 0.75], [0, 0, 0, 1]], float)


@pytest.mark.parametrize("model, coefficients", LENSES)
def test_layers(scene, poses, model, coefficients):
    """Oracle: rays cast through the centres of the pixels; OpenCV's formulas for their directions."""
    camera = adasplats.Camera.from_matrix(MATRIX, **CAMERA, model=model, coefficients=coefficients,
                                          mount=MOUNT)
    layers = scene.layers(camera=camera, trajectory=poses, pose=2)
    directions = camera.directions()
    x, y = (-directions[..., axis] / directions[..., 0] for axis in (1, 2))
    k1, k2, p1, p2, k3, k4, k5, k6 = (list(coefficients or []) + 8 * [0])[:8]
    r = np.hypot(x, y)
    if model == "fisheye":
        angle = np.arctan(r)
        factor = angle * (1 + k1 * angle**2 + k2 * angle**4) / np.where(r > 0, r, 1)
        u, v = x * factor, y * factor
    else:
        factor = (1 + k1 * r**2 + k2 * r**4 + k3 * r**6) / (1 + k4 * r**2 + k5 * r**4 + k6 * r**6)
        u = x * factor + 2 * p1 * x * y + p2 * (r**2 + 2 * x**2)
        v = y * factor + p1 * (r**2 + 2 * y**2) + 2 * p2 * x * y
    np.testing.assert_allclose(50 * u + 33.1, np.broadcast_to(np.arange(70), (45, 70)), atol=1e-6)
    np.testing.assert_allclose(51 * v + 22.7, np.broadcast_to(np.arange(45)[:, None], (45, 70)),
                               atol=1e-6)
    world_from_camera = poses.poses[2] @ MOUNT
    hits = scene.cast(world_from_camera[:3, 3],
                      directions.reshape(-1, 3) @ world_from_camera[:3, :3].T)
    ranges = np.where(np.isfinite(hits.ranges), hits.ranges, np.nan).reshape(45, 70)
    assert np.isfinite(ranges).sum() > 500
    same = hits.primitives.astype(np.int64).reshape(45, 70) == layers["splat"]
    hit = np.isfinite(ranges)
    assert same[hit].mean() > 0.999
    np.testing.assert_allclose(layers["range"][same], ranges[same], atol=1e-3)
    np.testing.assert_allclose(layers["depth"][same], (ranges * directions[..., 0])[same],
                               atol=1e-3)
    np.testing.assert_array_equal(np.isnan(layers["depth"]), layers["splat"] < 0)
    np.testing.assert_array_equal(layers["class"] < 0, layers["splat"] < 0)
    assert layers["normal"].shape == (45, 70, 3)
    facing = layers["normal"] @ world_from_camera[:3, :3] * directions
    assert (facing.sum(axis=-1)[hit & same] <= 0).all()


def test_cameras_are_those_of_the_program(street, scene, poses, tmp_path):
    file = tmp_path / "car.toml"
    file.write_text('[[camera]]\nname = "left"\nwidth = 70\nheight = 45\nfx = 50\nfy = 51\n'
                    'cx = 33.1\ncy = 22.7\nmodel = "brown_conrady"\n'
                    "coefficients = [-0.3, 0.1, 0.01, -0.005, 0]\nmount = [0.5, -0.25, 0.75]\n"
                    "mount_rotation_deg = [90, 0, 0]\n")
    run_program("render", street.model, "-o", tmp_path / "cli.png", "--camera", f"{file}:left",
                "--trajectory", street.sequence, "--pose", 1, "--layers", "depth,class,normal,splat")
    made = adasplats.Camera.from_matrix(MATRIX, **CAMERA, model="plumb_bob", mount=MOUNT,
                                        coefficients=[-0.3, 0.1, 0.01, -0.005, 0])
    read = adasplats.Camera(f"{file}:left")
    assert (read.name, read.width, read.height) == ("left", 70, 45)
    np.testing.assert_array_equal(read.matrix, MATRIX)
    np.testing.assert_allclose(read.mount, MOUNT, atol=1e-12)
    np.testing.assert_array_equal(read.directions(), made.directions())
    view = {"trajectory": street.sequence, "pose": 1}
    for camera in (read, file):
        np.testing.assert_array_equal(scene.render(camera=camera, **view),
                                      png_pixels(tmp_path / "cli.png"))
    layers = scene.layers(layers=["depth", "class", "normal", "splat"], camera=file, **view)
    assert list(layers) == ["depth", "class", "normal", "splat"]
    for name, array in layers.items():
        expected = np.load(tmp_path / f"cli.{name}.npy")
        assert array.dtype == expected.dtype
        np.testing.assert_array_equal(array, expected)


def test_wrong_cameras_and_layers(scene, poses):
    camera = adasplats.Camera.from_matrix(MATRIX, **CAMERA)
    with pytest.raises(ValueError, match="trajectory"):
        scene.layers(camera=camera)
    with pytest.raises(ValueError, match="width has no effect"):
        scene.layers(camera=camera, trajectory=poses, width=9)
    with pytest.raises(ValueError, match="pose is 99"):
        scene.render(camera=camera, trajectory=poses, pose=99)
    with pytest.raises(ValueError, match="did you mean 'depth'"):
        scene.layers(layers=["dept"], width=8, height=8)
    with pytest.raises(TypeError, match="expected a list"):
        scene.layers(layers="depth", width=8, height=8)
    with pytest.raises(TypeError, match="Camera or a path"):
        scene.render(camera=5, trajectory=poses)
    with pytest.raises(ValueError, match="skew"):
        adasplats.Camera.from_matrix([[1, 1, 0], [0, 1, 0], [0, 0, 1]], **CAMERA)
    with pytest.raises(ValueError, match="expected 4"):
        adasplats.Camera.from_matrix(MATRIX, **CAMERA, model="fisheye", coefficients=[1])


def test_realism(street, tmp_path):
    folders = [tmp_path / "one", tmp_path / "other"]
    for seed, folder in enumerate(folders):
        run_program("simulate", street.model, "--path", "0,0;8,0", "--spacing", 1, "--sensor",
                    "velodyne-hdl-64e-kitti", "--seed", seed, "-o", folder)
    expected = report_of(tmp_path, "evaluate", "realism", *folders, "--scans", "1:8", "--seed", 5)
    result = adasplats.evaluate.realism(*folders, first_scan=1, scan_count=8, seed=5)
    assert result == without_times(expected)
    assert result["sensor"] == "velodyne-hdl-64e-kitti"
    with pytest.raises(ValueError, match="7 scans, expected at least 8"):
        adasplats.evaluate.realism(*folders, scan_count=7)


def test_c2c(street):
    expected = report_of(street.folder, "evaluate", "c2c", street.cloud, street.sequence,
                         "--by-class", "--labels", "semantickitti")
    result = adasplats.evaluate.c2c(street.cloud, street.sequence, by_class=True,
                                    labels="semantickitti")
    assert result == without_times(expected)
    in_memory = adasplats.evaluate.c2c(adasplats.read(street.cloud),
                                       adasplats.read(street.sequence), by_class=True,
                                       labels="semantickitti")
    assert in_memory == result
    # Points without classes of their own get those of the nearest original ones.
    bare = adasplats.PointCloud(adasplats.read(street.cloud).world_positions)
    with pytest.raises(ValueError, match="no labels in the simulated cloud"):
        adasplats.evaluate.c2c(bare, street.sequence, by_class=True)
    nearest = adasplats.evaluate.c2c(bare, street.sequence, by_class=True, nearest_classes=True,
                                     labels="semantickitti")
    assert sum(c["points"] for c in nearest["by_class"].values()) == len(bare)
    for part in nearest["by_class"].values():
        assert part["points"] == 0 or part["c2c_m"] == part["c2c_to_all_m"]
    with pytest.raises(ValueError, match="nearest_classes has no effect without by_class"):
        adasplats.evaluate.c2c(bare, street.sequence, nearest_classes=True)


def test_resimulate(street, scene):
    expected = report_of(street.folder, "evaluate", "resimulate", street.model, street.sequence)
    result = adasplats.evaluate.resimulate(street.model, street.sequence)
    assert result == without_times(expected)
    assert adasplats.evaluate.resimulate(scene, street.sequence) == result


def test_resimulate_with_a_protocol(street, scene):
    expected = report_of(street.folder, "evaluate", "resimulate", street.model, street.sequence,
                         "--protocol", "lidar4d")
    result = adasplats.evaluate.resimulate(scene, street.sequence, protocol="lidar4d")
    assert result == without_times(expected)
    assert result["lidar4d"]["scans"] > 0
    with pytest.raises(ValueError, match="protocol must be 'lidar4d'"):
        adasplats.evaluate.resimulate(scene, street.sequence, protocol="lidarrf")
    with pytest.raises(TypeError, match="protocol"):
        adasplats.evaluate.resimulate(scene, street.sequence, protocol=4)


def test_truth(street):
    expected = report_of(street.folder, "evaluate", "truth", street.model, street.mesh,
                         "--trajectory", street.true_poses, "--sensor", street.sensor, "--every", 2)
    result = adasplats.evaluate.truth(street.model, street.mesh, trajectory=street.true_poses,
                                      sensor=street.sensor, every=2)
    assert result == without_times(expected)
    with pytest.raises(TypeError, match="trajectory"):
        adasplats.evaluate.truth(street.model, street.mesh)


def test_presence(street):
    expected = report_of(street.folder, "evaluate", "presence", street.model, street.cloud,
                         "--labels", "semantickitti", "--within", 0.2)
    result = adasplats.evaluate.presence(street.model, street.cloud, labels="semantickitti",
                                         within=0.2)
    assert result == without_times(expected)


def test_echoes(street):
    expected = report_of(street.folder, "evaluate", "echoes", street.model, street.sequence)
    assert adasplats.evaluate.echoes(street.model, street.sequence) == without_times(expected)


def test_labels(street, scene, poses, tmp_path):
    scene.simulate(street.sensor, poses).save(tmp_path)
    simulated = tmp_path / "sequences" / "00"
    expected = report_of(street.folder, "evaluate", "labels", simulated, street.sequence)
    assert adasplats.evaluate.labels(simulated, street.sequence) == without_times(expected)


def test_segmentation(street, tmp_path):
    """Oracle: the program, and the definitions with NumPy."""
    true = adasplats.read(street.cloud).classes.astype(np.int64)
    predicted = np.where(np.arange(true.size) % 3 == 0, 40, true)
    predicted[::7] = 0
    files = [tmp_path / "predicted.label", tmp_path / "true.label"]
    for file, labels in zip(files, (predicted, true)):
        (labels + (5 << 16)).astype("<u4").tofile(file)  # instances change nothing
    result = adasplats.evaluate.segmentation(predicted, true)
    assert result == adasplats.evaluate.segmentation(*files, threads=1)
    assert result == without_times(report_of(street.folder, "evaluate", "segmentation", *files))
    is_counted = ~np.isin(true, [0, 1, 52, 99])
    assert result["points"] == is_counted.sum()
    is_road, is_predicted_road = np.isin(true, [40, 60]), predicted == 40
    expected = (is_road & is_predicted_road).sum() / (is_counted & (is_road | is_predicted_road)).sum()
    np.testing.assert_allclose(result["iou"]["road"], expected)
    assert adasplats.evaluate.segmentation(true, true)["miou_present"] == 1


def test_segmentation_errors(street):
    segmentation = adasplats.evaluate.segmentation
    with pytest.raises(ValueError, match="1 predicted labels, 2 true"):
        segmentation([40], [40, 40])
    with pytest.raises(ValueError, match="class 2 of the true"):
        segmentation([40], np.uint8([2]))
    with pytest.raises(ValueError, match="none of the 0 true points"):
        segmentation(np.uint16([]), np.uint16([]))
    with pytest.raises(ValueError, match="for paths"):
        segmentation([40], [40], first_scan=1)
    with pytest.raises(ValueError, match="min_share"):
        segmentation([40], [40], min_share=2)
    with pytest.raises(TypeError, match="predicted: expected whole numbers"):
        segmentation([0.5], [40])
    with pytest.raises(TypeError, match="true: expected a path"):
        segmentation(street.cloud, [40])
    with pytest.raises(TypeError, match="predicted: expected a path or an array"):
        segmentation(None, [40])


def test_sensors(street):
    report = run_program("sensors").stdout
    names = adasplats.sensors()
    assert len(names) > 10 and all(name in report for name in names)
    sensor = adasplats.Sensor("hdl-64-paper")
    assert (sensor.rings, sensor.columns, sensor.rays_per_scan) == (64, 2250, 144000)
    firings = sensor.firings()
    elevations = np.arcsin(firings.directions[:, 2]).reshape(64, 2250)
    np.testing.assert_allclose(elevations[:, 0], sensor.elevations_rad, atol=1e-6)
    np.testing.assert_allclose(np.degrees(sensor.elevations_rad[[0, -1]]), [2, -24.8])
    assert firings.origins.shape == (144000, 3) and firings.times.max() < 0.1
    assert adasplats.Sensor(str(street.sensor)).name == "tiny"


def test_sensors_from_arrays(scene, poses, street):
    sensor = adasplats.Sensor("hdl-32-paper")
    beams = adasplats.Sensor.from_beams(sensor.elevations_rad, columns=1800, max_range_m=100,
                                        range_noise_m=sensor.range_noise_m)
    f = sensor.firings()
    rays = adasplats.Sensor.from_rays(f.directions, rings=f.rings, columns=f.columns,
                                      times_s=f.times, max_range_m=100,
                                      range_noise_m=sensor.range_noise_m)
    np.testing.assert_array_equal(rays.firings().rings, f.rings)
    np.testing.assert_allclose(rays.firings().directions, f.directions, atol=1e-7)
    ranges = [scene.simulate(s, poses[:1], noise=False)[0].ranges
              for s in (sensor.replaced(max_range_m=100), beams)]
    np.testing.assert_array_equal(*ranges)
    with pytest.raises(ValueError, match="topmost"):
        adasplats.Sensor.from_beams([-0.1, 0.1])
    with pytest.raises(ValueError, match="row 1 has length 0"):
        adasplats.Sensor.from_rays([[1.0, 0, 0], [0, 0, 0]])
    with pytest.raises(ValueError, match="rotation_hz"):
        sensor.replaced(rotation_hz=0)
    with pytest.raises(TypeError, match="did you mean 'max_range_m'"):
        sensor.replaced(max_range=3)


def test_divergence_needs_its_definition():
    """Oracle: a Gaussian beam has half its intensity at sqrt(ln 2 / 2) of its 1/e^2 radius."""
    ouster = adasplats.Sensor("ouster-os1-128")
    full = 2 / np.sqrt(2 * np.log(2))
    assert ouster.divergence_kind == "fwhm"
    np.testing.assert_allclose(np.degrees(ouster.divergence_rad), 2 * [0.18 * full])
    for kind, factor in (("fwhm", full), ("1/e2", 1), ("1/e2-half", 2), ("unknown", 1)):
        sensor = adasplats.Sensor.from_beams([0.0], divergence_horizontal_rad=3e-3,
                                             divergence_vertical_rad=1e-3, divergence_kind=kind)
        np.testing.assert_allclose(sensor.divergence_rad, [3e-3 * factor, 1e-3 * factor])
        assert sensor.divergence_kind == kind
    assert ouster.replaced(name="mine").divergence_rad == ouster.divergence_rad
    with pytest.raises(TypeError, match="needs divergence_kind.*'fwhm', '1/e2'"):
        ouster.replaced(divergence_vertical_rad=1e-3)
    with pytest.raises(TypeError, match="divergence_kind needs"):
        ouster.replaced(divergence_kind="fwhm")
    with pytest.raises(ValueError, match="did you mean 'fwhm'"):
        ouster.replaced(divergence_vertical_rad=1e-3, divergence_kind="FWHM")
    with pytest.raises(ValueError, match="0 to 90 degrees"):
        ouster.replaced(divergence_vertical_rad=1.0, divergence_kind="1/e2-half")


def test_label_schemes():
    scheme = adasplats.label_scheme("semantickitti")
    assert scheme.id_of("road") == 40 and scheme.names[list(scheme.ids).index(40)] == "road"
    assert len(scheme) == len(scheme.ids) == len(scheme.groups) == len(scheme.mobilities)
    assert scheme.colors.shape == (len(scheme), 3)
    assert set(scheme.groups) == {"ground", "surface", "linear", "non-surface"}
    with pytest.raises(KeyError):
        scheme.id_of("roda")


def test_trajectories(street, poses, tmp_path):
    again = adasplats.Trajectory(poses.poses, poses.times)
    again.save(tmp_path / "poses.csv")
    read = adasplats.Trajectory.read(tmp_path / "poses.csv")
    np.testing.assert_allclose(read.poses, poses.poses, atol=1e-8)
    shifted = poses.shifted([1, 2, 3])
    np.testing.assert_allclose(shifted.poses[:, :3, 3] - poses.poses[:, :3, 3],
                               [[1, 2, 3]] * len(poses))
    mount = np.eye(4)
    mount[:3, 3] = [0.5, 0, 1]
    np.testing.assert_allclose(poses.mounted(mount).poses, poses.poses @ mount, atol=1e-12)
    middle = (poses.times[0] + poses.times[1]) / 2
    np.testing.assert_allclose(poses.interpolate(middle)[:3, 3],
                               poses.poses[:2, :3, 3].mean(axis=0), atol=1e-9)
    dense = poses.resampled(rate_hz=10)
    np.testing.assert_allclose(np.diff(dense.times), 0.1)
    way = np.linalg.norm(np.diff(poses.resampled(spacing_m=2).poses[:, :3, 3], axis=0), axis=1)
    assert np.all(way < 2.001)
    with pytest.raises(TypeError):
        poses.resampled()
    with pytest.raises(ValueError, match="ascend"):
        adasplats.Trajectory(np.stack([np.eye(4)] * 2), [1, 1])
