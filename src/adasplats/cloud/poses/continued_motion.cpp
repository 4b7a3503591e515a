// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/continued_motion.h"

#include <algorithm>

namespace adasplats {

Trajectory with_motion_continued(Trajectory poses, double by_s) {
  if (poses.size() < 2) return poses;
  const double begin_s = poses.front().time_s, end_s = poses.back().time_s;
  const auto mirrored = [&](double at_s, double inside_s) {
    const RigidTransform at = interpolate(poses, at_s), inside = interpolate(poses, inside_s);
    return TimedPose{2 * at_s - inside_s, at * (inside.inverse() * at)};
  };
  const TimedPose first = mirrored(begin_s, std::min(begin_s + by_s, end_s));
  const TimedPose last = mirrored(end_s, std::max(end_s - by_s, begin_s));
  poses.insert(poses.begin(), first);
  poses.push_back(last);
  return poses;
}

}  // namespace adasplats
