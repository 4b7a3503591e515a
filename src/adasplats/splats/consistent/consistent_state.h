// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/scene/intersect.h"
#include "adasplats/splats/rays/measured_rays.h"
#include "adasplats/surface/fused_points.h"
#include "adasplats/surface/plane_fit.h"

namespace adasplats {

/// What the steps of the consistent method know between two of them, on the host; empty before it
/// is made. Points are numbered in canonical order.
struct ConsistentState {
  FusedPoints fused;
  std::vector<LocalPlane> planes;   ///< one a cell
  std::vector<Disk> seeds;          ///< one a cell; without a radius: none
  std::vector<std::uint32_t> rays;  ///< points of the measured rays, in the rays' order
  std::vector<float> radii_m;       ///< one a cell: how large its disk may be
  std::vector<Disk> chosen;         ///< one a cell; without a radius: not chosen
};

/// Steps that show what they know: on several devices it is compared step by step.
class ShowsConsistentState {
 public:
  virtual ~ShowsConsistentState() = default;
  virtual ConsistentState state() const = 0;
  /// What a round of balance_seeds() or limit_overhangs() counts for these disks; after
  /// order_rays().
  virtual RayEvidence evidence(const std::vector<Disk>& disks,
                               const EvidenceOptions& options) const = 0;
};

}  // namespace adasplats
