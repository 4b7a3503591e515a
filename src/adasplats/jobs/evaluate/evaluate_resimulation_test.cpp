// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "adasplats/jobs/session/session.h"

namespace adasplats {
namespace {

DeviceOptions on_cpu() {
  DeviceOptions options;
  options.kind = DeviceKind::cpu;
  return options;
}

/// A disk, and calibrated with scans at times 0, 1, 2 s and x = 0, 10, 20 m.
SplatModel calibrated_model() {
  SplatModel model;
  model.disks = {{{0, 0, 0}, 1, {0, 0, 1}}};
  for (const double i : {0.0, 1.0, 2.0}) model.calibration.poses.push_back({i, {10 * i, 0, 2}});
  return model;
}

TimedPose pose_at(double time_s, double x) {
  TimedPose pose{time_s, {}};
  pose.world_from_sensor.translation = {x, 0, 2};
  return pose;
}

// Oracle: the scans listed in the calibration. Time alone or position alone is no match.
TEST(HeldOutProtocol, ScansOfTheModelMatchByTimeAndPosition) {
  OwnSession session(on_cpu(), 1);
  const ModelScene scene(calibrated_model(), std::nullopt, session);
  KittiSequence sequence;
  EXPECT_EQ(scans_of_model(scene, sequence), 0U);
  sequence.trajectory = {pose_at(0, 0), pose_at(1, 10.5), pose_at(1.5, 20), pose_at(2, 20)};
  EXPECT_EQ(scans_of_model(scene, sequence), 2U);
  SplatModel bare = calibrated_model();
  bare.calibration = {};
  const ModelScene unknown(std::move(bare), std::nullopt, session);
  EXPECT_FALSE(scans_of_model(unknown, sequence).has_value());
}

TEST(HeldOutProtocol, UnknownValuesAreNullAndDifferencesAreListed) {
  Lidar4dEvaluation result;
  result.depth.psnr_db = std::numeric_limits<double>::infinity();
  result.chamfer_m2 = std::nan("");
  const nlohmann::ordered_json json = to_json(result);
  EXPECT_TRUE(json["depth_m"]["psnr_db"].is_null());
  EXPECT_TRUE(json["points"]["chamfer_m2"].is_null());
  EXPECT_TRUE(json["intensity"].is_null());
  EXPECT_TRUE(json["scans_of_model"].is_null());
  EXPECT_EQ(json["comparable"], "same protocol, other scene");
  EXPECT_EQ(json["differs"].size(), std::size(kLidar4dDiffers));
  EXPECT_EQ(json["range_image"]["rows"], 66);
  EXPECT_NEAR(json["range_image"]["span_deg"].get<double>(), 26.9, 1e-9);
  result.intensity.emplace();
  result.scans_of_model = 3;
  EXPECT_EQ(to_json(result)["intensity"]["rmse"], 0.0);
  EXPECT_EQ(to_json(result)["scans_of_model"], 3);
}

}  // namespace
}  // namespace adasplats
