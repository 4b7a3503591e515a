// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/segment/network/network.h"

namespace adasplats {

struct SegmentOptions {
  double tile_m = 32;     ///< side of the squares that are looked at one after the other, and...
  double margin_m = 12;   ///< ...how much around each is looked at, too
  bool intensity = true;  ///< is used where the points have it
  bool confidences = false;
  bool probabilities = false;
  /// How many points, from the first on, get classes; the others are looked at beside them.
  std::size_t wanted = static_cast<std::size_t>(-1);
};

struct Segmentation {
  std::vector<std::uint8_t> classes;  ///< of the points, indices into Network::classes
  std::vector<float> confidences;     ///< probabilities of these, 0 to 1; empty: not asked for
  std::vector<float> probabilities;   ///< of all classes, point by point; empty: not asked for
  std::size_t cells = 0, tiles = 0;   ///< that the network saw
};

class SegmentEngine;

/// The class of every point. The network sees means of cells; a point has the class of its cell.
/// Memory depends on the tiles and not on the cloud. The same for any number of threads. Errors:
/// data (a point that is not finite or farther than 100 km from the cloud's origin), unavailable
/// (the engine's).
Segmentation segment_cloud(const PointCloud& cloud, const Network& network,
                           const SegmentOptions& options, const SegmentEngine& engine,
                           const Executor& executor);
/// The same on the CPU.
Segmentation segment_cloud(const PointCloud& cloud, const Network& network,
                           const SegmentOptions& options, const Executor& executor);

}  // namespace adasplats
