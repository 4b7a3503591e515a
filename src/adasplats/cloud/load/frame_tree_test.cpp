// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/frame_tree.h"

#include <gtest/gtest.h>

#include <utility>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

FrameEdge edge(const char* parent, const char* child, bool is_static, Trajectory poses) {
  return {parent, child, is_static, std::move(poses), {}};
}

TimedPose at(double time_s, Vec3d place) { return {time_s, {{}, place}}; }

// Oracle: sums of translations.
TEST(FrameTree, ChainsAreKnownWhereAllOfThemAre) {
  FrameTree tree;
  tree.add(edge("map", "odom", false, {at(0, {0, 0, 0}), at(2, {2, 0, 0}), at(4, {4, 0, 0})}));
  tree.add(edge("odom", "car", false, {at(1, {0, 10, 0}), at(3, {0, 30, 0}), at(5, {0, 50, 0})}));
  tree.add(edge("car", "lidar", true, {at(0, {0, 0, 1})}));
  EXPECT_EQ(tree.root_of("lidar"), "map");
  EXPECT_TRUE(tree.moves("lidar"));
  EXPECT_FALSE(tree.moves("map"));
  const Trajectory poses = tree.poses_of("lidar");
  ASSERT_EQ(poses.size(), 4U);  // 1, 2, 3, 4 s: at 0 and 5 one of both is not known
  for (const TimedPose& pose : poses)
    EXPECT_LT(length(pose.world_from_sensor.translation - Vec3d{pose.time_s, 10 * pose.time_s, 1}),
              1e-12);
  EXPECT_EQ(tree.fixed_between("car", "lidar").translation, (Vec3d{0, 0, 1}));
  EXPECT_EQ(tree.fixed_between("lidar", "car").translation, (Vec3d{0, 0, -1}));
  EXPECT_EQ(tree.fixed_between("lidar", "lidar").translation, (Vec3d{0, 0, 0}));
  expect_error(ErrorKind::data, {"'car'", "moves"}, [&] { tree.fixed_between("odom", "lidar"); });
  expect_error(ErrorKind::data, {"'other'"}, [&] { tree.fixed_between("car", "other"); });
}

TEST(FrameTree, GapsStayGaps) {
  FrameTree tree;
  Trajectory sparse, dense;
  for (int k = 0; k < 40; ++k)
    if (k < 10 || k >= 30) sparse.push_back(at(0.1 * k, {}));
  for (int k = 0; k <= 400; ++k) dense.push_back(at(0.01 * k, {}));
  tree.add(edge("map", "odom", false, sparse));
  tree.add(edge("odom", "car", false, dense));
  for (const TimedPose& pose : tree.poses_of("car"))
    EXPECT_TRUE(pose.time_s < 0.9 + 0.1001 || pose.time_s > 3 - 0.1001) << pose.time_s;
}

TEST(FrameTree, RingsAndTwoParentsAreErrors) {
  FrameTree tree;
  tree.add(edge("a", "b", true, {at(0, {})}));
  tree.add(edge("b", "a", true, {at(0, {})}));
  expect_error(ErrorKind::data, {"cycle", "'a', 'b'"}, [&] { tree.root_of("a"); });
  expect_error(ErrorKind::data, {"two parents", "'a'", "'c'"},
               [&] { tree.add(edge("c", "b", false, {at(0, {})})); });
}

}  // namespace
}  // namespace adasplats
