// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Median distance, m, of points of one scan to the planes of another, after registration by a
/// rigid motion; NaN if fewer than 100 points of one are on planes of the other. Point to plane,
/// with weights that decrease with distance (Geman-McClure, from 50 to 5 cm). `points` and
/// `planes_of`: in the frames of their scans, m. `guess`: initial motion; poses need not be exact.
double scan_residual_m(std::span<const Vec3f> points, std::span<const Vec3f> planes_of,
                       const RigidTransform& guess, const Executor& executor);

/// The same for up to `max_pairs` of the chosen scans of a sequence, evenly spread, each against
/// the next chosen one.
std::vector<double> scan_residuals_m(const KittiSequence& sequence,
                                     std::span<const std::size_t> chosen, std::size_t max_pairs,
                                     const Executor& executor);

}  // namespace adasplats
