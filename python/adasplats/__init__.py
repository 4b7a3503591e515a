# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Make splat models (oriented disks) from LiDAR point clouds and simulate LiDAR scans in them.

    cloud = adasplats.PointCloud(positions, sensor_positions=sensors)   # or adasplats.read(paths)
    model = adasplats.model(cloud)                                      # splats
    scene = adasplats.Scene(model)                                      # on the CPU or a GPU
    for scan in scene.iter_scans("ouster-os1-64", poses):               # (N, 4, 4)
        scan.positions, scan.ranges, scan.classes                       # NumPy arrays

Lengths are in metres, angles in radians (or degrees, if documented), times in seconds; x is
forward, y left, z up. Poses are matrices world_from_sensor. Returned arrays are read-only views
without a copy unless documented as new. Arguments are read without a copy where possible. Long calls
release the GIL, and Ctrl-C interrupts them. Errors are TypeError, ValueError, OSError (missing
files: FileNotFoundError) or RuntimeError (a missing GPU); those of the library also derive from
adasplats.Error.
"""
from . import evaluate
from ._adasplats import (
    NO_PRIMITIVE,
    Camera,
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
    limit_gpu_memory,
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
    "Camera",
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
    "limit_gpu_memory",
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
