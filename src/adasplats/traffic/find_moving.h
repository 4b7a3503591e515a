// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/traffic/find_boxes.h"

namespace adasplats {

struct FindMovingOptions {
  SeenSpaceOptions seen;
  LooseOptions loose;
  FindBoxesOptions boxes;
};

/// Finds what moved in the chosen scans of a drive, without labels: points where other scans saw
/// free space, grouped to clusters, tracked, with boxes around them. The same for any number of
/// threads. Memory: about 70 scans at a time, and the loose points of all.
std::vector<BoxTrack> find_moving(const KittiSequence& drive, std::span<const std::size_t> scans,
                                  const FindMovingOptions& options, const Executor& executor,
                                  ProgressSink& progress);

}  // namespace adasplats
