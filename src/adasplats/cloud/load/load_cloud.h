// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

/// Columns of files without an attribute of PointCloud: `colors` are red, green and blue.
enum class KeptColumns : std::uint8_t { none, colors, all };

/// How files become a point cloud. `trajectory` gives the sensor position of points without one:
/// the pose at the point's time (TimedOrigins) if both have times, else the nearest pose in the
/// plane. The nearest pose is a guess, metres off (OriginKind::guessed), and only orients normals.
struct LoadOptions : DriveSettings {
  /// Column of the semantic class; empty: the first that exists of label, class, classification,
  /// semantic, scalar_label, scalar_Classification, sem_class.
  std::string label_field;
  /// Columns of the sensor position; empty: the first triple that exists of x_lidar_position, ...,
  /// sensor_x, ..., x_origin, ... and their scalar_ twins.
  std::string sensor_x_field, sensor_y_field, sensor_z_field;
  /// Position of the station that measured all points without a sensor position, world coordinates.
  /// It must be plausible (station_objection()). OriginKind::stated.
  std::optional<Vec3d> viewpoint;
  /// Scans of a sequence: at most `count`, starting at `first`, every `stride`-th.
  std::size_t first_scan = 0;
  std::size_t scan_count = static_cast<std::size_t>(-1);
  std::size_t scan_stride = 1;
  /// Which points of files are read. A selection disables the search for empty beams, because a
  /// missing point then proves nothing.
  PointSelection selection;
  /// Points that are not finite are an error instead of being dropped and counted.
  bool strict = false;
  /// Read whole records of truncated LAS files.
  bool salvage = false;
  /// Points farther than this from the median of all points are dropped and counted, m.
  double max_distance_m = 100e3;
  /// Dropping more than this share of all points as far or not finite is an error: single faults
  /// are rarer, and more means a second scene or another format. None of 51 small real files has
  /// such points. Missing returns of organised clouds (NaN, NaN, NaN) do not count.
  double max_dropped = 0.01;
  /// Skip the check that few points are hidden behind others as seen from their sensor positions.
  /// For files with later returns, which are behind earlier ones.
  bool trust_origins = false;
  /// Removal of points on the recording vehicle. Not set: those that find_own_body() finds; else
  /// all points nearer to their sensor than this, m; 0 removes none.
  std::optional<double> own_body_m;
  /// Half width of the volume that the recording vehicle drove through, m. Points in it are removed
  /// (find_in_driven_path()); 0 keeps them.
  double driven_path_m = 0.6;
  /// Also find the beams that met the sky (find_empty_beams(), before points are removed) and add
  /// them to the cloud; and all others without return.
  bool empty_beams = false, lost_beams = false;
  /// The columns of files to keep in PointCloud::others. For `all`, normals stay columns; else they
  /// orient points without a sensor position (OriginKind::guessed). Drives have only `timestamp`, s
  /// in the clock of the poses, if their points have times.
  KeptColumns other_columns = KeptColumns::none;
  /// Accept files that are one scan in the sensor frame of a known pose: to describe or segment
  /// them.
  bool accept_sensor_frame = false;
};

/// Which points are dropped, and how many dropped points are an error.
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
                .help = "Remove points closer to their sensor than this (the recording vehicle), "
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
                .help = "Accept the sensor positions even if other points hide some points from "
                        "them, as with later returns",
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

/// All options except the choice of scans and the columns of the sensor position.
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
  visit(
      Setting{.name = "boxes",
              .help = "Boxes of objects over time: annotations of PandaSet, Argoverse 2, nuScenes "
                      "or KITTI raw, or CSV "
                      "(time,id,stationary,x,y,z,size_x,size_y,size_z,yaw); points in moving "
                      "boxes are removed from scans",
              .value = "PATH",
              .group = kGroup},
      load.boxes);
  visit_scan_settings(load, kGroup, visit);
  visit(Setting{.name = "beams_from_poses",
                .help = "Use the poses as beam origins, even if the sensor is recognised",
                .group = kGroup},
        load.beams_from_poses);
  visit_drop_settings(load, kGroup, visit);
}

/// A sequence among the inputs, or a folder of scans with times.
struct LoadedDrive {
  std::filesystem::path folder;
  std::string sensor;     ///< of the library (ScanBeams::sensor)
  std::size_t scans = 0;  ///< number of chosen scans
  DriveFacts facts;       ///< of a folder of scans with a trajectory
};

/// How points with times were combined with the trajectory of their sensor.
struct TimedOrigins {
  std::size_t points = 0;
  TimeSpan times_s, trajectory_s;  ///< of the points and the poses, both in the trajectory's clock
  std::string clock;               ///< ClockPair::description()
  double offset_s = 0;
  bool is_mounted = false;  ///< a lever arm was given, else the poses are the sensor's own
  Vec3d mount_m;
  std::size_t scans = 0;  ///< the points are cut by their times
  double scan_s = 0;      ///< into scans of this length
  double median_range_m = 0;
  double share_behind = 0;  ///< SweepView's
  std::string description() const;
};

/// What was dropped while loading, and what was recognised.
struct LoadReport {
  std::size_t points_read = 0;
  /// Start of the beams of each sequence (ScanBeams::description).
  std::vector<std::string> beams;
  /// In the order of PointCloud::scan_poses.
  std::vector<LoadedDrive> drives;
  /// Files that are one scan in the frame of its sensor, and why (sensor_frame_of()).
  std::vector<std::pair<std::filesystem::path, std::string>> sensor_frames;
  /// Number of points per OriginKind.
  OriginCounts origins{};
  std::optional<TimedOrigins> timed;
  /// Points with a position that is not finite.
  std::size_t dropped_not_finite = 0;
  /// Those of them with three NaN coordinates.
  std::size_t no_returns = 0;
  /// Kept points with an intensity that was not finite: NaN (unknown) in the cloud.
  std::size_t unknown_intensities = 0;
  /// Farther than max_distance_m from the componentwise median, or beyond 1e12 m, where doubles no
  /// longer hold 0.1 mm.
  std::size_t dropped_far = 0;
  /// In boxes of moving objects, of scans with times.
  std::size_t in_boxes = 0;
  /// On the recording vehicle.
  std::size_t own_body = 0;
  /// In the volume that it drove through.
  std::size_t driven_path = 0;
  struct PartTime {
    std::string name;
    double seconds;
  };
  std::vector<PartTime> seconds;  ///< time of each part of loading

  /// Adds the report of another drive or piece.
  void add(LoadReport&& other);
};

/// Loads and joins point files and SemanticKITTI sequence folders (read_points,
/// open_kitti_sequence). cloud_inputs decides what a folder means, require_points which files are
/// not points. The cloud is in world coordinates; its origin depends on the extents alone.
/// - Attributes: if only some inputs have one, it is dropped with a warning. Sensor positions are
///   kept; points without one get OriginKind::none.
/// - A file that is one scan in the sensor frame (sensor_frame_of()) is an error if its pose is
///   known, else a warning: the sensor frame is the world. `viewpoint` states that it is. Several
///   are an error.
/// - Scans are numbered from 0 over all sequences, which must not start at the same pose
///   (require_distinct_starts).
/// - Coordinate system: that of the inputs. An input without one, or without one for heights, is
///   assumed to share the others', with a warning.
/// - Columns of files (names in any case): intensity is the first of intensity, reflectance,
///   remission, reflectivity, luma and their scalar_ twins. Classes are the low 16 bits of the
///   label column, instances its high 16 bits or the column `instance`; `scan_index` is as
///   save_cloud_ply writes it.
/// - Points with times and a trajectory with times: TimedOrigins. Their scans are 0.1 s long and
///   numbered after those of sequences.
/// - Memory: sequences 1.1 times the cloud; files the reader's plus 24 bytes a point, 60 with times
///   and a trajectory.
/// - Regardless of the chosen scans, up to five scans of a sequence are read to recognise its
///   sensor and up to eight to check its poses (verify_poses), without labels; unreadable ones are
///   skipped.
/// Dropped points are reported as warnings.
/// Errors: those of the readers; data for impossible sensor positions (usage if an option states
/// them); data for inputs in different coordinate systems, with both files and systems, and for an
/// extent without points; data for too many dropped points (max_dropped) and for degrees instead of
/// metres (require_metres); usage for options that apply to no input and for named columns that do
/// not exist; data for labels that are not whole numbers from 0 to 2^32 - 1.
std::pair<PointCloud, LoadReport> load_cloud(std::span<const std::filesystem::path> inputs,
                                             const LoadOptions& options, const Executor& executor,
                                             ProgressSink& progress);

/// Errors: data for a report of several files in the sensor frame, whose poses are unknown. `name`
/// is that of the inputs.
void require_poses_of_scans(const std::string& name, const LoadReport& report);

/// Writes a cloud as PLY with the columns x, y, z, x_lidar_position, y_lidar_position,
/// z_lidar_position, origin_kind (OriginKind; if not all are measured), intensity, label, instance,
/// scan_index, if the cloud has them (the layout of Paris-CARLA-3D), `more`, one value per point,
/// and the other columns of the cloud: colours as bytes if that is exact, 64-bit integers as
/// doubles. Doubles if the origin is not zero. The coordinate system as crs_comments(), the label
/// scheme as kLabelsComment.
void save_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud,
                    std::span<const ColumnView> more = {});

/// The same columns as PCD 0.7, binary, and as CSV (write_csv()), with the comments of the PLY.
void save_cloud_pcd(const std::filesystem::path& path, const PointCloud& cloud);
void save_cloud_csv(const std::filesystem::path& path, const PointCloud& cloud);

/// Writes a cloud as LAS 1.4, or as LAZ if the name ends in .laz: point format 6, 7 with colours, 8
/// also with near infrared, in millimetres from the cloud's origin; classification (the class; 0,
/// never classified, for numbers above 255), intensity (0 to 1 becomes 0 to 65535; larger numbers
/// are rounded). Extra bytes: the columns of the PLY, the intensity as `intensity_value`, and
/// `more`. Other columns go to the fields of LAS of their names, if these hold the values, else to
/// extra bytes. Coordinate system and label scheme are included. Errors: those of write_las.
void save_cloud_las(const std::filesystem::path& path, const PointCloud& cloud,
                    std::span<const ColumnView> more = {});

}  // namespace adasplats
