// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "adasplats/evaluate/resimulate.h"

namespace adasplats {

/// The range error of a beam that hit nothing.
inline constexpr float kNoHitError = std::numeric_limits<float>::quiet_NaN();

/// Sums up predicted - measured ranges in m, one a beam, kNoHitError for beams without a hit.
/// Bounds count as within. The median of an even number is the mean of the middle two, the 90th
/// percentile is by nearest rank; both and the means are NaN where no beam hit. No beams at all
/// give shares of 0.
BeamAccuracy accuracy_of(const std::vector<float>& errors_m);

}  // namespace adasplats
