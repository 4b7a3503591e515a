// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/consistent_steps.h"

#include <algorithm>
#include <cmath>

#include "adasplats/core/maths/median.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/splats/consistent/consistent_steps_on.h"
#include "adasplats/splats/consistent/element_steps.h"
#include "adasplats/splats/consistent/surface_cover.h"
#include "adasplats/splats/model/cpu_backend.h"
#include "adasplats/splats/rays/measured_rays.h"
#include "adasplats/splats/rays/present_disks.h"
#include "adasplats/surface/adaptive_planes.h"
#include "adasplats/surface/fused_points.h"

namespace adasplats {
namespace {

/// 0 without any.
double median_spacing(std::vector<float>& spacings) {
  return spacings.empty() ? 0 : static_cast<double>(upper_median_of(spacings));
}

/// The CPU backend of the consistent method.
class ConsistentOnCpu : public RaysOnCpu {
 public:
  using Cells = FusedPoints;
  using Index = PointIndex;
  using Cover = SurfaceCover;
  using CpuBackend::on_host;
  using RaysOnCpu::RaysOnCpu;

  static const FusedPoints& on_host(const FusedPoints& cells) { return cells; }
  static RayEvidence on_host(RayEvidence evidence) { return evidence; }

  FusedPoints fuse(const PointCloud& cloud, double cell_m, const CurveBox& box) const {
    return fuse_points(cloud.positions, cell_m, box, executor());
  }
  FusedPoints split(const PointCloud& cloud, const FusedPoints& cells,
                    std::span<const std::uint8_t> flags, double cell_m, const CurveBox& box) const {
    return split_cells(cloud.positions, cells, flags, cell_m, box, executor());
  }
  PointIndex index(const FusedPoints& cells) const {
    return PointIndex::from_sorted(cells.positions, executor());
  }
  std::vector<LocalPlane> planes(const FusedPoints& cells, const PointIndex& index,
                                 const AdaptivePlaneOptions& options) const {
    return adaptive_planes(cells, index, options, executor());
  }
  MeasuredRays rays(const PointCloud& cloud, const MeasuredPoints& /*points*/, double min_range_m,
                    RayEnds ends) const {
    return {cloud, min_range_m, executor(), ends};
  }
  RayEvidence evidence(std::span<const Disk> disks, std::span<const MeasuredRays* const> rays,
                       const EvidenceOptions& options) const {
    return collect_evidence(disks, rays, options, executor());
  }
  std::vector<ShiftSums> shifts(std::span<const Disk> disks, const MeasuredRays& rays,
                                const SettleOptions& options) const {
    return sum_shifts(disks, rays, options, executor());
  }
  std::vector<ExtentSums> extents(std::span<const Disk> disks, std::span<const DiskExtent> extents,
                                  std::span<const MeasuredRays* const> rays,
                                  const ExtentOptions& options) const {
    return sum_extents(disks, extents, rays, options, executor());
  }
  SurfaceCover cover(std::span<const Disk> seeds, std::span<const std::uint8_t> unchecked,
                     const PointIndex& index, const CoverOptions& options) const {
    return {seeds, index, options, executor(), unchecked};
  }
  std::vector<Disk> choose(const SurfaceCover& cover) const { return cover.choose(executor()); }

  static std::size_t count_present(const std::vector<Disk>& disks) {
    return static_cast<std::size_t>(
        std::ranges::count_if(disks, [](const Disk& disk) { return disk.radius > 0; }));
  }

  /// One flag per point: its ray meets no disk near it.
  std::vector<std::uint8_t> missed(std::span<const Disk> disks, const MeasuredRays& rays,
                                   std::size_t points, RayReach reach) const {
    std::vector<std::uint8_t> missed(points);
    RayCasting casting;
    casting.reach = reach;
    PresentDisks(disks, executor())
        .cast(rays, casting, executor(), [&](const RayBatch& batch, const NearestHits& hits) {
          for (std::size_t i = 0; i < batch.rays.size(); ++i)
            if (!hits.all[i].valid()) missed[rays.point(batch.numbers[i])] = 1;
        });
    return missed;
  }

  /// Median of the planes' spacings divided by their units, over planes with a unit; 0 without any.
  static double median_spacing(const std::vector<LocalPlane>& planes,
                               const std::vector<float>& units_m) {
    std::vector<float> spacings;
    spacings.reserve(planes.size());
    for (std::size_t i = 0; i < planes.size(); ++i) {
      if (units_m[i] > 0) spacings.push_back(planes[i].spacing_m / units_m[i]);
    }
    return adasplats::median_spacing(spacings);
  }

  /// The disks that have a radius, with the attributes of the points in their cells.
  static ConsistentSplats splats(const std::vector<Disk>& disks,
                                 const std::vector<DiskExtent>& extents, const FusedPoints& cells,
                                 const PointCloud& cloud) {
    ConsistentSplats splats;
    std::vector<std::uint16_t> classes;  // of one cell
    for (std::size_t cell = 0; cell < disks.size(); ++cell) {
      if (!(disks[cell].radius > 0)) continue;
      splats.disks.push_back(disks[cell]);
      if (!extents.empty()) splats.opacities.push_back(extents[cell].opacity);
      const auto points = cells.points_of(cell);
      if (!cloud.classes.empty()) {
        classes.clear();
        for (const std::uint32_t i : points) classes.push_back(cloud.classes[i]);
        std::ranges::sort(classes);
        splats.classes.push_back(majority_class(classes));
      }
      if (!cloud.intensities.empty())
        splats.intensities.push_back(mean_intensity(cloud.intensities.data(), points));
    }
    return splats;
  }
};

}  // namespace

double rounded_spacing(double median) {
  constexpr int kSteps = 256;  // of the mantissa, 0.5 to 1
  int exponent = 0;
  const double mantissa = std::frexp(median, &exponent);
  return std::ldexp(std::round(mantissa * kSteps) / kSteps, exponent);
}

TypicalSpacing typical_spacing(std::vector<float> with_beam, std::vector<float> without) {
  return {rounded_spacing(median_spacing(with_beam)), rounded_spacing(median_spacing(without))};
}

std::unique_ptr<ConsistentSteps> make_cpu_consistent_steps(const Executor& executor) {
  return std::make_unique<ConsistentStepsOn<ConsistentOnCpu>>(executor);
}

}  // namespace adasplats
