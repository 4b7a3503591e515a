// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/origins/clocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

namespace adasplats {
namespace {

constexpr double kWeek_s = 604800;
constexpr double kUnixOfGps_s = 315964800;  // 1980-01-06
constexpr double kAdjusted_s = 1e9;
constexpr double kTaiAheadOfGps_s = 19;
constexpr double kLatestGps_s = 2.5e9;  // 2059
// Adjusted times are of LAS 1.2 (2008); older recordings were converted, none before 1998.
constexpr double kEarliestAdjusted_s = -4.3e8;

/// Since when, in Unix's seconds, UTC is how far behind GPS (IERS Bulletin C).
struct LeapSecond {
  double unix_s;
  int behind_s;
};
constexpr std::array<LeapSecond, 18> kLeapSeconds = {{{362793600, 1},
                                                      {394329600, 2},
                                                      {425865600, 3},
                                                      {489024000, 4},
                                                      {567993600, 5},
                                                      {631152000, 6},
                                                      {662688000, 7},
                                                      {709948800, 8},
                                                      {741484800, 9},
                                                      {773020800, 10},
                                                      {820454400, 11},
                                                      {867715200, 12},
                                                      {915148800, 13},
                                                      {1136073600, 14},
                                                      {1230768000, 15},
                                                      {1341100800, 16},
                                                      {1435708800, 17},
                                                      {1483228800, 18}}};
constexpr int kFirstLeapOfLidars = 13, kLastLeap = 18;

int leap_of_unix(double unix_s) {
  int behind_s = 0;
  for (const LeapSecond& leap : kLeapSeconds)
    if (unix_s >= leap.unix_s) behind_s = leap.behind_s;
  return behind_s;
}

enum class Scale { gps, utc, tai };

/// A clock that some times may be of: an epoch, or the beginning of the week.
struct Reading {
  std::string name;
  double unit_s = 1;
  bool is_weekly = false;
  Scale scale = Scale::gps;
  double epoch_s = 0;  ///< GPS seconds (before leaps) of its zero

  /// GPS seconds of a value; of a week's begin where it is weekly.
  double gps_of(double value) const {
    const double s = value * unit_s + epoch_s;
    if (scale == Scale::utc && !is_weekly) return s + leap_of_unix(s + kUnixOfGps_s);
    return s;
  }
};

bool is_of_an_epoch(const Reading& reading, double value) {
  const double gps_s = reading.gps_of(value);
  return gps_s >= 0 && gps_s <= kLatestGps_s;
}

std::vector<Reading> readings_of(double value, DeclaredClock declared) {
  std::vector<Reading> readings;
  const bool fits_week = value >= 0 && value < 2 * kWeek_s;
  const bool may_be_adjusted = value >= kEarliestAdjusted_s && value + kAdjusted_s <= kLatestGps_s;
  if (declared == DeclaredClock::adjusted_gps)
    return {{"adjusted GPS time", 1, false, Scale::gps, kAdjusted_s}};
  if (fits_week) readings.push_back({"GPS seconds of the week", 1, true, Scale::gps, 0});
  if (declared == DeclaredClock::gps_week) return readings;
  if (fits_week) readings.push_back({"UTC seconds of the week", 1, true, Scale::utc, 0});
  struct Unit {
    double s;
    const char* name;
  };
  for (const Unit unit : {Unit{1, "s"}, Unit{1e-3, "ms"}, Unit{1e-6, "us"}, Unit{1e-9, "ns"}}) {
    const std::string in = std::string(" in ") + unit.name;
    // In the order of how usual they are. Weeks would be 1980 here and are no recordings.
    const std::array<Reading, 4> known = {
        {{"GPS time since 1980" + in, unit.s, false, Scale::gps, 0},
         {"UTC since 1970" + in, unit.s, false, Scale::utc, -kUnixOfGps_s},
         {"GPS time since 1970" + in, unit.s, false, Scale::gps, -kUnixOfGps_s},
         {"TAI (PTP) since 1970" + in, unit.s, false, Scale::tai,
          -kUnixOfGps_s - kTaiAheadOfGps_s}}};
    constexpr double kEarliestRecording_s = 5.6e8;  // 1997
    for (const Reading& reading : known)
      if (is_of_an_epoch(reading, value) && reading.gps_of(value) > kEarliestRecording_s)
        readings.push_back(reading);
  }
  if (may_be_adjusted) readings.push_back({"adjusted GPS time", 1, false, Scale::gps, kAdjusted_s});
  return readings;
}

/// The pairs that two readings allow: which week it was, and how many leap seconds there were, is
/// not in the times themselves where they are of a week.
std::vector<double> offsets_of(const Reading& p, TimeSpan points, const Reading& t,
                               TimeSpan trajectory) {
  std::vector<double> offsets;
  const auto at_points = p.gps_of(points.first), at_trajectory = t.gps_of(trajectory.first);
  const double shift_p = at_points - points.first * p.unit_s;
  const double shift_t = at_trajectory - trajectory.first * t.unit_s;
  if (!p.is_weekly && !t.is_weekly) return {shift_p - shift_t};
  const auto behind = [](const Reading& reading, double gps_s) {
    return reading.scale == Scale::utc ? gps_ahead_of_utc_s(gps_s) : 0;
  };
  if (p.is_weekly && t.is_weekly) {
    if (p.scale == t.scale) return {0};
    for (int leap_s = kLastLeap; leap_s >= kFirstLeapOfLidars; --leap_s)
      offsets.push_back(p.scale == Scale::gps ? -leap_s : leap_s);
    return offsets;
  }
  const double dated_gps_s = p.is_weekly ? at_trajectory : at_points;
  const double week =
      std::floor((dated_gps_s - behind(p.is_weekly ? p : t, dated_gps_s)) / kWeek_s);
  // A recording goes on behind the end of its week, or begins a little before the trajectory.
  for (const double k : {week, week - 1, week + 1}) {
    const double begin_s = k * kWeek_s + behind(p.is_weekly ? p : t, dated_gps_s);
    offsets.push_back(p.is_weekly ? begin_s - shift_t : shift_p - begin_s);
  }
  return offsets;
}

bool overlap(TimeSpan a, TimeSpan b) { return a.first <= b.last && b.first <= a.last; }

void add_pair(std::vector<ClockPair>& pairs, ClockPair pair, TimeSpan points, TimeSpan trajectory) {
  const TimeSpan seconds = {trajectory.first * pair.trajectory_unit_s,
                            trajectory.last * pair.trajectory_unit_s};
  if (!overlap(pair.in_trajectory(points), seconds)) return;
  const bool is_known = std::ranges::any_of(pairs, [&](const ClockPair& other) {
    return std::fabs(other.offset_s - pair.offset_s) < 1e-3 &&
           other.points_unit_s == pair.points_unit_s;
  });
  if (!is_known) pairs.push_back(std::move(pair));
}

std::vector<ClockPair> pairs_of(TimeSpan points, DeclaredClock declared, TimeSpan trajectory) {
  // Beyond it seconds are of no epoch; stamps of finer units are.
  constexpr double kMaxSeconds = 5e9;
  std::vector<ClockPair> pairs;
  if (std::fabs(points.last) < kMaxSeconds && std::fabs(trajectory.last) < kMaxSeconds)
    add_pair(pairs, {"one clock", kTheSameClock, 1, 1, 0}, points, trajectory);
  // The span's end: its begin may be before an epoch by a rounding.
  for (const Reading& p : readings_of(points.last, declared))
    for (const Reading& t : readings_of(trajectory.last, DeclaredClock::none)) {
      const bool is_same = p.name == t.name;
      for (const double offset_s : offsets_of(p, points, t, trajectory))
        add_pair(pairs,
                 {is_same ? "one clock, " + p.name : p.name, is_same ? kTheSameClock : t.name,
                  p.unit_s, t.unit_s, is_same && !p.is_weekly ? 0 : offset_s},
                 points, trajectory);
    }
  return pairs;
}

}  // namespace

int gps_ahead_of_utc_s(double gps_s) {
  int ahead_s = 0;
  for (const LeapSecond& leap : kLeapSeconds)
    if (gps_s >= leap.unix_s - kUnixOfGps_s + leap.behind_s) ahead_s = leap.behind_s;
  return ahead_s;
}

std::string ClockPair::description() const {
  std::array<char, 64> offset{};
  std::snprintf(offset.data(), offset.size(), "; offset %.3f s", offset_s);
  if (trajectory == kTheSameClock) return points + offset.data();
  return "points: " + points + "; trajectory: " + trajectory + offset.data();
}

std::vector<ClockPair> possible_clocks(TimeSpan points, DeclaredClock declared,
                                       TimeSpan trajectory) {
  std::vector<ClockPair> pairs = pairs_of(points, declared, trajectory);
  if (!pairs.empty() || declared == DeclaredClock::none) return pairs;
  pairs = pairs_of(points, DeclaredClock::none, trajectory);
  for (ClockPair& pair : pairs) pair.points += " (not what the LAS header says)";
  return pairs;
}

}  // namespace adasplats
