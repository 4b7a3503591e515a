// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/origins/origin_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace adasplats {

namespace {

constexpr std::size_t kMaxSampled = std::size_t{1} << 20;
constexpr double kPointsACell = 3;
constexpr double kFinest_rad = 0.05 * std::numbers::pi / 180;
constexpr double kCoarsest_rad = 3.2 * std::numbers::pi / 180;

struct Direction {
  float azimuth_rad, elevation_rad, range_m;
};

std::vector<Direction> directions_of(std::span<const Vec3f> points, const Executor& executor) {
  const std::size_t stride = (points.size() + kMaxSampled - 1) / kMaxSampled;
  std::vector<Direction> directions(points.empty() ? 0 : (points.size() + stride - 1) / stride);
  executor.for_chunks(directions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f p = points[i * stride];
      directions[i] = {std::atan2(p.y, p.x), std::atan2(p.z, std::hypot(p.x, p.y)), length(p)};
    }
  });
  return directions;
}

/// Cells of directions in their order, and the directions of each from near to far.
class DirectionCells {
 public:
  DirectionCells(std::span<const Direction> directions, double cell_rad, const Executor& executor)
      : directions_(directions), keys_(directions.size()) {
    const auto cell = [cell_rad](float angle_rad) {
      return static_cast<std::uint64_t>((static_cast<double>(angle_rad) + 2 * std::numbers::pi) /
                                        cell_rad);
    };
    executor.for_chunks(keys_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Direction& d = directions_[i];
        keys_[i] = cell(d.azimuth_rad) << 32 | cell(d.elevation_rad);
      }
    });
    executor.sort_keys(keys_, order_);
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      if (i == 0 || keys_[i] != keys_[i - 1]) begins_.push_back(i);
    }
    begins_.push_back(keys_.size());
  }

  std::size_t count() const { return begins_.size() - 1; }
  /// How many points lie behind the nearest one of their cell.
  std::size_t behind() const {
    std::size_t behind = 0;
    for (std::size_t c = 0; c < count(); ++c) {
      float nearest_m = std::numeric_limits<float>::infinity();
      for (std::size_t i = begins_[c]; i < begins_[c + 1]; ++i) {
        nearest_m = std::min(nearest_m, directions_[order_[i]].range_m);
      }
      for (std::size_t i = begins_[c]; i < begins_[c + 1]; ++i) {
        const float range_m = directions_[order_[i]].range_m;
        if (lies_behind(range_m, nearest_m)) ++behind;
      }
    }
    return behind;
  }

 private:
  std::span<const Direction> directions_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> order_;
  std::vector<std::size_t> begins_;
};

std::string in_percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

}  // namespace

StationView view_from_station(std::span<const Vec3f> from_station, const Executor& executor) {
  StationView view;
  const std::vector<Direction> directions = directions_of(from_station, executor);
  view.points = directions.size();
  if (directions.empty()) return view;
  view.nearest_m =
      static_cast<double>(std::ranges::min_element(directions, {}, &Direction::range_m)->range_m);
  const auto points = static_cast<double>(directions.size());
  for (view.cell_rad = kFinest_rad;; view.cell_rad *= std::numbers::sqrt2) {
    const DirectionCells cells(directions, view.cell_rad, executor);
    if (points < kPointsACell * static_cast<double>(cells.count()) && view.cell_rad < kCoarsest_rad)
      continue;
    view.share_behind = static_cast<double>(cells.behind()) / points;
    return view;
  }
}

std::string station_objection(const StationView& view) {
  if (view.nearest_m > kFarthestOriginM) {
    return "the nearest point is " + std::to_string(std::lround(view.nearest_m / 1000)) +
           " km away, beyond the range of LiDARs";
  }
  if (view.points >= kMinView && view.share_behind > kMaxBehind) {
    return in_percent(view.share_behind) +
           " of the points are hidden behind others as seen from there; expected at most " +
           in_percent(kMaxBehind) + " for one station (later returns: give `trust_origins`)";
  }
  return {};
}

namespace {

constexpr std::size_t kViews = 16;
constexpr std::size_t kMaxLookedAt = std::size_t{1} << 20;
constexpr std::size_t kMinPointsOfView = 100;
constexpr float kNear_m = 0.5F;   // origins as good as at the place
constexpr float kFar_m = 100;     // farther points hide nothing
constexpr float kLeast_m = 0.5F;  // nearer ones have no direction to speak of
constexpr int kColumns = 720, kRows = 360;

/// The nearest three ranges in every direction.
class DepthMap {
 public:
  void add(Vec3f way) {
    const float range_m = length(way);
    if (!(range_m > kLeast_m && range_m < kFar_m)) return;
    std::array<float, 3>& ranges = cells_[cell_of(way, range_m)];
    if (range_m >= ranges[2]) return;
    ranges[2] = range_m;
    std::ranges::sort(ranges);
  }

  bool hides(Vec3f way) const {
    const float range_m = length(way);
    if (!(range_m > kLeast_m)) return false;
    return lies_behind(range_m, cells_[cell_of(way, range_m)][2]);
  }

 private:
  static std::size_t cell_of(Vec3f way, float range_m) {
    constexpr float kPi = std::numbers::pi_v<float>;
    const float across = std::atan2(way.y, way.x) / (2 * kPi) + 0.5F;
    const float up = std::asin(std::clamp(way.z / range_m, -1.0F, 1.0F)) / kPi + 0.5F;
    const int column = std::clamp(static_cast<int>(across * kColumns), 0, kColumns - 1);
    const int row = std::clamp(static_cast<int>(up * kRows), 0, kRows - 1);
    return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
  }

  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<std::array<float, 3>> cells_ = std::vector<std::array<float, 3>>(
      std::size_t{kColumns} * kRows, {kInfinity, kInfinity, kInfinity});
};

struct OriginView {
  std::size_t points = 0, behind = 0;
};

OriginView view_from_origin(std::span<const Vec3f> positions, std::span<const Vec3f> origins,
                            std::size_t stride, Vec3f place) {
  DepthMap map;
  for (std::size_t i = 0; i < positions.size(); i += stride) map.add(positions[i] - place);
  OriginView view;
  for (std::size_t i = 0; i < positions.size(); i += stride) {
    if (!(length(origins[i] - place) < kNear_m)) continue;
    ++view.points;
    if (map.hides(positions[i] - place)) ++view.behind;
  }
  return view;
}

std::string whole_percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

}  // namespace

PathView view_from_path(std::span<const Vec3f> positions, std::span<const Vec3f> origins,
                        const Executor& executor) {
  const std::size_t stride = positions.size() / kMaxLookedAt + 1;
  std::array<OriginView, kViews> views{};
  if (!positions.empty())
    executor.for_chunks(kViews, 1, [&](std::size_t k, std::size_t) {
      const std::size_t middle = (2 * k + 1) * positions.size() / (2 * kViews);
      views[k] = view_from_origin(positions, origins, stride, origins[middle]);
    });
  PathView path;
  for (const OriginView& view : views) {
    if (view.points < kMinPointsOfView) continue;
    ++path.places;
    path.points += view.points;
    // A place where the sensor stood for long counts as much as any other.
    path.share_behind += static_cast<double>(view.behind) / static_cast<double>(view.points);
  }
  if (path.places > 0) path.share_behind /= static_cast<double>(path.places);
  return path;
}

std::string path_objection(const PathView& view) {
  if (view.points < kMinView || !(view.share_behind > kMaxBehindOfPath)) return {};
  return whole_percent(view.share_behind) +
         " of the points are hidden behind others as seen from their sensor positions; expected at "
         "most " +
         whole_percent(kMaxBehindOfPath) +
         " for a moving sensor (later returns: give `trust_origins`)";
}

}  // namespace adasplats
