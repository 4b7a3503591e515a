// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/pose_jump.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include "adasplats/core/maths/median.h"

namespace adasplats {

std::string PoseJump::text() const {
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(), "%.1f m within %.3g s (%.0f m/s; median %.1f m/s)",
                step_m, step_s, step_m / step_s, median_mps);
  return text.data();
}

std::optional<PoseJump> find_pose_jump(const Trajectory& poses, bool has_times,
                                       std::span<const double> steps_s) {
  constexpr double kMinStep_m = 10, kMaxSpeed_mps = 100;
  constexpr double kMaxOfMedian = 3, kMaxOfMedianWithoutTimes = 20;
  std::vector<PoseJump> steps;
  std::vector<double> speeds_mps;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const double step_s = steps_s.empty() ? poses[k].time_s - poses[k - 1].time_s : steps_s[k - 1];
    const double step_m =
        length(poses[k].world_from_sensor.translation - poses[k - 1].world_from_sensor.translation);
    if (!(step_s > 0)) continue;
    steps.push_back({k, step_m, step_s});
    speeds_mps.push_back(step_m / step_s);
  }
  if (steps.empty()) return std::nullopt;
  const double median_mps = upper_median_of(speeds_mps);
  const double limit_mps =
      std::max(kMaxSpeed_mps, (has_times ? kMaxOfMedian : kMaxOfMedianWithoutTimes) * median_mps);
  std::optional<PoseJump> fastest;
  for (const PoseJump& step : steps) {
    const double speed_mps = step.step_m / step.step_s;
    if (step.step_m <= kMinStep_m || speed_mps <= limit_mps) continue;
    if (!fastest || speed_mps > fastest->step_m / fastest->step_s) fastest = step;
  }
  if (fastest) fastest->median_mps = median_mps;
  return fastest;
}

}  // namespace adasplats
