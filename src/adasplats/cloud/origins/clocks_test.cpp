// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/origins/clocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace adasplats {
namespace {

// 2021-07-22 14:39:24 UTC, the same moment by every clock; worked out by hand from the epochs.
constexpr double kGps_s = 1311000000;
constexpr double kUtc_s = kGps_s + 315964800 - 18;
constexpr double kTai_s = kUtc_s + 37;
constexpr double kWeek_s = kGps_s - 2167 * 604800.0;
constexpr double kLength_s = 40;

bool has_offset(const std::vector<ClockPair>& pairs, double offset_s) {
  return std::ranges::any_of(
      pairs, [&](const ClockPair& pair) { return std::fabs(pair.offset_s - offset_s) < 1e-3; });
}

TimeSpan from(double first_s) { return {first_s, first_s + kLength_s}; }

// Oracle: IERS Bulletin C.
TEST(Clocks, LeapSeconds) {
  EXPECT_EQ(gps_ahead_of_utc_s(0), 0);
  EXPECT_EQ(gps_ahead_of_utc_s(46828800), 0);  // 1981-06-30 24:00, the leap second itself
  EXPECT_EQ(gps_ahead_of_utc_s(46828801), 1);
  EXPECT_EQ(gps_ahead_of_utc_s(1167264017), 17);  // 2016-12-31 23:59:60
  EXPECT_EQ(gps_ahead_of_utc_s(1167264018), 18);
  EXPECT_EQ(gps_ahead_of_utc_s(kGps_s), 18);
}

TEST(Clocks, OneMomentByEveryPairOfClocks) {
  const double first[] = {kGps_s, kGps_s - 1e9, kUtc_s,      kGps_s + 315964800,
                          kTai_s, kWeek_s,      kWeek_s - 18};
  for (const double points : first)
    for (const double trajectory : first)
      EXPECT_TRUE(has_offset(possible_clocks(from(points), DeclaredClock::none, from(trajectory)),
                             trajectory - points))
          << points << " " << trajectory;
}

TEST(Clocks, StampsOfFinerUnits) {
  for (const double unit_s : {1e-3, 1e-6, 1e-9}) {
    const TimeSpan stamps = {kUtc_s / unit_s, (kUtc_s + kLength_s) / unit_s};
    const auto pairs = possible_clocks(stamps, DeclaredClock::none, from(kGps_s));
    ASSERT_FALSE(pairs.empty());
    EXPECT_EQ(pairs.front().points_unit_s, unit_s);
    EXPECT_NEAR(pairs.front().in_trajectory(stamps).first, kGps_s, 1e-3);
    const auto same = possible_clocks(stamps, DeclaredClock::none, stamps);
    EXPECT_EQ(same.front().trajectory_unit_s, unit_s);
    EXPECT_EQ(same.front().offset_s, 0);
  }
}

TEST(Clocks, WhatTheHeaderSaysRules) {
  const auto pairs =
      possible_clocks(from(kGps_s - 1e9), DeclaredClock::adjusted_gps, from(kWeek_s));
  ASSERT_FALSE(pairs.empty());
  EXPECT_EQ(pairs.front().points, "adjusted GPS time");
  EXPECT_NE(pairs.front().description().find("GPS seconds of the week; offset -310"),
            std::string::npos)
      << pairs.front().description();
  // Adjusted times under a header that says seconds of the week: common, and said aloud.
  const auto wrong = possible_clocks(from(kGps_s - 1e9), DeclaredClock::gps_week, from(kGps_s));
  ASSERT_TRUE(has_offset(wrong, 1e9));
  EXPECT_EQ(wrong.front().points, "adjusted GPS time (not what the LAS header says)");
}

TEST(Clocks, OthersAreNone) {
  EXPECT_TRUE(possible_clocks(from(kGps_s), DeclaredClock::none, from(kGps_s + 1e6)).empty());
  EXPECT_TRUE(possible_clocks(from(0.5), DeclaredClock::none, from(1e12)).empty());
}

TEST(Clocks, ADriveOverTheEndOfTheWeek) {
  const double end_s = 2168 * 604800.0;
  const auto pairs = possible_clocks({604790, 604810}, DeclaredClock::gps_week, from(end_s - 20));
  EXPECT_TRUE(has_offset(pairs, end_s - 604800));
}

}  // namespace
}  // namespace adasplats
