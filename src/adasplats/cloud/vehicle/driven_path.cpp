// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/vehicle/driven_path.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace adasplats {
namespace {

constexpr double kNoGround = std::numeric_limits<double>::quiet_NaN();

/// Where the sensor was in the mean of each scan, by the numbers of the scans; of scans without a
/// measured origin nothing.
std::vector<Vec3d> places_of_scans(const PointCloud& cloud) {
  std::vector<std::pair<Vec3d, std::size_t>> sums;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.origin_kind(i) != OriginKind::measured) continue;
    const std::size_t scan = cloud.scan_indices[i];
    if (scan >= sums.size()) sums.resize(scan + 1);
    sums[scan].first = sums[scan].first + vec_cast<double>(cloud.sensor_positions[i]);
    ++sums[scan].second;
  }
  std::vector<Vec3d> places;
  for (const auto& [sum, count] : sums)
    if (count > 0) places.push_back(sum / static_cast<double>(count));
  return places;
}

/// The path from place to place, a step apart, and how long it is.
class Path {
 public:
  Path(const std::vector<Vec3d>& scans, const DrivenPathOptions& options) {
    for (std::size_t k = 0; k < scans.size(); ++k) {
      const double apart_m = k == 0 ? 0 : length(scans[k] - scans[k - 1]);
      const bool joined = k > 0 && apart_m <= options.most_apart_m;
      const int steps = joined ? static_cast<int>(apart_m / options.step_m) : 0;
      if (joined) length_m_ += apart_m;
      for (int step = 1; step <= steps; ++step)
        add(scans[k - 1] + (step / (steps + 1.0)) * (scans[k] - scans[k - 1]));
      add(scans[k]);
    }
  }

  double length_m() const { return length_m_; }
  const std::vector<Vec3d>& places() const { return places_; }

  /// Calls body(place, distance in the plane) for the places within a cell or so of a point.
  template <class Body>
  void for_each_near(Vec3f point, Body&& body) const {
    const auto [x, y] = cell_of(vec_cast<double>(point));
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const auto found = cells_.find(key(x + dx, y + dy));
        if (found == cells_.end()) continue;
        for (const std::size_t place : found->second) {
          const Vec3d offset = vec_cast<double>(point) - places_[place];
          body(place, std::hypot(offset.x, offset.y));
        }
      }
    }
  }

 private:
  static constexpr double kCell_m = 1;  // ground_radius_m and half_width_m are not more
  static std::array<std::int64_t, 2> cell_of(Vec3d place) {
    return {static_cast<std::int64_t>(std::floor(place.x / kCell_m)),
            static_cast<std::int64_t>(std::floor(place.y / kCell_m))};
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return static_cast<std::uint64_t>(x) << 32 ^ static_cast<std::uint32_t>(y);
  }
  void add(Vec3d place) {
    // A vehicle at rest adds nothing.
    if (!places_.empty() && length(place - places_.back()) < 0.2 * kCell_m) return;
    const auto [x, y] = cell_of(place);
    cells_[key(x, y)].push_back(places_.size());
    places_.push_back(place);
  }

  std::vector<Vec3d> places_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
  double length_m_ = 0;
};

/// How high the sensor was above the ground at each place: below nine of ten points there.
std::vector<double> heights_above_ground(const PointCloud& cloud, const Path& path,
                                         const DrivenPathOptions& options,
                                         const Executor& executor) {
  constexpr double kBin_m = 0.05, kGroundShare = 0.1;
  const auto bins = static_cast<std::size_t>(std::ceil(options.most_height_m / kBin_m)) + 1;
  std::vector<std::uint32_t> counts(path.places().size() * bins);  // by depth below the sensor
  executor.for_chunks(cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      path.for_each_near(cloud.positions[i], [&](std::size_t place, double distance_m) {
        const double below_m = path.places()[place].z - static_cast<double>(cloud.positions[i].z);
        if (distance_m > options.ground_radius_m || below_m < 0) return;
        const auto bin = static_cast<std::size_t>(below_m / kBin_m);
        if (bin >= bins) return;
        std::atomic_ref<std::uint32_t>(counts[place * bins + bin])
            .fetch_add(1, std::memory_order_relaxed);
      });
    }
  });
  std::vector<double> heights(path.places().size(), kNoGround);
  for (std::size_t place = 0; place < heights.size(); ++place) {
    const auto first = counts.begin() + static_cast<std::ptrdiff_t>(place * bins);
    const std::size_t all =
        std::accumulate(first, first + static_cast<std::ptrdiff_t>(bins), std::size_t{0});
    if (all < options.least_points) continue;
    std::size_t deeper = 0, bin = bins;
    while (static_cast<double>(deeper) < kGroundShare * static_cast<double>(all))
      deeper += counts[place * bins + --bin];
    heights[place] = kBin_m * static_cast<double>(bin);
  }
  return heights;
}

/// The height at most places, which holds where nobody saw the ground; nothing where it is none: it
/// varies, or hardly any place has one.
std::optional<double> usual_height(std::vector<double> heights, const DrivenPathOptions& options) {
  const std::size_t places = heights.size();
  std::erase_if(heights, [](double height) { return std::isnan(height); });
  if (heights.empty() || 2 * heights.size() < places) return std::nullopt;
  std::ranges::sort(heights);
  const double low = heights[heights.size() / 10], high = heights[heights.size() * 9 / 10];
  if (high - low > options.most_spread_m) return std::nullopt;
  return heights[heights.size() / 2];
}

}  // namespace

std::vector<std::uint8_t> find_in_driven_path(const PointCloud& cloud,
                                              const DrivenPathOptions& options,
                                              const Executor& executor) {
  if (!(options.half_width_m > 0) || cloud.sensor_positions.empty() || cloud.scan_indices.empty())
    return {};
  const Path path(places_of_scans(cloud), options);
  if (path.length_m() < options.least_path_m) return {};
  std::vector<double> heights = heights_above_ground(cloud, path, options, executor);
  const std::optional<double> usual = usual_height(heights, options);
  if (!usual) return {};
  for (double& height : heights)
    if (std::isnan(height)) height = *usual;

  std::vector<std::uint8_t> inside(cloud.size());
  executor.for_chunks(cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      path.for_each_near(cloud.positions[i], [&](std::size_t place, double distance_m) {
        const double below_m = path.places()[place].z - static_cast<double>(cloud.positions[i].z);
        if (distance_m <= options.half_width_m && below_m >= -options.above_sensor_m &&
            below_m <= heights[place] - options.above_ground_m)
          inside[i] = 1;
      });
    }
  });
  if (std::ranges::none_of(inside, [](std::uint8_t flag) { return flag != 0; })) return {};
  return inside;
}

}  // namespace adasplats
