#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Drives with errors that are known, and what is left of them: beside bench/calibration.py.

  bench/any_drive.py build/release/bin/adasplats REAL_DATA OUT [PART...]

REAL_DATA has kitti-0005 and pandaset-002 as unpacked; what is missing is left out. PARTs, all
without any:

  rest    the frames of pandaset-002 at rest alone: a model of the even ones, beams of the odd ones
  poses   kitti-0005 with poses spoilt on purpose: smooth errors on all scans, and noise on the scans
          of the model alone
  lasers  kitti-0005 with offsets added to what its lasers measure, and the offsets found
  mounts  a street with turns whose sensor sits elsewhere than its poses say
  street  the measuring street with its exact surface: ghosts, holes, and what is found of thin things
  lidar4d kitti-0005 by the protocol of LiDAR4D (CVPR 2024): held out is every tenth scan or so

Writes OUT/any_drive.json (for bench/results) and prints Markdown tables. What the program reported
since it was built is not run again. Needs NumPy.
"""

import json
import math
import os
import pathlib
import sys
import tomllib

import numpy as np

from calibration import KITTI_BEAMS, KITTI_TRAINING, Drive, figures_of, report_of
from provenance import provenance_of

SEED = 20260501
SMOOTH_DEG, SMOOTH_M = 0.3, 0.2  # RMS about and along each axis
NOISE_DEG, NOISE_M = 0.1, 0.05  # standard deviations likewise
LASERS_M = 0.05  # RMS of the offsets
MOUNT_DEG, MOUNT_M, MOUNTS = 5.0, 0.5, 3
# Frames 12 to 25 of pandaset-002, whose files begin with 012: the vehicle leaves after them.
AT_REST = 14
STREET_POINTS = "2000000"
THIN = ("fence", "pole", "traffic-sign")
SENSORS = pathlib.Path(__file__).resolve().parent.parent / "sensors"


# ---- poses and points that are wrong -------------------------------------------------------

def rotations(vectors):
    """(N, 3, 3) of rotations as axis times angle (N, 3), rad (Rodrigues)."""
    angles = np.linalg.norm(vectors, axis=1)
    axes = vectors / np.maximum(angles, 1e-300)[:, None]
    cross = np.zeros((len(vectors), 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -axes[:, 2], axes[:, 1], -axes[:, 0]
    cross -= cross.transpose(0, 2, 1)
    sines, cosines = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return np.eye(3) + sines * cross + (1 - cosines) * cross @ cross


def transforms(vectors, shifts_m):
    """(N, 4, 4) of rotations as axis times angle and shifts, both (N, 3)."""
    made = np.tile(np.eye(4), (len(vectors), 1, 1))
    made[:, :3, :3], made[:, :3, 3] = rotations(vectors), shifts_m
    return made


def smooth_curve(random, reference_s, rms):
    """A function of time (N,) to (N, 3): waves of 5, 10 and 20 s, each axis of zero mean and this RMS
    at the reference times."""
    sizes, phases = random.normal(size=(3, 3)), random.uniform(0, 2 * math.pi, (3, 3))

    def waves(times_s):
        turns = 2 * math.pi * times_s[:, None, None] / np.array([5.0, 10.0, 20.0])[None, None, :]
        return (sizes * np.sin(turns + phases)).sum(axis=2)

    mean = waves(reference_s).mean(axis=0)
    size = np.sqrt(((waves(reference_s) - mean) ** 2).mean(axis=0))
    return lambda times_s: (waves(times_s) - mean) * rms / size


def read_poses(sequence):
    """world_from_sensor (N, 4, 4) of a sequence, and what its files are in: sensor to camera."""
    rows = np.loadtxt(sequence / "poses.txt", ndmin=2).reshape(-1, 3, 4)
    whole = np.tile(np.eye(4), (len(rows), 1, 1))
    whole[:, :3] = rows
    camera = np.eye(4)
    line = next(x for x in (sequence / "calib.txt").read_text().split("\n") if x.startswith("Tr:"))
    camera[:3] = np.array(line.split()[1:], float).reshape(3, 4)
    return np.linalg.inv(camera) @ whole @ camera, camera


def linked(sequence, copy, but):
    """A sequence with links to all parts of another but one, which it gets from elsewhere."""
    copy.mkdir(parents=True, exist_ok=True)
    for part in sequence.iterdir():
        link = copy / part.name
        if part.name != but and not link.is_symlink():
            link.symlink_to(part.resolve())
    return copy


def with_poses(sequence, copy, world_from_sensor):
    _, camera = read_poses(sequence)
    poses = camera @ world_from_sensor @ np.linalg.inv(camera)
    lines = [" ".join(f"{x:.12e}" for x in pose[:3].ravel()) for pose in poses]
    (linked(sequence, copy, "poses.txt") / "poses.txt").write_text("\n".join(lines) + "\n")
    return copy


def smooth_errors(sequences, folder):
    """Sequences of one drive whose poses drift, by the same function of time."""
    random = np.random.default_rng(SEED)
    times_s = [np.loadtxt(sequence / "times.txt") for sequence in sequences]
    turn = smooth_curve(random, times_s[0], math.radians(SMOOTH_DEG))
    shift = smooth_curve(random, times_s[0], SMOOTH_M)
    spoilt = []
    for sequence, at in zip(sequences, times_s):
        poses, _ = read_poses(sequence)
        poses = poses @ transforms(turn(at), np.zeros((len(at), 3)))
        poses[:, :3, 3] += shift(at)
        spoilt.append(with_poses(sequence, folder / sequence.name, poses))
    return spoilt


def noisy(sequence, folder):
    """A sequence each of whose poses is wrong by itself."""
    random = np.random.default_rng(SEED + 1)
    poses, _ = read_poses(sequence)
    turns = random.normal(scale=math.radians(NOISE_DEG), size=(len(poses), 3))
    shifts_m = random.normal(scale=NOISE_M, size=(len(poses), 3))
    return with_poses(sequence, folder / sequence.name, poses @ transforms(turns, shifts_m))


def hdl64_beams(points, sweep_m):
    """Of motion-compensated points (N, 3) of KITTI's sensor: where their beams began (N, 3) and
    their lasers (N,): the points lie on cones, once the motion is undone."""
    sensor = tomllib.loads((SENSORS / "velodyne-hdl-64e-kitti.toml").read_text())
    elevations = np.radians(sensor["elevations_deg"])
    heights_m = np.array(sensor["beam_origins_m"])[:, 2]
    phases = -np.arctan2(points[:, 1], points[:, 0]) / (2 * math.pi)
    origins = phases[:, None] * sweep_m[None, :]
    still = points - origins
    radii = np.hypot(still[:, 0], still[:, 1])
    nearest = np.full(len(points), np.inf)
    lasers = np.zeros(len(points), int)
    for laser, (elevation, height_m) in enumerate(zip(elevations, heights_m)):
        away = np.abs(still[:, 2] - height_m - math.tan(elevation) * radii) * math.cos(elevation)
        lasers[away < nearest] = laser
        nearest = np.minimum(nearest, away)
    origins[:, 2] += heights_m[lasers]
    return origins, lasers


def sweeps_m(poses, times_s, revolution_s=0.1033):
    """How far the sensor moved during each scan, in its frame (N, 3); KITTI's turns take 0.1033 s."""
    before = np.maximum(np.arange(len(poses)) - 1, 0)
    after = np.minimum(np.arange(len(poses)) + 1, len(poses) - 1)
    moved_m = poses[after, :3, 3] - poses[before, :3, 3]
    speed = moved_m / (times_s[after] - times_s[before])[:, None]
    return np.einsum("nij,ni->nj", poses[:, :3, :3], revolution_s * speed)


def with_offsets(sequence, copy, offsets_m):
    """The sequence with ranges that each laser measures longer by its offset."""
    (linked(sequence, copy, "velodyne") / "velodyne").mkdir(exist_ok=True)
    moved_m = sweeps_m(read_poses(sequence)[0], np.loadtxt(sequence / "times.txt"))
    for file, sweep_m in zip(sorted((sequence / "velodyne").iterdir()), moved_m):
        scan = np.fromfile(file, np.float32).reshape(-1, 4)
        points = scan[:, :3].astype(float)
        origins, lasers = hdl64_beams(points, sweep_m)
        ways = points - origins
        ranges_m = np.maximum(np.linalg.norm(ways, axis=1), 1e-6)
        scan[:, :3] = origins + ways * (1 + offsets_m[lasers] / ranges_m)[:, None]
        scan.tofile(copy / "velodyne" / file.name)
    return copy


# ---- parts ---------------------------------------------------------------------------------

def row_of(program, folder, name, use, training, held_out, model_flags, beam_flags):
    drive = Drive(program, folder / name.replace(" ", "-"), training, held_out, model_flags,
                  beam_flags)
    row = {"name": name, "use": use, **drive.row(False)}
    given, new = row["as_given"], row["calibrated"]
    print(f"| {name} | {given['within_10cm']:.1%} | {new['within_10cm']:.1%} "
          f"| {row['registered']['within_10cm']:.1%} | {100 * given['median_m']:.2f} cm "
          f"| {100 * new['median_m']:.2f} cm |", flush=True)
    return row


def rest(program, data, folder):
    panda = data / "pandaset-002"
    if not panda.exists():
        return {}
    drive = ["--trajectory", str(panda / "vehicle_trajectory.csv"), "--boxes",
             str(panda / "cuboids.csv")]
    row = row_of(program, folder, "pandaset-002 at rest", "selection", panda / "frames",
                 panda / "frames", [*drive, "--scans", f"0:{AT_REST // 2}:2", "--remove", "none"],
                 [*drive, "--scans", f"1:{AT_REST // 2}:2"])
    return {"drives": [row]}


def poses(program, data, folder):
    kitti = data / "kitti-0005/sequences"
    if not kitti.exists():
        return {}
    smooth = smooth_errors([kitti / "00", kitti / "01"], folder / "smooth")
    noise = noisy(kitti / "00", folder / "noise")
    cases = [("kitti-0005", kitti / "00", kitti / "01"),
             (f"kitti-0005 smooth errors of {SMOOTH_DEG} deg and {100 * SMOOTH_M:.0f} cm", *smooth),
             (f"kitti-0005 noise of {NOISE_DEG} deg and {100 * NOISE_M:.0f} cm on the model's scans",
              noise, kitti / "01")]
    return {"drives": [row_of(program, folder, name, "development", training, held_out,
                              KITTI_TRAINING, KITTI_BEAMS) for name, training, held_out in cases]}


def lasers(program, data, folder):
    """The difference of two fits, with its mean removed: what all lasers measure is not observed."""
    sequence = data / "kitti-0005/sequences/00"
    if not sequence.exists():
        return {}
    random = np.random.default_rng(SEED + 2)
    offsets_m = random.normal(size=64)
    offsets_m *= LASERS_M / math.sqrt((offsets_m**2).mean())
    spoilt = with_offsets(sequence, folder / "lasers" / "00", offsets_m)
    found = []
    for name, place in (("as-recorded", sequence), ("offset", spoilt)):
        report = report_of([program, "calibrate", place, "-o", folder / f"lasers/{name}",
                            "--overwrite"], folder / f"lasers/{name}.json")
        found.append(np.array(report["lasers"]["range_offset_m"]))
    left_m = found[1] - found[0] + offsets_m
    left_m -= left_m.mean()
    result = {"added_rms_m": LASERS_M, "lasers": len(offsets_m),
              "left_rms_m": math.sqrt((left_m**2).mean()), "left_most_m": np.abs(left_m).max()}
    print(f"lasers: {1e3 * result['left_rms_m']:.1f} mm RMS are left of {100 * LASERS_M:.0f} cm, "
          f"{1e3 * result['left_most_m']:.1f} mm at most", flush=True)
    return {"lasers": result}


def random_mount(random):
    """Elsewhere by MOUNT_DEG about a random axis and MOUNT_M in a random direction (4, 4)."""
    turn, shift = random.normal(size=(2, 3))
    turn *= math.radians(MOUNT_DEG) / np.linalg.norm(turn)
    shift *= MOUNT_M / np.linalg.norm(shift)
    return transforms(turn[None], shift[None])[0]


def mount_left(wrong, mount):
    """What is left of a wrong mount after the correction of a report; the height by itself, since a
    level road does not tell it."""
    yaw, pitch, roll = np.radians(mount["yaw_pitch_roll_deg"])
    turns = rotations(np.array([[0, 0, yaw], [0, pitch, 0], [roll, 0, 0]]))
    found = np.eye(4)
    found[:3, :3] = turns[0] @ turns[1] @ turns[2]
    found[:3, 3] = mount["shift_m"]
    left = wrong @ found
    cosine = (np.trace(left[:3, :3]) - 1) / 2
    return {"applied": mount["applied"], "objection": mount.get("objection"),
            "turn_left_deg": math.degrees(math.acos(min(1.0, max(-1.0, cosine)))),
            "shift_left_m": float(np.hypot(*left[:2, 3])), "height_left_m": abs(left[2, 3]),
            "not_observed": [direction["name"] for direction in mount["not_observed"]]}


def mounts(program, _data, folder):
    street = folder / "turns"
    report_of([program, "synth", "street", "--turns", "-o", street, "--overwrite"],
              folder / "turns.json")
    sequence = street / "sequences/00"
    true_poses, _ = read_poses(sequence)
    random = np.random.default_rng(SEED + 3)
    rows = []
    for number in range(MOUNTS):
        wrong = random_mount(random)
        spoilt = with_poses(sequence, folder / f"mount-{number}/00", true_poses @ wrong)
        flags = ["--labels", "semantickitti"]
        row = row_of(program, folder, f"street mount {number + 1}", "synthetic", spoilt, spoilt,
                     [*flags, "--remove", "movable", "--scans", "0:1000:2"],
                     [*flags, "--drop-movable", "--scans", "1:1000:2"])
        row["mount"] = mount_left(wrong, row["calibration"]["mount"])
        print(f"mount {number + 1}: {row['mount']['turn_left_deg']:.4f} deg and "
              f"{1e3 * row['mount']['shift_left_m']:.1f} mm are left of {MOUNT_DEG} deg and "
              f"{MOUNT_M} m, {row['mount']['height_left_m']:.3f} m of the height", flush=True)
        rows.append(row)
    return {"mounts": rows}


def street(program, _data, folder):
    """As docs/compare has it. Found of a class: rays that meet it in truth and do not fall through the
    model by more than 50 cm; of its held-out beams those within 50 cm."""
    place, model = folder / "street", folder / "street.ply"
    report_of([program, "synth", "street", "--points", STREET_POINTS, "-o", place, "--overwrite"],
              folder / "street.json")
    made = report_of([program, "model", place / "mapping.ply", "-o", model, "--labels",
                      "semantickitti", "--remove", "movable"], folder / "street-model.json")
    truth = report_of([program, "evaluate", "truth", model, place / "mesh.ply", "--sensor",
                       "hdl-64-paper", "--trajectory", place / "mapping_trajectory.csv",
                       "--offset=1,1,-1", "--every", "9", "--labels", "semantickitti",
                       "--drop-movable"], folder / "street-truth.json")
    beams = report_of([program, "evaluate", "resimulate", model, place / "sequences/00",
                       *KITTI_BEAMS], folder / "street-beams.json")
    row = {"name": "street", "use": "synthetic", "primitives": made["primitives"],
           "ghosts": truth["ghost_share"], "holes": truth["hole_share"],
           "found": {name: 1 - truth["by_class"][name]["hole_share"] for name in THIN},
           "beams_within_50cm": {name: beams["by_class"][name]["within"]["0.50"] for name in THIN},
           "beams": figures_of(beams)}
    print(f"street: ghosts {row['ghosts']:.1%}, holes {row['holes']:.1%}, found: "
          + ", ".join(f"{name} {share:.1%}" for name, share in row["found"].items())
          + "; held-out beams within 50 cm: "
          + ", ".join(f"{name} {share:.1%}" for name, share in row["beams_within_50cm"].items()),
          flush=True)
    return {"streets": [row]}


def lidar4d(program, data, folder):
    """Parked cars stay: held-out scans have them. As given and calibrated."""
    kitti = data / "kitti-0005/sequences"
    if not kitti.exists():
        return {}
    drive = Drive(program, folder / "lidar4d", kitti / "00", kitti / "01",
                  ["--labels", "semantickitti", "--remove", "moving"],
                  ["--labels", "semantickitti", "--protocol", "lidar4d"])
    rows = []
    for name, flags in (("as given", ["--no-calibrate"]), ("calibrated", [])):
        _, beams = drive.reports(name.replace(" ", "-"), flags)
        rows.append({"name": f"kitti-0005, {name}", "use": "development", **beams["lidar4d"]})
        points, depth = rows[-1]["points"], rows[-1]["depth_m"]
        print(f"lidar4d, {name}: Chamfer {points['chamfer_m2']:.4f} m2, F-score "
              f"{points['f_score']:.4f}, depth RMSE {depth['rmse']:.3f} m, MedAE "
              f"{depth['medae']:.4f} m, SSIM {depth['ssim']:.4f}", flush=True)
    return {"lidar4d": rows}


PARTS = {"rest": rest, "poses": poses, "lasers": lasers, "mounts": mounts, "street": street,
         "lidar4d": lidar4d}


def main():
    if len(sys.argv) < 4 or not set(sys.argv[4:]) <= set(PARTS):
        sys.exit(__doc__)
    program, data, out = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    out.mkdir(parents=True, exist_ok=True)
    result = {"drives": []}
    print("| drive | as given | calibrated | registered | median as given | calibrated |\n"
          "|---|--:|--:|--:|--:|--:|")
    for name in sys.argv[4:] or PARTS:
        part = PARTS[name](program, data, out)
        result["drives"] += part.pop("drives", [])
        result.update(part)
    provenance = provenance_of(program)
    # Paths of data and output mean nothing elsewhere.
    words = ["any_drive.py build/release/bin/adasplats REAL_DATA OUT", *sys.argv[4:]]
    provenance |= {"command": " ".join(words), "load_average": os.getloadavg()[0]}
    (out / "any_drive.json").write_text(
        json.dumps({"provenance": provenance, **result}, indent=1) + "\n")


if __name__ == "__main__":
    main()
