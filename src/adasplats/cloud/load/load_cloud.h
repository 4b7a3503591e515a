// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/drive_settings.h"
#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/core/setting.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// How files become a point cloud. `trajectory` says where the sensor was when it measured the
/// points that have no sensor position: at their times (TimedOrigins), where they and its poses
/// have some. Else its nearest position (in the plane): a guess, metres off, OriginKind::guessed,
/// which turns normals alone.
struct LoadOptions : DriveSettings {
  /// Column of the semantic class; empty: the first of label, class, classification, semantic,
  /// scalar_label, scalar_Classification, sem_class that is there.
  std::string label_field;
  /// Columns of the sensor position; empty: the first triple found of x_lidar_position..,
  /// sensor_x.., x_origin.., scalar_x_lidar_position... (y and z likewise).
  std::string sensor_x_field, sensor_y_field, sensor_z_field;
  /// The station that measured every point that has no sensor position, world coordinates. It must
  /// be possible (station_objection()). OriginKind::stated.
  std::optional<Vec3d> viewpoint;
  /// Of a sequence: `count` scans (or as many as there are) from `first` on, every `stride`-th.
  std::size_t first_scan = 0;
  std::size_t scan_count = static_cast<std::size_t>(-1);
  std::size_t scan_stride = 1;
  /// Which points of files are read. No beams without a return are looked for then: that no point
  /// is there says nothing.
  PointSelection selection;
  /// Points not finite are an error instead of being dropped and counted.
  bool strict = false;
  /// Read whole records of truncated LAS files.
  bool salvage = false;
  /// Points farther than this from the median of all points are dropped and counted, m.
  double max_distance_m = 100e3;
  /// Where more than this share of all points would be dropped as far or as not finite, that is an
  /// error: single faults are rarer, and more is a second place or another format. Of 51 small
  /// real files none has any; no returns of organised clouds (NaN, NaN, NaN) do not count.
  double max_dropped = 0.01;
  /// Sensor positions are not judged by what lies behind what as seen from them. For files with
  /// later returns, which do lie behind earlier ones.
  bool trust_origins = false;
  /// Points on the vehicle that carried the sensor are left out: where this is not given those that
  /// find_own_body() finds, else all that are nearer to their sensor, m; with 0 none.
  std::optional<double> own_body_m;
  /// Points in the volume that the carrier of the sensor passed through, so far to each side of its
  /// path, m (find_in_driven_path()), are left out; 0 keeps them.
  double driven_path_m = 0.6;
  /// Also looks for the beams that returned nothing (find_empty_beams(), before points are left
  /// out) and puts them into the cloud.
  bool empty_beams = false;
};

/// What of the points is dropped, and when that is an error.
template <class Visit>
void visit_drop_settings(LoadOptions& load, const char* group, Visit&& visit) {
  visit(Setting{.name = "max_distance",
                .help = "Drop points farther than this from the median of all points, m",
                .key = "max_distance_m",
                .group = group,
                .min = 0,
                .max = std::numeric_limits<double>::infinity(),
                .exclusive_min = true},
        load.max_distance_m);
  visit(Setting{.name = "max_dropped",
                .help =
                    "Maximum fraction of points dropped as not finite or too far; more is an error",
                .value = "SHARE",
                .group = group,
                .min = 0,
                .max = 1},
        load.max_dropped);
  visit(Setting{.name = "own_body",
                .help = "Remove points closer to their sensor than this as the recording vehicle, "
                        "m; 0 keeps all (default: points that move with the sensor)",
                .value = "M",
                .key = "own_body_m",
                .group = group,
                .min = 0},
        load.own_body_m);
  visit(Setting{.name = "driven_path",
                .help = "Remove points in the volume that the vehicle drove through, up to this "
                        "distance to each side of its path, m; 0 keeps all",
                .value = "M",
                .key = "driven_path_m",
                .group = group,
                .min = 0,
                .max = 1},
        load.driven_path_m);
  visit(Setting{.name = "trust_origins",
                .help = "Trust the sensor positions of the file even if points are hidden behind "
                        "others from there, as later returns are",
                .group = group},
        load.trust_origins);
  visit(
      Setting{
          .name = "strict", .help = "Reject files with points that are not finite", .group = group},
      load.strict);
  visit(Setting{.name = "salvage",
                .help = "Read the complete records of truncated LAS files",
                .group = group},
        load.salvage);
}

/// All but which scans, and the columns of the sensor's position.
template <class Visit>
void visit_settings(LoadOptions& load, Visit&& visit) {
  constexpr const char* kGroup = "Input";
  visit(Setting{.name = "label_field",
                .help = "Column with the semantic class",
                .value = "NAME",
                .group = kGroup},
        load.label_field);
  visit(Setting{.name = "viewpoint",
                .help = "Sensor position of all points without one, world coordinates (a single "
                        "scanner station)",
                .group = kGroup},
        load.viewpoint);
  visit(Setting{.name = "trajectory",
                .help = "Poses of the recording. Points with times get their beam origins from it, "
                        "with the recognised sensor and mount or with --mount. Points without "
                        "times only get normals oriented towards the nearest pose",
                .group = kGroup},
        load.trajectory);
  visit_mount_settings(load, kGroup, visit);
  visit(
      Setting{.name = "extent",
              .help = "Load only points in this box; COPC files are decompressed only where needed",
              .group = kGroup},
      load.selection.extent);
  visit(Setting{.name = "level",
                .help = "COPC files: load levels of detail from the coarsest, 0, to this one",
                .value = "N",
                .group = kGroup,
                .min = 0,
                .max = 30},
        load.selection.level);
  visit(Setting{.name = "resolution",
                .help = "COPC files: load the levels of detail needed for this point spacing, m",
                .value = "M",
                .key = "resolution_m",
                .group = kGroup,
                .min = 0,
                .exclusive_min = true},
        load.selection.resolution_m);
  visit(Setting{.name = "boxes",
                .help = "Boxes of objects over time (CSV: "
                        "time,id,stationary,x,y,z,size_x,size_y,size_z,yaw); points in moving "
                        "boxes are removed from scans with times",
                .value = "FILE",
                .group = kGroup},
        load.boxes);
  visit_scan_settings(load, kGroup, visit);
  visit(Setting{.name = "beams_from_poses",
                .help = "Use the poses as beam origins, even if the sensor is recognised",
                .group = kGroup},
        load.beams_from_poses);
  visit_drop_settings(load, kGroup, visit);
}

/// A sequence, or a folder of scans with times, among the inputs.
struct LoadedDrive {
  std::filesystem::path folder;
  std::string sensor;     ///< of the library (ScanBeams::sensor)
  std::size_t scans = 0;  ///< that were chosen
  DriveFacts facts;       ///< of a folder of scans with a trajectory
};

/// What was understood of points with times and the trajectory of their sensor.
struct TimedOrigins {
  std::size_t points = 0;
  TimeSpan times_s, trajectory_s;  ///< of the points and the poses, both in the trajectory's clock
  std::string clock;               ///< ClockPair::description()
  double offset_s = 0;
  bool is_mounted = false;  ///< a lever arm was given, else the poses are the sensor's own
  Vec3d mount_m;
  std::size_t scans = 0;  ///< the points cut by their times...
  double scan_s = 0;      ///< ...into pieces so long
  double median_range_m = 0;
  double share_behind = 0;  ///< SweepView's
  std::string description() const;
};

/// What was dropped on the way, and what was understood.
struct LoadReport {
  std::size_t points_read = 0;
  /// Where the beams of the sequences started (ScanBeams::description), one each.
  std::vector<std::string> beams;
  /// One each, in the order of PointCloud::scan_poses.
  std::vector<LoadedDrive> drives;
  /// How many points of the cloud have an origin of each kind, by OriginKind.
  OriginCounts origins{};
  std::optional<TimedOrigins> timed;
  /// Position not finite.
  std::size_t dropped_not_finite = 0;
  /// Of these, points whose three coordinates are NaN.
  std::size_t no_returns = 0;
  /// Points kept whose intensity was not finite: NaN in the cloud, not known.
  std::size_t unknown_intensities = 0;
  /// Farther than max_distance_m from the componentwise median, or beyond 1e12 m, where doubles no
  /// longer hold 0.1 mm.
  std::size_t dropped_far = 0;
  /// In boxes of moving objects, of scans with times.
  std::size_t in_boxes = 0;
  /// On the vehicle that carried the sensor.
  std::size_t own_body = 0;
  /// In the volume that it passed through.
  std::size_t driven_path = 0;
  struct PartTime {
    std::string name;
    double seconds;
  };
  std::vector<PartTime> seconds;  ///< what the parts of loading took
};

/// Loads and accumulates point files and SemanticKITTI sequence folders (see read_points and
/// open_kitti_sequence); what a folder means and which files are no points: cloud_inputs,
/// require_points. World coordinates; the origin depends on the extents alone. Inputs with and
/// without an attribute together lose it, with a warning; but sensor positions stay, and points
/// without one (not finite, or of an input that has none) have OriginKind::none. Scans are numbered
/// from 0 over all sequences, which must not begin at the very same pose (require_one_world). The
/// cloud's coordinate system is the one that the inputs say; one that says none, or none of
/// heights, beside others that do is taken to be in theirs, with a warning. Files (names in any
/// case): intensity from the first of intensity, reflectance, remission, reflectivity, luma and
/// their scalar_ twins; classes are the low 16 bits of the label column, instances its high 16 bits
/// or the column `instance`; `scan_index` as save_cloud_ply writes it. Points with times and a
/// trajectory with times: TimedOrigins; their scans are pieces of 0.1 s, numbered behind those of
/// sequences. Memory: sequences 1.1x the cloud; files the reader's plus 24 bytes a point, with
/// times and a trajectory 60. Whichever scans of a sequence are chosen, up to five are read to
/// recognise its sensor and up to eight to check its poses (require_poses_that_fit), without
/// labels; there one that cannot be read is skipped. What is dropped is reported as warnings.
/// Errors: those of the readers; data for sensor positions that are impossible (usage for options
/// that state one); data for inputs of different coordinate systems, with both files and both
/// systems, and where nothing lies in the extent; data for too much dropped (max_dropped) and for
/// longitudes and latitudes instead of
/// metres (require_metres); usage for options that fit nothing and for named columns that are not
/// there; data for labels that are no whole numbers from 0 to 2^32 - 1.
std::pair<PointCloud, LoadReport> load_cloud(std::span<const std::filesystem::path> inputs,
                                             const LoadOptions& options, const Executor& executor,
                                             ProgressSink& progress);

/// Writes a cloud as PLY with the columns x, y, z, x_lidar_position, y_lidar_position,
/// z_lidar_position, origin_kind (OriginKind; where not all are measured), intensity, label,
/// instance, scan_index, as far as it has them (the layout of Paris-CARLA-3D), and `more`, a value
/// a point. Doubles where the origin is not zero. The coordinate system as crs_comments().
void save_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud,
                    std::span<const ColumnView> more = {});

/// Writes a cloud as LAS 1.4, or LAZ where the name ends in .laz: point format 6, in millimetres
/// from the cloud's origin; classification (the class; 0, never classified, for numbers above 255),
/// intensity (0 to 1 becomes 0 to 65535, numbers beyond 1 are rounded); extra bytes: what the PLY
/// has, the intensity as `intensity_value`, and `more`. The coordinate system along. Errors: those
/// of write_las.
void save_cloud_las(const std::filesystem::path& path, const PointCloud& cloud,
                    std::span<const ColumnView> more = {});

}  // namespace adasplats
