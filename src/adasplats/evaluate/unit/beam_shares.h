// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/unit/unit_beams.h"
#include "adasplats/sensors/calibrated_sensor.h"

// A share is the rank of a beam, from 0 to 1, among all beams with the same expectation.
namespace adasplats {

/// Number of neighbouring rings and columns that share a random number.
struct SharePatch {
  std::uint32_t rings = 1, columns = 1;
};

/// A random number from 0 to 1, the same for all beams of a patch. `stream`: its purpose.
inline double common_share(const SensorBeam& beam, SharePatch patch, std::uint64_t stream) {
  const std::uint64_t place =
      std::uint64_t{beam.ring / patch.rings} << 32 | beam.column / patch.columns;
  return Random(beam.scan, stream, place).uniform();
}

/// The share of a beam among all beams to which an event happens with probability `chance`. It is
/// below `chance` if the event has happened to this beam, otherwise above; within these bounds it
/// is random, but the same for neighbours, so runs of events remain runs if the chance is another
/// one. Uses `stream` and the next one.
inline double share_by_chance(const SensorBeam& beam, double chance, bool happened,
                              SharePatch patch_of_those, SharePatch patch_of_others,
                              std::uint64_t stream) {
  if (happened) return chance * common_share(beam, patch_of_those, stream);
  return chance + (1 - chance) * common_share(beam, patch_of_others, stream + 1);
}

/// Smooths the shares of neighbouring beams (IntensityFit::shares) until simulated intensities vary
/// no more from beam to beam than measured ones: shares applied in another scene add to the jumps
/// between the surfaces of its model. Returns the remaining contrast, from 1 (unchanged) to 0 (each
/// share is the mean of three).
double damp_shares(std::span<const SensorBeam> beams, const SensorIntensity& unit,
                   std::vector<float>& shares);

}  // namespace adasplats
