// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/labels/dynamic_removal.h"

#include <gtest/gtest.h>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

PointCloud cloud_of(std::vector<std::uint16_t> classes) {
  PointCloud cloud;
  cloud.positions.resize(classes.size());
  cloud.classes = std::move(classes);
  return cloud;
}

std::string text_of(const RemovedPoints& removed) {
  std::string text;
  for (const auto& part : removed.classes)
    text += part.name + " " + std::to_string(part.points) + ";";
  return text;
}

// Oracle: the paper, section "Adaptive Splatting": "moving and parked cars, moving pedestrians,
// cyclists, etc.".
TEST(DynamicRemoval, PaperRemovesParkedAndMovingThingsOfEveryScheme) {
  const PointCloud kitti = cloud_of({40, 10, 10, 252, 254, 30, 50});
  const auto all = points_to_remove(kitti, &semantickitti_labels(), DynamicRemoval::movable);
  EXPECT_EQ(text_of(all), "car 2;person 1;moving-car 1;moving-person 1;");
  EXPECT_EQ(all.points, 5U);
  EXPECT_EQ(all.ids.size(), 65536U);
  EXPECT_EQ(text_of(points_to_remove(kitti, &semantickitti_labels(), DynamicRemoval::moving)),
            "moving-car 1;moving-person 1;");

  const PointCloud paris = cloud_of({7, 10, 4, 20, 1, 10});
  EXPECT_EQ(text_of(points_to_remove(paris, &paris_carla_3d_labels(), DynamicRemoval::movable)),
            "pedestrian 1;vehicles 2;dynamic 1;");
}

// Oracle: ASPRS, "LAS specification 1.4 - R15", table 17: 7 and 18 are noise.
TEST(DynamicRemoval, NoiseIsRemovedUnlessNothingIs) {
  const PointCloud cloud = cloud_of({2, 7, 18, 18, 65});
  for (const auto removal : {DynamicRemoval::moving, DynamicRemoval::movable}) {
    const auto removed = points_to_remove(cloud, &asprs_labels(), removal);
    EXPECT_EQ(text_of(removed), "low noise 1;high noise 2;");
    EXPECT_FALSE(removed.ids.empty());
  }
  EXPECT_EQ(points_to_remove(cloud, &asprs_labels(), DynamicRemoval::none).points, 0U);
  EXPECT_TRUE(has_noise(asprs_labels()));
  EXPECT_FALSE(has_noise(semantickitti_labels()));
}

TEST(DynamicRemoval, NothingWithoutLabelsOrWhereNothingIsAsked) {
  const PointCloud bare = cloud_of({});
  const PointCloud labelled = cloud_of({10, 252});
  EXPECT_TRUE(points_to_remove(bare, &semantickitti_labels(), DynamicRemoval::movable).ids.empty());
  EXPECT_TRUE(points_to_remove(labelled, nullptr, DynamicRemoval::movable).ids.empty());
  EXPECT_EQ(points_to_remove(labelled, &semantickitti_labels(), DynamicRemoval::none).points, 0U);
  EXPECT_THROW(points_to_remove(cloud_of({7}), &semantickitti_labels(), DynamicRemoval::movable),
               Error);
}

TEST(DynamicRemoval, SaysWhyNothingCanBeRemoved) {
  const PointCloud cloud = cloud_of({10});
  const auto why = [&](const LabelScheme* labels, DynamicRemoval removal) {
    return removal_problem(cloud, labels, removal);
  };
  EXPECT_EQ(why(&paris_carla_3d_labels(), DynamicRemoval::moving),
            "the label scheme 'paris-carla-3d' has no class that is moving, only movable ones "
            "(`remove` movable)");
  EXPECT_TRUE(
      points_to_remove(cloud, &paris_carla_3d_labels(), DynamicRemoval::moving).ids.empty());
  EXPECT_EQ(why(&paris_carla_3d_labels(), DynamicRemoval::movable), "");
  EXPECT_EQ(why(&semantickitti_labels(), DynamicRemoval::moving), "");
  EXPECT_EQ(why(nullptr, DynamicRemoval::none), "");
  EXPECT_NE(why(nullptr, DynamicRemoval::movable).find("`labels`"), std::string::npos);
  EXPECT_EQ(removal_problem({}, nullptr, DynamicRemoval::moving), "the points have no labels");
  const LabelScheme still("still", {{1, "wall", SemanticGroup::surface, Mobility::fixed, {}}});
  EXPECT_EQ(why(&still, DynamicRemoval::movable),
            "the label scheme 'still' has no class that is movable");
}

}  // namespace
}  // namespace adasplats
