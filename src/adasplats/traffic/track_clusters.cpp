// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/track_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "adasplats/neighbors/point_index.h"

namespace adasplats {
namespace {

/// Disjoint sets; the smallest index represents its set.
class Sets {
 public:
  explicit Sets(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0U);
  }
  std::uint32_t root_of(std::uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root_of(a);
    b = root_of(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parents_;
};

double level_distance(Vec3d a, Vec3d b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

Cluster cluster_of(const LoosePoints& loose, std::size_t number,
                   std::vector<std::uint32_t> points) {
  Cluster cluster;
  cluster.scan = number;
  Vec3d low = loose.points[points.front()], high = low;
  for (const std::uint32_t i : points) {
    cluster.time_s += loose.times_s[i] / static_cast<double>(points.size());
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], loose.points[i][axis]);
      high[axis] = std::max(high[axis], loose.points[i][axis]);
    }
  }
  cluster.middle = 0.5 * (low + high);
  cluster.size_m = high - low;
  cluster.points = std::move(points);
  return cluster;
}

std::vector<Cluster> clusters_of(const LoosePoints& loose, std::size_t number,
                                 const ClusterOptions& options, const Executor& executor) {
  constexpr double kFlat = 0.5;  // rows of a sensor are further apart than points in a row
  std::vector<Vec3f> points;
  std::vector<float> reaches2;
  for (const Vec3d& point : loose.points) {
    const Vec3d from_sensor = point - loose.sensor;
    points.push_back(vec_cast<float>(Vec3d{from_sensor.x, from_sensor.y, kFlat * from_sensor.z}));
    const double reach_m = options.reach_m + options.reach_per_m * length(from_sensor);
    reaches2.push_back(static_cast<float>(reach_m * reach_m));
  }
  const PointIndex index(points, executor);
  Sets sets(points.size());
  const Executor one(1);
  constexpr std::uint32_t kNear = 48;
  index.for_each_neighborhood(
      one,
      [&](std::uint32_t rank) {
        return NeighborLimit{kNear, reaches2[index.index_of(rank)]};
      },
      [&](std::uint32_t rank, const NeighborList& near) {
        for (std::uint32_t k = 0; k < near.size; ++k)
          sets.join(index.index_of(rank), index.index_of(near.ranks[k]));
      });
  std::vector<std::vector<std::uint32_t>> members(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) members[sets.root_of(i)].push_back(i);
  std::vector<Cluster> clusters;
  for (std::vector<std::uint32_t>& of_set : members) {
    if (of_set.size() < options.min_points) continue;
    Cluster cluster = cluster_of(loose, number, std::move(of_set));
    if (std::hypot(cluster.size_m.x, cluster.size_m.y) <= options.max_length_m)
      clusters.push_back(std::move(cluster));
  }
  return clusters;
}

namespace {

/// Links the clusters of all scans.
class Linker {
 public:
  Linker(const std::vector<std::vector<Cluster>>& clusters, const TrackOptions& options)
      : clusters_(clusters), options_(options) {
    for (const std::vector<Cluster>& of_scan : clusters) taken_.emplace_back(of_scan.size(), false);
  }

  std::vector<ClusterTrack> run() {
    std::vector<Triple> triples = find_triples();
    std::ranges::sort(triples, {},
                      [](const Triple& t) { return std::tuple(t.cost_m, t.scan, t.a, t.b, t.c); });
    std::vector<ClusterTrack> tracks;
    for (const Triple& t : triples) {
      if (taken_[t.scan - 1][t.a] || taken_[t.scan][t.b] || taken_[t.scan + 1][t.c]) continue;
      ClusterTrack track = {take(t.scan - 1, t.a), take(t.scan, t.b), take(t.scan + 1, t.c)};
      while (extend(track)) {
      }
      std::ranges::reverse(track);
      while (extend(track)) {
      }
      std::ranges::reverse(track);
      if (track.size() >= options_.min_scans) tracks.push_back(std::move(track));
    }
    return tracks;
  }

 private:
  /// Three clusters that move uniformly: a, b, c in scans scan - 1, scan, scan + 1.
  struct Triple {
    double cost_m;
    std::size_t scan, a, b, c;
  };

  Cluster take(std::size_t scan, std::size_t k) {
    taken_[scan][k] = true;
    return clusters_[scan][k];
  }

  /// How different two clusters are in height; their lengths change with the view.
  static bool are_alike(const Cluster& a, const Cluster& b) {
    constexpr double kHeight_m = 1;
    return std::fabs(a.middle.z - b.middle.z) < kHeight_m &&
           std::fabs(a.size_m.z - b.size_m.z) < kHeight_m;
  }

  bool may_follow(const Cluster& a, const Cluster& b) const {
    return level_distance(a.middle, b.middle) <=
               options_.max_speed_mps * std::fabs(b.time_s - a.time_s) &&
           are_alike(a, b);
  }

  std::vector<Triple> find_triples() const {
    std::vector<Triple> triples;
    for (std::size_t scan = 1; scan + 1 < clusters_.size(); ++scan) {
      for (std::size_t b = 0; b < clusters_[scan].size(); ++b) {
        const Cluster& now = clusters_[scan][b];
        for (std::size_t a = 0; a < clusters_[scan - 1].size(); ++a) {
          const Cluster& before = clusters_[scan - 1][a];
          if (!may_follow(before, now)) continue;
          for (std::size_t c = 0; c < clusters_[scan + 1].size(); ++c) {
            const Cluster& next = clusters_[scan + 1][c];
            if (!are_alike(now, next)) continue;
            const double ahead = (next.time_s - now.time_s) / (now.time_s - before.time_s);
            const double cost_m =
                level_distance(next.middle, now.middle + ahead * (now.middle - before.middle));
            if (cost_m <= options_.gate_m) triples.push_back({cost_m, scan, a, b, c});
          }
        }
      }
    }
    return triples;
  }

  /// Appends the cluster where the last ones of a track lead; the track may run backwards.
  bool extend(ClusterTrack& track) {
    const bool forward = track.back().scan > track.front().scan;
    constexpr std::size_t kLast = 4;
    const Cluster& last = track.back();
    const Cluster& earlier = track[track.size() - std::min(kLast, track.size())];
    const Vec3d velocity = (1 / (last.time_s - earlier.time_s)) * (last.middle - earlier.middle);
    for (std::size_t gap = 1; gap <= options_.max_gap + 1; ++gap) {
      if (forward ? last.scan + gap >= clusters_.size() : last.scan < gap) return false;
      const std::size_t scan = forward ? last.scan + gap : last.scan - gap;
      const double gate_m = options_.gate_m * static_cast<double>(gap);
      double least_m = gate_m;
      std::optional<std::size_t> best;
      for (std::size_t k = 0; k < clusters_[scan].size(); ++k) {
        const Cluster& next = clusters_[scan][k];
        if (taken_[scan][k] || !are_alike(last, next)) continue;
        const Vec3d predicted = last.middle + (next.time_s - last.time_s) * velocity;
        const double off_m = level_distance(predicted, next.middle);
        if (off_m > least_m) continue;
        least_m = off_m;
        best = k;
      }
      if (!best) continue;
      track.push_back(take(scan, *best));
      return true;
    }
    return false;
  }

  const std::vector<std::vector<Cluster>>& clusters_;
  const TrackOptions& options_;
  std::vector<std::vector<bool>> taken_;
};

}  // namespace

std::vector<ClusterTrack> track_clusters(const std::vector<std::vector<Cluster>>& clusters,
                                         const TrackOptions& options) {
  return Linker(clusters, options).run();
}

}  // namespace adasplats
