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

struct EvidenceOptions {  // sources of the numbers: docs/research/consistent.md
  /// A ray ends at a disk if it crosses the disk within this distance of its end (range noise)...
  float range_margin_m = 0.04F;
  /// ...plus the distance that moves its end off the disk's plane by this height: grazing rays
  /// cross a slightly misplaced or tilted disk far from their ends.
  float height_margin_m = 0.01F;
  float min_cosine = 0.1F;  ///< of incidence; limits the margin of grazing rays
  /// Number of parts that rays are cast in (kRayParts or a smaller power of two)...
  std::uint32_t parts = 4;
  std::uint32_t part = 0;  ///< ...and the part to cast

  /// The maximum of end_margin_m().
  float max_margin_m() const { return range_margin_m + height_margin_m / min_cosine; }
};

/// Distance from its end within which a ray in this direction must cross a disk to end at it.
ADASPLATS_HD inline float end_margin_m(const Disk& disk, Vec3f direction,
                                       const EvidenceOptions& options) {
  const float cosine = std::fabs(dot(disk.normal, direction));
  return options.range_margin_m + options.height_margin_m / std::max(options.min_cosine, cosine);
}

/// Evidence of a ray for or against a disk that it crosses.
enum class RayVerdict : std::uint8_t { nothing, confirms, contradicts };

/// Evidence of a ray that crosses the disk at `hit_t` and was measured to end at `range_m`.
ADASPLATS_HD inline RayVerdict verdict_of_ray(const Disk& disk, const Ray& ray, float hit_t,
                                              float range_m, const EvidenceOptions& options) {
  const float margin_m = end_margin_m(disk, ray.direction, options);
  if (hit_t > range_m + margin_m) return RayVerdict::nothing;
  return hit_t < range_m - margin_m ? RayVerdict::contradicts : RayVerdict::confirms;
}

/// Ray counts of one disk in rings of equal area, from the centre outward.
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

/// Counts of all disks in host or device memory: [disk * kBins + bin].
struct EvidenceView {
  static constexpr std::size_t kBins = DiskEvidence::kBins;
  std::uint32_t* confirmed = nullptr;
  std::uint32_t* contradicted = nullptr;

  ADASPLATS_HD DiskEvidence of(std::size_t disk) const {
    return {{confirmed + disk * kBins, kBins}, {contradicted + disk * kBins, kBins}};
  }
};

/// The ring in which a ray crosses a disk at `hit_t`: ring k covers squared distances from the
/// centre of k to k + 1 kBins-ths of the squared radius.
ADASPLATS_HD inline std::uint32_t evidence_ring(const Disk& disk, const Ray& ray, float hit_t) {
  const Vec3f offset = ray.origin + hit_t * ray.direction - disk.center;
  const float position =
      dot(offset, offset) / (disk.radius * disk.radius) * static_cast<float>(DiskEvidence::kBins);
  // Compared before the conversion: CPUs and GPUs convert out-of-range values differently.
  constexpr std::uint32_t kOutermost = DiskEvidence::kBins - 1;
  return position < static_cast<float>(kOutermost) ? static_cast<std::uint32_t>(position)
                                                   : kOutermost;
}

/// Radius that encloses this many rings.
ADASPLATS_HD inline float radius_of_rings(int rings, float radius_m) {
  return radius_m * std::sqrt(static_cast<float>(rings) / DiskEvidence::kBins);
}

/// The radius at which confirming rays outnumber contradicting ones the most; 0 if there is none,
/// the full radius if no ray contradicts it.
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
  // Rings without rays are kept, and so are disks.
  return rings == last_seen ? radius_m : radius_of_rings(rings, radius_m);
}

/// Whether more than chance supports a disk at its balanced radius. The rays of the points that the
/// disk was made from always confirm its centre, whatever passes through the rest: of n
/// contradicting rays, sqrt(n) may miss the centre by chance.
ADASPLATS_HD inline bool is_supported(const DiskEvidence& evidence) {
  double balance = 0, best = 0, contradicted = 0;
  for (std::size_t bin = 0; bin < evidence.confirmed.size(); ++bin) {
    balance += static_cast<double>(evidence.confirmed[bin]);
    balance -= static_cast<double>(evidence.contradicted[bin]);
    contradicted += static_cast<double>(evidence.contradicted[bin]);
    best = std::max(best, balance);
  }
  return balance >= 0 || best * best >= contradicted;
}

/// Share of the rays through a disk that confirm it; needs rays.
ADASPLATS_HD inline double confirmed_share(const DiskEvidence& evidence) {
  double confirmed = 0, all = 0;
  for (std::size_t bin = 0; bin < evidence.confirmed.size(); ++bin) {
    confirmed += evidence.confirmed[bin];
    all += double{1} * evidence.confirmed[bin] + evidence.contradicted[bin];
  }
  return confirmed / all;
}

struct SeedCheckOptions {  // sources of the numbers: docs/research/consistent.md
  /// If larger than 0: disks stay as they are if at least this share of the rays confirms them, and
  /// are removed else.
  double min_share = 0;
  int core_rings = 2;           ///< rings that form the core of a disk
  std::uint32_t core_rays = 3;  ///< minimum rays that confirm the core...
  double core_share = 0.3;      ///< ...and minimum share of the rays through it, to retry the disk
  float core_radius = 0.25F;    ///< factor on the radius for the retry...
  float min_radius_m = 0.015F;  ///< ...and its minimum
};

/// The radius of a disk that the rays support: the balanced radius. If that is 0 but many rays
/// confirm the core (a bar, a twig), a small radius, to be checked again; else 0.
ADASPLATS_HD inline float supported_radius(const DiskEvidence& evidence, float radius_m,
                                           const SeedCheckOptions& options) {
  if (options.min_share > 0) return confirmed_share(evidence) >= options.min_share ? radius_m : 0;
  const float balanced_m = is_supported(evidence) ? balanced_radius(evidence, radius_m) : 0;
  if (balanced_m > 0 || radius_m <= options.min_radius_m) return balanced_m;
  std::uint32_t yes = 0, no = 0;
  for (std::size_t bin = 0; bin < static_cast<std::size_t>(options.core_rings); ++bin) {
    yes += evidence.confirmed[bin];
    no += evidence.contradicted[bin];
  }
  const bool has_core =
      yes >= options.core_rays && yes >= options.core_share * (double{1} * yes + no);
  return has_core ? std::max(options.core_radius * radius_m, options.min_radius_m) : 0;
}

/// The maximum radius at which contradicting rays are at most `max_share` of the confirming ones.
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

/// Maximum radius of a chosen disk that hardly any ray passes through; at least the radius that the
/// rays support for its seed, which may be contradicted by some rays (as leaves are).
ADASPLATS_HD inline float overhang_limit(const DiskEvidence& evidence, float radius_m,
                                         float seed_radius_m, double max_share) {
  const float strict_m = strict_radius(evidence, radius_m, max_share);
  if (strict_m >= radius_m) return radius_m;
  return std::max(strict_m, std::min(balanced_radius(evidence, radius_m), seed_radius_m));
}

}  // namespace adasplats
