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

/// Maximum distance of points from the origin of the coordinates: grids have 2^21 cells per side.
inline constexpr float kSegmentReach_m = 100e3F;

struct SegmentOptions {
  double tile_m = 32;     ///< side of the square tiles, which are processed one after another
  double margin_m = 12;   ///< context around each tile
  bool intensity = true;  ///< use intensities if the points have them
  bool confidences = false;
  bool probabilities = false;
  /// Number of points, from the first on, that get classes; the others are only context.
  std::size_t wanted = static_cast<std::size_t>(-1);
  /// The intensity that is scaled to 1; nullopt: full_intensity() of the cloud. For tiles of a
  /// city, which must get the classes of the whole city.
  std::optional<float> full_intensity;
};

/// Index of a square tile, counted from the origin of the coordinates.
struct SegmentSquare {
  std::int32_t x = 0, y = 0;
  auto operator<=>(const SegmentSquare&) const = default;
};
/// The tile that contains a point. The classes of its points depend on them, on the points in its
/// margin, on SegmentOptions::full_intensity, and in the last bits on the order of the points.
SegmentSquare square_of(Vec3f position, const SegmentOptions& options);

struct Segmentation {
  std::vector<std::uint8_t> classes;  ///< of the points, indices into Network::classes
  std::vector<float> confidences;     ///< probabilities of these, 0 to 1; empty: not requested
  std::vector<float> probabilities;   ///< of all classes, point by point; empty: not requested
  std::size_t cells = 0, tiles = 0;   ///< processed by the network
};

class SegmentEngine;

/// Classifies every point. The network processes means of cells; a point gets the class of its
/// cell. Memory depends on the size of tiles, not of the cloud. The same for any number of threads.
/// Errors: data (a point that is not finite or farther than 100 km from the cloud's origin),
/// unavailable (from the engine).
Segmentation segment_cloud(const PointCloud& cloud, const Network& network,
                           const SegmentOptions& options, const SegmentEngine& engine,
                           const Executor& executor);
/// The same on the CPU.
Segmentation segment_cloud(const PointCloud& cloud, const Network& network,
                           const SegmentOptions& options, const Executor& executor);

}  // namespace adasplats
