// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/segment/network/network.h"
#include "adasplats/segment/segment_cloud.h"

namespace adasplats {

/// A tile of a cloud with its margin.
struct SegmentTile {
  std::span<const std::uint32_t> indices;  ///< of points of the cloud, those of the tile first
  std::size_t wanted = 0;                  ///< number of points, from the first on, to classify
  Vec3f corner;                            ///< origin of grids, near the tile
  float width_m = 0;                       ///< of the tile with its margin
};

/// Common data of all tiles of a cloud.
struct SegmentTask {
  const PointCloud& cloud;
  const Network& network;
  const SegmentOptions& options;
  bool has_intensity = false;
  float full_intensity = 1;  ///< scaled to 1
};

/// Classifies the points of tiles, one tile after another.
class TileSegmenter {
 public:
  virtual ~TileSegmenter() = default;
  /// Returns the number of cells that the network processed. `tile` is not used after the call.
  virtual std::size_t segment(const SegmentTile& tile) = 0;
  /// Call after the last tile: stores classes, confidences and probabilities.
  virtual void finish(Segmentation& result) = 0;
};

/// A device that runs networks. Thread-safe.
class SegmentEngine {
 public:
  virtual ~SegmentEngine() = default;
  virtual std::string_view name() const = 0;
  /// `task` must outlive the result. Errors: unavailable.
  virtual std::unique_ptr<TileSegmenter> start(const SegmentTask& task) const = 0;
};

/// Errors on start: unavailable (built without OpenBLAS). `executor` must outlive the engine.
std::unique_ptr<SegmentEngine> make_cpu_segment_engine(const Executor& executor);

}  // namespace adasplats
