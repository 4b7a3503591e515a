# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Errors: built-in base class, message of the library, one line."""
import numpy as np
import pytest

import adasplats


def test_classes():
    for name, python in (("UsageError", ValueError), ("DataError", ValueError),
                         ("ConfigError", ValueError), ("InputError", FileNotFoundError),
                         ("OutputError", OSError), ("UnavailableError", RuntimeError),
                         ("SoftwareError", RuntimeError)):
        error = getattr(adasplats, name)
        assert issubclass(error, python) and issubclass(error, adasplats.Error)


def test_what_is_missing(tmp_path, scene):
    missing = tmp_path / "nothing.ply"
    for call in (lambda: adasplats.read(missing), lambda: adasplats.model(str(missing)),
                 lambda: adasplats.Model.load(missing), lambda: adasplats.Mesh.load(missing),
                 lambda: adasplats.Scene(missing), lambda: adasplats.Trajectory.read(missing),
                 lambda: adasplats.evaluate.c2c(missing, missing),
                 lambda: adasplats.evaluate.resimulate(scene, missing),
                 lambda: adasplats.evaluate.realism(missing, missing),
                 lambda: adasplats.evaluate.truth(missing, missing, trajectory=missing),
                 lambda: scene.simulate("hdl-32-paper", np.eye(4), ray_drop=missing)):
        with pytest.raises(FileNotFoundError, match="nothing.ply") as caught:
            call()
        assert isinstance(caught.value, adasplats.Error) and "\n" not in str(caught.value)


def test_what_is_wrong(tmp_path, scene):
    broken = tmp_path / "broken.ply"
    broken.write_text("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n1\n")
    for call in (adasplats.read, adasplats.Model.load, adasplats.Mesh.load, adasplats.Scene):
        with pytest.raises(ValueError, match="broken.ply"):
            call(broken)
    scheme = tmp_path / "scheme.toml"
    scheme.write_text("nam = 3\n")
    with pytest.raises(ValueError, match="scheme.toml:1"):
        adasplats.label_scheme(scheme)
    with pytest.raises(ValueError, match="did you mean 'hdl-64-paper'"):
        scene.simulate("hdl-64-papr", np.eye(4))


def test_arrays_are_no_clouds():
    with pytest.raises(TypeError, match="expected a PointCloud, a path or a list of paths, got nda"):
        adasplats.model(np.zeros((5, 3)))


def test_where_nothing_can_be_written(tmp_path, scene):
    model = adasplats.Model([[0.0, 0, 0]], [[0, 0, 1.0]], [1.0])
    with pytest.raises(OSError):
        model.save(tmp_path / "no" / "folder" / "model.ply")
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError):
        scene.simulate("hdl-32-paper", np.eye(4)).save(tmp_path / "file" / "scans")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file"]


def test_names_say_what_is_written(tmp_path):
    model = adasplats.Model([[0.0, 0, 0]], [[0, 0, 1.0]], [1.0])
    cloud = adasplats.PointCloud(np.zeros((5, 3)))
    for save in (model.save, cloud.save):
        with pytest.raises(ValueError, match=r"a.txt: the output format needs a name that ends "
                                             r"with .ply"):
            save(tmp_path / "a.txt")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("keywords, error, message", [
    ({"neighbours": 3}, TypeError, "keyword argument 'neighbours', did you mean 'neighbors'"),
    ({"completely_wrong": 3}, TypeError, "unexpected keyword argument 'completely_wrong'$"),
    ({"neighbors": 3.5}, TypeError, "neighbors must be a whole number, not float"),
    ({"neighbors": True}, TypeError, "neighbors must be a whole number, not bool"),
    ({"neighbors": 10**30}, ValueError, "neighbors is out of range"),
    ({"neighbors": 1}, ValueError, "neighbors"),
    ({"alpha": "0.2"}, TypeError, "alpha must be a number, not str"),
    ({"alpha": None}, TypeError, "alpha must be a number, not NoneType"),
    ({"fill": 1}, TypeError, "fill must be True or False, not int"),
    ({"method": "basik"}, ValueError, "method must be 'consistent', 'basic', 'desc.*not 'basik'"),
    ({"method": 3}, TypeError, "method must be a string, not int"),
    ({"seed": -1}, ValueError, "seed must be 0 to"),
    ({"threads": -1}, ValueError, "threads must be 0 to 4096"),
    ({"linear_scale": [1, 2]}, ValueError, "linear_scale: expected"),
    ({"progress": 3}, TypeError, "progress must be None or a function"),
    ({"labels": 3}, TypeError, "labels must be a string, not int"),
    ({"device": "gpu"}, ValueError, "device must be 'auto', 'cpu', 'cuda' or 'optix'"),
    ({"gpus": "0"}, TypeError, "gpus must be a list of whole numbers"),
    ({"method": "semantic"}, ValueError, "labels"),
])
def test_keywords(keywords, error, message):
    cloud = adasplats.PointCloud(np.random.default_rng(1).normal(size=(100, 3)))
    with pytest.raises(error, match=message):
        adasplats.model(cloud, **keywords)


def test_numpy_scalars_are_numbers():
    points = np.random.default_rng(1).normal(size=(200, 3))
    cloud = adasplats.PointCloud(points, sensor_positions=points + 1)
    a = adasplats.model(cloud, method="basic", neighbors=np.int16(10), alpha=np.float32(0.5),
                        denoise=np.bool_(False), radius=np.float64(0.3))
    b = adasplats.model(cloud, method="basic", neighbors=10, alpha=0.5, denoise=False, radius=0.3)
    np.testing.assert_array_equal(a.centers, b.centers)


def test_a_missing_gpu():
    if adasplats.devices():
        pytest.skip("there is a GPU")
    assert adasplats.why_no_gpu()
    model = adasplats.Model([[0.0, 0, 0]], [[0, 0, 1.0]], [1.0])
    with pytest.raises(RuntimeError, match="cuda"):
        adasplats.Scene(model, device="cuda")
    with pytest.raises(adasplats.UnavailableError, match="NVIDIA|CUDA"):
        adasplats.limit_gpu_memory(8)
    scene = adasplats.Scene(model)
    assert scene.device == "cpu"
    with pytest.raises(RuntimeError, match="on the CPU"):
        scene.cast_on_device("hdl-32-paper", np.eye(4))


def test_warnings_are_python_warnings(street):
    with pytest.warns(UserWarning, match="labels"):
        adasplats.model(street.cloud)


@pytest.mark.parametrize("call, message", [
    (lambda: adasplats.Sensor(name_of_file="x"),
     r"Sensor\(\) got an unexpected keyword argument 'name_of_file', did you mean 'name_or_file'"),
    (lambda: adasplats.Sensor(), r"Sensor\(\) is missing the argument 'name_or_file'"),
    (lambda: adasplats.Sensor("hdl-64-paper", 1),
     r"Sensor\(\) takes at most 1 positional arguments, but 2 were given"),
    (lambda: adasplats.Sensor("hdl-64-paper").firings(scan_idx=1),
     r"firings\(\) got an unexpected keyword argument 'scan_idx', did you mean 'scan_index'"),
    (lambda: adasplats.Sensor("hdl-64-paper").firings("one"), r"firings\(scan_index=0\).*\(str\)"),
    (lambda: adasplats.Sensor.from_beams(elevation_rad=[0.0]), "did you mean 'elevations_rad'"),
    (lambda: adasplats.Trajectory(np.eye(4)).resampled(rate=1),
     r"resampled\(\) got an unexpected keyword argument 'rate', did you mean 'rate_hz'"),
    (lambda: adasplats.PointCloud([[0.0, 0, 0]], class_ids=[1]), r"PointCloud\(\).*'classes'"),
    (lambda: adasplats.PointCloud(), r"PointCloud\(\) is missing the argument 'positions'"),
    (lambda: adasplats.PointCloud([[0.0, 0, 0]], positions=1), "several values"),
    (lambda: adasplats.label_scheme(name="semantickitti"), "did you mean 'name_or_path'"),
    (lambda: adasplats.evaluate.c2c("a"), r"c2c\(\) is missing the argument"),
])
def test_wrong_arguments_are_explained(call, message):
    """Oracle: no C++ terms in the message."""
    with pytest.raises(TypeError, match=message) as error:
        call()
    for word in ("incompatible", "pybind11", "handle", "std::", "arg0"):
        assert word not in str(error.value)


def test_messages_name_keywords(street):
    """Messages of the library name settings, which must become keywords, not options."""
    with pytest.raises(ValueError, match="^max_distance_m is -1, expected more than 0$"):
        adasplats.read(street.cloud, max_distance_m=-1)
    with pytest.raises(ValueError, match="^own_body_m is inf, expected 0 or more$"):
        adasplats.read(street.cloud, own_body_m=float("inf"))
    assert len(adasplats.read(street.cloud, max_distance_m=float("inf"))) > 0
