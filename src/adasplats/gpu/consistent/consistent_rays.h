// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/core/host_device.h"
#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/splats/consistent/seed_disk.h"
#include "adasplats/splats/rays/disk_evidence.h"
#include "adasplats/splats/rays/disk_extent.h"
#include "adasplats/splats/rays/disk_shift.h"
#include "adasplats/splats/rays/measured_rays.h"
#include "adasplats/splats/reflectance/element_steps.h"

namespace adasplats::gpu {

/// Private to gpu/: RayEvidence in device memory.
struct DeviceEvidence {
  DeviceBuffer<std::uint32_t> confirmed;
  DeviceBuffer<std::uint32_t> contradicted;

  EvidenceView view() const { return {confirmed.data(), contradicted.data()}; }
  RayEvidence download() const { return {confirmed.download(), contradicted.download()}; }
};

/// Private to gpu/: MeasuredRays in device memory, in the same order, and their counts on disks in
/// device memory: identical integers.
class DeviceRays {
 public:
  /// `points` (device memory, with sensors) must outlive the rays. Points closer to their sensor
  /// than `min_range_m` have no ray. Waits for the stream.
  DeviceRays(const MeasuredPoints& points, std::size_t count, double min_range_m,
             cudaStream_t stream, RayEnds ends = RayEnds::at_surfaces);

  std::size_t size() const { return numbers_.size(); }
  /// The rays' points, in the order of the rays.
  const DeviceBuffer<std::uint32_t>& points() const { return numbers_; }

  /// The points of one of `parts` parts, in device memory.
  std::span<const std::uint32_t> points_of(std::uint32_t parts, std::uint32_t part) const;
  const MeasuredPoints& measured() const { return measured_; }
  RayEnds ends() const { return ends_; }

  /// Evidence of the rays of every disk about its position: one sum per disk.
  DeviceBuffer<ShiftSums> shifts(const Disk* disks, std::size_t count,
                                 const SettleOptions& options) const;
  /// Calls `observe` for all rays and their nearest hits.
  void observe(const Disk* disks, std::size_t count, const ObserveRay& observe) const;
  /// One flag per point: whether its ray hits no disk near it. All flags are 0 if there are no
  /// disks. Waits for the stream.
  DeviceBuffer<std::uint8_t> missed(const Disk* disks, std::size_t count, RayReach reach) const;

 private:
  MeasuredPoints measured_;
  std::size_t point_count_;
  cudaStream_t stream_;
  RayEnds ends_;
  DeviceBuffer<std::uint32_t> numbers_;
  DeviceBuffer<std::uint32_t> by_part_;  ///< points of the rays, part by part
  RayPartBegins begins_;
};

/// sum_extents() on disks [0, count).
DeviceBuffer<ExtentSums> extents_on_device(const Disk* disks, const DiskExtent* extents,
                                           std::size_t count,
                                           std::span<const DeviceRays* const> rays,
                                           const ExtentOptions& options, cudaStream_t stream);

/// collect_evidence() on disks [0, count).
DeviceEvidence evidence_on_device(const Disk* disks, std::size_t count,
                                  std::span<const DeviceRays* const> rays,
                                  const EvidenceOptions& options, cudaStream_t stream);

}  // namespace adasplats::gpu
