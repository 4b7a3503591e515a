// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/trace/ray_source.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats::gpu {

/// Private to gpu/: what scans of many poses are cast from.

/// Scans in one launch hold about so many rays: enough to fill a GPU several times over, and few
/// enough that copying the last launch's results, which nothing overlaps, does not count.
inline constexpr std::size_t kScanRaysAtOnce = std::size_t{1} << 21;

/// Which firing is cast when: a warp's 32 rays stand one after another.
using CastingOrder = std::vector<std::uint32_t>;

/// For many scans a launch: by tiles of two rings and 16 columns, which meet more of the same
/// things than one ring's. A free pattern has rings or columns that say little; then this is as
/// good as its own order.
CastingOrder coherent_order(std::span<const Firing> firings);

/// For a single scan, which takes as long as its slowest warp: the rays along a street take long,
/// and a warp full of them, each with other boxes to visit, takes far longer. So a warp's rays are
/// four columns each of eight directions all around.
CastingOrder spread_order(std::span<const Firing> firings);

/// A sensor's firings in the order in which they are cast.
struct OrderedFirings {
  OrderedFirings() = default;
  OrderedFirings(std::span<const FiringRay> firings, const CastingOrder& casting_order,
                 cudaStream_t stream);
  DeviceBuffer<FiringRay> rays;
  DeviceBuffer<std::uint32_t> order;
};

/// The poses of some scans on a device: the knots of all of them, and where each one's begin.
struct BatchPoses {
  PinnedBuffer<ScanPose> poses;
  PinnedBuffer<std::uint32_t> first_poses;
  DeviceBuffer<ScanPose> device_poses;
  DeviceBuffer<std::uint32_t> device_first_poses;

  /// Queues the copy, once an earlier one is over.
  void upload(std::span<const ScanMotion> scans, Vec3d scene_origin, cudaStream_t stream);
  void set(RaySource& source) const {
    source.poses = device_poses.data();
    source.first_poses = moving ? device_first_poses.data() : nullptr;
  }

  Event uploaded;
  bool moving = false;
};

}  // namespace adasplats::gpu
