// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/simulate/scan_batches.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace adasplats::gpu {
namespace {

template <class Key>
CastingOrder ascending(std::span<const Firing> firings, const Key& key) {
  CastingOrder order(firings.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple_cat(key(firings[a]), std::tuple(a)) <
           std::tuple_cat(key(firings[b]), std::tuple(b));
  });
  return order;
}

}  // namespace

CastingOrder coherent_order(std::span<const Firing> firings) {
  constexpr std::uint32_t kTileRings = 2, kTileColumns = 16;
  return ascending(firings, [](const Firing& firing) {
    return std::tuple(firing.ring / kTileRings, firing.column / kTileColumns,
                      firing.ring % kTileRings, firing.column % kTileColumns);
  });
}

CastingOrder spread_order(std::span<const Firing> firings) {
  constexpr std::uint32_t kRunColumns = 4, kDirections = 8;
  std::uint32_t columns = 0;
  for (const Firing& firing : firings) columns = std::max(columns, firing.column + 1);
  const std::uint32_t columns_a_direction = (columns + kDirections - 1) / kDirections;
  return ascending(firings, [&](const Firing& firing) {
    const std::uint32_t direction = firing.column / columns_a_direction;
    const std::uint32_t column = firing.column % columns_a_direction;
    return std::tuple(firing.ring, column / kRunColumns, direction, column % kRunColumns);
  });
}

OrderedFirings::OrderedFirings(std::span<const FiringRay> firings,
                               const CastingOrder& casting_order, cudaStream_t stream)
    : order(std::span<const std::uint32_t>(casting_order), stream) {
  std::vector<FiringRay> in_order(firings.size());
  std::transform(casting_order.begin(), casting_order.end(), in_order.begin(),
                 [&](std::uint32_t i) { return firings[i]; });
  rays = DeviceBuffer<FiringRay>(std::span<const FiringRay>(in_order), stream);
}

void BatchPoses::upload(std::span<const ScanMotion> scans, Vec3d scene_origin,
                        cudaStream_t stream) {
  uploaded.wait("copy poses to the GPU");
  std::size_t knots = 0;
  for (const ScanMotion& scan : scans) knots += scan.knot_count();
  if (poses.size() < knots) {
    poses = PinnedBuffer<ScanPose>(knots);
    device_poses = DeviceBuffer<ScanPose>(knots, stream);
  }
  if (first_poses.size() < scans.size() + 1) {
    first_poses = PinnedBuffer<std::uint32_t>(scans.size() + 1);
    device_first_poses = DeviceBuffer<std::uint32_t>(scans.size() + 1, stream);
  }
  std::uint32_t filled = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    first_poses.data()[i] = filled;
    for (const ScanPose& pose : scan_poses(scans[i], scene_origin)) poses.data()[filled++] = pose;
  }
  first_poses.data()[scans.size()] = filled;
  moving = knots > scans.size();
  device_poses.upload(poses.span().first(knots));
  if (moving) device_first_poses.upload(first_poses.span().first(scans.size() + 1));
  uploaded.record(stream);
}

}  // namespace adasplats::gpu
#endif
