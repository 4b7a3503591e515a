# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Pickling of all objects."""
import copy
import multiprocessing
import pickle

import numpy as np
import pytest

import adasplats


def content_of(value):
    """All properties of an object in a form that can be compared."""
    content = {}
    for name in dir(type(value)):
        member = getattr(type(value), name)
        if name.startswith("_") or not isinstance(member, property):
            continue
        content[name] = getattr(value, name)
        if isinstance(content[name], np.ndarray):
            content[name] = (content[name].shape, content[name].dtype, content[name].tobytes())
    if isinstance(content.get("response"), dict):
        content["response"] = {key: each.tobytes() for key, each in content["response"].items()}
    return content


def objects(street, scene, poses):
    scans = scene.simulate(street.sensor, poses, returns=2)
    return {
        "Sensor": adasplats.Sensor("ouster-os1-64"),
        "Sensor of rays": adasplats.Sensor.from_rays([[1.0, 0, 0], [0, 1, 0]], times_s=[0, 0.01]),
        "Sensor with prisms": adasplats.Sensor("livox-mid-40"),
        "Camera": adasplats.Camera.from_matrix([[50, 0, 30], [0, 51, 20], [0, 0, 1]], 60, 40,
                                               model="fisheye", coefficients=[0.1, 0, 0, 0]),
        "Trajectory": poses,
        "Scan": scans[0],
        "Scans": scans,
        "PointCloud": adasplats.read(street.cloud),
        "PointCloud without points": adasplats.PointCloud(np.zeros((0, 3))),
        "Model": adasplats.Model.load(street.model),
        "Model that was made": adasplats.model(adasplats.read(street.cloud), method="basic"),
        "Mesh": adasplats.Mesh.load(street.mesh),
        "LabelScheme": adasplats.label_scheme("semantickitti"),
    }


def test_pickles_and_copies_are_equal(street, scene, poses):
    """Oracle: the object itself."""
    for name, value in objects(street, scene, poses).items():
        expected = content_of(value)
        for again in (pickle.loads(pickle.dumps(value)), copy.deepcopy(value),
                      pickle.loads(pickle.dumps(value, protocol=2))):
            assert type(again) is type(value), name
            assert content_of(again) == expected, name
            assert not hasattr(value, "__len__") or len(again) == len(value), name


def test_unpickled_sensors_have_the_same_rays():
    for name in adasplats.sensors():
        sensor = adasplats.Sensor(name)
        again = pickle.loads(pickle.dumps(sensor))
        for scan_index in (0, 3):
            np.testing.assert_array_equal(again.firings(scan_index).directions,
                                          sensor.firings(scan_index).directions)


def test_unpickled_scans_save_the_same_files(scene, poses, street, tmp_path):
    scans = scene.simulate(street.sensor, poses[:2])
    scans.save(tmp_path / "a", format="range-image")
    pickle.loads(pickle.dumps(scans)).save(tmp_path / "b", format="range-image")
    files = sorted(path.name for path in (tmp_path / "a").iterdir())
    assert any(name.endswith("_label.png") for name in files)
    assert sorted(path.name for path in (tmp_path / "b").iterdir()) == files
    for name in files:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def simulated(arguments):
    model, sensor, poses = arguments
    return adasplats.Scene(model, device="cpu", threads=1).simulate(sensor, poses, seed=3)[0]


def test_objects_pass_between_processes(street, poses):
    model = adasplats.Model.load(street.model)
    sensor = adasplats.Sensor(street.sensor)
    work = [(model, sensor, poses[:1]), (model, sensor, poses[1:2])]
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        scans = pool.map(simulated, work)
    for scan, arguments in zip(scans, work):
        np.testing.assert_array_equal(scan.positions, simulated(arguments).positions)


def test_wrong_pickles_are_rejected():
    sensor = adasplats.Sensor("hdl-64-paper")
    name, version, fields = sensor.__getstate__()
    fresh = adasplats.Sensor.__new__
    for state, message in (((name, version + 1, fields), f"has version {version + 1}.*reads version"),
                        (("adasplats.Scan", version, fields), "is of adasplats.Scan"),
                        ((name, version), "is damaged"), ("text", "is damaged"),
                        ((name, version, {}), "has no field 'name'"),
                        ((name, version, {**fields, "columns": b"1"}), "is truncated in columns"),
                        ((name, version, {**fields, "elevations_rad": b"1"}), "is truncated in"),
                        ((name, version, {**fields, "name": 1}), "of another type")):
        with pytest.raises(ValueError, match=message):
            fresh(adasplats.Sensor).__setstate__(state)


def test_scenes_cannot_be_pickled(scene):
    with pytest.raises(TypeError, match="Scene"):
        pickle.dumps(scene)
