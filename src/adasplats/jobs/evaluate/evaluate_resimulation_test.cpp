// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {
namespace {

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
  OwnSession session({.kind = DeviceKind::cpu}, 1);
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

/// Three scans of one pose, `x_m` along x, that measured a wall 5 m ahead of the sensor.
KittiSequence wall_scans(const TemporaryFolder& folder, double x_m) {
  KittiSequence sequence;
  sequence.folder = folder.path();
  std::vector<float> values;
  for (int i = -10; i <= 10; ++i)
    for (int k = -5; k <= 5; ++k)
      values.insert(values.end(),
                    {5, 0.2F * static_cast<float>(i), 0.1F * static_cast<float>(k), 0.5F});
  for (int scan = 0; scan < 3; ++scan) {
    sequence.scans.push_back(folder.write("velodyne/" + std::to_string(scan) + ".bin", values));
    sequence.trajectory.push_back(pose_at(0.1 * scan, x_m));
  }
  return sequence;
}

TEST(EvaluateResimulation, ModelsOfOtherPlacesAreReported) {
  class Warnings : public ProgressSink {
   public:
    void warn(std::string_view message) override { text += message; }
    std::string text;
  };
  const TemporaryFolder folder;
  OwnSession session({.kind = DeviceKind::cpu}, 1);
  const auto evaluate = [&](double x_m) {
    SplatModel wall;
    wall.disks = {{{5, 0, 2}, 4, {-1, 0, 0}}};
    const ModelScene scene(std::move(wall), std::nullopt, session);
    KittiSequence sequence = wall_scans(folder, x_m);
    Warnings warnings;
    Session reporting{session.executor, warnings, session.seed, session.device};
    evaluate_resimulation(scene, sequence, "semantickitti", {}, {}, reporting);
    return warnings.text;
  };
  EXPECT_EQ(evaluate(0), "");
  const std::string other = evaluate(-40);
  EXPECT_NE(other.find("the model does not explain its beams"), std::string::npos) << other;
  EXPECT_NE(other.find("x -40.0 to -40.0"), std::string::npos) << other;
  expect_error(ErrorKind::data, {folder.path().string(), "out of reach of the model", "x 2000.0"},
               [&] { evaluate(2000); });
}

}  // namespace
}  // namespace adasplats
