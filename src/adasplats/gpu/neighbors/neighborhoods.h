// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/gpu/base/device_memory.h"

namespace adasplats::gpu {

/// Private to gpu/: kernel view of a DevicePointIndex. The boxes of a level form groups of 32 with
/// the same parent; absent ones are inverted and infinitely far away.
struct PointIndexView {
  static constexpr std::uint32_t kChildren = 32;  ///< of a node, and points of a leaf
  static constexpr std::uint32_t kMaxLevels = 6;

  const float* coordinates[3] = {};  ///< by rank, padded to whole leaves with infinity
  const float* low[3] = {};          ///< of the boxes of all levels
  const float* high[3] = {};
  std::uint32_t begins[kMaxLevels] = {};  ///< of the boxes of each level; level 0 are the leaves
  std::uint32_t levels = 0;               ///< the last has one group of boxes
  std::uint32_t leaves = 0;
  std::uint32_t size = 0;
};

/// Private to gpu/: points along a curve (Hilbert order) under an implicit 32-ary tree of bounding
/// boxes, in device memory: a leaf holds 32 consecutive points, a node 32 consecutive nodes of the
/// level below, so a warp tests a node at once. A rank is the index of a point. neighborhoods.cuh
/// finds the same sets in it as PointIndex. Needs 13 bytes per point.
class DevicePointIndex {
 public:
  /// Maximum size of a neighbourhood.
  static constexpr std::uint32_t kMaxNeighbors = 512;

  /// `points`: device memory, copied. Errors: unavailable (2^31 points or more).
  DevicePointIndex(const Vec3f* points, std::size_t count, cudaStream_t stream);

  std::size_t size() const { return view_.size; }
  const PointIndexView& view() const { return view_; }

 private:
  PointIndexView view_;
  DeviceBuffer<float> coordinates_;
  DeviceBuffer<float> boxes_;
};

/// Rejects neighbourhoods of more points than DevicePointIndex::kMaxNeighbors.
/// Errors: usage, with a remedy.
void check_neighbors(std::uint64_t neighbors);

/// Number of points within the radius of every point, by rank, including itself, as
/// PointIndex::count_within.
DeviceBuffer<std::uint32_t> count_within(const DevicePointIndex& index, float radius,
                                         cudaStream_t stream);

}  // namespace adasplats::gpu
