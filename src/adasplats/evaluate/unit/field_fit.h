// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/evaluate/unit/unit_beams.h"
#include "adasplats/sensors/unit_intensity.h"

namespace adasplats {

/// How many columns apart beams of a ring are whose correlation is measured.
inline constexpr std::array<std::size_t, 14> kFieldLags = {1,  2,  3,  4,  6,  8,  12,
                                                           16, 24, 32, 48, 64, 96, 128};
using LagCorrelations = std::array<double, kFieldLags.size()>;

/// The number below which a share of the standard normal ones lies; the share is kept within 1e-6
/// of 0 and 1.
double normal_quantile(double share);

/// Correlation of octave `octave` of a field (beam_field.h) between columns so far apart.
double octave_correlation(std::size_t octave, std::size_t lag);

/// The shares whose correlations come nearest (least squares, none below 0, the sum at most 1).
FieldShares shares_of(const LagCorrelations& correlations);

/// Correlation of a normal field of which each beam's event happens where the field is below what
/// its chance asks: the one with which as many pairs of events would be seen (the tetrachoric
/// correlation, for chances that differ). NaN chance: the beam takes no part.
LagCorrelations latent_correlations(std::span<const UnitBeam> beams,
                                    std::span<const double> chances,
                                    std::span<const std::uint8_t> events);

/// Mean products of numbers of beams; NaN: takes no part.
LagCorrelations lag_products(std::span<const UnitBeam> beams, std::span<const double> numbers);

}  // namespace adasplats
