// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "adasplats/cloud/sequence/calibration.h"

namespace adasplats {

/// The motion of the whole that lays corrected poses on the given ones. Both where the poses are
/// and how they are turned tell it: a long way tells its direction better than the turns of single
/// poses do where these err. Each counts by how far its own differences spread (their medians), and
/// poses that differ by far more than the others hardly count. Identity of none.
RigidTransform onto_given(std::span<const PoseCorrection> poses);

/// What the poses get once all of them are moved as a whole.
PoseCorrection moved(const PoseCorrection& pose, const RigidTransform& motion);

}  // namespace adasplats
