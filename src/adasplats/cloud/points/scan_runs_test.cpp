// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/points/scan_runs.h"

#include <gtest/gtest.h>

#include <map>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

/// Oracle: a map from each scan to its points.
void expect_runs(const std::vector<std::uint32_t>& scans, int threads) {
  std::map<std::uint32_t, std::vector<std::size_t>> expected;
  for (std::size_t i = 0; i < scans.size(); ++i) expected[scans[i]].push_back(i);
  const ScanRuns runs(scans, Executor(threads));
  ASSERT_EQ(runs.size(), expected.size());
  std::size_t k = 0;
  for (const auto& [scan, points] : expected) {
    EXPECT_EQ(runs.scan(k), scan);
    EXPECT_EQ(runs.points(k), points.size());
    std::vector<std::size_t> found;
    runs.for_each(k, [&](std::size_t i) { found.push_back(i); });
    EXPECT_EQ(found, points);
    ++k;
  }
}

TEST(ScanRuns, HasThePointsOfEveryScanInTheirOrder) {
  constexpr std::size_t kPoints = 200'000;  // some chunks
  std::vector<std::uint32_t> drive, twice, mixed;
  for (std::size_t i = 0; i < kPoints; ++i) {
    drive.push_back(static_cast<std::uint32_t>(7 + 3 * (i / 30'000)));
    twice.push_back(static_cast<std::uint32_t>(i % (kPoints / 2) / 1000));
    Random random(0, 0, i);
    mixed.push_back(static_cast<std::uint32_t>(random.uniform(0, 50)));
  }
  for (const int threads : {1, 2}) {
    expect_runs(drive, threads);
    expect_runs(twice, threads);
    expect_runs(mixed, threads);
    expect_runs(std::vector<std::uint32_t>(kPoints, 5), threads);
    expect_runs({4'294'967'295}, threads);
    expect_runs({}, threads);
  }
}

}  // namespace
}  // namespace adasplats
