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

/// A square of a cloud and what lies around it.
struct SegmentTile {
  std::span<const std::uint32_t> indices;  ///< of points of the cloud, those of the square first...
  std::size_t wanted = 0;                  ///< ...of which so many get classes
  Vec3f corner;                            ///< of grids, near the square
  float width_m = 0;                       ///< of the square with what lies around it
};

/// What all tiles of a cloud have in common.
struct SegmentTask {
  const PointCloud& cloud;
  const Network& network;
  const SegmentOptions& options;
  bool has_intensity = false;
  float full_intensity = 1;  ///< intensities are shares of it
};

/// Gives the points of tiles classes, one tile after the other.
class TileSegmenter {
 public:
  virtual ~TileSegmenter() = default;
  /// Gives how many cells the network saw. `tile` is not used after the call.
  virtual std::size_t segment(const SegmentTile& tile) = 0;
  /// After the last tile: writes classes, confidences and probabilities, whose sizes are right.
  virtual void finish(Segmentation& result) = 0;
};

/// What networks are run on. Thread-safe.
class SegmentEngine {
 public:
  virtual ~SegmentEngine() = default;
  virtual std::string_view name() const = 0;
  /// The task outlives what is made. Errors: unavailable.
  virtual std::unique_ptr<TileSegmenter> start(const SegmentTask& task) const = 0;
};

/// Errors on start: unavailable (built without OpenBLAS). `executor` outlives the engine.
std::unique_ptr<SegmentEngine> make_cpu_segment_engine(const Executor& executor);

}  // namespace adasplats
