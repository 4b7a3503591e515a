# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Objects go from process to process."""
import copy
import multiprocessing
import pickle

import numpy as np
import pytest

import adasplats


def content_of(value):
    """Everything that an object tells, as something that can be compared."""
    told = {}
    for name in dir(type(value)):
        member = getattr(type(value), name)
        if name.startswith("_") or not isinstance(member, property):
            continue
        told[name] = getattr(value, name)
        if isinstance(told[name], np.ndarray):
            told[name] = (told[name].shape, told[name].dtype, told[name].tobytes())
    if isinstance(told.get("response"), dict):
        told["response"] = {key: each.tobytes() for key, each in told["response"].items()}
    return told


def objects(street, scene, poses):
    scans = scene.simulate(street.sensor, poses, returns=2)
    return {
        "Sensor": adasplats.Sensor("ouster-os1-64"),
        "Sensor of rays": adasplats.Sensor.from_rays([[1.0, 0, 0], [0, 1, 0]], times_s=[0, 0.01]),
        "Sensor with prisms": adasplats.Sensor("livox-mid-40"),
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


def test_a_sensor_of_a_pickle_casts_the_same_rays():
    for name in adasplats.sensors():
        sensor = adasplats.Sensor(name)
        again = pickle.loads(pickle.dumps(sensor))
        for scan_index in (0, 3):
            np.testing.assert_array_equal(again.firings(scan_index).directions,
                                          sensor.firings(scan_index).directions)


def test_scans_of_a_pickle_are_saved_alike(scene, poses, street, tmp_path):
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


def test_processes_hand_them_to_one_another(street, poses):
    model = adasplats.Model.load(street.model)
    sensor = adasplats.Sensor(street.sensor)
    work = [(model, sensor, poses[:1]), (model, sensor, poses[1:2])]
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        scans = pool.map(simulated, work)
    for scan, arguments in zip(scans, work):
        np.testing.assert_array_equal(scan.positions, simulated(arguments).positions)


def test_other_pickles_are_refused():
    sensor = adasplats.Sensor("hdl-64-paper")
    name, version, fields = sensor.__getstate__()
    fresh = adasplats.Sensor.__new__
    for state, says in (((name, version + 1, fields), f"has version {version + 1}.*reads version"),
                        (("adasplats.Scan", version, fields), "is one of adasplats.Scan"),
                        ((name, version), "is damaged"), ("text", "is damaged"),
                        ((name, version, {}), "has no field 'name'"),
                        ((name, version, {**fields, "columns": b"1"}), "is cut in columns"),
                        ((name, version, {**fields, "elevations_rad": b"1"}), "is cut in"),
                        ((name, version, {**fields, "name": 1}), "of another kind")):
        with pytest.raises(ValueError, match=says):
            fresh(adasplats.Sensor).__setstate__(state)


def test_what_cannot_be_pickled_says_so(scene):
    with pytest.raises(TypeError, match="Scene"):
        pickle.dumps(scene)
