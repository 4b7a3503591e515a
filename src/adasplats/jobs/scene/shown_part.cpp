// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/shown_part.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace adasplats {
namespace {

constexpr double kShareShown = 0.90;
constexpr int kColumnsAcross = 96;  // of the longer side of the middle box
constexpr std::size_t kMaxPoints = 20'000;
constexpr double kRim = 0.94;  // share of the picture's width and height for the part
constexpr int kDirections = 24;

/// Columns of ground over a box.
class Grid {
 public:
  Grid(Vec3d low, Vec3d high)
      : low_(low), side_m_(std::max({high.x - low.x, high.y - low.y, 1e-3}) / kColumnsAcross) {}

  /// Of the column with a point; negative: beyond the box.
  std::int64_t at(Vec3d p) const {
    const double x = std::floor((p.x - low_.x) / side_m_), y = std::floor((p.y - low_.y) / side_m_);
    if (!(x >= 0 && y >= 0 && x <= kColumnsAcross && y <= kColumnsAcross)) return -1;
    return static_cast<std::int64_t>(y) * (kColumnsAcross + 1) + static_cast<std::int64_t>(x);
  }
  static constexpr std::size_t kSize = std::size_t{kColumnsAcross + 1} * (kColumnsAcross + 1);

 private:
  Vec3d low_;
  double side_m_;
};

/// The fullest columns that together hold enough of all points.
std::vector<bool> full_columns(const std::vector<std::size_t>& counts, std::size_t points) {
  std::vector<std::uint32_t> order(counts.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return counts[a] > counts[b]; });
  std::vector<bool> full(counts.size(), false);
  std::size_t held = 0;
  for (const std::uint32_t column : order) {
    if (static_cast<double>(held) >= kShareShown * static_cast<double>(points)) break;
    full[column] = true;
    held += counts[column];
  }
  return full;
}

/// Keeps every n-th point, at most kMaxPoints.
void thin(std::vector<Vec3d>& points) {
  const std::size_t step = points.size() / kMaxPoints + 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); i += step) points[kept++] = points[i];
  points.resize(kept);
}

/// Removes the lowest and the highest percent.
void cut_heights(std::vector<Vec3d>& points) {
  std::vector<double> heights;
  heights.reserve(points.size());
  for (const Vec3d& p : points) heights.push_back(p.z);
  std::sort(heights.begin(), heights.end());
  const std::size_t cut = heights.size() / 100;
  const double low = heights[cut], high = heights[heights.size() - 1 - cut];
  std::erase_if(points, [&](const Vec3d& p) { return p.z < low || p.z > high; });
}

/// The farthest point to one side of the view, relative to the edge of the picture at its depth.
struct Reach {
  double max = -std::numeric_limits<double>::infinity();
  void add(double value) { max = std::max(max, value); }
};

/// The nearest position from which a camera with these axes sees all points: each side of the
/// picture is a plane that bounds them.
Vec3d place_camera(const std::vector<Vec3d>& points, const Mat3d& axes, double tan_x,
                   double tan_y) {
  Reach right, left, up, down;
  for (const Vec3d& p : points) {
    const Vec3d q = {dot(axes.rows[0], p), dot(axes.rows[1], p), dot(axes.rows[2], p)};
    left.add(q.y - tan_x * q.x);
    right.add(-q.y - tan_x * q.x);
    up.add(q.z - tan_y * q.x);
    down.add(-q.z - tan_y * q.x);
  }
  const double forward =
      std::min(-(left.max + right.max) / (2 * tan_x), -(up.max + down.max) / (2 * tan_y));
  // If one pair of sides needs more distance, the points are centred between the other pair.
  const double leftwards = 0.5 * (left.max - right.max), upwards = 0.5 * (up.max - down.max);
  return axes.transposed() * Vec3d{forward, leftwards, upwards};
}

/// How much of the part a camera shows, and how large: the sum of the sizes in the picture of the
/// points that are not hidden by nearer ones.
class Showing {
 public:
  double of(const std::vector<Vec3d>& points, const Camera& camera) {
    const Mat3d axes = camera.world_from_camera.rotation.transposed();
    const double scale = 0.5 * kAcross / std::tan(0.5 * camera.horizontal_fov_rad);
    depths_.assign(std::size_t{kAcross} * kAcross, std::numeric_limits<double>::infinity());
    seen_.clear();
    for (const Vec3d& p : points) {
      const Vec3d q = axes * (p - camera.world_from_camera.translation);
      const auto x = static_cast<std::int64_t>(std::floor(0.5 * kAcross - scale * q.y / q.x));
      const auto y = static_cast<std::int64_t>(std::floor(0.5 * kAcross - scale * q.z / q.x));
      if (x < 0 || y < 0 || x >= kAcross || y >= kAcross) continue;
      const auto cell = static_cast<std::size_t>(y * kAcross + x);
      depths_[cell] = std::min(depths_[cell], q.x);
      seen_.push_back({cell, q.x});
    }
    double sum = 0;
    for (const auto& [cell, depth] : seen_)
      if (depth < (1 + kHides) * depths_[cell]) sum += 1 / (depth * depth);
    return sum;
  }

 private:
  static constexpr std::int64_t kAcross = 128;  // cells; some points fall into each
  static constexpr double kHides = 0.03;        // of the depth: points farther behind are hidden
  std::vector<double> depths_;
  std::vector<std::pair<std::size_t, double>> seen_;
};

}  // namespace

std::pair<Vec3d, Vec3d> middle_box(std::span<const Vec3f> positions, Vec3d origin) {
  std::vector<float> values(positions.size());
  std::pair<Vec3d, Vec3d> box;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < positions.size(); ++i) values[i] = positions[i][axis];
    const auto at = [&](std::size_t rank) {
      const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
      std::nth_element(values.begin(), place, values.end());
      return static_cast<double>(*place) + origin[axis];
    };
    const std::size_t cut = positions.size() / 100;
    box.first[axis] = at(cut);
    box.second[axis] = at(positions.size() - 1 - cut);
  }
  return box;
}

ShownPart shown_part(std::span<const Vec3f> positions, Vec3d origin) {
  const auto [low, high] = middle_box(positions, origin);
  const Grid grid(low, high);
  std::vector<std::size_t> counts(Grid::kSize, 0);
  std::size_t within = 0;
  const auto world = [&](Vec3f p) { return vec_cast<double>(p) + origin; };
  for (const Vec3f& p : positions)
    if (const std::int64_t column = grid.at(world(p)); column >= 0) {
      ++counts[static_cast<std::size_t>(column)];
      ++within;
    }
  const std::vector<bool> full = full_columns(counts, within);
  ShownPart part;
  for (const Vec3f& p : positions)
    if (const std::int64_t column = grid.at(world(p));
        column >= 0 && full[static_cast<std::size_t>(column)])
      part.points.push_back(world(p));
  if (part.points.empty()) part.points = {world(positions.front())};
  cut_heights(part.points);
  thin(part.points);
  part.low = part.high = part.points.front();
  for (const Vec3d& p : part.points)
    for (int axis = 0; axis < 3; ++axis) {
      part.low[axis] = std::min(part.low[axis], p[axis]);
      part.high[axis] = std::max(part.high[axis], p[axis]);
    }
  return part;
}

Camera overview_from(const ShownPart& part, int width, int height, double horizontal_fov_rad,
                     double pitch_rad, double azimuth_rad) {
  const Vec3d direction = {std::cos(pitch_rad) * std::cos(azimuth_rad),
                           std::cos(pitch_rad) * std::sin(azimuth_rad), -std::sin(pitch_rad)};
  Camera camera = look_at(part.middle() - direction, part.middle());
  camera.width = width;
  camera.height = height;
  camera.horizontal_fov_rad = horizontal_fov_rad;
  const double tan_x = std::tan(0.5 * horizontal_fov_rad);
  const Mat3d axes = camera.world_from_camera.rotation.transposed();
  constexpr double kMinDistance_m = 1.0;  // to a part that is a single point
  camera.world_from_camera.translation =
      place_camera(part.points, axes, kRim * tan_x, kRim * tan_x * height / width) -
      kMinDistance_m * axes.rows[0];
  return camera;
}

Camera overview(const ShownPart& part, int width, int height, double horizontal_fov_rad) {
  constexpr double kPitches_rad[] = {0.50, 0.70, 0.95};  // below the horizon
  Camera best;
  double max_size = -1;
  Showing showing;
  for (const double pitch : kPitches_rad)
    for (int k = 0; k < kDirections; ++k) {
      const double azimuth = 2 * std::numbers::pi * k / kDirections;
      const Camera camera = overview_from(part, width, height, horizontal_fov_rad, pitch, azimuth);
      const double size = showing.of(part.points, camera);
      if (size > max_size) {
        max_size = size;
        best = camera;
      }
    }
  return best;
}

}  // namespace adasplats
