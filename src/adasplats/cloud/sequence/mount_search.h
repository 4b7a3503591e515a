// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "adasplats/cloud/sequence/cone_fit.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// The mounts that are searched.
inline constexpr double kMaxAside_m = 2;
inline constexpr double kLowest_m = -0.5;
inline constexpr double kHighest_m = 2.5;
inline constexpr double kMaxTilt_rad = 1.25 * kDegree;

/// The best mount of one sensor: a grid of places and tilts, judged by the points that lead
/// farthest (far ones, sparse lasers), then Gauss-Newton from the best of them with more and more
/// points.
ConeFit searched_fit(std::span<const Vec3d> points, const ConeTable& table,
                     const Executor& executor);

}  // namespace adasplats
