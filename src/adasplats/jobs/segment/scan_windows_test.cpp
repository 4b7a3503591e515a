// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/segment/scan_windows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numeric>
#include <set>
#include <string>

#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

/// Scans of some points each, named by their number; counts how often each is read.
class NumberedScans final : public ScanReader {
 public:
  explicit NumberedScans(std::size_t points) : points_(points) {}

  KittiScan read(const std::filesystem::path& file) const override {
    reads_.insert(file.string());
    KittiScan scan;
    const auto number = static_cast<float>(std::atoi(file.c_str()));
    for (std::size_t i = 0; i < points_; ++i) {
      scan.positions.push_back({0, static_cast<float>(i), 0});
      scan.intensities.push_back(number);
    }
    return scan;
  }
  const std::multiset<std::string>& reads() const { return reads_; }

 private:
  std::size_t points_;
  mutable std::multiset<std::string> reads_;
};

/// One scan a metre along x.
KittiSequence drive_of(std::size_t scans, std::shared_ptr<const ScanReader> reader) {
  KittiSequence sequence;
  for (std::size_t k = 0; k < scans; ++k) {
    sequence.scans.emplace_back(std::to_string(k));
    TimedPose& pose = sequence.trajectory.emplace_back();
    pose.world_from_sensor.translation = {1e6 + static_cast<double>(k), 0, 0};
  }
  sequence.reader = std::move(reader);
  return sequence;
}

std::vector<std::size_t> all_of(std::size_t scans) {
  std::vector<std::size_t> chosen(scans);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  return chosen;
}

TEST(ScanWindows, EveryScanIsReadOnceAndGetsLabelsOnce) {
  constexpr std::size_t kScans = 57, kPoints = 10, kMost = 120;
  const auto reader = std::make_shared<NumberedScans>(kPoints);
  const KittiSequence drive = drive_of(kScans, reader);
  ScanWindows windows(drive, all_of(kScans), {kMost}, 1000);
  std::size_t next = 0, count = 0;
  while (const auto window = windows.next()) {
    ++count;
    EXPECT_LE(window->cloud.size(), kMost + 3 * kPoints);
    EXPECT_EQ(window->points, kPoints * window->scans.size());
    for (std::size_t k = 0; k < window->scans.size(); ++k) {
      EXPECT_EQ(window->scans[k].index, next++);
      // Intensities are the scans' numbers: the window's own come first.
      EXPECT_EQ(window->cloud.intensities[k * kPoints], static_cast<float>(window->scans[k].index));
      EXPECT_NEAR(window->cloud.world(k * kPoints).x, 1e6 + static_cast<double>(next - 1), 1e-6);
    }
    const bool is_first = window->scans.front().index == 0;
    const bool is_last = window->scans.back().index + 1 == kScans;
    const std::size_t context = window->cloud.size() - window->points;
    EXPECT_EQ(context, (is_first ? 0 : kMost / 6) + (is_last ? 0 : kMost / 6));
  }
  EXPECT_EQ(next, kScans);
  EXPECT_GT(count, 5U);
  EXPECT_EQ(reader->reads().size(), kScans);
}

TEST(ScanWindows, AShortDriveIsOneWindow) {
  const auto reader = std::make_shared<NumberedScans>(10);
  const KittiSequence drive = drive_of(9, reader);
  ScanWindows windows(drive, {1, 3, 8}, {1000}, 1000);
  const auto window = windows.next();
  ASSERT_TRUE(window.has_value());
  EXPECT_EQ(window->scans.size(), 3U);
  EXPECT_EQ(window->points, window->cloud.size());
  EXPECT_FALSE(windows.next().has_value());
  EXPECT_EQ(reader->reads(), (std::multiset<std::string>{"1", "3", "8"}));
  EXPECT_FALSE(ScanWindows(drive, {}, {1000}, 1000).next().has_value());
}

/// Points at bad places.
class BadScans final : public ScanReader {
 public:
  KittiScan read(const std::filesystem::path& file) const override {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    if (file == "0") return {};
    KittiScan scan;
    scan.positions = {{1, 2, 3}, {kNaN, 0, 0}, {0, kInfinity, 0}, {1e30F, 0, 0}, {3, 2, 1}};
    if (file == "1") scan.intensities = {1, 2, 3, 4, kNaN};
    return scan;
  }
};

TEST(ScanWindows, WhatHasNoPlaceIsLeftOut) {
  const KittiSequence drive = drive_of(3, std::make_shared<BadScans>());
  ScanWindows windows(drive, all_of(3), {1000}, 100);
  const auto window = windows.next();
  ASSERT_TRUE(window.has_value());
  EXPECT_TRUE(window->scans[0].has_place.empty());
  EXPECT_EQ(window->scans[1].has_place, (std::vector<bool>{true, false, false, false, true}));
  ASSERT_EQ(window->cloud.size(), 4U);
  ASSERT_EQ(window->cloud.intensities.size(), 4U);
  EXPECT_EQ(window->cloud.intensities[0], 1);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_TRUE(std::isnan(window->cloud.intensities[i]));
}

TEST(ScanWindows, TooFewPointsAreRefused) {
  const KittiSequence drive = drive_of(1, std::make_shared<BadScans>());
  expect_error(ErrorKind::usage, {"window_points"}, [&] { ScanWindows(drive, {0}, {5}, 100); });
}

}  // namespace
}  // namespace adasplats
