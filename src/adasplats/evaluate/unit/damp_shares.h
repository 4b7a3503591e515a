// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/evaluate/unit/unit_beams.h"
#include "adasplats/sensors/calibrated_sensor.h"

namespace adasplats {

/// Draws the shares of neighbouring beams (IntensityFit::shares) together, as far as intensities
/// would otherwise differ more from beam to beam than measured ones do: where shares of one place
/// are applied in another, the jumps between the surfaces of a model are there once more. Gives by
/// how much: 1, not at all, to 0, each has the mean of three.
double damp_shares(std::span<const UnitBeam> beams, const UnitIntensity& unit,
                   std::vector<float>& shares);

}  // namespace adasplats
