# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Conversion of array arguments, and array views."""
import gc
import pickle

import numpy as np
import pytest
from conftest import unit_rays

import adasplats

POINTS = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]])


def same(array, kind):
    """The same numbers, laid out in memory in other ways."""
    if kind == "strided":
        wide = np.zeros((2 * len(array), 3), array.dtype)
        wide[::2] = array
        return wide[::2]
    if kind == "reversed":
        return array[::-1].copy()[::-1]
    if kind == "columns":
        wide = np.zeros((len(array), 5), array.dtype)
        wide[:, 1:4] = array
        return wide[:, 1:4]
    if kind == "fortran":
        return np.asfortranarray(array)
    if kind == "big-endian":
        return array.astype(array.dtype.newbyteorder(">"))
    if kind == "unaligned":
        raw = bytearray(1 + array.nbytes)
        raw[1:] = array.tobytes()
        return np.frombuffer(raw, array.dtype, offset=1).reshape(array.shape)
    if kind == "read-only":
        array = array.copy()
        array.flags.writeable = False
        return array
    if kind == "list":
        return array.tolist()
    return array.astype(kind)


KINDS = ["strided", "reversed", "columns", "fortran", "big-endian", "unaligned", "read-only",
         "list"]


@pytest.mark.parametrize("kind", KINDS + ["float64", "float16", "int64", "uint8", "int16",
                                          "longdouble"])
def test_points_of_any_layout(kind):
    cloud = adasplats.PointCloud(same(POINTS, kind))
    np.testing.assert_array_equal(cloud.world_positions, POINTS)
    cloud = adasplats.PointCloud(same(POINTS.astype(np.float32), kind))
    np.testing.assert_array_equal(cloud.positions, POINTS)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_rays_of_any_layout(wall, kind, dtype):
    directions = unit_rays(1000).astype(dtype)
    origins = np.zeros((1000, 3), dtype)
    expected = wall.cast(np.zeros(3), directions.copy())
    hits = wall.cast(same(origins, kind), same(directions, kind))
    np.testing.assert_array_equal(hits.ranges, expected.ranges)
    np.testing.assert_array_equal(hits.primitives, expected.primitives)


def test_analytic_ranges(wall):
    """Oracle: the plane x = 5 within 10 m of its middle."""
    directions = unit_rays(5000)
    hits = wall.cast([1.0, 0, 0], directions)
    t = 4 / directions[:, 0]
    inside = np.linalg.norm(t[:, None] * directions - [4, 0, 0], axis=1) < 10
    np.testing.assert_array_equal(hits.valid, inside)
    np.testing.assert_allclose(hits.ranges[inside], t[inside], rtol=1e-6)
    assert np.all(np.isinf(hits.ranges[~inside]))
    assert np.all(hits.primitives[~inside] == adasplats.NO_PRIMITIVE)
    np.testing.assert_array_equal(hits.classes, np.where(inside, 50, 0))
    np.testing.assert_array_equal(hits.normals[inside], np.broadcast_to([-1, 0, 0],
                                                                        (inside.sum(), 3)))
    assert np.all(np.isnan(hits.normals[~inside]))


def test_one_origin_or_one_direction_for_all(wall):
    directions = unit_rays(10)
    one = wall.cast([0.0, 0, 0], directions).ranges
    np.testing.assert_array_equal(one, wall.cast(np.zeros((10, 3)), directions).ranges)
    broadcast = np.broadcast_to(np.zeros(3, np.float32), (10, 3))
    np.testing.assert_array_equal(one, wall.cast(broadcast, directions).ranges)
    many = wall.cast([[0.0, 0, 0], [1.0, 0, 0]], [1.0, 0, 0])
    np.testing.assert_array_equal(many.ranges, [5, 4])
    assert len(wall.cast([0.0, 0, 0], [1.0, 0, 0])) == 1


def test_limits_and_depth():
    model = adasplats.Model([[x, 0, 0] for x in (1.0, 2, 3)], [[1.0, 0, 0]] * 3, [1.0] * 3)
    scene = adasplats.Scene(model, device="cpu")
    hits = scene.cast([[0.0, 0, 0]], [[1.0, 0, 0]], depth=5)
    np.testing.assert_array_equal(hits.ranges, [[1, 2, 3, np.inf, np.inf]])
    np.testing.assert_array_equal(hits.primitives[0, :3], [0, 1, 2])
    assert hits.normals.shape == (1, 5, 3)
    assert hits.classes is None
    assert scene.cast([0.0, 0, 0], [1.0, 0, 0], t_min=1.5).ranges[0] == 2
    assert np.isinf(scene.cast([0.0, 0, 0], [1.0, 0, 0], t_max=0.5).ranges[0])
    with pytest.raises(ValueError):
        scene.cast([0.0, 0, 0], [1.0, 0, 0], depth=0)


def test_world_and_local_coordinates():
    far = np.array([700000.0, 5000000.0, 100.0])
    model = adasplats.Model([far + [5, 0, 0]], [[1.0, 0, 0]], [1.0])
    scene = adasplats.Scene(model, device="cpu")
    assert np.linalg.norm(scene.origin - far) < 2000
    hit = scene.cast(far + [0.25, 0, 0], [1.0, 0, 0])
    assert hit.ranges[0] == 4.75
    local = (far + [0.25, 0, 0] - scene.origin).astype(np.float32)
    assert scene.cast(local, [1.0, 0, 0], local=True).ranges[0] == 4.75


def test_rays_that_are_not_finite_hit_nothing(wall):
    directions = np.array([[1.0, 0, 0], [np.nan, 0, 0], [np.inf, 0, 0], [0, 0, 0]])
    np.testing.assert_array_equal(wall.cast([0.0, 0, 0], directions).valid, [1, 0, 0, 0])


@pytest.mark.parametrize("empty", [np.zeros((0, 3)), np.zeros((0, 3), np.float32), [], np.zeros(0)])
def test_empty_gives_empty(wall, empty):
    hits = wall.cast([0.0, 0, 0], empty)
    assert hits.ranges.shape == (0,) and hits.primitives.shape == (0,) and len(hits) == 0
    assert hits.valid.shape == (0,) and hits.normals.shape == (0, 3)
    assert wall.cast(empty, empty, depth=3).ranges.shape == (0, 3)
    assert adasplats.PointCloud(empty).positions.shape == (0, 3)
    with pytest.raises(ValueError, match="no points"):
        adasplats.model(adasplats.PointCloud(empty))


def test_attributes_of_nothing_are_empty(wall):
    """Not None: code that takes them needs no special case for a scan without returns."""
    away = np.eye(4)
    away[0, 3] = 1000
    scan = wall.simulate("hdl-32-paper", away)[0]
    assert len(scan) == 0 and scan.rays > 0
    for name in ("positions", "ranges", "rings", "columns", "times", "classes", "intensities",
                 "instances", "return_indices"):
        assert len(getattr(scan, name)) == 0
    assert wall.simulate("hdl-32-paper", np.eye(4))[0].intensities is None


@pytest.mark.parametrize("bad", [np.zeros((3, 2)), np.zeros(4), np.zeros((3, 3, 3)),
                                 np.zeros((3, 0)), np.float64(1), np.zeros((3, 4))])
def test_wrong_shape(wall, bad):
    for call in (lambda: adasplats.PointCloud(bad), lambda: wall.cast([0.0, 0, 0], bad),
                 lambda: adasplats.Model(bad, bad, [1.0])):
        with pytest.raises(ValueError, match="expected shape"):
            call()


@pytest.mark.parametrize("bad", [np.zeros((3, 3), bool), np.zeros((3, 3), complex),
                                 np.zeros((3, 3), object), [["a", "b", "c"]], None, "points",
                                 np.zeros((3, 3), "M8[s]"), object(), {1: 2}])
def test_wrong_type(wall, bad):
    for call in (lambda: adasplats.PointCloud(bad), lambda: wall.cast([0.0, 0, 0], bad)):
        with pytest.raises(TypeError, match="expected"):
            call()


def test_row_counts_must_match(wall):
    with pytest.raises(ValueError, match="same number of rows"):
        wall.cast(np.zeros((2, 3)), np.ones((3, 3)))
    with pytest.raises(ValueError, match="expected shape"):
        adasplats.PointCloud(POINTS, classes=[1, 2])
    with pytest.raises(ValueError, match="sensor_positions"):
        adasplats.PointCloud(POINTS, sensor_positions=[[0.0, 0, 0]])


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_not_finite_names_the_first_row(value):
    points = POINTS.copy()
    points[1, 2] = value
    with pytest.raises(ValueError, match="positions: row 1 is not finite"):
        adasplats.PointCloud(points)
    with pytest.raises(ValueError, match="sensor_positions: row 1"):
        adasplats.PointCloud(POINTS, sensor_positions=points)
    if np.isnan(value):  # unknown
        assert np.isnan(adasplats.PointCloud(POINTS, intensities=[1, 2, value]).intensities[2])
        return
    with pytest.raises(ValueError, match=r"intensities\[2\] is not finite"):
        adasplats.PointCloud(POINTS, intensities=[1, 2, value])


@pytest.mark.parametrize("values, error", [([1, 2, 65536], ValueError), ([1, -1, 2], ValueError),
                                           ([1.0, 2.0, 3.0], TypeError), (["a"] * 3, TypeError),
                                           ([True] * 3, TypeError), ([[1, 2, 3]], ValueError)])
def test_classes_are_checked(values, error):
    with pytest.raises(error, match="classes"):
        adasplats.PointCloud(POINTS, classes=values)


def test_attributes_round_trip():
    attributes = {"classes": np.array([1, 2, 65535]), "instances": np.array([0, 1, 2], np.uint8),
                  "intensities": np.array([0.5, 1, 1.5]), "sensor_positions": POINTS + 1,
                  "scan_indices": np.array([0, 1, 4000000000], np.uint64)}
    cloud = adasplats.PointCloud(POINTS, **attributes)
    for name, values in attributes.items():
        np.testing.assert_array_equal(getattr(cloud, name), values)
    assert adasplats.PointCloud(POINTS).classes is None


# Fields of packed records are unaligned. Read wrongly, these crash under a sanitizer alone.
def test_attributes_in_packed_records():
    records = np.zeros(3, [("tag", "u1"), ("class", "u8"), ("instance", "i8"), ("intensity", "f8"),
                           ("pose", "f8", (4, 4))])
    records["class"], records["instance"] = [1, 2, 65535], [0, 1, 2]
    records["intensity"], records["pose"] = [0.25, 0.5, 1], np.eye(4)
    records["pose"][:, 0, 3] = [1, 2, 3]
    assert not records["class"].flags.aligned
    cloud = adasplats.PointCloud(POINTS, classes=records["class"], instances=records["instance"],
                                 intensities=records["intensity"])
    np.testing.assert_array_equal(cloud.classes, [1, 2, 65535])
    np.testing.assert_array_equal(cloud.instances, [0, 1, 2])
    np.testing.assert_array_equal(cloud.intensities, [0.25, 0.5, 1])
    for poses in (records["pose"], same(records["pose"].copy(), "unaligned")):
        np.testing.assert_array_equal(adasplats.Trajectory(poses).poses, records["pose"])


def test_far_coordinates_keep_millimetres():
    far = POINTS + [700000.125, 5000000.5, 100]
    cloud = adasplats.PointCloud(far)
    assert np.abs(cloud.world_positions - far).max() < 1e-3
    given = adasplats.PointCloud(far, origin=[700000, 5000000, 0])
    np.testing.assert_array_equal(given.origin, [700000, 5000000, 0])
    np.testing.assert_array_equal(given.world_positions, far)


def test_views_are_read_only_and_no_copies(wall):
    cloud = adasplats.PointCloud(POINTS, classes=[1, 2, 3])
    for array in (cloud.positions, cloud.classes):
        assert not array.flags.writeable and not array.flags.owndata
        with pytest.raises(ValueError):
            array[0] = 0
    first, again = cloud.positions, cloud.positions
    assert first.__array_interface__["data"] == again.__array_interface__["data"]
    hits = wall.cast([0.0, 0, 0], unit_rays(10))
    start = hits.ranges.__array_interface__["data"][0]
    assert hits.primitives.__array_interface__["data"][0] == start + 4
    assert hits.ranges.strides == (8,)


def test_arrays_outlive_their_owners(scene, poses):
    ranges = scene.simulate("hdl-32-paper", poses)[0].ranges
    kept = ranges.copy()
    centers = adasplats.Model([[1.0, 2, 3]], [[0, 0, 1.0]], [1.0]).centers
    positions = adasplats.PointCloud(POINTS).positions
    hits = adasplats.Scene(adasplats.Model([[1.0, 0, 0]], [[1.0, 0, 0]], [1.0], classes=[7]),
                           device="cpu").cast([0.0, 0, 0], [1.0, 0, 0])
    directions = adasplats.Sensor("hdl-32-paper").firings().directions
    gc.collect()
    np.testing.assert_array_equal(ranges, kept)
    np.testing.assert_array_equal(centers, [[1, 2, 3]])
    np.testing.assert_array_equal(positions, POINTS)
    np.testing.assert_array_equal(hits.classes, [7])
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1, rtol=1e-6)


def test_arrays_pickle_and_dlpack(scene, poses):
    scan = scene.simulate("hdl-32-paper", poses)[0]
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(scan.positions)), scan.positions)
    for array in (scan.ranges, scan.positions, scan.positions[::2, 1:], scan.ranges[:0]):
        exported = np.from_dlpack(array)
        np.testing.assert_array_equal(exported, array)
        assert exported.shape == array.shape and exported.dtype == array.dtype
    # Oracle: without a read-only flag the consumer gets a copy, or an error.
    has_readonly_flag = tuple(map(int, np.__version__.split(".")[:2])) >= (2, 1)
    assert np.shares_memory(np.from_dlpack(scan.ranges), scan.ranges) == has_readonly_flag
    with pytest.raises(BufferError, match=r"hand over array\.copy\(\)"):
        scan.ranges.__dlpack__(copy=False)
    assert np.shares_memory(np.from_dlpack(scan.ranges.copy()), scan.ranges) is False


def test_views_behave_like_arrays(scene, poses):
    ranges = scene.simulate("hdl-32-paper", poses)[0].ranges
    assert isinstance(ranges, np.ndarray) and not ranges.flags.writeable
    for plain in (ranges + 1, np.exp(ranges), np.array(ranges), ranges > 5):
        assert type(plain) is np.ndarray
    assert type(ranges.max()) is np.float32 and type(ranges[0]) is np.float32
    assert type(pickle.loads(pickle.dumps(ranges))) is np.ndarray
    with pytest.raises(ValueError, match="read-only"):
        ranges[0] = 1


def test_poses_are_checked(scene):
    good = np.eye(4)
    assert len(scene.simulate("hdl-32-paper", good)) == 1
    assert len(scene.simulate("hdl-32-paper", np.zeros((0, 4, 4)))) == 0
    for matrix, message in ((2 * good, "last row"), (np.diag([1, 1, -1.0, 1]), "orthonormal"),
                         (np.diag([2, 2, 2.0, 1]), "orthonormal"),
                         (np.diag([np.nan, 1, 1, 1]), "not finite")):
        with pytest.raises(ValueError, match=message):
            scene.simulate("hdl-32-paper", [good, matrix])
    for bad in (np.eye(3), np.zeros((2, 3, 4)), np.zeros(16)):
        with pytest.raises(ValueError, match=r"expected shape \(N, 4, 4\)"):
            scene.simulate("hdl-32-paper", bad)
    with pytest.raises(TypeError):
        scene.simulate("hdl-32-paper", "poses.csv")


def test_models_from_arrays_are_checked():
    good = ([[0.0, 0, 0]], [[0, 0, 1.0]], [1.0])
    assert len(adasplats.Model(*good)) == 1
    for centers, normals, radii, message in ((good[0], [[0, 0, 2.0]], good[2], "unit length"),
                                          (good[0], good[1], [0.0], "greater than 0"),
                                          (good[0], good[1], [np.nan], "not finite"),
                                          (good[0], good[1], [1.0, 2], "expected shape"),
                                          ([[np.nan, 0, 0]], good[1], good[2], "row 0")):
        with pytest.raises(ValueError, match=message):
            adasplats.Model(centers, normals, radii)
    with pytest.raises(ValueError, match="no splats"):
        adasplats.Scene(adasplats.Model(np.zeros((0, 3)), np.zeros((0, 3)), []))


def test_mesh_from_arrays():
    mesh = adasplats.Mesh([[5.0, -1, -1], [5, 1, -1], [5, 0, 1]], [[0, 1, 2]], classes=[40])
    hits = adasplats.Scene(mesh, device="cpu").cast([0.0, 0, 0], [1.0, 0, 0])
    assert hits.ranges[0] == 5 and hits.classes[0] == 40
    np.testing.assert_array_equal(np.abs(hits.normals[0]), [1, 0, 0])
    with pytest.raises(ValueError, match="triangles"):
        adasplats.Mesh([[5.0, -1, -1]], [[0, 1, 2]])
    with pytest.raises(ValueError, match="triangles"):
        adasplats.Mesh(POINTS, [[0, 1]])
