# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Types of adasplats; docstrings give shapes, dtypes and units."""
from __future__ import annotations

import os
from typing import Any, Callable, Iterator, Literal, Sequence, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import evaluate as evaluate

Path = Union[str, bytes, os.PathLike[str]]
Poses = Union["Trajectory", ArrayLike]
"""world_from_sensor, (N, 4, 4) or (4, 4)."""
Progress = Callable[[str, int, int], object]
"""Called with (step, done, total); total is 0 if unknown."""
Device = Literal["auto", "cpu", "cuda", "optix"]
DivergenceKind = Literal["fwhm", "1/e2", "1/e2-half", "unknown"]
Selection = Literal["most-discards-first", "largest-first", "curve", "scattered"]

__version__: str
NO_PRIMITIVE: int
"""Index of the primitive of rays that hit nothing."""

class Error(Exception):
    """Base of all errors of adasplats; each also derives from a built-in exception."""

class UsageError(Error, ValueError): ...
class DataError(Error, ValueError): ...
class ConfigError(Error, ValueError): ...
class InputError(Error, FileNotFoundError): ...
class OutputError(Error, OSError): ...
class UnavailableError(Error, RuntimeError): ...
class SoftwareError(Error, RuntimeError): ...

def read(
    paths: Path | Sequence[Path],
    *,
    label_field: str | None = None,
    viewpoint: ArrayLike | None = None,
    trajectory: Path | None = None,
    mount: ArrayLike | None = None,
    mount_rotation_deg: ArrayLike = (0.0, 0.0, 0.0),
    time_offset_s: float | None = None,
    extent: ArrayLike | None = None,
    level: int | None = None,
    resolution_m: float | None = None,
    boxes: Path | None = None,
    points_in: Literal["auto", "sensor", "world"] = "auto",
    sweep_points: Literal["auto", "measured", "compensated"] = "auto",
    scan_times: Path | None = None,
    topic: str | None = None,
    poses_topic: str | None = None,
    scene: str | None = None,
    packet_sensor: str | None = None,
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
    threads: int = 0,
    progress: Progress | None = None,
) -> PointCloud: ...

def model(
    points: PointCloud | Path | Sequence[Path],
    *,
    labels: Path | None = None,
    segment: bool = False,
    network: Path | None = None,
    draft: bool = False,
    method: Literal["consistent", "basic", "descriptors", "semantic"] = "consistent",
    neighbors: int = 40,
    alpha: float = 0.2,
    smoothness: float = 0.6,
    radius: float | None = None,
    error_bound: float | None = None,
    selection: Selection = "most-discards-first",
    denoise: bool = True,
    denoise_sigmas: float = 3.0,
    denoise_votes: float = 0.5,
    resample: bool = True,
    resample_density: float = 1.0,
    resample_base: Literal["points", "centers", "mixed"] = "mixed",
    ground_scale: ArrayLike = (3.0, 3.0, 3.0),
    surface_scale: ArrayLike = (1.0, 1.0, 1.0),
    linear_scale: ArrayLike = (0.33, 0.33, 0.33),
    non_surface_scale: ArrayLike = (0.25, 0.25, 0.25),
    planar_scale: ArrayLike = (2.0, 2.0, 2.0),
    group_normals: bool = True,
    cell: float = 0.05,
    small_cell: float = 0.02,
    largest_radius: float = 0.5,
    balance_rounds: int = 4,
    strict_rounds: int = 5,
    settle_rounds: int = 2,
    empty_beams: bool = True,
    fill: bool = True,
    refine: bool = True,
    remove: Literal["none", "moving", "movable"] = "movable",
    reflectance: bool = True,
    calibrate: bool = True,
    calibrate_poses: bool = True,
    calibrate_ranges: bool = True,
    calibrate_elevations: bool = True,
    calibrate_mount: bool = True,
    label_field: str | None = None,
    viewpoint: ArrayLike | None = None,
    trajectory: Path | None = None,
    mount: ArrayLike | None = None,
    mount_rotation_deg: ArrayLike = (0.0, 0.0, 0.0),
    time_offset_s: float | None = None,
    extent: ArrayLike | None = None,
    level: int | None = None,
    resolution_m: float | None = None,
    boxes: Path | None = None,
    points_in: Literal["auto", "sensor", "world"] = "auto",
    sweep_points: Literal["auto", "measured", "compensated"] = "auto",
    scan_times: Path | None = None,
    topic: str | None = None,
    poses_topic: str | None = None,
    scene: str | None = None,
    packet_sensor: str | None = None,
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
    seed: int = 1,
    progress: Progress | None = None,
) -> Model: ...

@overload
def segment(
    points: PointCloud,
    *,
    network: Path | None = None,
    tile: float = 32.0,
    margin: float = 12.0,
    intensity: bool = True,
    confidences: Literal[False] = False,
    device: Device = "auto",
    gpus: Sequence[int] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> NDArray[np.uint16]: ...
@overload
def segment(
    points: PointCloud,
    *,
    network: Path | None = None,
    tile: float = 32.0,
    margin: float = 12.0,
    intensity: bool = True,
    confidences: Literal[True],
    device: Device = "auto",
    gpus: Sequence[int] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> tuple[NDArray[np.uint16], NDArray[np.float32]]: ...
def mesh(
    points: PointCloud | Path | Sequence[Path],
    *,
    labels: Path | None = None,
    method: Literal["imls", "poisson"] = "imls",
    neighbors: int = 40,
    voxel: float = 0.07,
    sigma: float = 2.0,
    truncation: float = 3.0,
    depth: int = 13,
    samples_per_node: float | None = None,
    trim: float | None = None,
    poisson_program: Literal["auto", "poissonrecon", "open3d"] = "auto",
    remove: Literal["none", "moving", "movable"] = "movable",
    label_field: str | None = None,
    viewpoint: ArrayLike | None = None,
    trajectory: Path | None = None,
    mount: ArrayLike | None = None,
    mount_rotation_deg: ArrayLike = (0.0, 0.0, 0.0),
    time_offset_s: float | None = None,
    extent: ArrayLike | None = None,
    level: int | None = None,
    resolution_m: float | None = None,
    boxes: Path | None = None,
    points_in: Literal["auto", "sensor", "world"] = "auto",
    sweep_points: Literal["auto", "measured", "compensated"] = "auto",
    scan_times: Path | None = None,
    topic: str | None = None,
    poses_topic: str | None = None,
    scene: str | None = None,
    packet_sensor: str | None = None,
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
    threads: int = 0,
    progress: Progress | None = None,
) -> Mesh: ...
def calibrate(
    inputs: Path | Sequence[Path],
    output: Path,
    *,
    poses: bool = True,
    ranges: bool = True,
    elevations: bool = True,
    mount_correction: bool = True,
    window_scans: int = 200,
    label_field: str | None = None,
    viewpoint: ArrayLike | None = None,
    trajectory: Path | None = None,
    mount: ArrayLike | None = None,
    mount_rotation_deg: ArrayLike = (0.0, 0.0, 0.0),
    time_offset_s: float | None = None,
    extent: ArrayLike | None = None,
    level: int | None = None,
    resolution_m: float | None = None,
    boxes: Path | None = None,
    points_in: Literal["auto", "sensor", "world"] = "auto",
    sweep_points: Literal["auto", "measured", "compensated"] = "auto",
    scan_times: Path | None = None,
    topic: str | None = None,
    poses_topic: str | None = None,
    scene: str | None = None,
    packet_sensor: str | None = None,
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
    overwrite: bool = False,
    device: Device = "auto",
    gpus: Sequence[int] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...
def export(
    input: Path,
    output: Path,
    *,
    format: Literal[
        "gaussian-3d",
        "gaussian-2d",
        "3d-tiles",
        "usd",
        "glb",
        "ply",
        "las",
        "laz",
        "pcd",
        "csv",
        "mcap",
        "semantickitti",
        "kitti-raw",
        "nuscenes",
        "pandaset",
        "argoverse2",
    ]
    | None = None,
    labels: Path | None = None,
    color: Literal["class", "intensity", "height", "rgb"] | None = None,
    label_field: str | None = None,
    viewpoint: ArrayLike | None = None,
    trajectory: Path | None = None,
    mount: ArrayLike | None = None,
    mount_rotation_deg: ArrayLike = (0.0, 0.0, 0.0),
    time_offset_s: float | None = None,
    extent: ArrayLike | None = None,
    level: int | None = None,
    resolution_m: float | None = None,
    boxes: Path | None = None,
    points_in: Literal["auto", "sensor", "world"] = "auto",
    sweep_points: Literal["auto", "measured", "compensated"] = "auto",
    scan_times: Path | None = None,
    topic: str | None = None,
    poses_topic: str | None = None,
    scene: str | None = None,
    packet_sensor: str | None = None,
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
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...
def compare(
    data: Path,
    output: Path,
    *,
    methods: Sequence[str] | None = None,
    meshes: dict[str, Path] | None = None,
    preset: Literal["none", "paper-pc3d", "paper-kitti", "paper-mcity"] = "none",
    labels: Path | None = None,
    first_scan: int = 0,
    scan_count: int | None = None,
    scan_stride: int = 1,
    trajectory: Path | None = None,
    offset: ArrayLike | None = None,
    held_out: Path | None = None,
    held_out_first_scan: int = 0,
    held_out_scan_count: int | None = None,
    held_out_scan_stride: int = 1,
    truth: Path | None = None,
    sensor: Path = "hdl-64-paper",
    remove: Literal["none", "moving", "movable"] | None = None,
    every: int = 0,
    picture_width: int = 960,
    poisson_depth: int = 13,
    network: Path | None = None,
    time_limit: float = 3600.0,
    memory_limit: float = 0.0,
    retry: bool = False,
    program: Path | None = None,
    device: Device = "auto",
    threads: int = 0,
    seed: int = 1,
    progress: Progress | None = None,
) -> dict[str, Any]: ...
def fit_sensor(
    model: Path,
    scans: Path,
    output: Path,
    *,
    first_scan: int = 0,
    scan_count: int | None = None,
    scan_stride: int = 1,
    motion: Path | None = None,
    trajectory: Path | None = None,
    device: Literal["auto", "cpu", "cuda", "optix"] = "auto",
    gpus: Sequence[int] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> dict[str, Any]: ...
def simkitti32(
    sequence: Path,
    output: Path,
    *,
    sensor: Path = "hdl-32-paper",
    labels: Path = "semantickitti",
    first_scan: int = 0,
    scan_count: int | None = None,
    scan_stride: int = 1,
    offset: ArrayLike = (0.0, 0.0, -0.5),
    noise: float = 0.005,
    depth: int = 5,
    moving: bool = True,
    moving_radius: float = 0.14,
    method: Literal["consistent", "basic", "descriptors", "semantic"] = "consistent",
    model_every: int = 1,
    keep_model: bool = False,
    rain: float = 0.0,
    fog: float | None = None,
    snow: float = 0.0,
    white_intensity: float = 1.0,
    model: Path | None = None,
    ray_drop: Path | None = None,
    overwrite: bool = False,
    device: Device = "auto",
    gpus: Sequence[int] | None = None,
    threads: int = 0,
    seed: int = 1,
    progress: Progress | None = None,
) -> dict[str, Any]: ...

def label_scheme(name_or_path: Path) -> LabelScheme: ...

def sensors() -> list[str]: ...

def devices() -> list[dict[str, Any]]: ...
def provenance(threads: int = 0) -> dict[str, Any]: ...

def why_no_gpu() -> str: ...
def limit_gpu_memory(gigabytes: float, gpu: int = 0) -> None: ...

def synth_street(
    folder: Path,
    *,
    points: int = 300000,
    length: float = 0.0,
    range_noise: float = 0.005,
    passes: int = 2,
    driving_spacing: float = 2.0,
    threads: int = 0,
    seed: int = 1,
    progress: Progress | None = None,
) -> dict[str, Any]: ...

class PointCloud:
    """Points of one or many scans."""

    def __init__(
        self,
        positions: ArrayLike,
        *,
        classes: ArrayLike | None = None,
        instances: ArrayLike | None = None,
        intensities: ArrayLike | None = None,
        sensor_positions: ArrayLike | None = None,
        origin_kinds: ArrayLike | None = None,
        scan_indices: ArrayLike | None = None,
        origin: ArrayLike | None = None,
        crs_wkt: str = "",
    ) -> None: ...
    def __len__(self) -> int: ...
    @property
    def positions(self) -> NDArray[np.float32]:
        """(N, 3) float32, m, relative to origin."""
    @property
    def origin_kinds(self) -> NDArray[np.uint8] | None:
        """(N,) uint8, source of sensor_positions: 0 unknown, 1 guessed, 2 stated, 3 measured; or
        None."""
    @property
    def sensor_positions(self) -> NDArray[np.float32] | None:
        """(N, 3) float32, m, relative to origin; or None."""
    @property
    def intensities(self) -> NDArray[np.float32] | None:
        """(N,) float32, in the unit of the file, NaN if unknown; or None."""
    @property
    def classes(self) -> NDArray[np.uint16] | None:
        """(N,) uint16, ids of a label scheme; or None."""
    @property
    def instances(self) -> NDArray[np.uint16] | None:
        """(N,) uint16, 0 for none; or None."""
    @property
    def scan_indices(self) -> NDArray[np.uint32] | None:
        """(N,) uint32, the scan that a point is from; or None."""
    @property
    def lasers(self) -> NDArray[np.uint16] | None:
        """(N,) uint16, the laser that measured a point, topmost 0; 65535 if unknown; or None."""
    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) float64, world coordinates of the local origin, m."""
    @property
    def crs(self) -> str:
        """Code and name of the coordinate system, as in the input files ("EPSG:32632 (WGS 84 / UTM
        zone 32N)"); empty: none in the files."""
    @property
    def crs_wkt(self) -> str:
        """The coordinate system as well-known text; empty: none in the files, or given as GeoTIFF
        keys."""
    @property
    def world_positions(self) -> NDArray[np.float64]:
        """(N, 3) float64, origin + positions: a new array."""
    def save(self, path: Path) -> None: ...

class Network:
    """A network that predicts semantic classes of points."""

    def __init__(self, file: Path | None = None) -> None: ...
    @property
    def classes(self) -> list[str]:
        """Names of the classes that it distinguishes."""
    @property
    def card(self) -> str:
        """Model card: its training data and its purpose."""
    @property
    def cell_m(self) -> float:
        """Side of the cells; the input points are the means of cells, m."""
    def logits(
        self, points: ArrayLike, features: ArrayLike, *, threads: int = 0
    ) -> NDArray[np.float32]: ...

class LabelScheme:
    """Names and properties of semantic classes, made by label_scheme()."""

    def __len__(self) -> int: ...
    @property
    def name(self) -> str:
        """Name of the scheme."""
    @property
    def ids(self) -> NDArray[np.uint16]:
        """(C,) uint16, ids of the classes, ascending."""
    @property
    def names(self) -> list[str]:
        """Names of the classes, in the order of ids."""
    @property
    def groups(self) -> list[str]:
        """'ground', 'surface', 'linear' or 'non-surface', in the order of ids."""
    @property
    def mobilities(self) -> list[str]:
        """'fixed', 'movable' or 'moving', in the order of ids."""
    @property
    def colors(self) -> NDArray[np.uint8]:
        """(C, 3) uint8, RGB, in the order of ids."""
    def id_of(self, name: str) -> int: ...

class Trajectory:
    """Poses of a sensor over time."""

    def __init__(self, poses: Poses, times: ArrayLike | None = None) -> None: ...
    def __getitem__(self, slice: slice) -> Trajectory: ...
    def __len__(self) -> int: ...
    @staticmethod
    def read(path: Path) -> Trajectory: ...
    def save(self, path: Path) -> None: ...
    @property
    def poses(self) -> NDArray[np.float64]:
        """(N, 4, 4) float64, world_from_sensor: a new array."""
    @property
    def times(self) -> NDArray[np.float64]:
        """(N,) float64, s: a new array."""
    def resampled(
        self,
        *,
        rate_hz: float | None = None,
        spacing_m: float | None = None,
    ) -> Trajectory: ...
    def shifted(self, offset: ArrayLike) -> Trajectory: ...
    def mounted(self, vehicle_from_sensor: ArrayLike) -> Trajectory: ...
    def interpolate(self, time: float) -> NDArray[np.float64]: ...

class Firings:
    """The rays of one scan, made by Sensor.firings(). Arrays are read-only views without a copy."""

    def __len__(self) -> int: ...
    @property
    def directions(self) -> NDArray[np.float32]:
        """(N, 3) float32, unit vectors in the sensor frame."""
    @property
    def origins(self) -> NDArray[np.float32]:
        """(N, 3) float32, m: start points of the rays in the sensor frame."""
    @property
    def rings(self) -> NDArray[np.uint16]:
        """(N,) uint16, 0 the topmost."""
    @property
    def columns(self) -> NDArray[np.uint32]:
        """(N,) uint32, azimuth steps."""
    @property
    def times(self) -> NDArray[np.float32]:
        """(N,) float32, s since the start of the scan."""

class Camera:
    """A camera with a lens, mounted on a vehicle or sensor."""

    def __init__(self, file: Path) -> None: ...
    @staticmethod
    def from_matrix(
        matrix: ArrayLike,
        width: int,
        height: int,
        *,
        model: str = "none",
        coefficients: ArrayLike | None = None,
        mount: ArrayLike | None = None,
        name: str = "camera",
    ) -> Camera: ...
    @property
    def name(self) -> str:
        """Name of the camera."""
    @property
    def width(self) -> int:
        """Width of the picture, pixels."""
    @property
    def height(self) -> int:
        """Height of the picture, pixels."""
    @property
    def matrix(self) -> NDArray[np.float64]:
        """(3, 3) float64, new: fx 0 cx; 0 fy cy; 0 0 1, pixels."""
    @property
    def mount(self) -> NDArray[np.float64]:
        """(4, 4) float64, new: vehicle_from_camera; camera: x forward, y left, z up."""
    def directions(self) -> NDArray[np.float64]: ...

class Sensor:
    """A LiDAR: the rays of one revolution and the properties of its measurements."""

    def __init__(self, name_or_file: Path) -> None: ...
    @property
    def name(self) -> str:
        """Name of the sensor."""
    @property
    def source(self) -> str:
        """Source of its specification."""
    @property
    def rotation_hz(self) -> float:
        """Revolutions per second, Hz."""
    @property
    def columns(self) -> int:
        """Azimuth steps per revolution; 0: none."""
    @property
    def min_range_m(self) -> float:
        """Minimum range: nearer surfaces return no echo, m."""
    @property
    def max_range_m(self) -> float:
        """Maximum range: farther surfaces return no echo, m."""
    @property
    def range_noise_m(self) -> float:
        """Standard deviation of ranges, m."""
    @property
    def angular_noise_rad(self) -> float:
        """Standard deviation of angles, rad."""
    @property
    def range_resolution_m(self) -> float:
        """Ranges are multiples of this, m; 0: continuous."""
    @property
    def max_returns(self) -> int:
        """Maximum number of returns per firing."""
    @property
    def rings(self) -> int:
        """Number of beams."""
    @property
    def rays_per_scan(self) -> int:
        """Firings per scan."""
    @property
    def repeats(self) -> bool:
        """Whether every scan has the same rays."""
    @property
    def elevations_rad(self) -> NDArray[np.float64]:
        """(B,) float64, topmost first; empty for a list of rays or a rosette."""
    @property
    def range_offsets_m(self) -> NDArray[np.float64]:
        """(B,) float64, m, to add to the ranges of each ring of this sensor; empty: not calibrated.
        """
    @property
    def divergence_rad(self) -> tuple[float, float]:
        """Full angles of a beam at 1/e2 of its intensity, horizontal and vertical, rad."""
    @property
    def divergence_kind(self) -> DivergenceKind:
        """Definition of the angle in the source: 'fwhm', '1/e2', '1/e2-half' or 'unknown'."""
    @staticmethod
    def from_beams(
        elevations_rad: ArrayLike,
        *,
        azimuth_offsets_rad: ArrayLike | None = None,
        firing_times_s: ArrayLike | None = None,
        beam_origins_m: ArrayLike | None = None,
        columns: int = 1800,
        first_azimuth_rad: float = 0.0,
        clockwise: bool = False,
        name: str = "beams",
        rotation_hz: float = 10.0,
        min_range_m: float = 0.0,
        max_range_m: float = 120.0,
        range_noise_m: float = 0.0,
        angular_noise_rad: float = 0.0,
        range_resolution_m: float = 0.0,
        divergence_horizontal_rad: float | None = None,
        divergence_vertical_rad: float | None = None,
        divergence_kind: DivergenceKind | None = None,
        max_returns: int = 1,
    ) -> Sensor: ...
    @staticmethod
    def from_rays(
        directions: ArrayLike,
        *,
        origins_m: ArrayLike | None = None,
        times_s: ArrayLike | None = None,
        rings: ArrayLike | None = None,
        columns: ArrayLike | None = None,
        name: str = "rays",
        rotation_hz: float = 10.0,
        min_range_m: float = 0.0,
        max_range_m: float = 120.0,
        range_noise_m: float = 0.0,
        angular_noise_rad: float = 0.0,
        range_resolution_m: float = 0.0,
        divergence_horizontal_rad: float | None = None,
        divergence_vertical_rad: float | None = None,
        divergence_kind: DivergenceKind | None = None,
        max_returns: int = 1,
    ) -> Sensor: ...
    def replaced(self, **changes: object) -> Sensor: ...
    def firings(self, scan_index: int = 0) -> Firings: ...

class Model:
    """A scene as oriented disks (splats)."""

    def __init__(
        self,
        centers: ArrayLike,
        normals: ArrayLike,
        radii: ArrayLike,
        *,
        classes: ArrayLike | None = None,
        intensities: ArrayLike | None = None,
        labels: Path | None = None,
        origin: ArrayLike | None = None,
    ) -> None: ...
    def __len__(self) -> int: ...
    @staticmethod
    def load(path: Path) -> Model: ...
    def save(self, path: Path) -> None: ...
    @property
    def centers(self) -> NDArray[np.float32]:
        """(N, 3) float32, m, relative to origin."""
    @property
    def normals(self) -> NDArray[np.float32]:
        """(N, 3) float32, unit vectors."""
    @property
    def radii(self) -> NDArray[np.float32]:
        """(N,) float32, m."""
    @property
    def opacities(self) -> NDArray[np.float32] | None:
        """(N,) float32: probability that a ray through the centre stops; None: opaque disks."""
    @property
    def drop_log_odds(self) -> NDArray[np.float32] | None:
        """(N,) float32: by how much the log odds of losing a return exceed those of other splats at
        the same range and incidence; None: not measured."""
    @property
    def classes(self) -> NDArray[np.uint16] | None:
        """(N,) uint16, ids of the label scheme, or None."""
    @property
    def groups(self) -> NDArray[np.uint8] | None:
        """(N,) uint8: 0 ground, 1 surface, 2 linear, 3 non-surface; None for basic splats."""
    @property
    def intensities(self) -> NDArray[np.float32] | None:
        """(N,) float32: reflectances if there is a response, else as measured; or None."""
    @property
    def colors(self) -> NDArray[np.uint8] | None:
        """(N, 3) uint8, sRGB of the points, or None."""
    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) float64, world coordinates of the local origin, m."""
    @property
    def crs(self) -> str:
        """Code and name of the coordinate system, as in the input files ("EPSG:32632 (WGS 84 / UTM
        zone 32N)"); empty: none in the files."""
    @property
    def crs_wkt(self) -> str:
        """The coordinate system as well-known text; empty: none in the files, or given as GeoTIFF
        keys."""
    @property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3) float64: minimum and maximum world coordinates of the disks, m."""
    @property
    def labels(self) -> str:
        """Name or path of the label scheme; empty: none."""
    @property
    def network_sha256(self) -> str:
        """SHA-256 of the file of the network that predicted the classes; empty: none."""
    @property
    def method(self) -> str:
        """The method that made the model."""
    @property
    def response(self) -> dict[str, NDArray[np.float32]] | None:
        """Intensity as a function of range and incidence: a dict of float32 arrays ranges_m,
        range_gains, cos_incidences, incidence_gains; or None."""
    @property
    def report(self) -> dict[str, Any] | None:
        """Report of model(), with the keys of 'adasplats model --report'; None if loaded."""

class Mesh:
    """A scene as triangles."""

    def __init__(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike,
        *,
        classes: ArrayLike | None = None,
        labels: Path | None = None,
        origin: ArrayLike | None = None,
    ) -> None: ...
    def __len__(self) -> int: ...
    @staticmethod
    def load(path: Path) -> Mesh: ...
    def save(self, path: Path) -> None: ...
    @property
    def vertices(self) -> NDArray[np.float32]:
        """(V, 3) float32, m, relative to origin."""
    @property
    def triangles(self) -> NDArray[np.uint32]:
        """(T, 3) uint32, vertex indices."""
    @property
    def classes(self) -> NDArray[np.uint16] | None:
        """(T,) uint16, ids of the label scheme, or None."""
    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) float64, world coordinates of the local origin, m."""
    @property
    def crs(self) -> str:
        """Code and name of the coordinate system, as in the input files ("EPSG:32632 (WGS 84 / UTM
        zone 32N)"); empty: none in the files."""
    @property
    def crs_wkt(self) -> str:
        """The coordinate system as well-known text; empty: none in the files, or given as GeoTIFF
        keys."""
    @property
    def labels(self) -> str:
        """Name or path of the label scheme; empty: none."""

class Scan:
    """The returns of one revolution of a LiDAR, in firing order. Arrays are read-only views without
    a copy; attributes that the scene lacks are None."""

    def __len__(self) -> int: ...
    @property
    def positions(self) -> NDArray[np.float32]:
        """(N, 3) float32, m, in the sensor's frame."""
    @property
    def ranges(self) -> NDArray[np.float32]:
        """(N,) float32, m."""
    @property
    def rings(self) -> NDArray[np.uint16]:
        """(N,) uint16, 0 the topmost."""
    @property
    def columns(self) -> NDArray[np.uint32]:
        """(N,) uint32, azimuth steps."""
    @property
    def times(self) -> NDArray[np.float32]:
        """(N,) float32, s since the revolution began."""
    @property
    def intensities(self) -> NDArray[np.float32] | None:
        """(N,) float32, in the unit of the scene's intensities; or None."""
    @property
    def classes(self) -> NDArray[np.uint16] | None:
        """(N,) uint16, ids of the scene's label scheme; or None."""
    @property
    def instances(self) -> NDArray[np.uint16] | None:
        """(N,) uint16, 0 for none; or None."""
    @property
    def return_indices(self) -> NDArray[np.uint8] | None:
        """(N,) uint8, 0 for the first that the sensor reports of a firing; or None."""
    @property
    def pose(self) -> NDArray[np.float64]:
        """(4, 4) float64, world_from_sensor."""
    @property
    def time(self) -> float:
        """Time of the pose, s: the middle of the revolution if the sensor moves."""
    @property
    def begin(self) -> float:
        """Start of the revolution, s: the zero of times. The same as time if the sensor does not
        move."""
    @property
    def rays(self) -> int:
        """Number of firings in the revolution."""

class Scans:
    """The scans of one drive: a sequence of Scan, made by Scene.simulate()."""

    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int) -> Scan: ...
    @overload
    def __getitem__(self, slice: slice) -> Scans: ...
    def __iter__(self) -> Iterator[Scan]: ...
    def save(
        self,
        folder: Path,
        *,
        format: Literal[
            "semantickitti", "ply", "npy", "npz", "pcd", "las", "laz", "range-image", "mcap",
            "kitti-raw", "pandaset", "nuscenes", "argoverse2",
        ] = "semantickitti",
        point_order: Literal["kitti", "firing"] = "kitti",
    ) -> None: ...

class Hits:
    """Hits of rays, made by Scene.cast(): arrays have shape (N,), or (N, depth) for a depth above
    1. ranges and primitives are read-only strided views without a copy."""

    def __len__(self) -> int: ...
    @property
    def ranges(self) -> NDArray[np.float32]:
        """float32, m; inf for rays that hit nothing."""
    @property
    def primitives(self) -> NDArray[np.uint32]:
        """uint32: index of the splat or triangle; NO_PRIMITIVE for rays that hit nothing."""
    @property
    def valid(self) -> NDArray[np.bool_]:
        """bool, whether the ray hits something: a new array."""
    @property
    def classes(self) -> NDArray[np.uint16] | None:
        """uint16, 0 for rays that hit nothing: a new array; None without classes."""
    @property
    def normals(self) -> NDArray[np.float32]:
        """(..., 3) float32, NaN for rays that hit nothing: a new array."""

class Scene:
    """A scene that rays are cast into, on the CPU or on GPUs."""

    class DeviceArray:
        """An array in GPU memory that other libraries read without a copy through DLPack:
        torch.from_dlpack(array), cupy.from_dlpack(array). The memory is freed with the last
        reference."""

        def __dlpack__(self, *, stream: Any = None) -> Any: ...
        def __dlpack_device__(self) -> tuple[int, int]: ...
        @property
        def shape(self) -> tuple[int, ...]:
            """Shape, as in NumPy."""
        @property
        def pointer(self) -> int:
            """Address of the first element in GPU memory."""

    class DeviceHits:
        """Hits in GPU memory, made by Scene.cast_on_device(): arrays have shape (scans, firings),
        or (scans, firings, depth) for a depth above 1."""

        @property
        def ranges(self) -> Scene.DeviceArray:
            """float32, m; inf for rays that hit nothing."""
        @property
        def primitives(self) -> Scene.DeviceArray:
            """uint32: index of the splat or triangle; NO_PRIMITIVE for rays that hit nothing."""

    class ScanBatch:
        """Scans in consecutive arrays, made by Scene.scan_batches(): scan i has the returns
        offsets[i] to offsets[i + 1] - 1. Arrays are read-only views, or DeviceArrays in GPU memory
        for DLPack (torch.from_dlpack); attributes that were not requested or that the scene lacks
        are None."""

        def __len__(self) -> int: ...
        @property
        def first(self) -> int:
            """Index in poses of its first scan."""
        @property
        def offsets(self) -> NDArray[np.int64]:
            """(scans + 1,) int64, index of the first return of each scan."""
        @property
        def positions(self) -> NDArray[np.float32] | Scene.DeviceArray | None:
            """(N, 3) float32, m, in the sensor's frame; or None."""
        @property
        def intensities(self) -> NDArray[np.float32] | Scene.DeviceArray | None:
            """(N,) float32, in the unit of the scene's intensities; or None."""
        @property
        def classes(self) -> NDArray[np.uint16] | Scene.DeviceArray | None:
            """(N,) uint16, ids of the scene's label scheme; or None."""
        @property
        def instances(self) -> NDArray[np.uint16] | Scene.DeviceArray | None:
            """(N,) uint16, 0 for none; or None."""
        @property
        def rings(self) -> NDArray[np.uint16] | Scene.DeviceArray | None:
            """(N,) uint16, 0 the topmost; or None."""
        @property
        def columns(self) -> NDArray[np.uint32] | Scene.DeviceArray | None:
            """(N,) uint32, azimuth steps; or None."""
        @property
        def times(self) -> NDArray[np.float32] | Scene.DeviceArray | None:
            """(N,) float32, s since the revolution began; or None."""
        @property
        def ranges(self) -> NDArray[np.float32] | Scene.DeviceArray | None:
            """(N,) float32, m; or None."""
        @property
        def return_indices(self) -> NDArray[np.uint8] | Scene.DeviceArray | None:
            """(N,) uint8, 0 for the first that the sensor reports of a firing; or None."""
        def padded(self, name: str, length: int) -> NDArray[Any]: ...

    def __init__(
        self,
        model: Model | Mesh | Path,
        *,
        device: Device = "auto",
        gpus: Sequence[int] | None = None,
        threads: int = 0,
        progress: Progress | None = None,
        labels: Path | None = None,
    ) -> None: ...
    def __len__(self) -> int: ...
    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) float64, world coordinates of the local origin, m."""
    @property
    def device(self) -> str:
        """The device that casts rays: 'cpu', or 'cuda' or 'optix' and the names of GPUs."""
    @property
    def threads(self) -> int:
        """Number of CPU threads."""
    @property
    def labels(self) -> LabelScheme | None:
        """The LabelScheme of its classes, or None."""
    def cast(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        *,
        t_min: float = 0.0,
        t_max: float | None = None,
        depth: int = 1,
        local: bool = False,
    ) -> Hits: ...
    def simulate(
        self,
        sensor: Sensor | Path,
        poses: Poses,
        *,
        motion: Poses | None = None,
        rolling_shutter: bool = False,
        points: Literal["raw", "deskewed"] = "raw",
        noise: bool = True,
        sensor_offsets: bool = False,
        range_noise: float | None = None,
        min_range: float | None = None,
        max_range: float | None = None,
        rotation_rate: float | None = None,
        depth: int = 1,
        depth_gap: float = 0.1,
        sub_rays: int = 1,
        separation: float = 0.75,
        returns: int = 1,
        return_mode: Literal["strongest", "first", "last"] = "strongest",
        ray_drop: Path | None = None,
        vehicle_body: bool = True,
        rain: float = 0.0,
        fog: float | None = None,
        snow: float = 0.0,
        white_intensity: float = 1.0,
        seed: int = 1,
        first_number: int = 0,
        progress: Progress | None = None,
    ) -> Scans: ...
    def simulate_rig(
        self,
        rig: Path,
        poses: Poses,
        *,
        motion: Poses | None = None,
        rolling_shutter: bool = False,
        points: Literal["raw", "deskewed"] = "raw",
        noise: bool = True,
        sensor_offsets: bool = False,
        range_noise: float | None = None,
        min_range: float | None = None,
        max_range: float | None = None,
        rotation_rate: float | None = None,
        depth: int = 1,
        depth_gap: float = 0.1,
        sub_rays: int = 1,
        separation: float = 0.75,
        returns: int = 1,
        return_mode: Literal["strongest", "first", "last"] = "strongest",
        ray_drop: Path | None = None,
        vehicle_body: bool = True,
        rain: float = 0.0,
        fog: float | None = None,
        snow: float = 0.0,
        white_intensity: float = 1.0,
        seed: int = 1,
        first_number: int = 0,
        progress: Progress | None = None,
    ) -> dict[str, Scans]: ...
    def iter_scans(
        self,
        sensor: Sensor | Path,
        poses: Poses,
        *,
        motion: Poses | None = None,
        rolling_shutter: bool = False,
        points: Literal["raw", "deskewed"] = "raw",
        noise: bool = True,
        sensor_offsets: bool = False,
        range_noise: float | None = None,
        min_range: float | None = None,
        max_range: float | None = None,
        rotation_rate: float | None = None,
        depth: int = 1,
        depth_gap: float = 0.1,
        sub_rays: int = 1,
        separation: float = 0.75,
        returns: int = 1,
        return_mode: Literal["strongest", "first", "last"] = "strongest",
        ray_drop: Path | None = None,
        vehicle_body: bool = True,
        rain: float = 0.0,
        fog: float | None = None,
        snow: float = 0.0,
        white_intensity: float = 1.0,
        seed: int = 1,
        first_number: int = 0,
        progress: Progress | None = None,
    ) -> Iterator[Scan]: ...
    def scan_batches(
        self,
        sensor: Sensor | Path,
        poses: Poses,
        *,
        motion: Poses | None = None,
        rolling_shutter: bool = False,
        points: Literal["raw", "deskewed"] = "raw",
        noise: bool = True,
        sensor_offsets: bool = False,
        range_noise: float | None = None,
        min_range: float | None = None,
        max_range: float | None = None,
        rotation_rate: float | None = None,
        depth: int = 1,
        depth_gap: float = 0.1,
        sub_rays: int = 1,
        separation: float = 0.75,
        returns: int = 1,
        return_mode: Literal["strongest", "first", "last"] = "strongest",
        ray_drop: Path | None = None,
        vehicle_body: bool = True,
        rain: float = 0.0,
        fog: float | None = None,
        snow: float = 0.0,
        white_intensity: float = 1.0,
        seed: int = 1,
        first_number: int = 0,
        progress: Progress | None = None,
        fields: Sequence[str] | None = None,
        on_device: bool = False,
    ) -> Iterator[Scene.ScanBatch]: ...
    def poses_at(self, places: ArrayLike, *, height: float = 1.73) -> Trajectory: ...
    def poses_on_path(
        self,
        corners: ArrayLike,
        *,
        speed: float = 10.0,
        rate: float = 10.0,
        spacing: float | None = None,
        height: float = 1.73,
    ) -> Trajectory: ...
    def render(
        self,
        *,
        eye: ArrayLike | None = None,
        target: ArrayLike | None = None,
        birds_eye: bool = False,
        trajectory: Path | Poses | None = None,
        pose: int = 0,
        camera: Camera | Path | None = None,
        width: int = 2560,
        height: int = 1440,
        fov: float | None = None,
        color: Literal[
            "auto", "semantic", "shading", "normal", "intensity", "range", "height", "rgb"
        ] = "auto",
        samples: int = 2,
        relief: bool = True,
    ) -> NDArray[np.uint8]: ...
    def layers(
        self,
        *,
        layers: Sequence[Literal["depth", "range", "class", "normal", "splat"]] | None = None,
        eye: ArrayLike | None = None,
        target: ArrayLike | None = None,
        birds_eye: bool = False,
        trajectory: Path | Poses | None = None,
        pose: int = 0,
        camera: Camera | Path | None = None,
        width: int = 2560,
        height: int = 1440,
        fov: float | None = None,
    ) -> dict[str, NDArray[Any]]: ...
    def cast_on_device(
        self,
        sensor: Sensor | Path,
        poses: Poses,
        *,
        motion: Poses | None = None,
        rolling_shutter: bool = False,
        depth: int = 1,
    ) -> Scene.DeviceHits: ...
