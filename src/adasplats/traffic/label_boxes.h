// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Boxes around the objects that the labels of a drive tell apart: points of one class and
/// instance. Objects of moving classes get boxes by fit_boxes(), those that hardly move and objects
/// of movable classes one by fit_box_at_rest(). Left out are instance 0, moving objects in fewer
/// than 3 scans, and objects at rest that extend over more than 20 m: their number was used again.
/// A warning counts their points if they are more than 1 % of all. Empty without such labels. Ids
/// are the instances, where those are unique. The same for any number of threads.
BoxContent boxes_of_labels(const KittiSequence& drive, const LabelScheme& scheme,
                           const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
