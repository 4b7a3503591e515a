// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <vector>

#include "adasplats/gpu/base/model_steps.h"
#include "adasplats/gpu/consistent/consistent_cells.h"
#include "adasplats/gpu/consistent/consistent_cover.cuh"
#include "adasplats/gpu/consistent/consistent_planes.h"
#include "adasplats/gpu/consistent/consistent_rays.h"
#include "adasplats/gpu/consistent/consistent_seeds.h"
#include "adasplats/gpu/consistent/rays_on_gpu.cuh"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/splats/consistent/consistent_steps_on.h"
#include "adasplats/splats/reflectance/reflectances_on.h"

namespace adasplats::gpu {
namespace {

/// GPU backend of the steps of the consistent method.
class ConsistentOnGpu : public RaysOnGpu {
 public:
  using Cells = DeviceCells;
  using Index = DevicePointIndex;
  using Cover = DeviceCover;
  using RaysOnGpu::RaysOnGpu;

  DeviceCells fuse(const DeviceCloud& cloud, double cell_m, const CurveBox& box) const {
    return fuse_on_device(cloud.positions.data(), cloud.size(), cell_m, box, stream());
  }
  DeviceCells split(const DeviceCloud& cloud, const DeviceCells& cells,
                    const DeviceBuffer<std::uint8_t>& flags, double cell_m,
                    const CurveBox& box) const {
    return split_on_device(cloud.positions.data(), cells, flags.data(), cell_m, box, stream());
  }
  DevicePointIndex index(const DeviceCells& cells) const {
    return {cells.positions.data(), cells.size(), stream()};
  }
  DeviceBuffer<LocalPlane> planes(const DeviceCells& cells, const DevicePointIndex& index,
                                  const AdaptivePlaneOptions& options) const {
    return planes_on_device(cells.view(), index, options, stream());
  }
  double median_spacing(const DeviceBuffer<LocalPlane>& planes,
                        const DeviceBuffer<float>& units_m) const {
    return gpu::median_spacing(planes, units_m, stream());
  }
  DeviceRays rays(const DeviceCloud& cloud, const MeasuredPoints& points, double min_range_m,
                  RayEnds ends) const {
    return {points, cloud.size(), min_range_m, stream(), ends};
  }
  DeviceEvidence evidence(const DeviceBuffer<Disk>& disks, std::span<const DeviceRays* const> rays,
                          const EvidenceOptions& options) const {
    return evidence_on_device(disks.data(), disks.size(), rays, options, stream());
  }
  DeviceBuffer<ShiftSums> shifts(const DeviceBuffer<Disk>& disks, const DeviceRays& rays,
                                 const SettleOptions& options) const {
    return rays.shifts(disks.data(), disks.size(), options);
  }
  DeviceBuffer<ExtentSums> extents(const DeviceBuffer<Disk>& disks,
                                   const DeviceBuffer<DiskExtent>& extents,
                                   std::span<const DeviceRays* const> rays,
                                   const ExtentOptions& options) const {
    return extents_on_device(disks.data(), extents.data(), disks.size(), rays, options, stream());
  }
  DeviceBuffer<std::uint8_t> missed(const DeviceBuffer<Disk>& disks, const DeviceRays& rays,
                                    std::size_t /*points*/, RayReach reach) const {
    return rays.missed(disks.data(), disks.size(), reach);
  }
  DeviceCover cover(const DeviceBuffer<Disk>& seeds, const DeviceBuffer<std::uint8_t>& unchecked,
                    const DevicePointIndex& index, const CoverOptions& options) const {
    return {seeds.data(), unchecked.data(), index, options, stream()};
  }
  DeviceBuffer<Disk> choose(DeviceCover& cover) const { return cover.choose(); }
  std::size_t count_present(const DeviceBuffer<Disk>& disks) const {
    return gpu::count_present(disks, stream());
  }
  ConsistentSplats splats(const DeviceBuffer<Disk>& disks, const DeviceBuffer<DiskExtent>& extents,
                          const DeviceCells& cells, const DeviceCloud& cloud) const {
    return splats_of(disks, extents, cells, cloud, stream());
  }
};

}  // namespace

std::unique_ptr<ConsistentSteps> make_cuda_consistent_steps(int device) {
  const DeviceGuard guard(device);
  return std::make_unique<ConsistentStepsOn<ConsistentOnGpu>>(device);
}

Reflectances measure_reflectances(int device, const std::vector<Disk>& disks,
                                  const std::vector<float>& fallback, const PointCloud& cloud) {
  if (!cloud.has_beams() || cloud.intensities.empty()) return {fallback, {}};
  const DeviceGuard guard(device);
  const RaysOnGpu place(device);
  const DeviceCloud copy = copy_to_device(cloud, place.stream());
  const MeasuredPoints points = {copy.positions.data(), copy.sensor_positions.data(),
                                 data_or_null(copy.origin_kinds)};
  const DeviceRays rays(points, copy.size(), kMinReflectanceRange_m, place.stream());
  const RaysWithIntensities<RaysOnGpu> measured = {&rays, &copy.intensities};
  return ReflectancesOn<RaysOnGpu>(place, disks, fallback).run({&measured, 1});
}

}  // namespace adasplats::gpu
