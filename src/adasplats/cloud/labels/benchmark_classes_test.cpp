// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/labels/benchmark_classes.h"

#include <gtest/gtest.h>

#include <map>

namespace adasplats {
namespace {

// Oracle: learning_map of the published semantic-kitti.yaml, where 0 counts as nothing.
TEST(BenchmarkClasses, SemanticKittiAsPublished) {
  const std::map<std::uint16_t, std::size_t> learning_map = {
      {0, 0},   {1, 0},   {10, 1},  {11, 2},  {13, 5},  {15, 3},  {16, 5},  {18, 4},  {20, 5},
      {30, 6},  {31, 7},  {32, 8},  {40, 9},  {44, 10}, {48, 11}, {49, 12}, {50, 13}, {51, 14},
      {52, 0},  {60, 9},  {70, 15}, {71, 16}, {72, 17}, {80, 18}, {81, 19}, {99, 0},  {252, 1},
      {253, 7}, {254, 6}, {255, 8}, {256, 5}, {257, 5}, {258, 4}, {259, 5}};
  const BenchmarkClasses classes(semantickitti_labels());
  ASSERT_EQ(classes.classes().size(), 19U);
  for (std::size_t id = 0; id < 1 << 16; ++id) {
    const auto number = classes.find(static_cast<std::uint16_t>(id));
    const auto published = learning_map.find(static_cast<std::uint16_t>(id));
    ASSERT_EQ(number.has_value(), published != learning_map.end()) << id;
    if (!number) continue;
    EXPECT_EQ((*number + 1) % 20, published->second) << id;
  }
  EXPECT_EQ(classes.scheme(), "semantickitti");
  EXPECT_EQ(classes.classes()[0].name, "car");
  EXPECT_EQ(classes.classes()[18].name, "traffic-sign");
}

TEST(BenchmarkClasses, GroupsAreThoseOfTheScheme) {
  const BenchmarkClasses classes(semantickitti_labels());
  for (std::size_t k = 0; k < classes.classes().size(); ++k) {
    const BenchmarkClass& c = classes.classes()[k];
    EXPECT_EQ(c.is_movable, k < 8) << c.name;
    EXPECT_EQ(c.group, semantickitti_labels().find(c.name)->group) << c.name;
  }
  EXPECT_EQ(classes.classes()[16].name, "terrain");
  EXPECT_EQ(classes.classes()[16].group, SemanticGroup::ground);
}

TEST(BenchmarkClasses, OtherSchemesHaveTheirOwn) {
  const BenchmarkClasses paris(paris_carla_3d_labels());
  ASSERT_EQ(paris.classes().size(), 22U);
  EXPECT_EQ(paris.classes()[0].name, "building");
  EXPECT_EQ(paris.find(0), 22U);
  EXPECT_EQ(paris.find(22), 21U);
  EXPECT_EQ(paris.find(23), std::nullopt);
  EXPECT_TRUE(paris.classes()[*paris.find(10)].is_movable);

  const SemanticClass wall{7, "wall", SemanticGroup::surface, Mobility::fixed, {}};
  const SemanticClass bus{3, "bus", SemanticGroup::surface, Mobility::moving, {}};
  SemanticClass twin = wall;
  twin.id = 9;
  // The name of a scheme alone does not make it SemanticKITTI.
  const BenchmarkClasses own(LabelScheme("semantickitti", {wall, bus, twin}));
  ASSERT_EQ(own.classes().size(), 2U);
  EXPECT_EQ(own.find(3), 0U);
  EXPECT_TRUE(own.classes()[0].is_movable);
  EXPECT_EQ(own.find(7), 1U);
  EXPECT_EQ(own.find(9), 1U);
  EXPECT_EQ(own.find(0), 2U);
  EXPECT_EQ(own.find(1), std::nullopt);
  // Where a scheme says what 0 is, it is that.
  SemanticClass zero = wall;
  zero.id = 0;
  EXPECT_EQ(BenchmarkClasses(LabelScheme("mine", {zero})).find(0), 0U);
}

TEST(BenchmarkClasses, NoClasses) {
  const BenchmarkClasses none(LabelScheme("none", {}));
  EXPECT_TRUE(none.classes().empty());
  EXPECT_EQ(none.find(0), 0U);
  EXPECT_EQ(none.find(65535), std::nullopt);
}

}  // namespace
}  // namespace adasplats
