# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Real LiDAR point clouds in, splat models (oriented disks) and simulated LiDAR scans out.

    cloud = adasplats.PointCloud(positions, sensor_positions=sensors)   # or adasplats.read(paths)
    model = adasplats.model(cloud)                                      # splats
    scene = adasplats.Scene(model)                                      # what rays are cast into
    for scan in scene.iter_scans("ouster-os1-64", poses):               # (N, 4, 4)
        scan.positions, scan.ranges, scan.classes                       # NumPy arrays

Lengths are metres, angles radians (degrees where a name says so), times seconds; x forward, y left,
z up. Poses are matrices world_from_sensor. Arrays that come out are read-only views without a copy;
arrays that go in are read where they are wherever that is possible. Long work is done without the
GIL and ends with KeyboardInterrupt when asked to. Errors are TypeError, ValueError, OSError
(missing files: FileNotFoundError), RuntimeError (a GPU that is not there) and adasplats.Error besides.
"""
from . import evaluate
from ._adasplats import (
    NO_PRIMITIVE,
    ConfigError,
    DataError,
    Error,
    Firings,
    Hits,
    InputError,
    LabelScheme,
    Mesh,
    Model,
    Network,
    OutputError,
    PointCloud,
    Scan,
    Scans,
    Scene,
    Sensor,
    SoftwareError,
    Trajectory,
    UnavailableError,
    UsageError,
    __version__,
    calibrate,
    compare,
    devices,
    export,
    fit_sensor,
    label_scheme,
    mesh,
    model,
    provenance,
    read,
    segment,
    sensors,
    simkitti32,
    synth_street,
    why_no_gpu,
)

__all__ = [
    "NO_PRIMITIVE",
    "ConfigError",
    "DataError",
    "Error",
    "Firings",
    "Hits",
    "InputError",
    "LabelScheme",
    "Mesh",
    "Model",
    "Network",
    "OutputError",
    "PointCloud",
    "Scan",
    "Scans",
    "Scene",
    "Sensor",
    "SoftwareError",
    "Trajectory",
    "UnavailableError",
    "UsageError",
    "__version__",
    "calibrate",
    "compare",
    "devices",
    "evaluate",
    "export",
    "fit_sensor",
    "label_scheme",
    "mesh",
    "model",
    "provenance",
    "read",
    "segment",
    "sensors",
    "simkitti32",
    "synth_street",
    "why_no_gpu",
]
