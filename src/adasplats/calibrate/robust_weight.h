// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/host_device.h"

namespace adasplats {

/// Weight of a residual in a least-squares fit, 0 to 1 (Geman and McClure); a quarter at `width_m`.
ADASPLATS_HD inline double robust_weight(double residual_m, double width_m) {
  const double squared = width_m * width_m;
  const double share = squared / (squared + residual_m * residual_m);
  return share * share;
}

}  // namespace adasplats
