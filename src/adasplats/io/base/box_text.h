// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// A box in a message: "x 1 .. 2, y 3 .. 4, z 5 .. 6", without axes that have no bounds.
std::string box_text(Vec3d low, Vec3d high);

}  // namespace adasplats
