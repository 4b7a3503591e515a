// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "adasplats/evaluate/empty_beams_cast.h"
#include "adasplats/evaluate/resimulate.h"

namespace adasplats {

/// How well a model tells which beams return: a beam that hits it is said to. Shares are from 0 to
/// 1; NaN of nothing.
struct BeamReturns {
  std::size_t returned = 0;  ///< measured beams that did
  double holes = 0;          ///< share of these that hit nothing, at any distance
  std::size_t empty = 0;     ///< beams that are known to have returned nothing
  double ghosts = 0;         ///< share of these that hit the model (EmptyBeamHits)
  /// Of "this beam returns"; NaN where no empty beams are known.
  double precision = 0;
  double recall = 0;
  double f1 = 0;
};

/// Joins beams that returned, cast again, with those that did not.
BeamReturns beam_returns(const BeamAccuracy& returned, const EmptyBeamHits& empty);

}  // namespace adasplats
