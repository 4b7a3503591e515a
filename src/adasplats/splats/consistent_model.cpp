// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent_model.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "adasplats/splats/present_disks.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {
namespace {

constexpr std::size_t kGrain = 16384;

/// Mean distance of a cell's points to their sensors.
double mean_range_m(const PointCloud& cloud, std::span<const std::uint32_t> points) {
  double sum = 0;
  for (const std::uint32_t i : points) {
    sum += static_cast<double>(length(cloud.positions[i] - cloud.sensor_positions[i]));
  }
  return sum / static_cast<double>(points.size());
}

/// Turns normals to the sensors, or gives them a sign that depends on the data alone.
void orient_normals(const PointCloud& cloud, const FusedPoints& fused, std::span<LocalPlane> planes,
                    const Executor& executor) {
  executor.for_chunks(planes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3f& normal = planes[i].normal;
      if (cloud.sensor_positions.empty()) {
        normal = with_canonical_sign(normal);
        continue;
      }
      Vec3d to_sensors;
      for (const std::uint32_t k : fused.points_of(i)) {
        to_sensors = to_sensors + vec_cast<double>(cloud.sensor_positions[k] - cloud.positions[k]);
      }
      if (dot(vec_cast<double>(normal), to_sensors) < 0) normal = -normal;
    }
  });
}

/// As large as the cells are apart, but no larger than beams are from one another; 0 for a cell far
/// from all others.
float seed_radius(double spacing_m, double largest_m, const ConsistentOptions& options) {
  const double wanted_m = options.seed_spacing * spacing_m;
  if (!(wanted_m > 0) || wanted_m > options.isolated * largest_m) return 0;
  return static_cast<float>(
      std::clamp(wanted_m, options.least_radius_m, std::max(options.least_radius_m, largest_m)));
}

/// What the spacing of a cell is compared with: 1 m, or the distance to the sensor, where that is
/// known.
std::vector<float> spacing_units_m(const PointCloud& cloud, const FusedPoints& fused,
                                   const Executor& executor) {
  std::vector<float> units_m(fused.size(), 1.0F);
  if (cloud.sensor_positions.empty()) return units_m;
  executor.for_chunks(fused.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      units_m[i] = static_cast<float>(mean_range_m(cloud, fused.points_of(i)));
    }
  });
  return units_m;
}

double median_spacing(const std::vector<LocalPlane>& planes, const std::vector<float>& units_m) {
  std::vector<float> spacings;
  spacings.reserve(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (units_m[i] > 0) spacings.push_back(planes[i].spacing_m / units_m[i]);
  }
  if (spacings.empty()) return 0;
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return static_cast<double>(*middle);
}

/// `typical_spacing`: median spacing of cells that are all of one size.
std::vector<Disk> seed_disks(const PointCloud& cloud, const FusedPoints& fused,
                             const std::vector<LocalPlane>& planes, double typical_spacing,
                             const ConsistentOptions& options, const Executor& executor) {
  const std::vector<float> units_m = spacing_units_m(cloud, fused, executor);
  const double spacings =
      cloud.sensor_positions.empty() ? options.unchecked_largest_spacing : options.largest_spacing;
  const double largest = spacings * typical_spacing;
  std::vector<Disk> seeds(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const double largest_m = largest * static_cast<double>(units_m[i]);
    const auto spacing_m = static_cast<double>(planes[i].spacing_m);
    seeds[i] = {planes[i].center, seed_radius(spacing_m, largest_m, options), planes[i].normal};
  }
  return seeds;
}

/// Splits cells around which no plane is larger than the smallest scales: leaves, poles, wires are
/// smaller than a cell. Gives the median spacing of the cells before.
double split_where_not_flat(const PointCloud& cloud, const ConsistentOptions& options,
                            FusedPoints& fused, const Executor& executor) {
  const PointIndex index = PointIndex::from_sorted(fused.positions, executor);
  // Larger scales than the first that decides need not be looked at.
  AdaptivePlaneOptions few = options.planes;
  const std::size_t decides =
      std::min<std::size_t>(options.split_scale + 1U, few.scales.size() - 1);
  std::fill(few.scales.begin() + decides, few.scales.end(), few.scales[decides]);
  const auto planes = adaptive_planes(fused, index, few, executor);
  const double spacing = median_spacing(planes, spacing_units_m(cloud, fused, executor));
  if (options.small_cell_m == 0) return spacing;
  std::vector<bool> split(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) split[i] = planes[i].scale <= options.split_scale;
  fused = split_cells(cloud.positions, fused, split, options.small_cell_m, executor);
  return spacing;
}

/// As many rays as a round needs, other ones every round.
EvidenceOptions evidence_of_round(int round, std::size_t rays, const ConsistentOptions& options) {
  EvidenceOptions chosen = options.evidence;
  const std::size_t stride =
      std::clamp<std::size_t>(rays / options.evidence_rays, 1, chosen.stride);
  chosen.stride = static_cast<std::uint32_t>(stride);
  chosen.phase = static_cast<std::uint32_t>(round) % chosen.stride;
  return chosen;
}

/// Shrinks and removes seeds that more rays contradict than confirm; what stands behind them is
/// judged better every round.
void balance(std::span<Disk> seeds, const MeasuredRays& rays, const ConsistentOptions& options,
             const Executor& executor) {
  for (int round = 0; round < options.balance_rounds; ++round) {
    const RayEvidence evidence =
        collect_evidence(seeds, rays, evidence_of_round(round, rays.size(), options), executor);
    executor.for_chunks(seeds.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const DiskEvidence own = evidence_of(evidence, i);
        if (seeds[i].radius > 0 && own.seen()) {
          seeds[i].radius = judged_radius(own, seeds[i].radius, options.judge);
        }
      }
    });
  }
}

/// Limits chosen disks that hang over edges until hardly any ray goes through them.
void limit_overhangs(SurfaceCover& cover, const MeasuredRays& rays,
                     const ConsistentOptions& options, const Executor& executor) {
  std::vector<Disk> chosen;
  for (int round = 0; round < options.strict_rounds; ++round) {
    chosen = cover.choose(executor);
    const RayEvidence evidence =
        collect_evidence(chosen, rays, evidence_of_round(round, rays.size(), options), executor);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const DiskEvidence own = evidence_of(evidence, i);
      if (!(chosen[i].radius > 0) || !own.seen()) continue;
      const float radius_m = chosen[i].radius;
      const float strict_m = strict_radius(own, radius_m, options.most_contradicted);
      if (strict_m >= radius_m) continue;
      // A seed need not be free of contradiction: leaves are not.
      const float balanced_m = std::min(balanced_radius(own, radius_m), cover.seed_radius(i));
      cover.limit(i, std::max(strict_m, balanced_m));
    }
  }
  // What is chosen next instead of limited disks was not checked in its large size.
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!(chosen[i].radius > 0)) cover.limit(i, cover.seed_radius(i));
  }
}

/// Puts seeds back at cells whose rays find nothing where they ended: chosen disks cover the
/// middles of all seeds, not all that is between them.
void fill_gaps(std::vector<Disk>& chosen, const std::vector<Disk>& seeds, const FusedPoints& fused,
               const MeasuredRays& rays, const ConsistentOptions& options,
               const Executor& executor) {
  constexpr std::size_t kRaysAtOnce = std::size_t{1} << 18;
  std::vector<std::uint8_t> missed(fused.members.size());  // one a point
  {
    const PresentDisks present(chosen, executor);
    if (present.empty()) return;
    std::vector<Ray> batch;
    std::vector<Hit> hits;
    for (std::size_t first = 0; first < rays.size(); first += kRaysAtOnce) {
      batch.resize(std::min(kRaysAtOnce, rays.size() - first));
      hits.assign(batch.size(), Hit{});
      executor.for_chunks(batch.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) batch[k] = rays.ray(first + k, options.missed_m);
      });
      present.tracer().nearest(batch, hits, executor);
      for (std::size_t k = 0; k < batch.size(); ++k) {
        if (!hits[k].valid()) missed[rays.point(first + k)] = 1;
      }
    }
  }
  for (std::size_t cell = 0; cell < chosen.size(); ++cell) {
    if (chosen[cell].radius > 0) continue;
    for (const std::uint32_t i : fused.points_of(cell)) {
      if (missed[i] != 0) chosen[cell] = seeds[cell];
    }
  }
}

}  // namespace

ConsistentDisks consistent_disks(const PointCloud& cloud, const ConsistentOptions& options,
                                 const Executor& executor,
                                 const std::function<void(std::string_view)>& begin_step) {
  ConsistentDisks result;
  begin_step("fusion");
  result.fused = fuse_points(cloud.positions, options.cell_m, executor);

  begin_step("planes");
  const double typical_spacing = split_where_not_flat(cloud, options, result.fused, executor);
  const PointIndex index = PointIndex::from_sorted(result.fused.positions, executor);
  std::vector<LocalPlane> planes = adaptive_planes(result.fused, index, options.planes, executor);
  orient_normals(cloud, result.fused, planes, executor);
  std::vector<Disk> seeds =
      seed_disks(cloud, result.fused, planes, typical_spacing, options, executor);

  std::optional<MeasuredRays> rays;
  result.checked = !cloud.sensor_positions.empty() && options.balance_rounds > 0;
  if (result.checked) {
    begin_step("ray check of seeds");
    rays.emplace(cloud, options.least_range_m, executor);
    balance(seeds, *rays, options, executor);
  }

  begin_step("cover");
  CoverOptions cover_options = options.cover;
  if (!result.checked) cover_options.sectors = options.unchecked_sectors;
  SurfaceCover cover(seeds, index, cover_options, executor);
  if (result.checked) {
    begin_step("ray check of splats");
    limit_overhangs(cover, *rays, options, executor);
  }
  std::vector<Disk> chosen = cover.choose(executor);
  if (result.checked) {
    begin_step("settling");
    for (int round = 0; round < options.settle_rounds; ++round) {
      settle_disks(chosen, *rays, options.settle, executor);
    }
    if (options.fill) {
      begin_step("filling");
      fill_gaps(chosen, seeds, result.fused, *rays, options, executor);
    }
  }
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!(chosen[i].radius > 0)) continue;
    result.disks.push_back(chosen[i]);
    result.cells.push_back(static_cast<std::uint32_t>(i));
  }
  return result;
}

}  // namespace adasplats
