// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/model/label_use.h"

#include "adasplats/core/error.h"

namespace adasplats {

void check_label_use(const LabelUse& use, const PointCloud& cloud, const LabelScheme* scheme,
                     ProgressSink& progress) {
  if (cloud.classes.empty() && !use.labels.empty()) {
    throw Error(ErrorKind::usage, "`labels` " + use.labels +
                                      ": the points have no labels; leave it out (`label_field` "
                                      "names their column)");
  }
  const std::string why = why_nothing_is_removed(cloud, scheme, use.removal);
  if (why.empty()) return;
  if (use.removal_is_asked) {
    throw Error(ErrorKind::usage, "`remove` " + std::string(name_of(use.removal)) + ": " + why);
  }
  if (!cloud.classes.empty()) progress.warn(why + "; nothing is removed");
}

}  // namespace adasplats
