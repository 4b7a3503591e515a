// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// What the user says about the labels of points that a model or a mesh is made of.
struct LabelUse {
  std::string labels;  ///< --labels as given; may be empty
  DynamicRemoval removal = DynamicRemoval::movable;
  bool removal_is_asked = false;  ///< else `removal` is the default
};

/// Labels and removals without any effect: errors (usage) where they are asked for, else a warning
/// where the points have labels.
void check_label_use(const LabelUse& use, const PointCloud& cloud, const LabelScheme* scheme,
                     ProgressSink& progress);

}  // namespace adasplats
