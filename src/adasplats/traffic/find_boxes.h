// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/executor.h"
#include "adasplats/traffic/fit_boxes.h"
#include "adasplats/traffic/loose_points.h"
#include "adasplats/traffic/track_clusters.h"

namespace adasplats {

struct FindBoxesOptions {
  ClusterOptions clusters;
  TrackOptions tracks;
  BoxFitOptions boxes;
  /// Minimum fraction of loose points in an object's boxes; lower ones indicate what is at rest.
  double min_loose = 0.4;
  double margin_m = 0.4;  ///< clusters whose middle is in a box grown by this belong to its object
};

/// The boxes of what moved in a drive, from the loose points of its scans: clusters, tracks of
/// clusters, boxes around them. Objects in several clusters become one. Ids from 1.
std::vector<BoxTrack> find_boxes(std::span<const LoosePoints> loose,
                                 FunctionRef<double(Vec3d)> height_below,
                                 const FindBoxesOptions& options, const Executor& executor);

}  // namespace adasplats
