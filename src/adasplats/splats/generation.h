// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "adasplats/cloud/label_scheme.h"
#include "adasplats/cloud/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/splats/build_model.h"
#include "adasplats/splats/grow.h"
#include "adasplats/splats/select.h"
#include "adasplats/surface/base_neighborhoods.h"

namespace adasplats {

/// Splats of one pass over a cloud, each with the rank of the point it was grown from.
struct Generation {
  std::vector<Disk> disks;
  std::vector<std::uint32_t> seeds;   ///< index of each splat's seed point in the cloud
  std::vector<SemanticGroup> groups;  ///< one a point of the cloud; empty for basic splats
  double radius_m = 0;                ///< R
  double error_m = 0;                 ///< E
};

/// Calls `step(name)` before each part of the work.
using StepSink = FunctionRef<void(std::string_view name)>;

/// One generation of splats from a cloud in canonical order. `groups` has one entry a point, or is
/// empty: then descriptors give them (SplatMethod::descriptors) or none are used (basic).
Generation generate_splats(const PointCloud& cloud, std::span<const SemanticGroup> groups,
                           const BuildOptions& options, const Executor& executor, StepSink step);

}  // namespace adasplats
