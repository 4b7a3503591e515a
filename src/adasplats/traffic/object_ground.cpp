// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/object_ground.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {
namespace {

constexpr double kCell_m = 0.25;
/// Points in this layer above the plane are ground, too: sensors measure it that thick.
constexpr double kThick_m = 0.08;

/// z = height + x * slope_x + y * slope_y.
struct GroundPlane {
  double height = 0, slope_x = 0, slope_y = 0;
  double above(Vec3d p) const { return p.z - height - slope_x * p.x - slope_y * p.y; }
};

/// The lowest points of the cells of the base that may be ground: most of what is low in the cell
/// is at one height, other than on a side of the object.
struct Lows {
  std::vector<Vec3d> flat;
  std::size_t cells = 0;
};

Lows lows_of(const RecordedObject& object) {
  constexpr std::size_t kMinPoints = 5;
  constexpr double kLayer_m = 0.3, kMinShare = 0.6;
  std::map<std::pair<int, int>, std::vector<Vec3d>> cells;
  for (const ObjectScan& scan : object.scans)
    for (const Vec3d& point : scan.points)
      if (point.z < 0)
        cells[{static_cast<int>(std::floor(point.x / kCell_m)),
               static_cast<int>(std::floor(point.y / kCell_m))}]
            .push_back(point);
  Lows lows;
  for (auto& of_cell : cells) {
    std::vector<Vec3d>& points = of_cell.second;
    if (points.size() < kMinPoints) continue;
    ++lows.cells;
    const auto low = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 10);
    std::ranges::nth_element(points, low, {}, &Vec3d::z);
    const double low_m = low->z;
    const auto within = [&](double above_m) {
      return static_cast<double>(std::ranges::count_if(
          points, [&](const Vec3d& point) { return point.z < low_m + above_m; }));
    };
    if (within(kThick_m) > kMinShare * within(kLayer_m)) lows.flat.push_back(*low);
  }
  return lows;
}

/// The height that most of the lows share; the lower one of equals.
double common_height(const std::vector<Vec3d>& lows, double near_m) {
  double height = 0;
  std::size_t most = 0;
  for (const Vec3d& low : lows) {
    const auto count = static_cast<std::size_t>(std::ranges::count_if(
        lows, [&](const Vec3d& other) { return std::fabs(other.z - low.z) < near_m; }));
    if (count > most || (count == most && low.z < height)) {
      most = count;
      height = low.z;
    }
  }
  return height;
}

/// Least squares of the lows near a plane; nothing if they do not determine one.
std::optional<GroundPlane> fitted(const std::vector<Vec3d>& lows, const GroundPlane& plane,
                                  double near_m) {
  Vec3d mean;
  double count = 0;
  for (const Vec3d& low : lows)
    if (std::fabs(plane.above(low)) < near_m) mean = mean + low, count += 1;
  if (count < 3) return std::nullopt;
  mean = mean / count;
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
  for (const Vec3d& low : lows) {
    if (!(std::fabs(plane.above(low)) < near_m)) continue;
    const Vec3d d = low - mean;
    xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y, xz += d.x * d.z, yz += d.y * d.z;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 1e-3 * xx * yy)) return std::nullopt;
  GroundPlane fit;
  fit.slope_x = (xz * yy - yz * xy) / determinant;
  fit.slope_y = (yz * xx - xz * xy) / determinant;
  fit.height = mean.z - fit.slope_x * mean.x - fit.slope_y * mean.y;
  return fit;
}

std::optional<GroundPlane> ground_of(const RecordedObject& object) {
  constexpr double kNear_m = 0.12, kMaxSlope = 0.105, kMinShare = 0.1, kMaxBelow = 0.01;
  constexpr std::size_t kMinCells = 6;
  const Lows lows = lows_of(object);
  if (lows.flat.size() < kMinCells) return std::nullopt;
  std::optional<GroundPlane> plane = GroundPlane{common_height(lows.flat, kNear_m), 0, 0};
  for (int round = 0; round < 3 && plane; ++round) plane = fitted(lows.flat, *plane, kNear_m);
  if (!plane || std::hypot(plane->slope_x, plane->slope_y) > kMaxSlope) return std::nullopt;
  const auto near = static_cast<double>(std::ranges::count_if(
      lows.flat, [&](const Vec3d& low) { return std::fabs(plane->above(low)) < kThick_m; }));
  if (near < kMinShare * static_cast<double>(lows.cells)) return std::nullopt;
  std::size_t below = 0;
  for (const ObjectScan& scan : object.scans)
    below += static_cast<std::size_t>(std::ranges::count_if(
        scan.points, [&](const Vec3d& point) { return plane->above(point) < -kNear_m; }));
  return static_cast<double>(below) <= kMaxBelow * static_cast<double>(object.points())
             ? plane
             : std::nullopt;
}

}  // namespace

std::size_t remove_ground(RecordedObject& object) {
  const std::optional<GroundPlane> plane = ground_of(object);
  if (!plane) return 0;
  std::size_t removed = 0;
  for (ObjectScan& scan : object.scans) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Vec3d point = scan.points[i], origin = scan.origins[i];
      if (plane->above(point) < kThick_m) {
        scan.passing.push_back({origin, normalized(point - origin)});
        continue;
      }
      scan.points[kept] = point;
      scan.origins[kept] = origin;
      if (!scan.intensities.empty()) scan.intensities[kept] = scan.intensities[i];
      ++kept;
    }
    removed += scan.points.size() - kept;
    scan.points.resize(kept);
    scan.origins.resize(kept);
    if (!scan.intensities.empty()) scan.intensities.resize(kept);
  }
  std::erase_if(object.scans, [](const ObjectScan& scan) { return scan.points.empty(); });
  return removed;
}

}  // namespace adasplats
