// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// A point in world coordinates with the time of its measurement.
struct TimedPoint {
  Vec3d world;
  double time = 0;  ///< in the unit and clock of its file
};

/// Points of a recording by which clocks are judged.
struct SweepSample {
  std::vector<TimedPoint> points;  ///< evenly chosen
  std::vector<std::vector<TimedPoint>>
      sweeps;  ///< all that were measured within 0.1 s, of some times
};

/// How measured points look from where a trajectory has their sensor at their times.
struct SweepView {
  std::size_t points = 0;
  double median_range_m = 0;
  double share_far = 0;  ///< of the points, beyond kFarInStreets_m and not below a flying sensor
  Vec3d median_way_m;    ///< from the sensor to the points, componentwise
  /// Entropy of the directions in the sensor's frame plus three mean logarithms of the range: what
  /// the points' places are unlikely by (minus logarithm of their density), for a sensor that looks
  /// into the directions found and measures all magnitudes of range alike. A sensor looks into few
  /// directions (a plane, cones, a field of view); from elsewhere its points are all over the
  /// sphere, or far away.
  double scatter = 0;
  double share_behind = 0;       ///< StationView's, mean of the sweeps
  std::size_t sweep_points = 0;  ///< of a sweep in the mean; 0: none had enough
  /// The largest share_behind that can be.
  double max_behind() const;

  /// The less the better a trajectory and a clock fit. What a spinning sensor measured hides behind
  /// other points as seen from elsewhere; the profiles of a mobile scanner do not, but leave their
  /// plane. Of a Pandar64 at 0 to 5 m/s it was 0.4 higher with a clock wrong by 0.3 s and 0.8 with
  /// 1 s; of simulated profilers at 8 to 33 m/s 1.5 to 3.7 and 2.7 to 5.8, of 16 beams at 1.2 m/s
  /// 0.5 and 1.1, of scanners 1000 m up at 60 m/s 0.0 to 0.2 and 0.7 to 0.9.
  double cost() const { return scatter + 10 * share_behind; }
};

/// A cost that is lower by less says nothing.
inline constexpr double kClearlyLess = 0.3;
/// Nor do fewer points say anything, nor sweeps of fewer.
inline constexpr std::size_t kMinEvidence = 1000, kMinOfSweep = 5000;
/// Largest share_behind of points that were measured from there, for sweeps with many points and
/// for others, whose cells of directions are coarse. A Pandar64 has 0.03 with 100,000 points a
/// sweep, thinned to 30,000 0.08, to 5000 0.14; taken to be at the vehicle's pose on the ground
/// 0.22 to 0.30, at 1 m instead of 1.85 m above it 0.16.
inline constexpr double kMaxHidden = 0.1, kMaxHiddenOfFew = 0.17;
inline constexpr std::size_t kManyOfSweep = 20'000;
/// Farther things are rarely measured from vehicles, m; sensors in the air look down steeply.
inline constexpr double kFarInStreets_m = 300;

/// `trajectory`: in seconds of its clock.
SweepView view_along(const SweepSample& sample, const ClockPair& clock,
                     const Trajectory& trajectory, const Executor& executor);

}  // namespace adasplats
