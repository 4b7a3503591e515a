# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Scene.simulate_rig()."""
import numpy as np
import pytest

RIG = """
[[sensors]]
name = "top"
sensor = "velodyne-vlp-16"
mount = [0.5, 0.1, 0.3]
time_offset_s = 0.25
[[sensors]]
name = "front"
sensor = "velodyne-vlp-16"
"""


def test_every_sensor_is_simulated_with_its_mount_and_clock(scene, tmp_path):
    """Oracle: simulate() at mounted poses."""
    rig = tmp_path / "rig.toml"
    rig.write_text(RIG)
    vehicle = np.tile(np.eye(4), (2, 1, 1))
    vehicle[:, :3, 3] = [[1, 0, 1.5], [1.5, 0, 1.5]]
    mount = np.eye(4)
    mount[:3, 3] = [0.5, 0.1, 0.3]
    scans = scene.simulate_rig(rig, vehicle, noise=False)
    assert list(scans) == ["top", "front"]
    for name, poses in (("top", vehicle @ mount), ("front", vehicle)):
        alone = scene.simulate("velodyne-vlp-16", poses, noise=False)
        for one, other in zip(scans[name], alone):
            np.testing.assert_array_equal(one.pose, other.pose)
            assert len(one.positions) > 100
            np.testing.assert_array_equal(one.ranges, other.ranges)
            assert one.time == other.time - (0.25 if name == "top" else 0)
    with pytest.raises(OSError):
        scene.simulate_rig(tmp_path / "missing.toml", vehicle)
