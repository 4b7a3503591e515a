// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/object_ground.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

/// The rear and the left side of a car of 4 x 1.8 x 1.5 m whose sill is 0.25 m above the ground,
/// with tyres; the ground, `lower_m` above the bottom of its box, rises by 2 % along x.
RecordedObject car(double lower_m, bool has_ground) {
  RecordedObject object;
  object.size_m = {4, 1.8, 1.5 + lower_m};
  const double bottom = -0.5 * object.size_m.z + lower_m;
  ObjectScan scan;
  const auto add = [&](double x, double y, double above_m) {
    scan.points.push_back({x, y, bottom + 0.02 * x + above_m});
    scan.origins.push_back({-15, 6, 1});
    scan.intensities.push_back(static_cast<float>(above_m));
  };
  Random random(3, 0, 0);
  for (int i = 0; i < 4000; ++i) {
    add(random.uniform(-2, 2), 0.9, random.uniform(0.25, 1.4));
    add(-2, random.uniform(-0.9, 0.9), random.uniform(0.25, 1.4));
    if (i % 8 == 0) add(random.uniform(0, 1) < 0.5 ? -1.3 : 1.3, 0.9, random.uniform(0, 0.3));
    if (has_ground)
      add(random.uniform(-2.2, 2.2), random.uniform(-1, 1.2), random.uniform(-0.02, 0.02));
  }
  object.scans = {scan};
  return object;
}

TEST(RemoveGround, LeavesTheObject) {
  RecordedObject object = car(0.2, true);
  const std::size_t before = object.points();
  const std::size_t removed = remove_ground(object);
  EXPECT_NEAR(static_cast<double>(removed), 4000 + 500 * 0.08 / 0.3, 80);
  EXPECT_EQ(object.points(), before - removed);
  const ObjectScan& scan = object.scans.front();
  EXPECT_EQ(scan.passing.size(), removed);
  ASSERT_EQ(scan.intensities.size(), scan.points.size());
  EXPECT_GT(*std::ranges::min_element(scan.intensities), 0.06F) << "heights above the ground";
}

TEST(RemoveGround, WithoutGroundNothingIsRemoved) {
  RecordedObject object = car(0.0, false);
  EXPECT_EQ(remove_ground(object), 0U);
  RecordedObject nothing;
  EXPECT_EQ(remove_ground(nothing), 0U);
}

}  // namespace
}  // namespace adasplats
