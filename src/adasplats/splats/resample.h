// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/splats/generation.h"

namespace adasplats {

/// A cloud for the second generation, in no particular order, with the group of each point.
struct ResampledCloud {
  PointCloud cloud;
  std::vector<SemanticGroup> groups;
  std::size_t new_points = 0;
};

/// Paper section "Splat-Based Resampling and Denoising": where the density of splats is below its
/// mean, new points half way between neighbouring splats of the same class (group without labels)
/// whose normals agree. `cloud` is what `first` was generated from.
ResampledCloud resample(const PointCloud& cloud, const Generation& first,
                        const BuildOptions& options, const Executor& executor);

}  // namespace adasplats
