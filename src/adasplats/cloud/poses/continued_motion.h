// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// One more pose `by_s` before the first and one behind the last, as the motion within that time
/// there goes on: sensors sweep a little longer than there are poses. Of a single pose: that pose.
Trajectory with_motion_continued(Trajectory poses, double by_s);

}  // namespace adasplats
