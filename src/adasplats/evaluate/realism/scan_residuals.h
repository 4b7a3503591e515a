// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// How far points of one scan lie from the planes of another one, once the scans are laid on each
/// other as well as a rigid motion can: the median distance, m; NaN where fewer than 100 points of
/// one lie on planes of the other. Point to plane, with weights that fall with the distance
/// (Geman-McClure, from 50 to 5 cm). `points` and `planes_of`: in the frames of their scans, m.
/// `guess`: to begin with; poses need not be exact.
double scan_residual_m(std::span<const Vec3f> points, std::span<const Vec3f> planes_of,
                       const RigidTransform& guess, const Executor& executor);

/// That of up to `most` of the chosen scans of a sequence, evenly spread, each against the chosen
/// one behind it.
std::vector<double> scan_residuals_m(const KittiSequence& sequence,
                                     std::span<const std::size_t> chosen, std::size_t most,
                                     const Executor& executor);

}  // namespace adasplats
