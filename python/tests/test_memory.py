# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""No needless copies, no leaks."""
import gc
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
from conftest import memory

import adasplats

HERE = str(Path(__file__).parent)
HEAD = f"""
import sys
sys.path.insert(0, {HERE!r})
import numpy as np
import adasplats
from conftest import memory
"""


def test_no_leak_over_1000_simulations(street, scene, poses):
    one = poses[:1]
    rays = np.random.default_rng(1).normal(size=(2000, 3))
    sensor = adasplats.Sensor(street.sensor)
    matrices = one.poses

    def work():
        scan = scene.simulate(sensor, matrices)[0]
        for name in ("positions", "ranges", "classes", "rings", "times", "pose"):
            getattr(scan, name).sum()
        hits = scene.cast([0.0, 0, 2], rays)
        for name in ("ranges", "primitives", "valid", "classes", "normals"):
            getattr(hits, name).sum()
        next(scene.iter_scans(sensor, matrices))

    for _ in range(100):
        work()
    gc.collect()
    counts = [sys.getrefcount(x) for x in (scene, sensor, rays, matrices)]
    before = memory("VmRSS")
    for _ in range(1000):
        work()
    gc.collect()
    assert memory("VmRSS") - before < 5_000_000
    assert [sys.getrefcount(x) for x in (scene, sensor, rays, matrices)] == counts


def test_errors_leak_nothing(scene):
    bad = np.zeros((1000, 2))
    counts = sys.getrefcount(bad)
    for _ in range(100):
        try:
            scene.cast([0.0, 0, 2], bad)
        except ValueError:
            pass
        try:
            adasplats.PointCloud(bad)
        except ValueError:
            pass
    assert sys.getrefcount(bad) == counts


def peak_of_casting(street, dtype):
    """Bytes that the peak of memory grows by when 10 M rays are cast, beyond the result."""
    script = textwrap.dedent(f"""
        scene = adasplats.Scene({str(street.model)!r}, device="cpu")
        draw = np.random.default_rng(1)
        directions = np.zeros((10_000_000, 3), np.{dtype})
        directions[:] = draw.normal(size=3)
        origins = np.ones((10_000_000, 3), np.{dtype})
        scene.cast(origins[:300_000], directions[:300_000])
        before = memory("VmRSS")
        hits = scene.cast(origins, directions)
        assert len(hits) == 10_000_000
        print(memory("VmHWM") - before - hits.ranges.size * 8)
    """)
    done = subprocess.run([sys.executable, "-c", HEAD + script], stdout=subprocess.PIPE,
                          timeout=200, check=True)
    return int(done.stdout)


def test_ten_million_rays_are_not_copied(street):
    """Two arrays of 120 MB (float32) or 240 MB (float64): a copy of one would show."""
    assert peak_of_casting(street, "float32") < 16_000_000
    assert peak_of_casting(street, "float64") < 16_000_000


def test_iterating_keeps_few_scans(street):
    script = textwrap.dedent(f"""
        scene = adasplats.Scene({str(street.model)!r}, device="cpu")
        poses = np.repeat(np.eye(4)[None], 200, axis=0)
        size = 0
        for number, scan in enumerate(scene.iter_scans("hdl-64-paper", poses)):
            if number == 20:
                before = memory("VmRSS")
            size += scan.positions.nbytes
        print(memory("VmHWM") - before, size)
    """)
    done = subprocess.run([sys.executable, "-c", HEAD + script], stdout=subprocess.PIPE,
                          timeout=200, check=True)
    grown, size = map(int, done.stdout.split())
    assert size > 30_000_000
    assert grown < 16_000_000
