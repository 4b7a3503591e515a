// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/beam_returns.h"

#include <cmath>

#include "adasplats/evaluate/share.h"

namespace adasplats {
namespace {

/// How many of `whole` a share is of.
std::size_t count_of(double share, std::size_t whole) {
  return whole == 0 ? 0
                    : static_cast<std::size_t>(std::llround(share * static_cast<double>(whole)));
}

}  // namespace

BeamReturns beam_returns(const BeamAccuracy& returned, const EmptyBeamHits& empty) {
  const std::size_t missed = count_of(returned.no_hit, returned.rays);
  const std::size_t hit = returned.rays - missed;
  const std::size_t ghosts = count_of(empty.ghosts, empty.beams);
  BeamReturns result;
  result.returned = returned.rays;
  result.holes = share_of(missed, returned.rays);
  result.empty = empty.beams;
  result.ghosts = share_of(ghosts, empty.beams);
  const bool both_known = empty.beams > 0;
  result.precision = both_known ? share_of(hit, hit + ghosts) : kNaN;
  result.recall = both_known ? share_of(hit, returned.rays) : kNaN;
  result.f1 = both_known ? share_of(2 * hit, 2 * hit + ghosts + missed) : kNaN;
  return result;
}

}  // namespace adasplats
