// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/vehicle/own_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace adasplats {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A cloud and which of its points count.
struct Measured {
  const PointCloud& cloud;
  std::span<const std::uint8_t> left_out;  ///< 1 or 0 each; empty: none is

  bool has(std::size_t i) const {
    return cloud.origin_kind(i) == OriginKind::measured && (left_out.empty() || left_out[i] == 0);
  }
};

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

void sort_unique(std::vector<std::uint64_t>& keys) {
  std::ranges::sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// Up to `most` of the values, evenly chosen.
template <class T>
std::vector<T> evenly(std::span<const T> values, std::size_t most) {
  const std::size_t stride = (values.size() + most - 1) / most;
  std::vector<T> chosen;
  for (std::size_t k = 0; k < values.size(); k += stride) chosen.push_back(values[k]);
  return chosen;
}

/// The diagonal of the box of all sensor positions.
double path_m(const Measured& points, const Executor& executor) {
  const std::vector<Vec3f>& sensors = points.cloud.sensor_positions;
  struct Sensors {
    Vec3f low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};
    Sensors& operator+=(const Sensors& other) {
      low = min(low, other.low);
      high = max(high, other.high);
      return *this;
    }
  };
  const Sensors box = executor.sum_chunks(sensors.size(), kCoarseGrain, Sensors{},
                                          [&](std::size_t begin, std::size_t end) {
                                            Sensors part;
                                            for (std::size_t i = begin; i < end; ++i)
                                              if (points.has(i)) part += {sensors[i], sensors[i]};
                                            return part;
                                          });
  return box.low.x <= box.high.x ? static_cast<double>(length(box.high - box.low)) : 0;
}

/// Cells of sensor positions, numbered in the order of their keys. Points come as they were
/// measured, so that many in a row are of one station: these runs are what is kept.
class Stations {
 public:
  /// Consecutive points of one station, up to where the next run begins.
  struct Run {
    std::uint32_t begin;
    std::uint32_t station;  ///< kNone: points that do not count
  };
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  Stations(const Measured& points, double side_m, const Executor& executor)
      : points_(points), side_m_(side_m), runs_((points.cloud.size() + kGrain - 1) / kGrain) {
    std::vector<std::vector<std::uint64_t>> keys(runs_.size());
    executor.for_chunks(points.cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      keys[begin / kGrain] = find_runs(begin, end, runs_[begin / kGrain]);
    });
    for (const auto& part : keys) keys_.insert(keys_.end(), part.begin(), part.end());
    sort_unique(keys_);
    executor.for_chunks(runs_.size(), 1, [&](std::size_t chunk, std::size_t) {
      for (Run& run : runs_[chunk])
        if (run.station != kNone) run.station = of(run.begin);
    });
  }
  std::size_t size() const { return keys_.size(); }
  std::uint32_t of(std::size_t point) const {
    const std::uint64_t key = key_of(points_.cloud.sensor_positions[point]);
    return static_cast<std::uint32_t>(std::ranges::lower_bound(keys_, key) - keys_.begin());
  }
  /// Calls visit(station, begin, end) for all runs of points that count, ascending.
  template <class Visit>
  void for_each_run(Visit&& visit) const {
    for (std::size_t chunk = 0; chunk < runs_.size(); ++chunk) {
      const std::vector<Run>& runs = runs_[chunk];
      const std::size_t chunk_end = std::min((chunk + 1) * kGrain, points_.cloud.size());
      for (std::size_t k = 0; k < runs.size(); ++k) {
        const std::size_t end = k + 1 < runs.size() ? runs[k + 1].begin : chunk_end;
        if (runs[k].station != kNone) visit(runs[k].station, std::size_t{runs[k].begin}, end);
      }
    }
  }

 private:
  /// Finds the runs of some points, with kNone or without their number; gives their keys.
  std::vector<std::uint64_t> find_runs(std::size_t begin, std::size_t end,
                                       std::vector<Run>& runs) const {
    constexpr std::uint64_t kNoKey = std::numeric_limits<std::uint64_t>::max();
    std::vector<std::uint64_t> keys;
    std::uint64_t last = kNoKey - 1;  // which is none, either
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t key = points_.has(i) ? key_of(points_.cloud.sensor_positions[i]) : kNoKey;
      if (key == last) continue;
      last = key;
      runs.push_back({static_cast<std::uint32_t>(i), key == kNoKey ? kNone : 0});
      if (key != kNoKey) keys.push_back(key);
    }
    sort_unique(keys);
    return keys;
  }

  /// Cells of 0.2 m have keys of their own up to 200 km from the cloud's origin.
  std::uint64_t key_of(Vec3f sensor) const {
    constexpr double kMiddle = 1 << 20;
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::floor(static_cast<double>(sensor[axis]) / side_m_) + kMiddle;
      key = key << 21U | static_cast<std::uint64_t>(std::clamp(cell, 0.0, 2 * kMiddle - 1));
    }
    return key;
  }

  Measured points_;
  double side_m_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::vector<Run>> runs_;  ///< by chunks of kGrain points
};

/// The shortest range that a station measured in each direction, in the cells of a cube's faces
/// (0.35 degrees in their middle).
class View {
 public:
  void add(Vec3f from_sensor) {
    const float range_m = length(from_sensor);
    if (!(range_m > 0)) return;
    if (ranges_m_.empty()) ranges_m_.resize(6 * kCells * kCells, kInfinity);
    float& shortest_m = ranges_m_[cell_of(from_sensor)];
    shortest_m = std::min(shortest_m, range_m);
  }
  void add_sensor(Vec3f sensor) {
    sum_ = sum_ + vec_cast<double>(sensor);
    ++count_;
  }
  Vec3f sensor() const { return vec_cast<float>(sum_ / static_cast<double>(count_)); }
  /// Infinite where nothing was measured.
  float range_m(Vec3f direction) const {
    return ranges_m_.empty() ? kInfinity : ranges_m_[cell_of(direction)];
  }

 private:
  static constexpr std::size_t kCells = 256;

  static std::size_t cell_of(Vec3f v) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (std::fabs(v[k]) > std::fabs(v[axis])) axis = k;
    const float along = std::fabs(v[axis]);
    const auto cell = [along](float across) {
      constexpr auto kHalf = static_cast<float>(kCells) / 2;
      return std::min(static_cast<std::size_t>((across / along + 1) * kHalf), kCells - 1);
    };
    const std::size_t face = 2 * static_cast<std::size_t>(axis) + (v[axis] < 0 ? 1 : 0);
    return (face * kCells + cell(v[(axis + 1) % 3])) * kCells + cell(v[(axis + 2) % 3]);
  }

  std::vector<float> ranges_m_;
  Vec3d sum_;
  std::size_t count_ = 0;
};

class Search {
 public:
  Search(const Measured& points, const OwnBodyOptions& options, const Executor& executor)
      : cloud_(points.cloud),
        points_(points),
        options_(options),
        executor_(executor),
        stations_(points, options.station_m, executor) {}

  bool has_enough_motion() const {
    return stations_.size() >= options_.min_stations &&
           path_m(points_, executor_) >= options_.min_path_m;
  }

  std::vector<std::uint8_t> run() const {
    const std::vector<std::uint32_t> near = near_points();
    const std::vector<std::vector<std::uint32_t>> kept = rings_that_stay(near);
    const std::vector<View> views = views_of_stations();
    std::vector<std::uint8_t> is_body(kept.size());
    executor_.for_chunks(kept.size(), 1, [&](std::size_t ring, std::size_t) {
      is_body[ring] = is_seen_through(kept[ring], views) ? 1 : 0;
    });
    std::vector<std::uint8_t> flags;
    for (const std::uint32_t i : near) {
      if (is_body[ring_of(i)] == 0) continue;
      flags.resize(cloud_.size());
      flags[i] = 1;
    }
    return flags;
  }

 private:
  Vec3f from_sensor(std::size_t i) const {
    return cloud_.positions[i] - cloud_.sensor_positions[i];
  }
  std::size_t rings_outwards() const {
    return static_cast<std::size_t>(std::ceil(options_.reach_m / options_.ring_m)) + 1;
  }
  std::size_t rings() const { return 2 * rings_outwards() * rings_outwards(); }
  /// The ring around its sensor that a near point lies in.
  std::size_t ring_of(std::size_t i) const {
    const Vec3f d = from_sensor(i);
    const auto number = [&](double m) { return static_cast<std::size_t>(m / options_.ring_m); };
    return number(static_cast<double>(std::hypot(d.x, d.y))) * 2 * rings_outwards() +
           number(static_cast<double>(d.z) + options_.reach_m);
  }

  std::vector<std::uint32_t> near_points() const {
    return concatenated(cloud_.size(), executor_, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> near;
      for (std::size_t i = begin; i < end; ++i) {
        if (points_.has(i) && static_cast<double>(length(from_sensor(i))) < options_.reach_m)
          near.push_back(static_cast<std::uint32_t>(i));
      }
      return near;
    });
  }

  /// Of each ring the points to look at; none of a ring that too few stations have points in.
  std::vector<std::vector<std::uint32_t>> rings_that_stay(
      const std::vector<std::uint32_t>& near) const {
    std::vector<std::vector<std::uint32_t>> points(rings());
    for (const std::uint32_t i : near) points[ring_of(i)].push_back(i);
    const double least = options_.min_share * static_cast<double>(stations_.size());
    executor_.for_chunks(points.size(), 1, [&](std::size_t ring, std::size_t) {
      std::vector<std::uint64_t> stations;
      for (const std::uint32_t i : points[ring]) stations.push_back(stations_.of(i));
      sort_unique(stations);
      if (static_cast<double>(stations.size()) < least) points[ring].clear();
      points[ring] = evenly<std::uint32_t>(points[ring], options_.looked_at);
    });
    return points;
  }

  /// What the stations that look have measured.
  std::vector<View> views_of_stations() const {
    const std::size_t stride = (stations_.size() + options_.looking - 1) / options_.looking;
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> runs(
        (stations_.size() + stride - 1) / stride);  // of points, by station
    stations_.for_each_run([&](std::uint32_t station, std::size_t begin, std::size_t end) {
      if (station % stride == 0)
        runs[station / stride].emplace_back(static_cast<std::uint32_t>(begin),
                                            static_cast<std::uint32_t>(end));
    });
    std::vector<View> views(runs.size());
    executor_.for_chunks(views.size(), 1, [&](std::size_t station, std::size_t) {
      for (const auto& [begin, end] : runs[station]) {
        for (std::size_t i = begin; i < end; ++i) {
          views[station].add(from_sensor(i));
          views[station].add_sensor(cloud_.sensor_positions[i]);
        }
      }
    });
    return views;
  }

  /// Whether beams of the stations go through where these points are, more than end there.
  bool is_seen_through(const std::vector<std::uint32_t>& points,
                       const std::vector<View>& views) const {
    std::size_t through = 0, looked = 0;
    for (const std::uint32_t i : points) {
      for (const View& view : views) {
        const Vec3f to_point = cloud_.positions[i] - view.sensor();
        const auto distance_m = static_cast<double>(length(to_point));
        const float measured_m = view.range_m(to_point);
        if (distance_m < options_.min_view_m || measured_m == kInfinity) continue;
        const double behind_m = static_cast<double>(measured_m) - distance_m;
        if (behind_m < -options_.margin_m) continue;  // something is before it
        ++looked;
        if (behind_m > options_.margin_m) ++through;
      }
    }
    return looked > 0 &&
           static_cast<double>(through) > options_.min_through * static_cast<double>(looked);
  }

  const PointCloud& cloud_;
  Measured points_;
  const OwnBodyOptions& options_;
  const Executor& executor_;
  Stations stations_;
};

}  // namespace

std::vector<std::uint8_t> find_own_body(const PointCloud& cloud, const OwnBodyOptions& options,
                                        const Executor& executor,
                                        std::span<const std::uint8_t> left_out) {
  if (!cloud.has_beams()) return {};
  const Search search({cloud, left_out}, options, executor);
  return search.has_enough_motion() ? search.run() : std::vector<std::uint8_t>();
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
