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
#include "adasplats/splats/rays/measured_ray.h"

namespace adasplats {

/// What stands at the end of measured rays: a surface, or nothing that is known.
enum class RayEnds : std::uint8_t { at_surfaces, nowhere };

/// The rays that a LiDAR measured: each says that there is a surface at its range (but for those
/// that end nowhere) and nothing before it. In an order in which neighbours start and point alike,
/// which tracers are fast with.
class MeasuredRays {
 public:
  /// Needs sensor positions. Points whose origin nobody measured or stated, and those nearer to
  /// their sensor than `min_range_m` have no ray.
  MeasuredRays(const PointCloud& cloud, double min_range_m, const Executor& executor,
               RayEnds ends = RayEnds::at_surfaces);

  std::size_t size() const { return points_.size(); }
  bool empty() const { return points_.empty(); }
  /// Index of ray `i`'s point in the cloud.
  std::uint32_t point(std::size_t i) const { return points_[i]; }
  const std::vector<std::uint32_t>& points() const { return points_; }
  /// Infinite where rays end nowhere.
  float range_m(std::size_t i) const;
  RayEnds ends() const { return ends_; }
  Ray ray(std::size_t i, RayReach reach) const;
  /// From the sensor through the point and `beyond_m` farther.
  Ray ray(std::size_t i, float beyond_m) const { return ray(i, RayReach{beyond_m}); }
  /// Numbers of the rays of one part of so many, 2 or kRayParts, in their order by kRayParts.
  std::span<const std::uint32_t> part(std::uint32_t parts, std::uint32_t part) const {
    return std::span(by_part_).subspan(begins_.first(parts, part), begins_.count(parts, part));
  }
  /// Begins to load what ray(i) reads: rays that stand side by side have points all over the cloud.
  void prefetch(std::size_t i) const {
    __builtin_prefetch(&cloud_.positions[points_[i]]);
    __builtin_prefetch(&cloud_.sensor_positions[points_[i]]);
  }

 private:
  void order_by_part(const Executor& executor);

  const PointCloud& cloud_;
  RayEnds ends_;
  std::vector<std::uint32_t> points_;
  std::vector<std::uint32_t> by_part_;  ///< numbers of the rays part by part
  RayPartBegins begins_;
};

/// Empty beams as points for rays that end nowhere: `reach_m` from where they left the sensor.
PointCloud ends_of(const std::vector<EmptyBeam>& beams, float reach_m);

/// How far empty beams say that nothing is: as far as all but one in twenty of the points with a
/// beam are from their sensor, in whole centimetres. Farther off what returns nothing may still be
/// there. 0 without points.
float empty_reach_m(const PointCloud& cloud);

/// How many beams are how long, of points that need not be in memory together.
class RangeCounts {
 public:
  void add(float range_m);
  void add(const RangeCounts& other);
  float empty_reach_m() const;  ///< of the points that were added
  std::uint64_t all() const { return all_; }

 private:
  static constexpr float kUnit_m = 0.01F;
  static constexpr float kMost_m = 10'000;  ///< longer beams are counted as such

  std::vector<std::uint64_t> counts_;
  std::uint64_t all_ = 0;
};

/// How measured rays bear disks out, by how far from a disk's middle they cross it: bin b holds
/// squared distances from b to b + 1 of kBins parts of the squared radius (rings of equal area).
struct RayEvidence {
  static constexpr int kBins = DiskEvidence::kBins;
  std::vector<std::uint32_t> confirmed;     ///< rays that end at the disk: [disk * kBins + bin]
  std::vector<std::uint32_t> contradicted;  ///< rays that go on behind it

  EvidenceView view() { return {confirmed.data(), contradicted.data()}; }
};

DiskEvidence evidence_of(const RayEvidence& evidence, std::size_t disk);

/// Counts, for every disk that rays cross, however many they are; disks with no radius are not
/// there. Whole numbers: the same on any number of threads.
RayEvidence collect_evidence(std::span<const Disk> disks, std::span<const MeasuredRays* const> rays,
                             const EvidenceOptions& options, const Executor& executor);

}  // namespace adasplats
