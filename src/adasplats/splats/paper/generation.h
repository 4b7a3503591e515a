// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/splats/paper/grow.h"
#include "adasplats/splats/paper/paper_options.h"
#include "adasplats/splats/paper/select.h"
#include "adasplats/surface/base_neighborhoods.h"

namespace adasplats {

/// "Ground and surface using the planarity descriptor; linear using linearity; non-surface using
/// sphericity." Planar points are kept as `surface`.
ADASPLATS_HD inline SemanticGroup group_of(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::linear: return SemanticGroup::linear;
    case ShapeKind::planar: return SemanticGroup::surface;
    case ShapeKind::spherical: return SemanticGroup::non_surface;
  }
  return SemanticGroup::surface;
}

/// Parameters of neighbourhood and growing for one group.
struct GroupRules {
  NeighborLimit limit;
  GrowRules grow;
  bool like_base;  ///< its neighbourhood is the base neighbourhood
};

/// Rules of the four groups for the given R and E. `is_oriented`: normals face the sensors.
std::array<GroupRules, kSemanticGroups> group_rules(const PaperOptions& options, double radius_m,
                                                    double error_m, bool is_oriented);

/// Splats of one pass over a cloud, each with the rank of the point it was grown from.
struct Generation {
  std::vector<Disk> disks;
  std::vector<std::uint32_t> seeds;   ///< index of each splat's seed point in the cloud
  std::vector<SemanticGroup> groups;  ///< one per point of the cloud; empty for basic splats
  double radius_m = 0;                ///< R
  double error_m = 0;                 ///< E
};

/// Called before each part of the work with its name and its number of passes (ProgressPass); 0:
/// unknown.
using StepSink = FunctionRef<void(std::string_view name, int passes)>;

/// One generation of splats from a cloud in canonical order. `groups` has one entry per point. If
/// it is empty, local descriptors decide (PaperVariant::descriptors), or there are no groups
/// (basic).
Generation generate_splats(const PointCloud& cloud, std::span<const SemanticGroup> groups,
                           const PaperOptions& options, const Executor& executor, StepSink step);

}  // namespace adasplats
