# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""bench/: scan unfolding, packs of scans for training, and when a command is run again."""
import os
import stat
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "tools" / "segmentation")]

import calibration  # noqa: E402
import scan_unfolding  # noqa: E402
import segmentation_transfer as transfer  # noqa: E402
import units  # noqa: E402


def rings_of_points(rings, columns=50, first_turn=0.0):
    """As a file of KITTI has them: ring by ring, counter-clockwise from straight ahead."""
    turns = (np.arange(columns) + 0.5) / columns + first_turn
    ring, turn = np.repeat(np.arange(rings), columns), np.tile(turns, rings)
    return np.stack([10 * np.cos(2 * np.pi * turn), 10 * np.sin(2 * np.pi * turn), -0.1 * ring],
                    axis=1).astype("<f4"), ring


@pytest.mark.parametrize("rings", [1, 2, 64])
def test_unfolding_finds_the_rings(rings):
    points, ring = rings_of_points(rings)
    assert np.array_equal(scan_unfolding.unfolded(points), ring)


def test_unfolding_needs_the_order_of_the_file():
    """Firings of all rings, column by column, are one ring; a seam behind splits none."""
    points, _ = rings_of_points(4)
    by_column = points.reshape(4, -1, 3).transpose(1, 0, 2).reshape(-1, 3)
    assert scan_unfolding.unfolded(by_column)[-1] == 0
    from_behind, ring = rings_of_points(4, first_turn=0.5)
    assert not np.array_equal(scan_unfolding.unfolded(from_behind), ring)


def test_who_fired_is_found_by_coordinates(tmp_path):
    points, ring = rings_of_points(5)
    order = np.random.default_rng(1).permutation(len(points))
    np.savez(tmp_path / "scan.npz", points=points[order], rings=ring[order].astype(np.uint16))
    assert np.array_equal(scan_unfolding.fired_rings(points, tmp_path / "scan.npz"), ring)
    with pytest.raises(SystemExit, match="are not those of the same scan"):
        scan_unfolding.fired_rings(points + 0.001, tmp_path / "scan.npz")
    with pytest.raises(SystemExit, match="are not those of the same scan"):
        scan_unfolding.fired_rings(points[1:], tmp_path / "scan.npz")


def test_rings_that_differ_say_where():
    points, ring = rings_of_points(64, columns=360)
    sides = [scan_unfolding.Counts() for _ in range(2)]
    missing = (ring == 60) & (points[:, 0] < 0) & (points[:, 1] > 0)  # the second quarter
    sides[0].add(points, ring)
    sides[1].add(points[~missing], ring[~missing])
    apart = scan_unfolding.rings_json(*sides)["apart"]
    assert [of["ring"] for of in apart] == [60] and abs(apart[0]["ratio"] - 0.75) < 0.01
    assert apart[0]["by_sector_deg"]["90 to 135"] == -45
    assert apart[0]["by_sector_deg"]["180 to 225"] == 0
    # The other way round they are points in what nothing real comes from.
    assert scan_unfolding.shadow_json(*sides)["simulated"] == 0
    assert scan_unfolding.shadow_json(*sides[::-1])["simulated"] == 90


def write_sequence(folder, scans=2):
    """Points of SemanticKITTI's form, classes road and car; poses 5 m apart, turned."""
    for name in ("velodyne", "labels"):
        (folder / name).mkdir(parents=True)
    random = np.random.default_rng(3)
    poses = []
    for k in range(scans):
        points = np.column_stack([random.uniform(-50, 50, (400, 2)), random.uniform(-2, 5, 400),
                                  random.uniform(0, 1, 400)]).astype("<f4")
        points[0, :3] = 200  # beyond what counts
        points.tofile(folder / f"velodyne/{k:06d}.bin")
        (np.arange(400) % 2 * -30 + 40).astype("<u4").tofile(folder / f"labels/{k:06d}.label")
        poses.append(f"0 -1 0 {5 * k} 1 0 0 0 0 0 1 0")
    (folder / "poses.txt").write_text("\n".join(poses) + "\n")
    (folder / "calib.txt").write_text("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n")


def test_a_pack_gives_the_scans_back(tmp_path):
    write_sequence(tmp_path / "place")
    np.savez(tmp_path / "scans.npz", **transfer.pack_place(tmp_path / "place"))
    scans = transfer.Scans(tmp_path / "scans.npz")
    assert scans.counts.tolist() == [399, 399]
    measured = np.fromfile(tmp_path / "place/velodyne/000001.bin", "<f4").reshape(-1, 4)[1:]
    assert np.abs(scans.points[399:] - measured[:, :3]).max() <= 0.00501
    road, car = transfer.NAMES.index("road"), transfer.NAMES.index("car")
    assert scans.classes[399:].tolist() == [car if k % 2 else road for k in range(1, 400)]
    # Turned by a quarter and moved by the pose, relative to the middle of all.
    place = scans.together([1])
    expected = np.column_stack([5 - measured[:, 1], measured[:, 0], measured[:, 2]])
    expected -= np.median(expected, axis=0)
    assert len(place["positions"]) == 399 and set(place["scans"]) == {0}
    assert np.abs(place["positions"] / 100 - expected).max() < 0.02


def test_labels_of_another_count_are_refused(tmp_path):
    write_sequence(tmp_path / "place")
    np.zeros(3, "<u4").tofile(tmp_path / "place/labels/000001.label")
    with pytest.raises(SystemExit, match="3 labels of 400 points"):
        transfer.pack_place(tmp_path / "place")


def test_losses_are_of_the_same_classes():
    """A class that one side has not counts on neither."""
    count = len(transfer.NAMES)
    whole, lost = np.zeros((count, count)), np.zeros((count, count))
    whole[0, 0] = whole[1, 1] = whole[2, 2] = 100
    lost[0, 0], lost[0, 1], lost[1, 1] = 80, 20, 100
    result = transfer.compared({(a, b): lost if b == "simulated" else whole
                                for a in transfer.SIDES for b in transfer.SIDES})
    assert result["classes"] == transfer.NAMES[:2]
    assert abs(result["losses"]["real network, real to simulated"]
               - 100 * (1 - (0.8 + 100 / 120) / 2)) < 1e-9
    assert not result["reached"]["real network, real to simulated"]
    assert result["reached"]["on real, real to simulated network"]


def test_no_place_is_judged_by_a_unit_of_itself():
    assert all(place != by for place, by in units.UNIT_OF.items())


def test_a_command_runs_again_where_something_changed(tmp_path):
    """A program that counts its runs, and fails where it is told to."""
    program = tmp_path / "program"
    program.write_text(f"""#!/bin/sh
echo x >> {tmp_path}/runs
[ "$1" = fail ] && {{ echo 'wrong input' >&2; exit 65; }}
for last; do :; done
echo '{{"a": 1}}' > "$last"
""")
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    (tmp_path / "input").write_text("1")
    for file in (program, tmp_path / "input"):
        os.utime(file, (1e9, 1e9))
    report = tmp_path / "report.json"

    def runs_after(*words):
        assert calibration.report_of([program, *words], report) == {"a": 1}
        return len((tmp_path / "runs").read_text().split())

    assert runs_after(tmp_path / "input") == 1
    assert runs_after(tmp_path / "input") == 1
    assert runs_after(tmp_path / "input", "more") == 2
    os.utime(tmp_path / "input", (4e9, 4e9))
    assert runs_after(tmp_path / "input", "more") == 3
    with pytest.raises(SystemExit, match="wrong input"):
        calibration.report_of([program, "fail"], report)
    assert not report.exists()
