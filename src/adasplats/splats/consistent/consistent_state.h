// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/scene/intersect.h"
#include "adasplats/splats/rays/measured_rays.h"
#include "adasplats/surface/adaptive_planes.h"
#include "adasplats/surface/fused_points.h"

namespace adasplats {

/// Intermediate results of the consistent method, on the host; empty before the step that makes
/// them. Points are numbered in canonical order.
struct ConsistentState {
  FusedPoints fused;
  std::vector<LocalPlane> planes;   ///< one per cell
  std::vector<Disk> seeds;          ///< one per cell; radius 0: none
  std::vector<std::uint32_t> rays;  ///< points of the measured rays, in the order of the rays
  std::vector<float> radii_m;       ///< one per cell: maximum radius of its disk
  std::vector<Disk> chosen;         ///< one per cell; radius 0: not chosen
};

/// Steps that expose their intermediate results, so that tests can compare devices step by step.
class ShowsConsistentState {
 public:
  virtual ~ShowsConsistentState() = default;
  virtual ConsistentState state() const = 0;
  /// Counts rays for these disks as a round of balance_seeds() or limit_overhangs() does; valid
  /// after order_rays().
  virtual RayEvidence evidence(const std::vector<Disk>& disks,
                               const EvidenceOptions& options) const = 0;
};

}  // namespace adasplats
