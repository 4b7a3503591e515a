// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/scene/scene.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {

/// A rigid moving object: triangles in its own frame (x forward, z up, origin on the ground) and
/// its trajectory. It exists only from its first pose to its last.
struct MovingObject {
  TriangleMesh mesh;                ///< own frame; classes are moving classes
  std::vector<float> reflectances;  ///< one per triangle, 0..1
  std::uint16_t instance = 0;
  Trajectory world_from_object;
};

/// The procedural street: exact geometry with SemanticKITTI classes. Metres, z up; the road runs
/// along +x from 0 to `length_m` with its axis at y = 0 and its surface near z = 0; origin zero.
struct Street {
  double length_m = 0;
  TriangleMesh fixed;
  std::vector<std::uint16_t> instances;  ///< one per triangle of `fixed`; parked cars have ids
  std::vector<float> reflectances;       ///< one per triangle of `fixed`, 0..1
  std::vector<MovingObject> moving;
  double traffic_period_s = 0;  ///< `moving` repeats with this period
};

inline constexpr double kMinStreetLength_m = 50;
inline constexpr double kMaxStreetLength_m = 2000;

struct StreetOptions {
  std::uint64_t seed = 1;
  double length_m = 60;  ///< of the road: kMinStreetLength_m to kMaxStreetLength_m
};

/// Builds the street: road with crossfall, markings and kerbs, sidewalks, a side street, apartment
/// buildings with recessed windows and balconies, houses behind gardens, walls, fences and barriers
/// with single bars, poles, signs, lamps, trees and hedges of single leaves, parked cars, street
/// furniture, moving cars and people. Depends only on the options.
/// Errors: usage (length out of range).
Street make_street(const StreetOptions& options);

/// Street length that suits a number of mapping points, so that small clouds are not too sparse: 60
/// m for 300,000, growing with the 0.4th power (265 m for 12.3 million: 46,000 points per metre,
/// within a factor of 2.4 of Paris-CARLA-3D's 60 million on 550 m).
double street_length_for(std::size_t points);

/// How the street is scanned. The defaults are those of the embedded demo.
struct StreetScanOptions {
  std::uint64_t seed = 1;
  std::size_t points = 300'000;    ///< target for the mapping cloud, met within 10 %; >= 1000
  double range_noise_m = 0.005;    ///< standard deviation; HDL-32 of paper section "SimKITTI32"
  double pose_error_m = 0.01;      ///< standard deviation of each pass's offset, per axis
  double pose_error_rad = 0.0002;  ///< standard deviation of each pass's rotation, per axis
  int passes = 2;                  ///< drives along the street, back and forth
  /// Each pass starts in the cross street at one end, turns by 90 degrees into the street, and
  /// turns by 90 degrees in the opposite direction into the cross street at the other end.
  bool turns = false;
  double speed_m_per_s = 8;
  double driving_spacing_m = 2;         ///< between driving scans, all on the last pass; 0: none
  std::size_t max_driving_scans = 150;  ///< on longer streets the spacing grows
};

/// The recordings of one street. Recorded poses and points contain the error of their pass; true
/// poses do not.
struct StreetRecording {
  PointCloud mapping;  ///< HDL-32 pitched by 45 degrees, as in Paris-CARLA-3D; intensities 0..1
  Trajectory mapping_trajectory;  ///< recorded world_from_sensor of the revolutions
  Trajectory true_mapping_trajectory;
  Trajectory driving_trajectory;  ///< recorded, HDL-64 in AV configuration
  Trajectory true_driving_trajectory;
};

/// Scans the street and returns the mapping cloud. `on_driving_scan` receives every HDL-64 scan
/// (index, scan with its recorded pose) in order.
///
/// The HDL-32 (hdl_32_paper) is 2 m above the road, pitched so that its scan plane points down at
/// the rear and up at the front. The HDL-64 (hdl_64_paper) is level at 1.73 m, as in KITTI. All
/// rays of a revolution are simultaneous. With fewer points than the full sensor gives at 10 Hz,
/// revolutions are farther apart and have fewer azimuth steps, both evenly. A mover is omitted
/// while it would collide with the scanning vehicle.
/// Errors: usage (an option out of range).
StreetRecording scan_street(const Street& street, const StreetScanOptions& options,
                            const std::function<void(std::size_t, const Scan&)>& on_driving_scan,
                            const Executor& executor, ProgressSink& progress);

/// Writes `street.fixed` as a PLY mesh with `class`, `instance` and `reflectance` per face. Moving
/// objects are omitted: the mesh is the ground truth of a model without movers.
void save_street_mesh(const std::filesystem::path& path, const Street& street);
/// The same for a mesh with one instance and one reflectance per triangle.
void save_street_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                      std::span<const std::uint16_t> instances,
                      std::span<const float> reflectances);

/// Figures of write_street().
struct StreetReport {
  double length_m = 0;
  std::size_t mesh_triangles = 0;
  std::size_t moving_objects = 0;
  std::size_t mapping_points = 0;
  std::size_t mapping_scans = 0;
  std::size_t driving_scans = 0;
};

/// Builds, scans and writes a street: FOLDER/mapping.ply, mapping_trajectory.csv (recorded),
/// sequences/00/ (SemanticKITTI, recorded poses), mesh.ply (ground truth),
/// true_mapping_trajectory.csv and true_driving_trajectory.csv. A `street.length_m` of 0 becomes
/// street_length_for(points).
/// Errors: those of make_street and scan_street; cannot_create (also if sequences/00 exists), io.
StreetReport write_street(const std::filesystem::path& folder, StreetOptions street,
                          const StreetScanOptions& scan, const Executor& executor,
                          ProgressSink& progress);

}  // namespace adasplats
