// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "adasplats/core/host_device.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

struct EvidenceOptions {  // numbers: docs/fidelity.md
  /// A ray ends at a disk if it crosses it this near to its end, as the noise of ranges has it...
  float range_margin_m = 0.04F;
  /// ...and as much farther as puts its end this far off the disk's plane: a disk that stands or
  /// leans a little wrong is crossed far from there by grazing rays.
  float height_margin_m = 0.01F;
  float min_cosine = 0.1F;  ///< rays that graze more have no wider margins
  /// Rays are cast in turns: one part of so many (kRayParts or a power of two below)...
  std::uint32_t parts = 4;
  std::uint32_t part = 0;  ///< ...and this one

  /// How far behind its end a ray may cross a disk at which it ends.
  float max_margin_m() const { return range_margin_m + height_margin_m / min_cosine; }
};

/// How near to its end a ray in this direction must cross a disk to end at it.
ADASPLATS_HD inline float end_margin_m(const Disk& disk, Vec3f direction,
                                       const EvidenceOptions& options) {
  const float cosine = std::fabs(dot(disk.normal, direction));
  return options.range_margin_m + options.height_margin_m / std::max(options.min_cosine, cosine);
}

/// What a ray that crosses a disk says of it.
enum class RayWord : std::uint8_t { nothing, confirms, contradicts };

/// Of a ray that crosses a disk at `hit_t` and ended at `range_m`.
ADASPLATS_HD inline RayWord word_of_ray(const Disk& disk, const Ray& ray, float hit_t,
                                        float range_m, const EvidenceOptions& options) {
  const float margin_m = end_margin_m(disk, ray.direction, options);
  if (hit_t > range_m + margin_m) return RayWord::nothing;
  return hit_t < range_m - margin_m ? RayWord::contradicts : RayWord::confirms;
}

/// What the rays say of one disk: counts of its rings of equal area, from the middle outward.
struct DiskEvidence {
  static constexpr int kBins = 16;
  std::span<const std::uint32_t> confirmed;
  std::span<const std::uint32_t> contradicted;

  ADASPLATS_HD bool seen() const { return any(confirmed) || any(contradicted); }

 private:
  ADASPLATS_HD static bool any(std::span<const std::uint32_t> counts) {
    for (const std::uint32_t n : counts) {
      if (n > 0) return true;
    }
    return false;
  }
};

/// Counts of all disks, wherever they are: [disk * kBins + bin].
struct EvidenceView {
  static constexpr std::size_t kBins = DiskEvidence::kBins;
  std::uint32_t* confirmed = nullptr;
  std::uint32_t* contradicted = nullptr;

  ADASPLATS_HD DiskEvidence of(std::size_t disk) const {
    return {{confirmed + disk * kBins, kBins}, {contradicted + disk * kBins, kBins}};
  }
};

/// The ring in which a ray crosses a disk at `hit_t`: squared distances from the middle in kBins
/// parts of the squared radius.
ADASPLATS_HD inline std::uint32_t evidence_ring(const Disk& disk, const Ray& ray, float hit_t) {
  const Vec3f offset = ray.origin + hit_t * ray.direction - disk.center;
  const float place =
      dot(offset, offset) / (disk.radius * disk.radius) * static_cast<float>(DiskEvidence::kBins);
  // Asked before it is converted: of what no integer holds CPUs and GPUs make different ones.
  constexpr std::uint32_t kOutermost = DiskEvidence::kBins - 1;
  return place < static_cast<float>(kOutermost) ? static_cast<std::uint32_t>(place) : kOutermost;
}

/// Radius that encloses that many of the rings.
ADASPLATS_HD inline float radius_of_rings(int rings, float radius_m) {
  return radius_m * std::sqrt(static_cast<float>(rings) / DiskEvidence::kBins);
}

/// The radius at which confirming rays outnumber contradicting ones by most; 0 where there is
/// none, the radius itself where nobody speaks against it.
ADASPLATS_HD inline float balanced_radius(const DiskEvidence& evidence, float radius_m) {
  std::int64_t balance = 0, best = 0;
  int rings = 0;      // of the best radius
  int last_seen = 0;  // outermost ring that any ray crossed
  for (int k = 0; k < DiskEvidence::kBins; ++k) {
    const auto bin = static_cast<std::size_t>(k);
    const std::int64_t yes = evidence.confirmed[bin], no = evidence.contradicted[bin];
    balance += yes - no;
    if (yes + no > 0) last_seen = k + 1;
    if (balance > best || (balance == best && yes > 0)) {
      best = balance;
      rings = k + 1;
    }
  }
  // Rings that nobody crossed stay, and so do disks.
  return rings == last_seen ? radius_m : radius_of_rings(rings, radius_m);
}

/// Whether more than chance speaks for a disk at its balanced radius. The middle of a disk stands
/// on the points that it is made from, so their rays confirm some of the middle, whatever goes
/// through the rest: of n contradicting rays, the square root of n may miss it by chance.
ADASPLATS_HD inline bool is_borne_out(const DiskEvidence& evidence) {
  double balance = 0, best = 0, contradicted = 0;
  for (std::size_t bin = 0; bin < evidence.confirmed.size(); ++bin) {
    balance += static_cast<double>(evidence.confirmed[bin]);
    balance -= static_cast<double>(evidence.contradicted[bin]);
    contradicted += static_cast<double>(evidence.contradicted[bin]);
    best = std::max(best, balance);
  }
  return balance >= 0 || best * best >= contradicted;
}

struct JudgeOptions {           // numbers: docs/fidelity.md
  int core_rings = 2;           ///< the middle of a disk
  std::uint32_t core_rays = 3;  ///< that must confirm the middle...
  double core_share = 0.3;      ///< ...and be so much of those that cross it, to give it a chance
  float core_radius = 0.25F;    ///< of the radius: what is tried next
  float min_radius_m = 0.015F;  ///< not below this
};

/// What the rays leave of a disk: its balanced radius; where that is none but many rays confirm
/// the very middle (a bar, a twig), a small disk, to be judged again; else 0.
ADASPLATS_HD inline float judged_radius(const DiskEvidence& evidence, float radius_m,
                                        const JudgeOptions& options) {
  const float balanced_m = is_borne_out(evidence) ? balanced_radius(evidence, radius_m) : 0;
  if (balanced_m > 0 || radius_m <= options.min_radius_m) return balanced_m;
  std::uint32_t yes = 0, no = 0;
  for (std::size_t bin = 0; bin < static_cast<std::size_t>(options.core_rings); ++bin) {
    yes += evidence.confirmed[bin];
    no += evidence.contradicted[bin];
  }
  const bool has_chance =
      yes >= options.core_rays && yes >= options.core_share * (double{1} * yes + no);
  return has_chance ? std::max(options.core_radius * radius_m, options.min_radius_m) : 0;
}

/// The largest radius at which at most `max_share` as many rays contradict as confirm.
ADASPLATS_HD inline float strict_radius(const DiskEvidence& evidence, float radius_m,
                                        double max_share) {
  double yes = 0, no = 0;
  int rings = 0;
  for (int k = 0; k < DiskEvidence::kBins; ++k) {
    yes += evidence.confirmed[static_cast<std::size_t>(k)];
    no += evidence.contradicted[static_cast<std::size_t>(k)];
    if (no <= max_share * yes) rings = k + 1;
  }
  return rings == DiskEvidence::kBins ? radius_m : radius_of_rings(rings, radius_m);
}

/// What a chosen disk is limited to so that hardly any ray goes through it; not less than what the
/// rays leave of its seed, which need not be free of contradiction: leaves are not.
ADASPLATS_HD inline float overhang_limit(const DiskEvidence& evidence, float radius_m,
                                         float seed_radius_m, double max_share) {
  const float strict_m = strict_radius(evidence, radius_m, max_share);
  if (strict_m >= radius_m) return radius_m;
  return std::max(strict_m, std::min(balanced_radius(evidence, radius_m), seed_radius_m));
}

}  // namespace adasplats
