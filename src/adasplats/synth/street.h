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

/// A rigid thing that moves through the street: triangles in its own frame (x forward, z up, origin
/// on the ground) and where it is when. It is there from its first pose to its last, not before and
/// not after.
struct MovingObject {
  TriangleMesh mesh;                ///< own frame; classes are moving classes
  std::vector<float> reflectances;  ///< one a triangle, 0..1
  std::uint16_t instance = 0;
  Trajectory world_from_object;
};

/// The procedural street: exact geometry with SemanticKITTI classes. Metres, z up, the road along
/// +x from 0 to `length_m`, its axis at y = 0, its surface about z = 0; origin zero.
struct Street {
  double length_m = 0;
  TriangleMesh fixed;
  std::vector<std::uint16_t> instances;  ///< one a triangle of `fixed`; parked cars have ids
  std::vector<float> reflectances;       ///< one a triangle of `fixed`, 0..1
  std::vector<MovingObject> moving;
  double traffic_period_s = 0;  ///< `moving` repeats itself after this time
};

inline constexpr double kShortestStreet_m = 50;
inline constexpr double kLongestStreet_m = 2000;

struct StreetOptions {
  std::uint64_t seed = 1;
  double length_m = 60;  ///< of the road: kShortestStreet_m to kLongestStreet_m
};

/// Builds the street: road with crossfall, markings and kerbs, sidewalks, a side street, apartment
/// buildings with recessed windows and balconies, houses behind gardens, walls, fences and barriers
/// with single bars, poles, signs, lamps, trees and hedges of single leaves, parked cars, street
/// furniture; cars and people that move. Depends on the options alone.
/// Errors: usage (length out of its range).
Street make_street(const StreetOptions& options);

/// The length of street that suits so many mapping points: 60 m for 300,000, growing with the 0.4th
/// power (265 m for 12.3 million: 46,000 points a metre, the density of Paris-CARLA-3D's 60 million
/// on 550 m to a factor of 2.4), so that a small cloud is not a hopelessly thin one.
double street_length_for(std::size_t points);

/// How the street is scanned. Defaults are the embedded demo.
struct StreetScanOptions {
  std::uint64_t seed = 1;
  std::size_t points = 300'000;    ///< within 10 % as many points in the mapping cloud; >= 1000
  double range_noise_m = 0.005;    ///< standard deviation; the HDL-32 of paper section "SimKITTI32"
  double pose_error_m = 0.01;      ///< standard deviation of each pass's offset, per axis
  double pose_error_rad = 0.0002;  ///< standard deviation of each pass's rotation, per axis
  int passes = 2;                  ///< drives along the street, there and back
  /// Each pass comes from the street across the one end, by a quarter turn, and leaves into that
  /// across the other, by another to the other side.
  bool turns = false;
  double speed_m_per_s = 8;
  double driving_spacing_m = 2;  ///< between the driving scans, all on the last pass; 0: none
  std::size_t max_driving_scans = 150;  ///< a longer street has them further apart
};

/// The recordings of one street. Recorded poses and points hold the error of their pass; the true
/// ones do not.
struct StreetRecording {
  PointCloud mapping;  ///< HDL-32 pitched 45 degrees, as Paris-CARLA-3D; intensities 0..1
  Trajectory mapping_trajectory;  ///< recorded world_from_sensor of its revolutions
  Trajectory true_mapping_trajectory;
  Trajectory driving_trajectory;  ///< recorded, of the HDL-64 in AV configuration
  Trajectory true_driving_trajectory;
};

/// Scans the street. `on_driving_scan` receives every HDL-64 scan (index, scan with its recorded
/// pose) in order as it is made; the mapping cloud is returned.
///
/// The HDL-32 (hdl_32_paper) rides 2 m above the road, its scan plane pitched so that it looks down
/// behind and up in front; the HDL-64 (hdl_64_paper) level at 1.73 m, as KITTI's. All rays of a
/// revolution leave at once. With fewer points than the full sensor at 10 Hz gives, revolutions are
/// further apart and have fewer azimuth steps, both evenly. A mover in the way of the scanning
/// vehicle is left out while it is.
/// Errors: usage (an option out of its range).
StreetRecording scan_street(const Street& street, const StreetScanOptions& options,
                            const std::function<void(std::size_t, const Scan&)>& on_driving_scan,
                            const Executor& executor, ProgressSink& progress);

/// Writes `street.fixed` as a PLY mesh with `class`, `instance` and `reflectance` a face. Moving
/// objects are not in it: it is the truth that a model without movers should reproduce.
void save_street_mesh(const std::filesystem::path& path, const Street& street);
/// The same of a mesh with one instance and one reflectance a triangle.
void save_street_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                      std::span<const std::uint16_t> instances,
                      std::span<const float> reflectances);

/// What write_street wrote.
struct StreetReport {
  double length_m = 0;
  std::size_t mesh_triangles = 0;
  std::size_t moving_objects = 0;
  std::size_t mapping_points = 0;
  std::size_t mapping_scans = 0;
  std::size_t driving_scans = 0;
};

/// Makes, scans and writes a street: FOLDER/mapping.ply, mapping_trajectory.csv (recorded),
/// sequences/00/ (SemanticKITTI, recorded poses), mesh.ply (the truth), true_mapping_trajectory.csv
/// and true_driving_trajectory.csv. A `street.length_m` of 0 becomes street_length_for(points).
/// Errors: as make_street and scan_street; cannot_create (also where sequences/00 is there
/// already), io.
StreetReport write_street(const std::filesystem::path& folder, StreetOptions street,
                          const StreetScanOptions& scan, const Executor& executor,
                          ProgressSink& progress);

}  // namespace adasplats
