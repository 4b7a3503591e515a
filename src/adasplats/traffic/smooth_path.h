// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace adasplats {

/// A coordinate over time.
struct SmoothPath {
  std::vector<double> values, rates;  ///< one per time; rates per second
};

/// The most likely path through measurements of one coordinate, for motion with random
/// accelerations: a Kalman filter with a constant-velocity model and the Rauch-Tung-Striebel
/// smoother. Measurements far from the path count less (a second pass). `times_s` ascend.
/// `deviations`: standard deviations of the values. `acceleration`: of the motion, over one second.
SmoothPath smooth_path(std::span<const double> times_s, std::span<const double> values,
                       std::span<const double> deviations, double acceleration);

}  // namespace adasplats
