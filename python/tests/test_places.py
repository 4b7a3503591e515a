# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Poses above the ground of a scene, without a recording."""
import numpy as np
import pytest

import adasplats

UTM = np.array([448262.0, 5411932.0, 110.0])


@pytest.fixture(scope="module")
def scene():
    """A level square of 20 m, 110 m above zero, far from it."""
    corners = np.array([[-10, -10, 0], [10, -10, 0], [10, 10, 0], [-10, 10, 0]]) + UTM
    mesh = adasplats.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    return adasplats.Scene(mesh, device="cpu")


def test_places(scene):
    x, y, z = UTM
    poses = scene.poses_at([[x, y], [x + 1, y]])
    assert isinstance(poses, adasplats.Trajectory)
    np.testing.assert_allclose(poses.poses[:, :3, 3],
                               [[x, y, z + 1.73], [x + 1, y, z + 1.73]], atol=1e-4)
    np.testing.assert_allclose(poses.times, [0, 0.1])
    turned = scene.poses_at([[x, y, np.nan, 90], [x, y, 130.5, 180]], height=2).poses
    np.testing.assert_allclose(turned[:, 2, 3], [z + 2, 130.5], atol=1e-4)
    np.testing.assert_allclose(turned[:, :2, 0], [[0, 1], [-1, 0]], atol=1e-12)
    assert len(scene.simulate("velodyne-vlp-16", poses)) == 2


def test_paths(scene):
    x, y, z = UTM
    corners = np.array([[x - 5, y], [x + 5, y], [x + 5, y + 5]])
    poses = scene.poses_on_path(corners)
    assert len(poses) == 16
    np.testing.assert_allclose(poses.poses[:, 2, 3], z + 1.73, atol=1e-4)
    np.testing.assert_allclose(poses.poses[[0, 10, 15], :2, 3], corners, atol=1e-6)
    np.testing.assert_allclose(poses.poses[-1, :2, 0], [0, 1], atol=1e-12)
    slow = scene.poses_on_path(corners, speed=5, rate=20, height=0.5)
    assert len(slow) == 61
    np.testing.assert_allclose(slow.times[-1], 3)
    assert len(scene.poses_on_path(corners, spacing=5)) == 4


def test_errors(scene):
    x, y, _ = UTM
    with pytest.raises(ValueError, match="no ground at 0.00,0.00"):
        scene.poses_at([[0, 0]])
    with pytest.raises(ValueError, match="no ground"):
        scene.poses_on_path([[x, y], [x + 100, y]])
    for wrong in [[], [x, y], [[x]], [[x, y, 1, 2, 3]]]:
        with pytest.raises(ValueError, match="places: expected shape"):
            scene.poses_at(wrong)
    with pytest.raises(TypeError):
        scene.poses_at("here")
    with pytest.raises(ValueError):
        scene.poses_at([[np.inf, y]])
    with pytest.raises(ValueError, match="two corners"):
        scene.poses_on_path([[x, y], [x, y]])
    for keywords in [{"speed": 0}, {"rate": -1}, {"spacing": 0}]:
        with pytest.raises(ValueError):
            scene.poses_on_path([[x, y], [x + 1, y]], **keywords)
