// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/box_text.h"

#include <cmath>

#include "adasplats/io/base/number_text.h"

namespace adasplats {

std::string box_text(Vec3d low, Vec3d high) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(low[axis]) && !std::isfinite(high[axis])) continue;
    text += (text.empty() ? "" : ", ") + std::string(1, "xyz"[axis]) + " " +
            decimal_text(low[axis]) + " .. " + decimal_text(high[axis]);
  }
  return text;
}

}  // namespace adasplats
