# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""For realism.py: models of real drives, calibrated sensors fitted to these drives, and scans that the
sensors simulate at the poses of the real ones.

REAL_DATA: folder with kitti-0005, semantickitti-labelled and pandaset-002, unpacked; missing ones
are skipped. No SemanticKITTI scene is tested with a sensor that was fitted to it.
"""
import argparse
import pathlib
import shlex
from dataclasses import dataclass

import numpy as np

from calibration import report_of
from provenance import provenance_of

KITTI_SENSOR = "velodyne-hdl-64e-kitti"
# Mount of the Pandar64 in the vehicle frame, as `info` estimates it for the drive.
PANDA_MOUNT = "0.019,0.725,1.887"
# SemanticKITTI sequence: the sequence for fitting its sensor.
UNIT_OF = {"00": "02", "01": "00", "02": "00", "03": "01", "05": "00", "07": "00", "09": "02"}
NUMPY_TYPES = {"float": "<f4", "double": "<f8", "uchar": "u1", "ushort": "<u2", "uint": "<u4",
               "char": "i1", "short": "<i2", "int": "<i4"}


def fit_options(unit):
    """Output options of `fit-sensor` for the folder of a calibrated sensor."""
    return ["-o", unit / "unit.toml"]


def unit_options(unit):
    """Options of `simulate` for the calibrated sensor in a folder."""
    return ["--sensor", unit / "unit.toml", "--sensor-offsets"]


# ---- drives --------------------------------------------------------------------------------

@dataclass(frozen=True)
class Drive:
    """Measured scans, options for reading them, and the drive for the model of their scene."""
    name: str
    scans: pathlib.Path
    model_of: str               # name of a drive
    model_words: tuple          # of `model`, after its input
    reading: tuple              # of `fit-sensor` and `evaluate`: how the scans are read
    fitting: tuple              # of `fit-sensor` alone
    driving: tuple              # of `simulate`: poses, motion and format, without the sensor
    scan_folder: str            # in the output of `simulate`
    plain_sensor: str           # the library's sensor of this kind


@dataclass(frozen=True)
class Row:
    """Scans to test, and the scans for fitting the sensor that simulates them."""
    name: str
    drive: str
    fitted_drive: str
    fitted_scans: str           # FIRST:COUNT[:STRIDE], empty: all
    judged_scans: str           # empty: all
    use: str = "test"           # or development: these scans influenced the method
    held_out_scans: str = ""    # of the tested ones, if not all

    @property
    def key(self):
        return self.name.replace(" ", "-").replace(",", "")


def kitti_drives(data):
    sequences = data / "kitti-0005/sequences"
    if not sequences.exists():
        return
    whole, raw = sequences / "00", sequences / "01_raw"
    common = {"model_of": "kitti-0005 00", "model_words": ("--remove", "moving"), "reading": (),
              "scan_folder": "sequences/00", "plain_sensor": KITTI_SENSOR}
    yield Drive("kitti-0005 00", whole, fitting=(), driving=(
        "--trajectory", whole, "--rolling-shutter", "--points", "deskewed"), **common)
    yield Drive("kitti-0005 01_raw", raw, fitting=("--motion", whole), driving=(
        "--trajectory", raw, "--motion", whole, "--rolling-shutter"), **common)


def labelled_drives(data):
    """Drives of SemanticKITTI; parked cars remain in the models, since the scans contain them."""
    for place in sorted((data / "semantickitti-labelled/sequences").glob("*")):
        name = f"semantickitti {place.name}"
        yield Drive(name, place, name, ("--remove", "none"), (), (), (
            "--trajectory", place, "--rolling-shutter", "--points", "deskewed"), "sequences/00",
            KITTI_SENSOR)


def panda_drives(data, out):
    panda = data / "pandaset-002"
    if not panda.exists():
        return
    trajectory = panda / "vehicle_trajectory.csv"
    poses = poses_at_middles(panda / "frames", trajectory, out / "pandaset-poses.csv")
    reading = ("--trajectory", trajectory)
    yield Drive("pandaset-002", panda / "frames", "pandaset-002",
                (*reading, "--boxes", panda / "cuboids.csv"), reading, (),
                ("--trajectory", poses, "--format", "ply", "--mount", PANDA_MOUNT), "",
                "hesai-pandar64")


def drives_of(data, out):
    """All drives by name."""
    found = [*kitti_drives(data), *labelled_drives(data), *panda_drives(data, out)]
    return {drive.name: drive for drive in found}


def labelled_rows():
    """Rows of SemanticKITTI: all scans of a sequence with the sensor of another sequence."""
    return [Row(f"semantickitti {place} by {by}", f"semantickitti {place}", f"semantickitti {by}", "",
                "") for place, by in UNIT_OF.items()]


def kitti_rows():
    """Rows of the drive that was used to develop the method."""
    whole, raw = "kitti-0005 00", "kitti-0005 01_raw"
    return [Row("kitti-0005 01_raw by its own even scans", raw, raw, "0:4:2", "", "development",
                "1:4:2"),
            Row("kitti-0005 01_raw by even scans of 00", raw, whole, "0:39:2", "", "development"),
            Row("kitti-0005 odd scans of 00 by its even ones", whole, whole, "0:39:2", "1:38:2",
                "development")]


def other_rows():
    """Frames 12 to 40 of pandaset-002 are its first 29 files, frames 60 to 79 its last 19 (some are
    missing)."""
    return [Row("semantickitti 07 by kitti-0005 01_raw", "semantickitti 07", "kitti-0005 01_raw",
                "0:4:2", ""),
            Row("pandaset-002 frames 60 to 79 by 12 to 40", "pandaset-002", "pandaset-002", "0:29",
                "45:19")]


def middle_time_s(file):
    """Middle of the times of the points in a binary PLY file."""
    data = file.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    lines = header.decode().split("\n")
    count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    fields = [(line.split()[2], NUMPY_TYPES[line.split()[1]]) for line in lines
              if line.startswith("property")]
    times = np.frombuffer(body, np.dtype(fields), count)["time"]
    return 0.5 * (times.min() + times.max())


def poses_at_middles(frames, trajectory, output):
    """The vehicle's poses at the middle of its frames, interpolated (linearly for quaternions of poses
    0.1 s apart, then normalised). An existing file is reused."""
    if output.exists():
        return output
    rows_of_file = np.loadtxt(trajectory, delimiter=",", skiprows=1)
    middles = np.array([middle_time_s(file) for file in sorted(frames.glob("*.ply"))])
    poses = np.column_stack([np.interp(middles, rows_of_file[:, 0], rows_of_file[:, k])
                             for k in range(1, 8)])
    poses[:, 3:] /= np.linalg.norm(poses[:, 3:], axis=1)[:, None]
    np.savetxt(output, np.column_stack([middles, poses]), delimiter=",", fmt="%.9f",
               header="time,x,y,z,qw,qx,qy,qz", comments="")
    return output


# ---- models, sensors and scans -----------------------------------------------------------------

class Workshop:
    """Models, calibrated sensors and scans in a folder. Files that are newer than all their inputs are
    reused. `commands` lists the commands, with names in place of the folders' paths."""

    def __init__(self, program, data, out):
        self.program, self.data, self.out = (path.absolute() for path in (program, data, out))
        self.out.mkdir(parents=True, exist_ok=True)
        self.drives = drives_of(self.data, self.out)
        self.commands = []

    def report(self, words, name):
        """The report of a command."""
        words = [self.program, *words]
        text = shlex.join(str(word) for word in words)
        for path, short in ((self.program, "adasplats"), (self.data, "REAL_DATA"),
                            (self.out, "OUT")):
            text = text.replace(str(path), short)
        if text not in self.commands:
            self.commands.append(text)
        return report_of(words, self.out / f"{name}.json")

    def model(self, drive):
        """The model of a drive's scene."""
        of = self.drives[drive.model_of]
        name = of.name.replace(" ", "-")
        self.report(["model", of.scans, "-o", self.out / f"{name}.ply", *of.model_words],
                    f"{name}-model")
        return self.out / f"{name}.ply"

    def unit(self, row):
        """The folder of a row's calibrated sensor, and the report of `fit-sensor`."""
        drive = self.drives[row.fitted_drive]
        scans = f"-{row.fitted_scans.replace(':', '-')}" if row.fitted_scans else ""
        unit = self.out / ("unit-" + drive.name.replace(" ", "-") + scans)
        unit.mkdir(exist_ok=True)
        report = self.report(
            ["fit-sensor", self.model(drive), drive.scans, *drive.reading, *drive.fitting,
             *(["--scans", row.fitted_scans] if row.fitted_scans else []), *fit_options(unit)],
            unit.name)
        return unit, report

    def predicted(self, row):
        """The report of `evaluate unit` for held-out scans."""
        unit, _ = self.unit(row)
        drive, scans = self.drives[row.drive], row.held_out_scans or row.judged_scans
        return self.report(["evaluate", "unit", self.model(drive), drive.scans, *drive.reading,
                            *drive.fitting, "--sensor", unit / "unit.toml",
                            *(["--scans", scans] if scans else [])], f"{row.key}-unit")

    def scans(self, row, name, more=()):
        """The folder of scans that a row's sensor simulates at the poses of the real ones."""
        drive, folder = self.drives[row.drive], self.out / name
        self.report(["simulate", self.model(drive), *drive.driving,
                     *unit_options(self.unit(row)[0]), *more, "-o", folder, "--overwrite"], name)
        return folder

    def available(self, rows, only):
        """Rows with existing drives and with names that contain one of the texts."""
        for row in rows:
            if row.drive not in self.drives or row.fitted_drive not in self.drives:
                continue
            if not only or any(text in row.name for text in only):
                yield row

    def provenance(self, options, script):
        """Provenance without paths of this machine."""
        only = " --only " + shlex.join(options.only) if options.only else ""
        command = f"{script} build/release/bin/adasplats REAL_DATA OUT{only}"
        return provenance_of(self.program) | {"command": command, "commands": self.commands}


def options_parser(text):
    """Argument parser of a script on all rows."""
    parser = argparse.ArgumentParser(description=text,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("program", "data", "out"):
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--only", nargs="+", default=[], help="only rows with names that contain one of these")
    return parser
