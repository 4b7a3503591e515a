// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/sensor_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "adasplats/cloud/beams/scan_rings.h"
#include "adasplats/cloud/load/nuscenes_drive.h"
#include "adasplats/cloud/origins/origin_check.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/recognize_sensor.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/column_names.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/point_format.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMinPointsInFrame = 10;
constexpr double kMinShareInFrame = 0.9;

constexpr std::array<std::string_view, 5> kRangeNames = {"range", "range_m", "ranges", "distance",
                                                         "distance_m"};

/// A column of ranges, in any case, with or without CloudCompare's prefix.
const Column* range_column(const Table& table) {
  constexpr std::string_view kPrefix = "scalar_";
  for (const Column& column : table.columns) {
    std::string name = lower_case(column.name);
    if (name.starts_with(kPrefix)) name.erase(0, kPrefix.size());
    if (std::ranges::find(kRangeNames, name) != kRangeNames.end()) return &column;
  }
  return nullptr;
}

/// Whether ranges are the distances from the origin: within 0.1 m, since lasers are a little off
/// the origin.
bool are_distances(const Column& ranges, double unit_m, std::span<const Vec3d> positions) {
  constexpr double kTolerance_m = 0.1, kMin_m = 0.5;
  std::size_t points = 0, same = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double distance_m = length(positions[i]);
    if (!std::isfinite(distance_m) || distance_m < kMin_m) continue;
    ++points;
    if (std::fabs(unit_m * ranges.as_double(i) - distance_m) <= kTolerance_m) ++same;
  }
  return points >= kMinPointsInFrame &&
         static_cast<double>(same) >= kMinShareInFrame * static_cast<double>(points);
}

/// Whether the points of each ring have one elevation above the origin. Points near the sensor are
/// skipped: lasers are a little off the origin.
bool are_on_cones(const Column& rings, std::span<const Vec3d> positions) {
  constexpr double kMin_m = 5, kTolerance_rad = 0.5 * kDegree, kMinSpread_rad = 4 * kDegree;
  constexpr std::size_t kMinRings = 4, kMaxRings = 1024;
  std::map<double, std::vector<double>> elevations;
  std::size_t points = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3d p = positions[i];
    if (!is_finite(p) || length(p) < kMin_m) continue;
    elevations[rings.as_double(i)].push_back(std::atan2(p.z, std::hypot(p.x, p.y)));
    ++points;
    if (elevations.size() > kMaxRings) return false;
  }
  if (elevations.size() < kMinRings || points < kMinPointsInFrame * elevations.size()) return false;
  std::size_t same = 0;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (auto& [ring, all] : elevations) {
    const double middle = upper_median_of(all);
    least = std::min(least, middle);
    most = std::max(most, middle);
    same += static_cast<std::size_t>(std::ranges::count_if(
        all, [&](double one) { return std::fabs(one - middle) <= kTolerance_rad; }));
  }
  return most - least >= kMinSpread_rad &&
         static_cast<double>(same) >= kMinShareInFrame * static_cast<double>(points);
}

/// Whether the origin is in the box of the points and none is farther than LiDARs measure.
bool are_around_origin(std::span<const Vec3d> positions) {
  constexpr double kMaxRange_m = 500;
  Vec3d low, high;
  std::size_t points = 0;
  for (const Vec3d p : positions) {
    if (!is_finite(p)) continue;
    if (length(p) > kMaxRange_m) return false;
    low = points == 0 ? p : min(low, p);
    high = points == 0 ? p : max(high, p);
    ++points;
  }
  return points >= kMinPointsInFrame && low.x < 0 && low.y < 0 && high.x > 0 && high.y > 0;
}

/// Points at distances that LiDARs measure.
std::vector<Vec3d> points_in_reach(std::span<const Vec3d> positions) {
  constexpr double kMin_m = 0.3, kMax_m = 500;
  std::vector<Vec3d> points;
  points.reserve(positions.size());
  for (const Vec3d p : positions) {
    const double range_m = length(p);  // of NaN neither is true
    if (range_m > kMin_m && range_m < kMax_m) points.push_back(p);
  }
  return points;
}

/// Whether the elevations of 98 % of the points have the span of a spinning sensor: QT128 has 105
/// degrees, stations on tripods more.
bool has_span_of_scan(std::span<const Vec3d> points) {
  constexpr double kMin_rad = 4 * kDegree, kMax_rad = 110 * kDegree;
  std::vector<double> elevations;
  elevations.reserve(points.size());
  for (const Vec3d p : points) elevations.push_back(std::atan2(p.z, std::hypot(p.x, p.y)));
  std::ranges::sort(elevations);
  const std::size_t end = elevations.size() / 100;
  const double span_rad = elevations[elevations.size() - 1 - end] - elevations[end];
  return span_rad > kMin_rad && span_rad < kMax_rad;
}

/// Sharp rings have 0.9 of the points near them. Rings blurred by motion compensation (HDL-64E)
/// have 0.91 of the nearest neighbours along them, at 1/2.4 of the distance to the next ring, and
/// 0.69 of them at even steps. As seen from 1 m aside 0.5 are at even steps; two scans joined have
/// 0.32 to 0.43 along rings, rasters of stations a ratio of about 1.
bool is_on_rings(const RingPattern& pattern) {
  constexpr std::size_t kMinRings = 8, kMaxRings = 256;
  constexpr double kMinNear = 0.8, kMinUneven = 0.25;
  constexpr double kMinAlong = 0.85, kMinAnisotropy = 1.8, kMinEven = 0.6;
  const bool has_sharp_rings =
      pattern.rings >= kMinRings && pattern.rings <= kMaxRings && pattern.near >= kMinNear;
  const bool has_rings = pattern.along >= kMinAlong && pattern.anisotropy >= kMinAnisotropy &&
                         pattern.even >= kMinEven;
  return (has_sharp_rings || has_rings) && pattern.uneven >= kMinUneven;
}

/// Whether `simulate` wrote the folder.
bool is_simulated(const fs::path& folder) {
  std::error_code ignored;
  const fs::path manifest = folder / "adasplats.json";
  if (!fs::exists(folder / "poses.csv", ignored) || !fs::is_regular_file(manifest, ignored))
    return false;
  return read_file(manifest).find("\"command\": \"simulate\"") != std::string::npos;
}

}  // namespace

bool has_viewpoint(const Table& table) {
  return std::ranges::any_of(table.comments, [](const std::string& comment) {
    constexpr std::string_view kKey = "VIEWPOINT ";
    return comment.starts_with(kKey) && comment.substr(kKey.size()) != "0 0 0 1 0 0 0";
  });
}

std::optional<SensorFrame> sensor_frame_of(const fs::path& file, const Table& table,
                                           std::span<const Vec3d> positions) {
  SensorFrame frame;
  const Column* const ranges = range_column(table);
  const Column* const rings = find_column(table, PointColumn::ring);
  if (ranges != nullptr &&
      (are_distances(*ranges, 1, positions) || are_distances(*ranges, 1e-3, positions)))
    frame.because = "its column '" + ranges->name + "' has the distances from the origin";
  else if (rings != nullptr && are_on_cones(*rings, positions))
    frame.because = "the points of each '" + rings->name + "' have one elevation above the origin";
  else if (lower_case(file.extension().string()) == ".bin" && !is_octree_part(file) &&
           are_around_origin(positions))
    frame.because = "a .bin file is a scan, and its points are around the origin";
  else
    return std::nullopt;
  frame.has_pose = has_viewpoint(table);
  return frame;
}

std::optional<SensorFrame> scan_pattern_of(std::span<const Vec3d> positions,
                                           const Executor& executor) {
  constexpr std::size_t kMinPoints = 2000, kMaxPoints = 600'000;  // OS2-128: 524,288
  if (positions.size() < kMinPoints || positions.size() > kMaxPoints) return std::nullopt;
  const std::vector<Vec3d> points = points_in_reach(positions);
  if (points.size() < kMinPoints || !has_span_of_scan(points)) return std::nullopt;
  std::vector<Vec3f> ways;
  ways.reserve(points.size());
  for (const Vec3d p : points) ways.push_back(vec_cast<float>(p));
  if (view_from_station(ways, executor).share_behind > kMaxBehind) return std::nullopt;
  SensorFrame frame;
  frame.by_points = true;
  if (is_on_rings(ring_pattern(points))) {
    frame.because = "its points are on rings around the origin";
    return frame;
  }
  const auto sensor = recognize_in_place(points, library_cones(), executor);
  if (!sensor) return std::nullopt;
  frame.because = "its points are on the cones of the beams of " + sensor->cones.sensor;
  return frame;
}

std::optional<fs::path> drive_with_scan(const fs::path& file) {
  std::error_code ignored;
  const fs::path folder = fs::absolute(file, ignored).parent_path();
  if (is_simulated(folder)) return file.parent_path();
  if (lower_case(file.extension().string()) != ".bin") return std::nullopt;
  const fs::path up = folder.parent_path();
  const bool is_kitti = folder.filename() == "velodyne" && fs::exists(up / "poses.txt", ignored);
  if (is_kitti || (folder.filename() == "data" && is_kitti_raw_drive(up.parent_path())) ||
      is_nuscenes_root(up.parent_path()))
    return is_kitti ? up : up.parent_path();
  return std::nullopt;
}

std::string advice_for_scans(const fs::path& folder, const fs::path& poses) {
  return "to use them as world points, apply the poses first: 'adasplats export " +
         folder.string() + " --trajectory " + poses.string() + " -o points.ply'";
}

}  // namespace adasplats
