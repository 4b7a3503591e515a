# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Jobs called from Python: the same bytes and the same errors as on the command line."""
import json

import numpy as np
import pytest
from conftest import PROGRAM, report_of, run_program
from test_pipeline import files_of, without_times

import adasplats


def test_mesh_of_a_file_and_of_points(street, tmp_path):
    run_program("mesh", street.cloud, "-o", tmp_path / "cli.ply", "--labels", "semantickitti",
                "--voxel", 0.3, "--remove", "moving")
    options = {"labels": "semantickitti", "voxel": 0.3, "remove": "moving"}
    adasplats.mesh(street.cloud, **options).save(tmp_path / "file.ply")
    adasplats.mesh(adasplats.read(street.cloud), **options).save(tmp_path / "points.ply")
    expected = (tmp_path / "cli.ply").read_bytes()
    assert (tmp_path / "file.ply").read_bytes() == expected
    assert (tmp_path / "points.ply").read_bytes() == expected
    with pytest.raises(ValueError, match="depth has no effect with the method imls"):
        adasplats.mesh(street.cloud, depth=9)
    with pytest.raises(ValueError, match="voxel is -1, expected more than 0"):
        adasplats.mesh(street.cloud, voxel=-1)
    with pytest.raises(FileNotFoundError):
        adasplats.mesh(tmp_path / "nothing.ply")


def test_export(street, tmp_path):
    run_program("export", street.model, "-o", tmp_path / "cli.ply", "--format", "gaussian-2d")
    report = adasplats.export(street.model, tmp_path / "here.ply", format="gaussian-2d")
    assert (tmp_path / "here.ply").read_bytes() == (tmp_path / "cli.ply").read_bytes()
    assert report == {"splats": len(adasplats.Model.load(street.model)), "points_dropped": 0,
                    "bytes": (tmp_path / "here.ply").stat().st_size}
    adasplats.export(street.cloud, tmp_path / "cloud.glb", color="height", labels="semantickitti")
    assert (tmp_path / "cloud.glb").stat().st_size > 0
    with pytest.raises(ValueError, match="format must be 'gaussian-3d', "):
        adasplats.export(street.model, tmp_path / "x.ply", format="gauss")
    with pytest.raises(ValueError, match="mcap"):
        adasplats.export(street.model, tmp_path / "x.mcap")
    assert not (tmp_path / "x.mcap").exists()


def hall_drive(folder):
    """Scans of KITTI's sensor in a hall, with a sine error in the poses."""
    quads = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    corners = [[(-20, 20)[k & 1], (-14, 14)[k >> 1 & 1], (0, 10)[k >> 2]] for k in range(8)]
    text = "".join("v {} {} {}\n".format(*corner) for corner in corners)
    for a, b, c, d in quads:
        text += f"f {a + 1} {b + 1} {c + 1}\nf {a + 1} {c + 1} {d + 1}\n"
    (folder / "hall.obj").write_text(text)
    poses = np.tile(np.eye(4), (8, 1, 1))
    poses[:, :3, 3] = [[-3 + 0.6 * k, np.sin(0.4 * k), 1.8] for k in range(8)]
    scans = adasplats.Scene(folder / "hall.obj", device="cpu").simulate(
        "velodyne-hdl-64e-kitti", poses, range_noise=0.005)
    scans.save(folder / "drive")
    sequence = folder / "drive" / "sequences" / "00"
    sequence = sequence if sequence.exists() else folder / "drive"
    rows = np.loadtxt(sequence / "poses.txt")
    rows[:, 3] += 0.06 * np.sin(np.arange(8))
    np.savetxt(sequence / "poses.txt", rows)
    return sequence


def test_calibrate(tmp_path):
    sequence = hall_drive(tmp_path)
    run_program("calibrate", sequence, "-o", tmp_path / "cli", "--own-body", 0)
    report = adasplats.calibrate(sequence, tmp_path / "here", own_body_m=0)
    assert files_of(tmp_path / "here") == files_of(tmp_path / "cli")
    assert report == json.loads((tmp_path / "here" / "report.json").read_text(encoding="utf-8"))
    assert report["applied"] and report["largest_shift_m"] > 0.03
    sensor = adasplats.Sensor(tmp_path / "here" / "sensor.toml")
    np.testing.assert_allclose(sensor.range_offsets_m, report["lasers"]["range_offset_m"], atol=1e-5)
    assert len(adasplats.Trajectory.read(tmp_path / "here" / "trajectory.csv")) == 8
    with pytest.raises(OSError, match="not empty"):
        adasplats.calibrate(sequence, tmp_path / "here")
    with pytest.raises(ValueError, match="nothing to estimate: poses, ranges, elevations and"):
        adasplats.calibrate(sequence, tmp_path / "no", poses=False, ranges=False, elevations=False,
                            mount_correction=False)
    with pytest.raises(adasplats.DataError, match="nothing calibrated"):
        adasplats.calibrate(sequence, tmp_path / "few", own_body_m=0, scan_count=1)


def test_fit_sensor(street, tmp_path):
    scans = tmp_path / "scans"
    scene = adasplats.Scene(street.model)
    poses = scene.poses_on_path([(0, 0), (8, 0)], spacing=1)
    scene.simulate("velodyne-hdl-64e-kitti", poses, seed=3).save(scans)
    expected = report_of(tmp_path, "fit-sensor", street.model, scans, "-o", tmp_path / "cli.toml",
                         "--scans", "0:4")
    report = adasplats.fit_sensor(street.model, scans, tmp_path / "here.toml", scan_count=4)
    assert report == without_times(expected)
    assert (tmp_path / "here.toml").read_bytes() == (tmp_path / "cli.toml").read_bytes()
    assert adasplats.Sensor(tmp_path / "here.toml").rings == 64


def test_simkitti32(street, tmp_path):
    expected = report_of(tmp_path, "simkitti32", street.sequence, "-o", tmp_path / "cli", "--sensor",
                         street.sensor, "--scans", "0:2", "--depth", 3, "--offset", "0,0,-0.4")
    report = adasplats.simkitti32(street.sequence, tmp_path / "here", sensor=street.sensor, scan_count=2,
                                depth=3, offset=(0, 0, -0.4), device="cpu")
    assert files_of(tmp_path / "here") == files_of(tmp_path / "cli")
    assert set(report) <= set(expected) and report["scans"] == 2
    left_out = {"model", "seconds", "seconds_simulated", "scans_per_second"}
    assert ({k: v for k, v in report.items() if k not in left_out}
            == {k: v for k, v in without_times(expected).items() if k in report and k not in left_out})
    points = sum(np.fromfile(scan, np.float32).size // 4
                 for scan in (tmp_path / "here").rglob("*.bin"))
    assert points == report["points"] > 0
    with pytest.raises(ValueError, match="depth is 0, expected 1 to 64"):
        adasplats.simkitti32(street.sequence, tmp_path / "no", depth=0)
    with pytest.raises(OSError):
        adasplats.simkitti32(street.sequence, tmp_path / "here")


def test_simkitti32_with_a_model(street, tmp_path):
    def make(name, **options):
        return adasplats.simkitti32(street.sequence, tmp_path / name, sensor=street.sensor,
                                    scan_count=2, device="cpu", **options)

    made = make("made", keep_model=True)
    model = tmp_path / "made" / "model.ply"
    assert make("given", model=model)["points"] == made["points"]
    with pytest.raises(ValueError, match="contains the input"):
        make("made", model=model, overwrite=True)
    with pytest.raises(ValueError, match="model_every has no effect with a given model"):
        make("no", model=model, model_every=2)


def test_simkitti32_with_weather_and_ray_drop(street, tmp_path):
    def points(name, **options):
        return adasplats.simkitti32(street.sequence, tmp_path / name, sensor=street.sensor,
                                    scan_count=2, device="cpu", **options)["points"]

    clear = points("clear", keep_model=True)
    model = tmp_path / "clear" / "model.ply"
    assert points("fog", model=model, fog=15) < 0.8 * clear
    drop = tmp_path / "drop.toml"
    drop.write_text("usual_reflectance = 0.3\nweights = [0, 0.1, 0, 0, 0, 0, 0, 0]\n")
    assert points("drop", model=model, ray_drop=drop) < 0.8 * clear
    report = (tmp_path / "clear" / "adasplats.json").read_text()
    assert '"fog_visibility_m": null' in report and '"rain_mm_h": 0.0' in report


def test_arguments_are_checked_before_the_work_starts(street, tmp_path):
    def rejects(text, **options):
        with pytest.raises(ValueError, match=text):
            adasplats.simkitti32(street.sequence, tmp_path / "none", sensor=street.sensor, **options)
        assert list(tmp_path.glob("*none*")) == []

    drop = tmp_path / "drop.toml"
    drop.write_text("garbage = 1\n")
    rejects("garbage", ray_drop=drop)
    rejects("stride is 0", scan_stride=0)
    rejects("moving_radius has no effect", moving=False, moving_radius=0.2)
    rejects("rain is -1, expected 0 to 3000", rain=-1)
    with pytest.raises(ValueError, match="first_scan has no effect on a splat model"):
        adasplats.export(street.model, tmp_path / "x.glb", first_scan=3)


@pytest.mark.parametrize("options, text", [
    ({"min_range": -5}, "min_range is -5"), ({"min_range": float("nan")}, "min_range is nan"),
    ({"range_noise": -1}, "range_noise is -1"),
    ({"min_range": 100, "max_range": 10}, "less than max_range"),
    ({"rotation_rate": 0}, "rotation_rate is 0, expected 0.001 to 10000"),
    ({"sub_rays": 65}, "sub_rays is 65, expected 1 to 64"),
])
def test_overrides_of_a_sensor_are_checked(scene, poses, options, text):
    with pytest.raises(ValueError, match=text):
        scene.simulate("velodyne-vlp-16", poses, **options)



# Keys that differ from run to run or contain paths.
RUN_KEYS = {"command", "provenance", "made_by", "date", "seconds", "step_seconds",
              "peak_memory_bytes", "images_per_second", "scans_per_second", "trajectory"}


def without_run_keys(results):
    """compare.json without times and commands."""
    if isinstance(results, list):
        return [without_run_keys(each) for each in results]
    if isinstance(results, dict):
        return {key: without_run_keys(value) for key, value in results.items() if key not in RUN_KEYS}
    return results


def test_compare(street, tmp_path):
    run_program("compare", street.folder / "street", "-o", tmp_path / "cli", "--methods", "basic",
                "--picture-width", 64, "--every", 40, "--held-out-scans", "0:2", "--device", "cpu")
    report = adasplats.compare(street.folder / "street", tmp_path / "here", methods=["basic"],
                             picture_width=64, every=40, held_out_scan_count=2, device="cpu",
                             program=PROGRAM)
    here, cli = (json.loads((tmp_path / name / "compare.json").read_text(encoding="utf-8"))
                 for name in ("here", "cli"))
    assert report == here
    assert without_run_keys(here) == without_run_keys(cli)
    entry = here["competitors"][0]
    assert (entry["name"], entry["state"]) == ("basic", "done")
    assert "--device cpu" in entry["generate"]["command"]
    for step, made_by in cli["competitors"][0]["made_by"].items():
        assert entry["made_by"][step]["commit"] == made_by["commit"]
    for report in ("report.md", "report.html"):
        assert (tmp_path / "here" / report).stat().st_size > 1000
    # A second call runs no step, so the dates of the steps do not change.
    again = adasplats.compare(street.folder / "street", tmp_path / "here", methods=["basic"],
                              picture_width=64, every=40, held_out_scan_count=2, device="cpu",
                              program=PROGRAM)
    assert again["competitors"] == here["competitors"]


def test_compare_rejects_wrong_arguments(street, tmp_path, monkeypatch):
    def rejects(error, text, **options):
        with pytest.raises(error, match=text):
            adasplats.compare(street.folder / "street", tmp_path / "none",
                              **{"program": PROGRAM, **options})
        assert not (tmp_path / "none" / "compare.json").exists()

    rejects(ValueError, "unknown method 'basics', did you mean 'basic'", methods=["basics"])
    rejects(TypeError, "methods must be None or a list of strings", methods="basic")
    rejects(TypeError, "meshes must be None or a dict", meshes=["a.ply"])
    rejects(ValueError, "'a b' must consist of letters", meshes={"a b": street.mesh})
    rejects(FileNotFoundError, "none.ply", meshes={"artist": tmp_path / "none.ply"})
    rejects(ValueError, "time_limit is 0, expected more than 0", time_limit=0)
    rejects(ValueError, "poisson_depth has no effect without the method poisson",
           methods=["basic"], poisson_depth=9)
    rejects(ValueError, "preset must be 'none', 'paper-pc3d'", preset="kitti")
    rejects(FileNotFoundError, "cannot be started", program=tmp_path / "no program")
    rejects(ValueError, "is not adasplats", program="true")
    monkeypatch.setenv("PATH", str(tmp_path))
    rejects(FileNotFoundError, "adasplats: the program .* not on PATH; install", program=None)
