// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/own_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

namespace adasplats {
namespace {

constexpr std::size_t kGrain = 16384;

/// A cell of a grid in space as one number; cells that neighbour differ by kAlong in one axis.
using CellKey = std::uint64_t;
constexpr std::array<CellKey, 3> kAlong = {CellKey{1} << 42U, CellKey{1} << 21U, CellKey{1}};

/// Cells of 0.2 m have such numbers up to 200 km from the cloud's origin.
CellKey cell_of(Vec3f p, double side_m) {
  constexpr double kMiddle = 1 << 20;
  CellKey key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::floor(static_cast<double>(p[axis]) / side_m) + kMiddle;
    key = key << 21U | static_cast<CellKey>(std::clamp(cell, 1.0, 2 * kMiddle - 2));
  }
  return key;
}

std::array<CellKey, 27> with_neighbors(CellKey key) {
  std::array<CellKey, 27> keys;
  std::size_t count = 0;
  const CellKey least = key - kAlong[0] - kAlong[1] - kAlong[2];
  for (CellKey x = 0; x < 3; ++x)
    for (CellKey y = 0; y < 3; ++y)
      for (CellKey z = 0; z < 3; ++z)
        keys[count++] = least + x * kAlong[0] + y * kAlong[1] + z * kAlong[2];
  return keys;
}

void sort_unique(std::vector<CellKey>& keys) {
  std::ranges::sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// Sorted cells and their neighbours along one axis.
std::vector<CellKey> widened(const std::vector<CellKey>& keys, CellKey along) {
  std::vector<CellKey> before = keys, after = keys, both, all;
  for (CellKey& key : before) key -= along;
  for (CellKey& key : after) key += along;
  std::ranges::merge(before, after, std::back_inserter(both));
  std::ranges::merge(both, keys, std::back_inserter(all));
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// A set of sorted cells that tells quickly what is not in it.
class CellSet {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  explicit CellSet(std::vector<CellKey>&& keys) : keys_(std::move(keys)), bits_(kBits / 64) {
    for (const CellKey key : keys_) bits_[place(key) / 64] |= std::uint64_t{1} << place(key) % 64;
  }
  std::size_t size() const { return keys_.size(); }
  /// The number of a cell in the order of keys.
  std::uint32_t find(CellKey key) const {
    if ((bits_[place(key) / 64] >> place(key) % 64 & 1U) == 0) return kNone;
    const auto found = std::ranges::lower_bound(keys_, key);
    if (found == keys_.end() || *found != key) return kNone;
    return static_cast<std::uint32_t>(found - keys_.begin());
  }

 private:
  static constexpr std::size_t kBits = std::size_t{1} << 22U;
  static std::size_t place(CellKey key) { return key * 0x9E3779B97F4A7C15U >> 42U; }

  std::vector<CellKey> keys_;
  std::vector<std::uint64_t> bits_;
};

bool is_measured(const PointCloud& cloud, std::size_t i) {
  return cloud.origin_kind(i) == OriginKind::measured;
}

/// What `of_chunk(begin, end)` gives of all chunks of the points, one after the other.
template <class F>
auto concatenated(std::size_t count, const Executor& executor, F&& of_chunk) {
  std::vector<decltype(of_chunk(count, count))> parts((count + kGrain - 1) / kGrain);
  executor.for_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
    parts[begin / kGrain] = of_chunk(begin, end);
  });
  decltype(of_chunk(count, count)) all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Where the sensor stood.
CellSet stations_of(const PointCloud& cloud, double side_m, const Executor& executor) {
  auto all = concatenated(cloud.size(), executor, [&](std::size_t begin, std::size_t end) {
    std::vector<CellKey> keys;
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_measured(cloud, i)) continue;
      const CellKey key = cell_of(cloud.sensor_positions[i], side_m);
      if (keys.empty() || keys.back() != key) keys.push_back(key);
    }
    sort_unique(keys);
    return keys;
  });
  sort_unique(all);
  return CellSet(std::move(all));
}

/// The diagonal of the box of all sensor positions.
double path_m(const PointCloud& cloud) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  Vec3f low{kNone, kNone, kNone}, high{-kNone, -kNone, -kNone};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!is_measured(cloud, i)) continue;
    low = min(low, cloud.sensor_positions[i]);
    high = max(high, cloud.sensor_positions[i]);
  }
  return low.x <= high.x ? static_cast<double>(length(high - low)) : 0;
}

/// How many different values the pairs of each first number hold.
std::vector<std::uint32_t> count_seconds(std::vector<std::uint64_t>&& pairs, std::size_t firsts,
                                         const Executor& executor) {
  std::vector<std::uint32_t> order, counts(firsts);
  executor.sort_keys(pairs, order);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (i == 0 || pairs[i] != pairs[i - 1]) ++counts[pairs[i] >> 32U];
  return counts;
}

std::uint64_t pair_of(std::uint64_t first, std::uint32_t second) { return first << 32U | second; }

class Search {
 public:
  Search(const PointCloud& cloud, const OwnBodyOptions& options, const Executor& executor)
      : cloud_(cloud),
        options_(options),
        executor_(executor),
        stations_(stations_of(cloud, options.station_m, executor)) {}

  bool can_tell() const {
    return stations_.size() >= options_.least_stations && path_m(cloud_) >= options_.least_path_m;
  }

  std::vector<std::uint8_t> run() {
    const std::vector<std::uint32_t> near = points_between(0, options_.reach_m);
    const std::vector<std::uint32_t> around = points_around();
    std::vector<std::uint32_t> both = near;
    both.insert(both.end(), around.begin(), around.end());
    const std::vector<std::uint32_t> stations = seen_from(both);
    // The station of a point around is one of those that see it.
    const auto needed = static_cast<std::uint32_t>(options_.confirmed_by);
    std::size_t unconfirmed = 0;
    for (std::size_t n = near.size(); n < both.size(); ++n)
      if (stations[n] < needed + 1) ++unconfirmed;
    if (share(unconfirmed, around.size()) > options_.most_unconfirmed) return {};
    const std::vector<std::uint8_t> is_body = rings_of_body(near, stations);
    std::vector<std::uint8_t> flags;
    for (const std::uint32_t i : near) {
      if (is_body[ring_of(i)] == 0) continue;
      flags.resize(cloud_.size());
      flags[i] = 1;
    }
    return flags;
  }

 private:
  double range_m(std::size_t i) const {
    return static_cast<double>(length(cloud_.positions[i] - cloud_.sensor_positions[i]));
  }
  bool is_near(std::size_t i) const { return range_m(i) < options_.reach_m; }
  static double share(std::size_t part, std::size_t all) {
    return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all);
  }
  std::uint32_t station_of(std::size_t i) const {
    return stations_.find(cell_of(cloud_.sensor_positions[i], options_.station_m));
  }
  std::size_t rings_outwards() const {
    return static_cast<std::size_t>(std::ceil(options_.reach_m / options_.ring_m)) + 1;
  }
  std::size_t rings() const { return 2 * rings_outwards() * rings_outwards(); }
  /// The ring around its sensor that a near point lies in.
  std::size_t ring_of(std::size_t i) const {
    const Vec3f d = cloud_.positions[i] - cloud_.sensor_positions[i];
    const auto number = [&](double m) { return static_cast<std::size_t>(m / options_.ring_m); };
    return number(static_cast<double>(std::hypot(d.x, d.y))) * 2 * rings_outwards() +
           number(static_cast<double>(d.z) + options_.reach_m);
  }

  std::vector<std::uint32_t> points_between(double least_m, double most_m) const {
    return concatenated(cloud_.size(), executor_, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> points;
      for (std::size_t i = begin; i < end; ++i) {
        if (!is_measured(cloud_, i)) continue;
        const double range = range_m(i);
        if (range >= least_m && range < most_m) points.push_back(static_cast<std::uint32_t>(i));
      }
      return points;
    });
  }
  std::vector<std::uint32_t> points_around() const {
    const auto all = points_between(options_.reach_m, 2 * options_.reach_m);
    const std::size_t stride = all.size() / options_.around + 1;
    std::vector<std::uint32_t> chosen;
    for (std::size_t k = 0; k < all.size(); k += stride) chosen.push_back(all[k]);
    return chosen;
  }

  /// Which cells points that are not near lie in, each with their station.
  std::vector<std::uint64_t> seen(const CellSet& cells, std::size_t begin, std::size_t end) const {
    std::vector<std::uint64_t> pairs;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t cell = cells.find(cell_of(cloud_.positions[i], options_.cell_m));
      if (cell != CellSet::kNone && is_measured(cloud_, i) && !is_near(i))
        pairs.push_back(pair_of(cell, station_of(i)));
    }
    sort_unique(pairs);
    return pairs;
  }

  /// How many stations saw something from farther than a body reaches in the cell of each of these
  /// points or in one beside it, whichever most did.
  std::vector<std::uint32_t> seen_from(const std::vector<std::uint32_t>& points) const {
    std::vector<CellKey> wanted;
    wanted.reserve(points.size());
    for (const std::uint32_t i : points)
      wanted.push_back(cell_of(cloud_.positions[i], options_.cell_m));
    sort_unique(wanted);
    for (const CellKey along : kAlong) wanted = widened(wanted, along);
    const CellSet cells(std::move(wanted));
    const auto of_cells = count_seconds(
        concatenated(cloud_.size(), executor_,
                     [&](std::size_t begin, std::size_t end) { return seen(cells, begin, end); }),
        cells.size(), executor_);
    std::vector<std::uint32_t> stations(points.size());
    executor_.for_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        const CellKey own = cell_of(cloud_.positions[points[n]], options_.cell_m);
        for (const CellKey key : with_neighbors(own))
          stations[n] = std::max(stations[n], of_cells[cells.find(key)]);
      }
    });
    return stations;
  }

  std::vector<std::uint8_t> rings_of_body(const std::vector<std::uint32_t>& near,
                                          const std::vector<std::uint32_t>& seen_from) const {
    std::vector<std::size_t> points(rings()), unconfirmed(rings());
    std::vector<std::uint64_t> pairs;
    for (std::size_t n = 0; n < near.size(); ++n) {
      const std::size_t ring = ring_of(near[n]);
      ++points[ring];
      if (seen_from[n] < static_cast<std::uint32_t>(options_.confirmed_by)) ++unconfirmed[ring];
      pairs.push_back(pair_of(ring, station_of(near[n])));
    }
    const auto stations = count_seconds(std::move(pairs), rings(), executor_);
    std::vector<std::uint8_t> is_body(rings());
    for (std::size_t r = 0; r < rings(); ++r) {
      is_body[r] = points[r] > 0 && share(stations[r], stations_.size()) >= options_.least_share &&
                   share(unconfirmed[r], points[r]) >= options_.least_unconfirmed;
    }
    return is_body;
  }

  const PointCloud& cloud_;
  const OwnBodyOptions& options_;
  const Executor& executor_;
  CellSet stations_;
};

}  // namespace

std::vector<std::uint8_t> find_own_body(const PointCloud& cloud, const OwnBodyOptions& options,
                                        const Executor& executor) {
  if (!cloud.has_beams()) return {};
  Search search(cloud, options, executor);
  return search.can_tell() ? search.run() : std::vector<std::uint8_t>();
}

std::vector<std::uint8_t> points_within(const PointCloud& cloud, double radius_m,
                                        const Executor& executor) {
  std::vector<std::uint8_t> flags(cloud.size());
  executor.for_chunks(cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_beam(cloud.origin_kind(i))) continue;
      const float range_m = length(cloud.positions[i] - cloud.sensor_positions[i]);
      flags[i] = static_cast<double>(range_m) < radius_m ? 1 : 0;
    }
  });
  return flags;
}

}  // namespace adasplats
