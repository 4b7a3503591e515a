// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/segment/network/network.h"

namespace adasplats {

/// How far from the origin of their coordinates points may be: grids have 2^21 cells a side.
inline constexpr float kSegmentReach_m = 100e3F;

struct SegmentOptions {
  double tile_m = 32;     ///< side of the squares that are looked at one after the other, and...
  double margin_m = 12;   ///< ...how much around each is looked at, too
  bool intensity = true;  ///< is used where the points have it
  bool confidences = false;
  bool probabilities = false;
  /// How many points, from the first on, get classes; the others are looked at beside them.
  std::size_t wanted = static_cast<std::size_t>(-1);
  /// What intensities are shares of; nothing: full_intensity() of the cloud's. For parts of a place
  /// that are to get the classes of the whole.
  std::optional<float> full_intensity;
};

/// A square that is looked at, counted in sides from the origin of the coordinates.
struct SegmentSquare {
  std::int32_t x = 0, y = 0;
  auto operator<=>(const SegmentSquare&) const = default;
};
/// The one that a point stands in. The classes of its points follow from them, from the points in
/// its margin and from SegmentOptions::full_intensity, and, to the last bit, from their order.
SegmentSquare square_of(Vec3f position, const SegmentOptions& options);

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
