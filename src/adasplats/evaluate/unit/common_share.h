// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/unit/unit_beams.h"

namespace adasplats {

/// So many rings and columns have a number in common.
struct SharePatch {
  std::uint32_t rings = 1, columns = 1;
};

/// A number from 0 to 1 that the beams of a patch have in common. `stream`: what it is for.
inline double common_share(const UnitBeam& beam, SharePatch patch, std::uint64_t stream) {
  const std::uint64_t place =
      std::uint64_t{beam.ring / patch.rings} << 32 | beam.column / patch.columns;
  return Random(beam.scan, stream, place).uniform();
}

/// Of all beams to which something happens at such a chance, the share to which it happens before
/// this one. Those to which it did are below the chance, others above; where within, nobody knows:
/// what is drawn is alike in neighbours, so that runs stay runs where the chance is another one.
/// `stream` and the next one are used.
inline double share_by_chance(const UnitBeam& beam, double chance, bool happened,
                              SharePatch patch_of_those, SharePatch patch_of_others,
                              std::uint64_t stream) {
  if (happened) return chance * common_share(beam, patch_of_those, stream);
  return chance + (1 - chance) * common_share(beam, patch_of_others, stream + 1);
}

}  // namespace adasplats
