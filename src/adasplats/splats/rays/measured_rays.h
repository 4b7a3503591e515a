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

namespace adasplats {

/// What stands at the end of measured rays: a surface, or nothing that is known.
enum class RayEnds : std::uint8_t { at_surfaces, nowhere };

/// The rays that a LiDAR measured: each says that there is a surface at its range (but for those
/// that end nowhere) and nothing before it. In an order in which neighbours start and point alike,
/// which tracers are fast with.
class MeasuredRays {
 public:
  /// Needs sensor positions. Points whose origin nobody measured or stated, and those nearer to
  /// their sensor than `least_range_m` have no ray.
  MeasuredRays(const PointCloud& cloud, double least_range_m, const Executor& executor,
               RayEnds ends = RayEnds::at_surfaces);

  std::size_t size() const { return points_.size(); }
  bool empty() const { return points_.empty(); }
  /// Index of ray `i`'s point in the cloud.
  std::uint32_t point(std::size_t i) const { return points_[i]; }
  const std::vector<std::uint32_t>& points() const { return points_; }
  /// Infinite where rays end nowhere.
  float range_m(std::size_t i) const;
  RayEnds ends() const { return ends_; }
  /// From the sensor through the point and `beyond_m` farther.
  Ray ray(std::size_t i, float beyond_m) const;
  /// Begins to load what ray(i) reads: rays that stand side by side have points all over the cloud.
  void prefetch(std::size_t i) const {
    __builtin_prefetch(&cloud_.positions[points_[i]]);
    __builtin_prefetch(&cloud_.sensor_positions[points_[i]]);
  }

 private:
  const PointCloud& cloud_;
  RayEnds ends_;
  std::vector<std::uint32_t> points_;
};

/// Empty beams as points for rays that end nowhere: `reach_m` from where they left the sensor.
PointCloud ends_of(const std::vector<EmptyBeam>& beams, float reach_m);

/// How far empty beams say that nothing is: as far as all but one in twenty of the points with a
/// beam are from their sensor. Farther off what returns nothing may still be there. 0 without
/// points.
float empty_reach_m(const PointCloud& cloud);

/// How measured rays bear disks out, by how far from a disk's middle they cross it: bin b holds
/// squared distances from b to b + 1 of kBins parts of the squared radius (rings of equal area).
struct RayEvidence {
  static constexpr int kBins = DiskEvidence::kBins;
  std::vector<std::uint32_t> confirmed;     ///< rays that end at the disk: [disk * kBins + bin]
  std::vector<std::uint32_t> contradicted;  ///< rays that go on behind it

  EvidenceView view() { return {confirmed.data(), contradicted.data()}; }
};

DiskEvidence evidence_of(const RayEvidence& evidence, std::size_t disk);

/// Counts, for every disk that `rays` (and `empty` ones) cross, however many they are; disks with
/// no radius are not there. Whole numbers: the same on any number of threads.
RayEvidence collect_evidence(std::span<const Disk> disks, const MeasuredRays& rays,
                             const EvidenceOptions& options, const Executor& executor,
                             const MeasuredRays* empty = nullptr);

}  // namespace adasplats
