// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/traffic/loose_points.h"

namespace adasplats {

/// Loose points of one scan that are close to each other.
struct Cluster {
  std::size_t scan = 0;               ///< number of its LoosePoints, not of the scan in the drive
  double time_s = 0;                  ///< mean of its points
  Vec3d middle;                       ///< of the box along the world's axes, m
  Vec3d size_m;                       ///< of that box
  std::vector<std::uint32_t> points;  ///< indices, ascending
};

/// The clusters of one object, by time.
using ClusterTrack = std::vector<Cluster>;

struct ClusterOptions {
  /// Points closer than reach_m + reach_per_m * range belong together.
  double reach_m = 0.4;
  double reach_per_m = 0.01;
  std::size_t min_points = 5;
  double max_length_m = 20;  ///< larger clusters are no vehicles
};

/// `points`: indices, ascending, at least one.
Cluster cluster_of(const LoosePoints& loose, std::size_t number, std::vector<std::uint32_t> points);

/// Clusters by ascending first point.
std::vector<Cluster> clusters_of(const LoosePoints& loose, std::size_t number,
                                 const ClusterOptions& options, const Executor& executor);

struct TrackOptions {
  double max_speed_mps = 40;
  double gate_m = 1;        ///< of a cluster from where uniform motion predicts it
  std::size_t max_gap = 2;  ///< scans without a cluster
  std::size_t min_scans = 4;
};

/// Links clusters of consecutive scans: first three clusters that move uniformly, the most uniform
/// first, then further ones before and behind, each where the motion of the last ones leads. A
/// cluster belongs to one track at most. Objects at rest have tracks, too.
std::vector<ClusterTrack> track_clusters(const std::vector<std::vector<Cluster>>& clusters,
                                         const TrackOptions& options);

}  // namespace adasplats
