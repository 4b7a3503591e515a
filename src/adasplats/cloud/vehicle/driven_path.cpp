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
#include <utility>

#include "adasplats/cloud/points/scan_runs.h"

namespace adasplats {
namespace {

constexpr double kNoGround = std::numeric_limits<double>::quiet_NaN();

/// Which points of a cloud are looked at.
struct Looked {
  const PointCloud& cloud;
  std::span<const std::uint8_t> left_out;  ///< 1 or 0 each; empty: none is

  bool has(std::size_t i) const { return left_out.empty() || left_out[i] == 0; }
};

/// Where the sensor was in the mean of each scan, by the numbers of the scans; of scans without a
/// measured origin nothing.
std::vector<Vec3d> positions_of_scans(const Looked& points, const Executor& executor) {
  const PointCloud& cloud = points.cloud;
  const ScanRuns scans(cloud.scan_indices, executor);
  std::vector<std::pair<Vec3d, std::size_t>> sums(scans.size());
  executor.for_chunks(scans.size(), 1, [&](std::size_t k, std::size_t) {
    Vec3d sum;
    std::size_t count = 0;
    scans.for_each(k, [&](std::size_t i) {
      if (!points.has(i) || cloud.origin_kind(i) != OriginKind::measured) return;
      sum = sum + vec_cast<double>(cloud.sensor_positions[i]);
      ++count;
    });
    sums[k] = {sum, count};
  });
  std::vector<Vec3d> places;
  for (const auto& [sum, count] : sums)
    if (count > 0) places.push_back(sum / static_cast<double>(count));
  return places;
}

/// Whether an offset is at most `radius_m` long in the plane, as std::hypot says it: that takes as
/// long as all else here, and squares are inconclusive only next to the radius.
bool is_within(Vec3d offset, double radius_m) {
  constexpr double kSure = 1e-12;
  const double square = offset.x * offset.x + offset.y * offset.y, most = radius_m * radius_m;
  if (square > most * (1 + kSure)) return false;
  return square < most * (1 - kSure) || std::hypot(offset.x, offset.y) <= radius_m;
}

/// Where the sensor was in a scan, relative to the cloud's origin.
struct ScanPosition {
  Vec3d at;
  bool is_own = true;  ///< the scan is in the cloud
};

/// The places of a cloud's scans, between those beyond.
std::vector<ScanPosition> path_positions(const std::vector<Vec3d>& own, const PathBeyond& beyond,
                                         Vec3d origin) {
  std::vector<ScanPosition> places;
  for (const Vec3d world : beyond.before) places.push_back({world - origin, false});
  for (const Vec3d at : own) places.push_back({at, true});
  for (const Vec3d world : beyond.after) places.push_back({world - origin, false});
  return places;
}

/// The path from place to place, a step apart, and how long it is; without what is far from all
/// points.
class Path {
 public:
  Path(const std::vector<ScanPosition>& scans, const PointCloud& cloud,
       const DrivenPathOptions& options) {
    for (const Vec3f point : cloud.positions) {
      low_ = min(low_, point);
      high_ = max(high_, point);
    }
    for (std::size_t k = 0; k < scans.size(); ++k) {
      const auto [at, is_own] = scans[k];
      const Vec3d last = scans[k == 0 ? 0 : k - 1].at;
      const double apart_m = length(at - last);
      const bool joined = k > 0 && apart_m <= options.max_apart_m;
      const int steps = joined ? static_cast<int>(apart_m / options.step_m) : 0;
      if (joined) length_m_ += apart_m;
      for (int step = 1; step <= steps; ++step)
        add(last + (step / (steps + 1.0)) * (at - last), is_own);
      add(at, is_own);
    }
    for (const auto& [key, places] : cells_) near_[slot_of(key)] = 1;
  }

  double length_m() const { return length_m_; }
  const std::vector<Vec3d>& places() const { return places_; }
  bool is_own(std::size_t place) const { return is_own_[place] != 0; }  ///< of the cloud's scans

  /// Calls body(place, offset from it) for the places within a cell or so of a point.
  template <class Body>
  void for_each_near(Vec3f point, Body&& body) const {
    const auto [x, y] = cell_of(vec_cast<double>(point));
    const std::uint64_t cell = key(x, y);
    if (near_[slot_of(cell)] == 0) return;
    const auto found = cells_.find(cell);
    if (found == cells_.end()) return;
    for (const std::size_t place : found->second)
      body(place, vec_cast<double>(point) - places_[place]);
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
  void add(Vec3d place, bool is_own) {
    // A vehicle at rest adds nothing.
    if (!places_.empty() && length(place - places_.back()) < 0.2 * kCell_m) return;
    if (!is_own && is_far(place)) return;
    const auto [x, y] = cell_of(place);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        cells_[key(x + dx, y + dy)].push_back(places_.size());
    places_.push_back(place);
    is_own_.push_back(is_own ? 1 : 0);
  }
  /// Whether no point is within the cells around a place.
  bool is_far(Vec3d place) const {
    constexpr double kReach_m = 2 * kCell_m;
    return place.x < static_cast<double>(low_.x) - kReach_m ||
           place.y < static_cast<double>(low_.y) - kReach_m ||
           place.x > static_cast<double>(high_.x) + kReach_m ||
           place.y > static_cast<double>(high_.y) + kReach_m;
  }
  /// A small table that rejects most points: they are near no position.
  static std::size_t slot_of(std::uint64_t key) {
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15;  // Fibonacci hashing (Knuth 6.4)
    return static_cast<std::size_t>(key * kGolden >> (64U - kSlotBits));
  }
  static constexpr unsigned kSlotBits = 16;

  static constexpr float kNone = std::numeric_limits<float>::infinity();
  Vec3f low_{kNone, kNone, kNone}, high_{-kNone, -kNone, -kNone};  // of the points
  std::vector<Vec3d> places_;
  std::vector<std::uint8_t> is_own_;
  /// The places in a cell and in those around it.
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
  std::vector<std::uint8_t> near_ = std::vector<std::uint8_t>(std::size_t{1} << kSlotBits);
  double length_m_ = 0;
};

/// How high the sensor was above the ground at each place: below nine of ten points there.
std::vector<double> heights_above_ground(const Looked& points, const Path& path,
                                         const DrivenPathOptions& options,
                                         const Executor& executor) {
  constexpr double kBin_m = 0.05, kGroundShare = 0.1;
  const auto bins = static_cast<std::size_t>(std::ceil(options.max_height_m / kBin_m)) + 1;
  std::vector<std::uint32_t> counts(path.places().size() * bins);  // by depth below the sensor
  const std::vector<Vec3f>& positions = points.cloud.positions;
  executor.for_chunks(positions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!points.has(i)) continue;
      path.for_each_near(positions[i], [&](std::size_t place, Vec3d offset) {
        const double below_m = path.places()[place].z - static_cast<double>(positions[i].z);
        if (below_m < 0 || !is_within(offset, options.ground_radius_m)) return;
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
    if (all < options.min_points) continue;
    std::size_t deeper = 0, bin = bins;
    while (static_cast<double>(deeper) < kGroundShare * static_cast<double>(all))
      deeper += counts[place * bins + --bin];
    heights[place] = kBin_m * static_cast<double>(bin);
  }
  return heights;
}

/// The height at most places of the cloud's scans, which holds where nobody saw the ground; nothing
/// where it is none: it varies, or hardly any place has one.
std::optional<double> usual_height(const std::vector<double>& all, const Path& path,
                                   const DrivenPathOptions& options) {
  std::vector<double> heights;
  std::size_t places = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!path.is_own(k)) continue;
    ++places;
    if (!std::isnan(all[k])) heights.push_back(all[k]);
  }
  if (heights.empty() || 2 * heights.size() < places) return std::nullopt;
  std::ranges::sort(heights);
  const double low = heights[heights.size() / 10], high = heights[heights.size() * 9 / 10];
  if (high - low > options.max_spread_m) return std::nullopt;
  return heights[heights.size() / 2];
}

}  // namespace

std::vector<std::uint8_t> find_in_driven_path(const PointCloud& cloud,
                                              const DrivenPathOptions& options,
                                              const Executor& executor,
                                              std::span<const std::uint8_t> left_out,
                                              const PathBeyond& beyond) {
  if (!(options.half_width_m > 0) || cloud.sensor_positions.empty() || cloud.scan_indices.empty())
    return {};
  const Looked points{cloud, left_out};
  const Path path(path_positions(positions_of_scans(points, executor), beyond, cloud.origin), cloud,
                  options);
  if (path.length_m() < options.min_path_m) return {};
  std::vector<double> heights = heights_above_ground(points, path, options, executor);
  const std::optional<double> usual = usual_height(heights, path, options);
  if (!usual) return {};
  for (double& height : heights)
    if (std::isnan(height)) height = *usual;

  std::vector<std::uint8_t> inside(cloud.size());
  executor.for_chunks(cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!points.has(i)) continue;
      path.for_each_near(cloud.positions[i], [&](std::size_t place, Vec3d offset) {
        const double below_m = path.places()[place].z - static_cast<double>(cloud.positions[i].z);
        if (below_m >= -options.above_sensor_m &&
            below_m <= heights[place] - options.above_ground_m &&
            is_within(offset, options.half_width_m))
          inside[i] = 1;
      });
    }
  });
  if (std::ranges::none_of(inside, [](std::uint8_t flag) { return flag != 0; })) return {};
  return inside;
}

}  // namespace adasplats
