// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace adasplats {

/// When something begins and ends, in the unit and clock of its file.
struct TimeSpan {
  double first = 0, last = 0;
};

/// What a LAS header says of its points' times: bit 0 of the global encoding ("LAS specification
/// 1.4 - R15", table 4). Other files say nothing.
enum class DeclaredClock { none, gps_week, adjusted_gps };

/// How far GPS time is ahead of UTC at a time, in seconds of GPS (since 1980-01-06). The table ends
/// with the leap second of 2017-01-01, 18 s; none has been announced since.
int gps_ahead_of_utc_s(double gps_s);

/// ClockPair::trajectory where it is the points' clock.
inline constexpr const char* kTheSameClock = "the same";

/// One way to understand the times of points and those of a trajectory together:
/// trajectory's s = points' s + offset_s, after both were brought to seconds by their units.
struct ClockPair {
  std::string points, trajectory;  ///< names of the clocks
  double points_unit_s = 1, trajectory_unit_s = 1;
  double offset_s = 0;

  /// A time of the points in the trajectory's clock, s.
  double in_trajectory(double time) const { return time * points_unit_s + offset_s; }
  TimeSpan in_trajectory(TimeSpan of_points) const {
    return {in_trajectory(of_points.first), in_trajectory(of_points.last)};
  }
  /// "points: adjusted GPS time; trajectory: GPS seconds of the week; offset 1000000000.000 s".
  std::string description() const;
};

/// All known ways by which the two spans overlap, the more usual first; each offset once. Known are
/// one clock for both, GPS time since 1980, adjusted (less 1e9 s), of the week, and on Unix's epoch
/// (without leap seconds); UTC on Unix's epoch and of the week; TAI on Unix's epoch, as PTP has it;
/// those on an epoch in s, ms, us and ns, too. `said` rules; where nothing fits by it, headers are
/// wrong often enough that the others are tried, and the name says so.
std::vector<ClockPair> possible_clocks(TimeSpan points, DeclaredClock declared,
                                       TimeSpan trajectory);

}  // namespace adasplats
