// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/evaluate/resimulate.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// What measured beams without return hit in a model.
struct EmptyBeamHits {
  std::size_t beams = 0;  ///< beams identified as without return; 0: the scans do not allow it
  double ghosts = 0;      ///< share of these that hit the model within `reach_m`; NaN without beams
  double reach_m = 0;     ///< 19 of 20 points of the scans are nearer
};

/// All points of a sequence (read_all_returns()) with the origins, lasers and scans of their beams,
/// relative to `origin`.
PointCloud cloud_of_scans(const KittiSequence& sequence, Vec3d origin, const Executor& executor);

/// Casts the beams without return of held-out scans (find_empty_beams()). Scans without rings have
/// none. Points in boxes of moving objects count as returns. Errors: those of read_kitti_points.
EmptyBeamHits cast_empty_beams(const Tracer& tracer, Vec3d scene_origin,
                               const KittiSequence& sequence, const Executor& executor);

/// How well a model predicts which beams return: it predicts a return for every beam that hits it.
/// Shares are from 0 to 1, or NaN.
struct BeamReturns {
  std::size_t returned = 0;  ///< measured beams with return
  double holes = 0;          ///< share of these that hit nothing, at any distance
  std::size_t empty = 0;     ///< beams identified as without return
  double ghosts = 0;         ///< share of these that hit the model (EmptyBeamHits)
  /// Of "this beam returns"; NaN without empty beams.
  double precision = 0;
  double recall = 0;
  double f1 = 0;
};

/// Combines beams with return, cast again, and beams without.
BeamReturns beam_returns(const BeamAccuracy& returned, const EmptyBeamHits& empty);

}  // namespace adasplats
