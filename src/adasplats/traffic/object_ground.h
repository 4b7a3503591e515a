// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "adasplats/traffic/recorded_object.h"

namespace adasplats {

/// Removes the ground below an object: labelled boxes are often lower than it. The ground is the
/// plane, level to 6 degrees, through the lowest points of at least a tenth of the box's base
/// where nothing rises from it at once, as sides of objects do; without one, or with points
/// below it, nothing is removed. Beams that ended on the ground become passing ones. Returns the
/// number of removed points.
std::size_t remove_ground(RecordedObject& object);

}  // namespace adasplats
