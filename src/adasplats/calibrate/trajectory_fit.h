// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "adasplats/cloud/sequence/calibration.h"

namespace adasplats {

/// The rigid motion that aligns corrected poses to the given ones. It uses positions and
/// orientations: over a long trajectory, positions constrain the heading better than noisy
/// orientations. Each is weighted by the spread (median) of its differences, and outliers have
/// little weight. The identity if there are no poses.
RigidTransform onto_given(std::span<const PoseCorrection> poses);

/// The correction of a pose after a rigid motion of all poses.
PoseCorrection moved(const PoseCorrection& pose, const RigidTransform& motion);

}  // namespace adasplats
