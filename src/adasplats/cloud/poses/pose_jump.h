// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// A step between consecutive poses that is too fast for a vehicle.
struct PoseJump {
  std::size_t later = 0;  ///< index of the pose after the step
  double step_m = 0, step_s = 0;
  double median_mps = 0;  ///< speed of all steps

  /// "54.1 m within 0.1 s (541 m/s; median 11 m/s)".
  std::string text() const;
};

/// The fastest step of more than 10 m and 100 m/s that is also faster than 3 times the median
/// speed, or 20 times if the times are placeholders. `steps_s`: the durations of the steps; empty:
/// the differences of the poses' times.
std::optional<PoseJump> find_pose_jump(const Trajectory& poses, bool has_times,
                                       std::span<const double> steps_s = {});

}  // namespace adasplats
