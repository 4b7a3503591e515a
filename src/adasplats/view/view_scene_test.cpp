// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/view_scene.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "adasplats/view/room_test.h"

namespace adasplats {
namespace {

using Json = nlohmann::json;

Json parsed(const ViewScene& scene) { return Json::parse(scene_json(scene)); }

TEST(ViewScene, SceneJsonDescribesTheScene) {
  const Room room;
  const Json json = parsed(room.view);
  EXPECT_EQ(json["version"], 2);
  EXPECT_EQ(json["origin_m"], Json({5000, 6000, 0}));
  ASSERT_EQ(json["layers"].size(), 2U);
  EXPECT_EQ(json["layers"][0]["kind"], "splats");
  EXPECT_EQ(json["layers"][0]["count"], room.model.splats()->size());
  EXPECT_TRUE(json["layers"][0]["has_classes"]);
  EXPECT_FALSE(json["layers"][0]["has_errors"]);
  EXPECT_EQ(json["layers"][1]["kind"], "points");
  EXPECT_TRUE(json["layers"][1]["has_errors"]);
  EXPECT_TRUE(json["can_simulate"]);
  EXPECT_EQ(json["sensors"].size(), lidar_model_names().size());
  EXPECT_EQ(json["trajectories"][0]["poses"][0][0], 1.5) << "relative to the origin";
  bool has_road = false;
  for (const Json& c : json["classes"])
    has_road = has_road || (c["id"] == 40 && c["name"] == "road");
  EXPECT_TRUE(has_road);
}

TEST(ViewScene, PointsOfAnotherOriginHaveTheSamePosition) {
  const Room room;
  const LevelNode& splats = room.view.layers[0].tree.nodes().front();
  const LevelNode& points = room.view.layers[1].tree.nodes().front();
  // Boxes of merged elements differ by at most half a cell.
  EXPECT_NEAR(points.low.x, splats.low.x, 0.2);
  EXPECT_NEAR(points.high.y, splats.high.y, 0.2);
}

// Oracle: the floor is at 0.
TEST(ViewScene, WithoutPosesTheSensorIsAboveTheGround) {
  Room room;
  room.view.trajectories.clear();
  EXPECT_NEAR(start_pose_of(room.view, 1.8, room.executor).translation.z, 1.8, 1e-3);
}

}  // namespace
}  // namespace adasplats
