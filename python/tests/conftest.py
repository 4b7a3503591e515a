# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures: a small street, its model, and the program to check against."""
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import adasplats

PROGRAM = os.environ.get("ADASPLATS_PROGRAM", "adasplats")

SENSOR = """\
name = "tiny"
beams = 16
elevation_top_deg = 10.0
elevation_bottom_deg = -25.0
columns = 180
max_range_m = 60.0
range_noise_m = 0.01
"""


def run_program(*arguments):
    """Runs the command line, which must succeed."""
    result = subprocess.run([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, timeout=120, encoding="utf-8")
    assert result.returncode == 0, (arguments, result.stderr)
    return result


def report_of(folder, *arguments):
    """The --report of a command."""
    path = Path(folder) / "report.json"
    run_program(*arguments, "--report", path)
    return json.loads(path.read_text(encoding="utf-8"))


def memory(key):
    """Bytes of this process: VmRSS, what is in memory, or VmHWM, its peak. (getrusage also counts
    what the process was before exec.)"""
    with open("/proc/self/status", encoding="ascii") as status:
        return next(1024 * int(x.split()[1]) for x in status if x.startswith(key + ":"))


class Street:
    """A procedural street with a model made by the command line."""

    def __init__(self, folder):
        self.folder = folder
        run_program("synth", "street", "-o", folder / "street", "--points", 20000,
                    "--driving-spacing", 10)
        self.cloud = folder / "street" / "mapping.ply"
        self.sequence = folder / "street" / "sequences" / "00"
        self.mesh = folder / "street" / "mesh.ply"
        self.true_poses = folder / "street" / "true_driving_trajectory.csv"
        self.model = folder / "model.ply"
        run_program("model", self.cloud, "-o", self.model, "--labels", "semantickitti")
        self.sensor = folder / "tiny.toml"
        self.sensor.write_text(SENSOR)


@pytest.fixture(scope="session")
def street(tmp_path_factory):
    return Street(tmp_path_factory.mktemp("adasplats ä"))


@pytest.fixture(scope="session")
def scene(street):
    return adasplats.Scene(street.model, device="cpu")


@pytest.fixture(scope="session")
def poses(street):
    return adasplats.Trajectory.read(street.sequence)


@pytest.fixture
def wall():
    """A disk of radius 10 across +x at 5 m, and its scene."""
    model = adasplats.Model([[5.0, 0, 0]], [[-1.0, 0, 0]], [10.0], classes=[50])
    return adasplats.Scene(model, device="cpu")


def unit_rays(count, seed=1):
    """Directions in a cone around +x."""
    draw = np.random.default_rng(seed)
    directions = draw.normal(size=(count, 3)) * 0.2 + [1, 0, 0]
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)
