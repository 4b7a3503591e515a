# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Semantic classes of a network, as arrays and in models, against the command line."""
import hashlib
import json
import pickle
import struct

import numpy as np
import pytest
from conftest import run_program

import adasplats

ROAD, CAR = 40, 10
HEIGHT_M = 1.13


def write_network(path, classes=("road", "car")):
    """Points higher than HEIGHT_M above the ground belong to the second class."""
    layer = {"kind": "unary", "level": 0, "input": 0, "output": 1, "weight": 0, "bias": 1}
    header = {"version": 1, "card": "a test", "values": 2, "kernel": [[0, 0, 0]],
              "shape": {"cell_m": 0.1, "levels": 1, "radius": 2.5, "neighbors": 8, "sigma": 1.2,
                        "height_unit_m": HEIGHT_M},
              "features": ["one", "height"], "classes": list(classes), "layers": [layer],
              "weights": [{"shape": [2, 2], "offset": 0}, {"shape": [1, 2], "offset": 8}]}
    text = json.dumps(header).encode()
    path.write_bytes(b"adasplats-network\n" + struct.pack("<Q", len(text)) + text +
                     struct.pack("<6e", 1, 0, 0, 1, 0, 0))
    return path


@pytest.fixture
def network(tmp_path):
    path = write_network(tmp_path / "height.network")
    try:
        adasplats.segment(adasplats.PointCloud(np.zeros((1, 3))), network=path)
    except adasplats.UnavailableError as error:
        assert "OpenBLAS" in str(error)
        pytest.skip("built without OpenBLAS")
    return path


@pytest.fixture
def cloud():
    """A road and a wall next to it, without labels."""
    draw = np.random.default_rng(1)
    road = np.stack([draw.uniform(0, 12, 4000), draw.uniform(-4, 4, 4000), np.zeros(4000)], 1)
    wall = np.stack([draw.uniform(0, 12, 2000), np.full(2000, 4.0), draw.uniform(0, 3, 2000)], 1)
    points = np.concatenate([road, wall])
    return adasplats.PointCloud(points, sensor_positions=points * [1, 0, 0] + [0, 0, 2],
                                intensities=draw.uniform(size=6000))


def test_classes_and_confidences(cloud, network):
    classes = adasplats.segment(cloud, network=network)
    assert classes.dtype == np.uint16 and classes.shape == (len(cloud),)
    heights = cloud.positions[:, 2]
    clear = np.abs(heights + cloud.origin[2] - HEIGHT_M) > 0.1  # a cell has one class
    expected = np.where(heights + cloud.origin[2] > HEIGHT_M, CAR, ROAD)
    np.testing.assert_array_equal(classes[clear], expected[clear])
    again, confidences = adasplats.segment(cloud, network=network, confidences=True, threads=1)
    np.testing.assert_array_equal(again, classes)
    assert confidences.dtype == np.float32 and confidences.shape == classes.shape
    # Oracle: softmax of two logits, 1 and the height over HEIGHT_M; on the road the height is 0.
    np.testing.assert_allclose(confidences[:4000][clear[:4000]].max(), 1 / (1 + np.exp(-1)),
                               atol=0.01)
    assert confidences.min() >= 0.5
    if hasattr(np, "from_dlpack"):
        np.testing.assert_array_equal(np.from_dlpack(confidences), confidences)
    classes[0] = 7  # an array of its own


def test_classes_equal_those_of_the_command(cloud, network, tmp_path):
    cloud.save(tmp_path / "cloud.ply")
    run_program("segment", tmp_path / "cloud.ply", "-o", tmp_path / "cli.ply", "--network", network)
    labelled_cloud = adasplats.read(tmp_path / "cli.ply")
    np.testing.assert_array_equal(adasplats.segment(labelled_cloud, network=network), labelled_cloud.classes)


def test_a_model_by_classes_of_a_network(cloud, network, tmp_path):
    model = adasplats.model(cloud, method="semantic", segment=True, network=network)
    digest = hashlib.sha256(network.read_bytes()).hexdigest()
    assert model.network_sha256 == digest
    assert model.report["segmentation"]["network"]["sha256"] == digest
    assert set(model.report["points_removed"]) == {"car"}
    assert set(np.unique(model.classes)) == {ROAD} and model.labels == "semantickitti"
    model.save(tmp_path / "here.ply")
    assert adasplats.Model.load(tmp_path / "here.ply").network_sha256 == digest
    assert pickle.loads(pickle.dumps(model)).network_sha256 == digest
    cloud.save(tmp_path / "cloud.ply")
    run_program("model", tmp_path / "cloud.ply", "-o", tmp_path / "cli.ply", "--method", "semantic",
                "--segment", "--network", network)
    adasplats.model(tmp_path / "cloud.ply", method="semantic", segment=True,
                    network=network).save(tmp_path / "file.ply")
    assert (tmp_path / "file.ply").read_bytes() == (tmp_path / "cli.ply").read_bytes()
    assert adasplats.model(cloud, method="basic").network_sha256 == ""


def test_labels_are_replaced_with_a_warning(cloud, network):
    labelled = adasplats.PointCloud(cloud.world_positions, classes=np.full(len(cloud), 50),
                                    sensor_positions=cloud.sensor_positions + cloud.origin)
    with pytest.warns(UserWarning, match="labels of the points are replaced .*segment"):
        model = adasplats.model(labelled, segment=True, network=network, method="basic")
    assert model.report["segmentation"]["replaced_labels"]
    assert 50 not in model.classes


def test_wrong_arguments(cloud, network, tmp_path):
    with pytest.raises(ValueError, match="network has no effect without segmentation"):
        adasplats.model(cloud, network=network)
    with pytest.raises(ValueError, match="labels has no effect with segment"):
        adasplats.model(cloud, segment=True, labels="semantickitti")
    with pytest.raises(FileNotFoundError, match="nothing"):
        adasplats.segment(cloud, network=tmp_path / "nothing")
    with pytest.raises(ValueError, match="no class 'dragon'"):
        adasplats.segment(cloud, network=write_network(tmp_path / "odd", ("road", "dragon")))
    with pytest.raises(ValueError, match="tile is 0, expected 1 to 1000"):
        adasplats.segment(cloud, tile=0)
    with pytest.raises(TypeError, match="confidences must be True or False"):
        adasplats.segment(cloud, confidences=3)
    with pytest.raises(TypeError, match="points"):
        adasplats.segment(np.zeros((3, 3)))
