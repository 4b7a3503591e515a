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

// Private to gpu/: ray sources for scans of many poses.

/// Approximate number of rays per launch: enough to fill a GPU several times, and few enough that
/// the copy of the last launch's results, which overlaps nothing, is negligible.
inline constexpr std::size_t kScanRaysAtOnce = std::size_t{1} << 21;

/// Order in which firings are cast: the 32 rays of a warp are consecutive.
using CastingOrder = std::vector<std::uint32_t>;

/// For many scans per launch: by tiles of two rings and 16 columns, whose rays are more coherent
/// than those of one ring. For a free pattern, whose rings or columns mean little, it is no worse
/// than the original order.
CastingOrder coherent_order(std::span<const Firing> firings);

/// For a single scan, which takes as long as its slowest warp: rays along a street are slow, and a
/// warp full of them, each visiting different boxes, is far slower. So a warp has four columns in
/// each of eight directions all around.
CastingOrder spread_order(std::span<const Firing> firings);

/// The firings of a sensor in casting order.
struct OrderedFirings {
  OrderedFirings() = default;
  OrderedFirings(std::span<const FiringRay> firings, const CastingOrder& casting_order,
                 cudaStream_t stream);
  DeviceBuffer<FiringRay> rays;
  DeviceBuffer<std::uint32_t> order;
};

/// The poses of some scans on a device: the knots of all scans, and the begin of each scan's knots.
struct BatchPoses {
  PinnedBuffer<ScanPose> poses;
  PinnedBuffer<std::uint32_t> first_poses;
  DeviceBuffer<ScanPose> device_poses;
  DeviceBuffer<std::uint32_t> device_first_poses;

  /// Queues the copy after the previous one.
  void upload(std::span<const ScanMotion> scans, Vec3d scene_origin, cudaStream_t stream);
  void set(RaySource& source) const {
    source.poses = device_poses.data();
    source.first_poses = moving ? device_first_poses.data() : nullptr;
  }

  Event uploaded;
  bool moving = false;
};

}  // namespace adasplats::gpu
