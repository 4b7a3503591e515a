# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Types of adasplats.evaluate: dicts with the keys of 'adasplats evaluate --report'."""
from typing import Any, Sequence

from numpy.typing import ArrayLike

from . import Device, Path, PointCloud, Progress, Scene

def c2c(
    simulated: PointCloud | Path,
    original: PointCloud | Path,
    *,
    by_class: bool = False,
    nearest_classes: bool = False,
    labels: Path | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...

def echoes(
    model: Path,
    sequence: Path,
    *,
    first_scan: int = 0,
    scan_count: int | None = None,
    scan_stride: int = 1,
    motion: Path | None = None,
    sensor: Path = "velodyne-hdl-64e-kitti",
    drop: Path | None = None,
    device: Device = "auto",
    gpus: Sequence[int] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...

def labels(
    simulated: Path,
    original: Path,
    *,
    window: int = 10,
    every: int = 1,
    labels: Path = "semantickitti",
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...

def presence(
    model: Path,
    points: Path,
    *,
    labels: Path | None = None,
    within: float = 0.1,
    min_range: float = 2.5,
    max_range: float = 50.0,
    label_field: str | None = None,
    viewpoint: ArrayLike | None = None,
    trajectory: Path | None = None,
    mount: ArrayLike | None = None,
    mount_rotation_deg: ArrayLike = (0.0, 0.0, 0.0),
    time_offset_s: float | None = None,
    boxes: Path | None = None,
    points_in: Literal["auto", "sensor", "world"] = "auto",
    sweep_points: Literal["auto", "measured", "compensated"] = "auto",
    scan_times: Path | None = None,
    topic: str | None = None,
    poses_topic: str | None = None,
    scene: str | None = None,
    beams_from_poses: bool = False,
    max_distance_m: float = 100000.0,
    max_dropped: float = 0.01,
    own_body_m: float | None = None,
    driven_path_m: float = 0.6,
    trust_origins: bool = False,
    strict: bool = False,
    salvage: bool = False,
    sensor_x_field: str | None = None,
    sensor_y_field: str | None = None,
    sensor_z_field: str | None = None,
    first_scan: int = 0,
    scan_count: int | None = None,
    scan_stride: int = 1,
    device: Device = "auto",
    gpus: Sequence[int] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...

def realism(
    simulated: Path,
    real: Path,
    *,
    first_scan: int = 0,
    scan_count: int | None = None,
    scan_stride: int = 1,
    trajectory: Path | None = None,
    threads: int = 0,
    seed: int = 1,
    progress: Progress | None = None,
) -> dict[str, Any]: ...

def resimulate(
    model: Scene | Path,
    sequence: Path,
    *,
    first_scan: int = 0,
    scan_count: int | None = None,
    scan_stride: int = 1,
    beams_from_poses: bool = False,
    motion: Path | None = None,
    trajectory: Path | None = None,
    boxes: Path | None = None,
    mount: ArrayLike | None = None,
    mount_rotation_deg: ArrayLike = (0.0, 0.0, 0.0),
    time_offset_s: float | None = None,
    points_in: Literal["auto", "sensor", "world"] = "auto",
    sweep_points: Literal["auto", "measured", "compensated"] = "auto",
    scan_times: Path | None = None,
    topic: str | None = None,
    poses_topic: str | None = None,
    scene: str | None = None,
    labels: Path = "semantickitti",
    min_range: float = 2.5,
    max_range: float = 50.0,
    drop_moving: bool = True,
    drop_movable: bool = False,
    all_poses: bool = False,
    protocol: str | None = None,
    device: Device = "auto",
    gpus: Sequence[int] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...

def segmentation(
    predicted: Path | ArrayLike,
    true: Path | ArrayLike,
    *,
    first_scan: int = 0,
    scan_count: int | None = None,
    scan_stride: int = 1,
    labels: Path = "semantickitti",
    least_share: float = 0.0005,
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...

def truth(
    model: Path,
    truth: Path,
    *,
    trajectory: Path | None = None,
    sensor: Path = "hdl-64-paper",
    offset: ArrayLike = (0.0, 0.0, 0.0),
    every: int = 1,
    labels: Path | None = None,
    drop_moving: bool = True,
    drop_movable: bool = False,
    device: Device = "auto",
    gpus: Sequence[int] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...

def unit(
    model: Path,
    scans: Path,
    *,
    sensor: str = "",
    first_scan: int = 0,
    scan_count: int | None = None,
    scan_stride: int = 1,
    motion: Path | None = None,
    trajectory: Path | None = None,
    device: Device = "auto",
    gpus: Sequence[int] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...
