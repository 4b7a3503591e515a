// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace adasplats {

/// Spearman's rank correlation, equal values sharing the mean of their ranks; NaN for fewer than
/// two pairs or if one side does not vary. Throws std::logic_error if sizes differ.
double rank_correlation(std::span<const float> a, std::span<const float> b);

/// How well predicted intensities agree with measured ones, whatever their scales.
struct IntensityAgreement {
  std::size_t beams = 0;
  double rank_correlation = 0;  ///< NaN if one side does not vary
  /// Of the line through the pairs with the least squares, in units of the full scale: 255 if a
  /// measured intensity is above 1, else 1. NaN without beams.
  double rmse_after_fit = 0;
};

/// Throws std::logic_error if sizes differ.
IntensityAgreement intensity_agreement(std::span<const float> predicted,
                                       std::span<const float> measured);

}  // namespace adasplats
