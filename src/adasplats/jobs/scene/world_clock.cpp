// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/world_clock.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

namespace adasplats {

bool warn_of_world_clock(const World& world, double begin_s, double end_s, ProgressSink& progress) {
  double first_s = std::numeric_limits<double>::infinity(), last_s = -first_s;
  for (std::size_t i = 0; i < world.object_count(); ++i) {
    const Trajectory& poses = world.object(i).trajectory;
    if (poses.size() < 2) continue;
    first_s = std::min(first_s, poses.front().time_s);
    last_s = std::max(last_s, poses.back().time_s);
  }
  if (!(first_s < last_s) || (begin_s <= last_s && end_s >= first_s)) return false;
  std::array<char, 240> text{};
  std::snprintf(text.data(), text.size(),
                "no object of the world moves during the drive: the objects move from %.3f to %.3f "
                "s, the drive lasts from %.3f to %.3f s; both need the same clock (delay_s shifts "
                "an object)",
                first_s, last_s, begin_s, end_s);
  progress.warn(text.data());
  return true;
}

}  // namespace adasplats
