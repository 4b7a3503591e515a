// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "adasplats/evaluate/resimulate.h"

namespace adasplats {

// Private to evaluate/: shared by the comparisons of beams.

/// The range error of a beam that hit nothing.
inline constexpr float kNoHitError = std::numeric_limits<float>::quiet_NaN();

/// Summarises predicted - measured ranges in m, one per beam, kNoHitError for beams without a hit.
/// Errors equal to a bound are within it. The median of an even number is the mean of the middle
/// two, the 90th percentile is by nearest rank; both and the means are NaN if no beam hits. Without
/// beams all shares are 0.
BeamAccuracy accuracy_of(const std::vector<float>& errors_m);

/// Median of one or more values, the mean of the middle two of an even number. Reorders them.
double median_of(std::vector<float>& values);
/// The smallest value that `percent` of one or more values do not exceed. Reorders them.
double percentile_of(std::vector<float>& values, std::size_t percent);

/// Whether a beam on an object of this mobility counts.
inline bool is_counted(Mobility mobility, bool drop_moving, bool drop_movable) {
  switch (mobility) {
    case Mobility::fixed: return true;
    case Mobility::movable: return !drop_movable;
    case Mobility::moving: return !drop_moving;
  }
  return true;
}

}  // namespace adasplats
