// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr std::size_t kScansPerDrive = 60;

/// Two drives over the same time, 1 km apart, with random intervals, steps and corrections.
Calibration two_drives() {
  Calibration calibration;
  for (std::uint64_t drive = 0; drive < 2; ++drive) {
    double time_s = 100, x_m = 0;
    for (std::uint64_t scan = 0; scan < kScansPerDrive; ++scan) {
      Random random(3, drive, scan);
      time_s += random.uniform(0.05, 0.3);
      x_m += random.uniform(0.2, 3.0);
      const Vec3d shift = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      calibration.poses.push_back(
          {time_s, {x_m, 1000.0 * static_cast<double>(drive), 0}, {}, shift});
    }
  }
  return calibration;
}

/// Linear search: examines every interval of the drive whose y is that of the position.
std::optional<Vec3d> shift_by_linear_search(const Calibration& calibration, double time_s,
                                            Vec3d position) {
  const std::vector<PoseCorrection>& poses = calibration.poses;
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const PoseCorrection &a = poses[k], &b = poses[k + 1];
    if (a.position[1] != position[1] || b.position[1] != position[1]) continue;
    const bool is_first = k % kScansPerDrive == 0, is_last = (k + 2) % kScansPerDrive == 0;
    const double interval_s = b.time_s - a.time_s;
    if (time_s < a.time_s - (is_first ? interval_s : 0)) continue;
    if (time_s > b.time_s + (is_last ? interval_s : 0)) continue;
    const double share = std::clamp((time_s - a.time_s) / interval_s, 0.0, 1.0);
    return a.shift_m + share * (b.shift_m - a.shift_m);
  }
  return std::nullopt;
}

/// A position on the (extended) path of a drive at a time.
Vec3d position_at(const Calibration& calibration, std::size_t drive, double time_s) {
  const auto* poses = &calibration.poses[drive * kScansPerDrive];
  std::size_t k = 0;
  while (k + 2 < kScansPerDrive && poses[k + 1].time_s < time_s) ++k;
  const double share = (time_s - poses[k].time_s) / (poses[k + 1].time_s - poses[k].time_s);
  return poses[k].position + share * (poses[k + 1].position - poses[k].position);
}

TEST(CorrectionLookup, FindsWhatALinearSearchFinds) {
  const Calibration calibration = two_drives();
  const CorrectionLookup lookup(calibration);
  std::size_t found = 0, missing = 0;
  for (std::uint64_t n = 0; n < 4000; ++n) {
    Random random(4, 0, n);
    const double time_s = random.uniform(99, 115);
    const auto drive = static_cast<std::size_t>(n % 2);
    const Vec3d position = position_at(calibration, drive, time_s);
    const auto expected = shift_by_linear_search(calibration, time_s, position);
    const auto correction = lookup.at(time_s, position);
    ASSERT_EQ(correction.has_value(), expected.has_value()) << time_s << " s, drive " << drive;
    ++(expected ? found : missing);
    if (expected) {
      EXPECT_LT(length(correction->shift_m - *expected), 1e-9) << time_s << " s";
    }
  }
  EXPECT_GT(found, 1000U);
  EXPECT_GT(missing, 50U);
}

TEST(CorrectionLookup, ReturnsTheStoredCorrectionOfAnEstimatedScan) {
  const Calibration calibration = two_drives();
  const CorrectionLookup lookup(calibration);
  for (const PoseCorrection& pose : calibration.poses) {
    const auto correction = lookup.at(pose.time_s, pose.position);
    ASSERT_TRUE(correction);
    EXPECT_EQ(correction->shift_m, pose.shift_m);
  }
}

TEST(CorrectionLookup, RejectsPositionsAwayFromThePath) {
  const Calibration calibration = two_drives();
  const PoseCorrection& pose = calibration.poses[kScansPerDrive / 2];
  EXPECT_FALSE(CorrectionLookup(calibration).at(pose.time_s, pose.position + Vec3d{0, 500, 0}));
}

}  // namespace
}  // namespace adasplats
