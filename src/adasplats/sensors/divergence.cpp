// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/divergence.h"

#include <cmath>
#include <numbers>

namespace adasplats {

double full_e2_angle_rad(double stated_rad, DivergenceKind kind) {
  switch (kind) {
    case DivergenceKind::fwhm: return 2.0 * stated_rad / std::sqrt(2.0 * std::numbers::ln2);
    case DivergenceKind::half_e2: return 2.0 * stated_rad;
    case DivergenceKind::full_e2:
    case DivergenceKind::unknown: break;
  }
  return stated_rad;
}

}  // namespace adasplats
