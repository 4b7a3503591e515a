// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

namespace adasplats {

/// What a stated divergence of a beam measures. Makers mean different things by the word.
enum class DivergenceKind : std::uint8_t {
  unknown,  ///< a full angle, its level not stated: taken for full_e2
  fwhm,     ///< full angle between half the intensity of the axis
  full_e2,  ///< full angle between 1/e^2 of the intensity of the axis
  half_e2,  ///< half of that: from the axis
};

/// The word of each kind, in sensor files and in Python.
inline constexpr std::pair<std::string_view, DivergenceKind> kDivergenceKinds[] = {
    {"fwhm", DivergenceKind::fwhm},
    {"1/e2", DivergenceKind::full_e2},
    {"1/e2-half", DivergenceKind::half_e2},
    {"unknown", DivergenceKind::unknown}};

/// A stated divergence as the full angle between 1/e^2 of the axis' intensity, which is what
/// LidarModel::divergence_rad holds. A Gaussian beam has the intensity exp(-2 r^2 / w^2) at the
/// radius r and half of it at r = w sqrt(ln(2) / 2), so that w = FWHM / sqrt(2 ln 2) = 0.849 FWHM
/// and the full angle 2 w is 1.699 FWHM.
double full_e2_angle_rad(double stated_rad, DivergenceKind kind);

}  // namespace adasplats
