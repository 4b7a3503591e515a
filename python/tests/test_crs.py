# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Coordinate systems are kept; reading parts of a file."""
import pickle

import numpy as np
import pytest

import adasplats

WKT = 'PROJCS["WGS 84 / UTM zone 32N",AUTHORITY["EPSG","32632"]]'
NAME = "EPSG:32632 (WGS 84 / UTM zone 32N)"
UTM = np.array([448262.0, 5411932.0, 110.0])


@pytest.fixture()
def cloud():
    """Points of a level square, 5 cm apart."""
    x, y = np.meshgrid(np.arange(0, 4, 0.05), np.arange(0, 4, 0.05))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    return adasplats.PointCloud(points + UTM, sensor_positions=points + UTM + [0, 0, 5],
                                crs_wkt=WKT)


def test_crs_of_models_and_files(cloud, tmp_path):
    assert (cloud.crs, cloud.crs_wkt) == (NAME, WKT)
    assert adasplats.PointCloud(np.zeros((1, 3))).crs == ""
    assert pickle.loads(pickle.dumps(cloud)).crs_wkt == WKT
    cloud.save(tmp_path / "cloud.ply")
    assert adasplats.read(tmp_path / "cloud.ply").crs == NAME
    model = adasplats.model(cloud)
    assert model.crs == NAME
    model.save(tmp_path / "model.ply")
    assert adasplats.Model.load(tmp_path / "model.ply").crs_wkt == WKT
    assert pickle.loads(pickle.dumps(model)).crs == NAME
    other = adasplats.PointCloud(UTM[None], crs_wkt=WKT.replace("32", "33"))
    other.save(tmp_path / "other.ply")
    with pytest.raises(ValueError, match="EPSG:33633.*EPSG:32632"):
        adasplats.read([tmp_path / "cloud.ply", tmp_path / "other.ply"])


def test_extents(cloud, tmp_path):
    path = tmp_path / "cloud.ply"
    cloud.save(path)
    x, y, z = UTM
    half = adasplats.read(path, extent=(x - 1, y - 1, x + 1.97, y + 9))
    assert len(half) == len(cloud) // 2
    assert len(adasplats.read(path, extent=np.array([x, y, x + 9, y + 9, z - 1, z + 1]))) == 6400
    with pytest.raises(ValueError, match="no point of .*is in the extent"):
        adasplats.read(path, extent=(0, 0, 1, 1))
    for wrong in [(1, 2, 3), (1, 2, 0, 4), (1, 2, 3, np.nan), "here", [[1, 2, 3, 4]]]:
        with pytest.raises(ValueError, match="extent: expected"):
            adasplats.read(path, extent=wrong)
    for keyword in ({"level": 1}, {"resolution_m": 0.5}):
        with pytest.raises(ValueError, match="COPC"):
            adasplats.read(path, **keyword)
    with pytest.raises(TypeError, match="level"):
        adasplats.read(path, level=1.5)
    with pytest.raises(ValueError, match="level"):
        adasplats.read(path, level=-1)
