// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/ray.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/rays/disk_evidence.h"
#include "adasplats/splats/rays/disk_extent.h"
#include "adasplats/splats/rays/disk_shift.h"
#include "adasplats/splats/rays/measured_ray.h"

namespace adasplats {

/// What rays end at: a surface, or nothing (beams without return).
enum class RayEnds : std::uint8_t { at_surfaces, nowhere };

/// The rays that a LiDAR measured. Each shows free space up to its range and a surface there
/// (except rays that end nowhere). Neighbours in their order have similar origins and directions,
/// which tracers need to be fast.
class MeasuredRays {
 public:
  /// Needs sensor positions. Points have no ray if their origin is neither measured nor stated, or
  /// if they are nearer to their sensor than `min_range_m`.
  MeasuredRays(const PointCloud& cloud, double min_range_m, const Executor& executor,
               RayEnds ends = RayEnds::at_surfaces);

  std::size_t size() const { return points_.size(); }
  bool empty() const { return points_.empty(); }
  /// Index of ray `i`'s point in the cloud.
  std::uint32_t point(std::size_t i) const { return points_[i]; }
  const std::vector<std::uint32_t>& points() const { return points_; }
  /// Infinite for rays that end nowhere.
  float range_m(std::size_t i) const;
  RayEnds ends() const { return ends_; }
  Ray ray(std::size_t i, RayReach reach) const;
  /// From the sensor through the point and `beyond_m` farther.
  Ray ray(std::size_t i, float beyond_m) const { return ray(i, RayReach{beyond_m}); }
  /// Indices of the rays of one of `parts` parts (2 or kRayParts), in their order.
  std::span<const std::uint32_t> part(std::uint32_t parts, std::uint32_t part) const {
    return std::span(by_part_).subspan(begins_.first(parts, part), begins_.count(parts, part));
  }
  /// Prefetches what ray(i) reads: the points of consecutive rays are scattered over the cloud.
  void prefetch(std::size_t i) const {
    __builtin_prefetch(&cloud_.positions[points_[i]]);
    __builtin_prefetch(&cloud_.sensor_positions[points_[i]]);
  }

 private:
  void order_by_part(const Executor& executor);

  const PointCloud& cloud_;
  RayEnds ends_;
  std::vector<std::uint32_t> points_;
  std::vector<std::uint32_t> by_part_;  ///< indices of the rays, part by part
  RayPartBegins begins_;
};

/// Beams without return as points for rays that end nowhere, `reach_m` from their origins.
PointCloud ends_of(const std::vector<EmptyBeam>& beams, float reach_m);

/// Length of the free space that a beam without return shows: 95 % of the points with a beam are
/// within this range, in whole centimetres. Farther surfaces may not return an echo. 0 without
/// points.
float empty_reach_m(const PointCloud& cloud);
/// The largest range of a point with a beam; 0 without any.
float farthest_m(const PointCloud& cloud);

/// Histogram of ranges, for points that are not in memory at the same time.
class RangeCounts {
 public:
  void add(float range_m);
  void add(const RangeCounts& other);
  float empty_reach_m() const;  ///< of the added points
  std::uint64_t all() const { return all_; }

 private:
  static constexpr float kUnit_m = 0.01F;
  static constexpr float kMax_m = 10'000;  ///< longer beams count as this

  std::vector<std::uint64_t> counts_;
  std::uint64_t all_ = 0;
};

/// Counts of measured rays that confirm or contradict disks, in rings of equal area
/// (evidence_ring()).
struct RayEvidence {
  static constexpr int kBins = DiskEvidence::kBins;
  std::vector<std::uint32_t> confirmed;     ///< rays that end at the disk: [disk * kBins + bin]
  std::vector<std::uint32_t> contradicted;  ///< rays that pass through it

  EvidenceView view() { return {confirmed.data(), contradicted.data()}; }
};

DiskEvidence evidence_of(const RayEvidence& evidence, std::size_t disk);

/// Counts the rays that cross each disk; disks with radius 0 are ignored. Integers, so the number
/// of threads does not matter.
RayEvidence collect_evidence(std::span<const Disk> disks, std::span<const MeasuredRays* const> rays,
                             const EvidenceOptions& options, const Executor& executor);

/// Sums, for every disk, the offsets of the ends of the rays that meet it first. Of several disks a
/// few centimetres apart, rays meet the first one too early on average; settled() removes that
/// bias. Integers, so the number of threads does not matter.
std::vector<ShiftSums> sum_shifts(std::span<const Disk> disks, const MeasuredRays& rays,
                                  const SettleOptions& options, const Executor& executor);

/// What rays show about the extents of disks (add_extents_of_ray()). `disks` have options.reach
/// times their radius. Integers, so the number of threads does not matter.
std::vector<ExtentSums> sum_extents(std::span<const Disk> disks,
                                    std::span<const DiskExtent> extents,
                                    std::span<const MeasuredRays* const> rays,
                                    const ExtentOptions& options, const Executor& executor);

}  // namespace adasplats
