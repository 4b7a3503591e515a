// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "adasplats/core/executor.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/measured_rays.h"

namespace adasplats {

/// What the rays say of one disk: counts of its rings of equal area, from the middle outward.
struct DiskEvidence {
  std::span<const std::uint32_t> confirmed;
  std::span<const std::uint32_t> contradicted;

  bool seen() const;
};

DiskEvidence evidence_of(const RayEvidence& evidence, std::size_t disk);

/// The radius at which confirming rays outnumber contradicting ones by most; 0 where there is
/// none, the radius itself where nobody speaks against it.
float balanced_radius(const DiskEvidence& evidence, float radius_m);

/// Whether more than chance speaks for a disk at its balanced radius. The middle of a disk stands
/// on the points that it is made from, so their rays confirm some of the middle, whatever goes
/// through the rest: of n contradicting rays, the square root of n may miss it by chance.
bool is_borne_out(const DiskEvidence& evidence);

struct JudgeOptions {
  int core_rings = 2;             ///< the middle of a disk
  std::uint32_t core_rays = 3;    ///< that must confirm the middle...
  double core_share = 0.3;        ///< ...and be so much of those that cross it, to give it a chance
  float core_radius = 0.25F;      ///< of the radius: what is tried next
  float least_radius_m = 0.015F;  ///< not below this
};

/// What the rays leave of a disk: its balanced radius; where that is none but many rays confirm
/// the very middle (a bar, a twig), a small disk, to be judged again; else 0.
float judged_radius(const DiskEvidence& evidence, float radius_m, const JudgeOptions& options);

/// The largest radius at which at most `most_share` as many rays contradict as confirm.
float strict_radius(const DiskEvidence& evidence, float radius_m, double most_share);

struct SettleOptions {
  double reach_m = 0.4;       ///< rays whose range is farther from the disk say nothing of it
  double scale_m = 0.08;      ///< of the Cauchy weights on range errors
  double prior_rays = 3;      ///< as many rays say that the disk is right as it is
  double least_cosine = 0.1;  ///< grazing rays count no more than at this cosine
  std::uint32_t least_rays = 4;
  double most_shift_m = 0.1;
};

/// Moves every disk along its normal to where the rays that meet it first say the surface is. The
/// first of several disks a few centimetres apart is met too early on average: this takes that
/// bias out. Sums are whole numbers: the same on any number of threads.
void settle_disks(std::span<Disk> disks, const MeasuredRays& rays, const SettleOptions& options,
                  const Executor& executor);

}  // namespace adasplats
