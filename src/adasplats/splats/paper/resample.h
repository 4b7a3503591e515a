// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/splats/paper/generation.h"

namespace adasplats {

/// Whether objects are so thin that removing points would lose them.
ADASPLATS_HD inline bool is_thin(SemanticGroup group) {
  return group == SemanticGroup::linear || group == SemanticGroup::non_surface;
}

/// Number of the points missing in a neighbourhood that one of its splats makes. The paper
/// processes splats one after another, and each new point raises the density of all splats around
/// it. Here splats are independent, so the `density` splats of a neighbourhood share the missing
/// points, each share rounded: none if more than two thirds of the target exist. The paper's splats
/// would make the last third one by one.
ADASPLATS_HD inline int share_of_missing(double wanted, std::uint32_t density) {
  return static_cast<int>(std::lround((wanted - density) / density));
}

/// A new point half way between two splats.
ADASPLATS_HD inline Vec3f midpoint(const Disk& a, const Disk& b) {
  return 0.5F * (a.center + b.center);
}

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
                        const PaperOptions& options, const Executor& executor);

}  // namespace adasplats
