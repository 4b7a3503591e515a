// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// What a model has where measured beams returned nothing.
struct EmptyBeamHits {
  std::size_t beams = 0;  ///< that are known to have returned nothing; 0: the scans do not tell
  double ghosts = 0;      ///< share of these that hit the model within `reach_m`; NaN of none
  double reach_m = 0;     ///< all but one in twenty of the scans' points are nearer
};

/// All points of a sequence (read_all_returns()) with their beams' origins, lasers and scans,
/// relative to `origin`.
PointCloud cloud_of_scans(const KittiSequence& sequence, Vec3d origin, const Executor& executor);

/// Casts the beams of held-out scans that returned nothing (find_empty_beams()). None are known of
/// scans without rings. Points in boxes of moving objects count: their beams did return. Errors:
/// those of read_kitti_points.
EmptyBeamHits cast_empty_beams(const Tracer& tracer, Vec3d scene_origin,
                               const KittiSequence& sequence, const Executor& executor);

}  // namespace adasplats
