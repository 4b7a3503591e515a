// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/model/make_model.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

/// A plane of 40 x 40 points with sensor positions and intensities.
PointCloud plane() {
  PointCloud cloud;
  for (int i = 0; i < 1600; ++i) {
    const float x = 0.1F * static_cast<float>(i % 40);
    const float y = 0.1F * static_cast<float>(i / 40);
    cloud.positions.push_back({x, y, 0.001F * static_cast<float>(i % 7)});
    cloud.sensor_positions.push_back({2, 2, 2});
    cloud.intensities.push_back(0.25F);
    cloud.classes.push_back(40);
  }
  return cloud;
}

class MakeModelTest : public testing::Test {
 protected:
  Executor executor_{2};
  ProgressSink progress_;
  DeviceChoice device_;
  Session session_{executor_, progress_, 1, device_};
};

// Oracle: build_model.
TEST_F(MakeModelTest, PointsInMemoryGiveTheModelOfTheStageBelow) {
  for (const SplatMethod method : {SplatMethod::basic, SplatMethod::consistent}) {
    ModelOptions options;
    options.build.recipe = MethodChoice{.method = method}.recipe();
    options.build.remove = DynamicRemoval::none;
    const PointCloud cloud = plane();
    const auto [model, result] = make_model(cloud, options, session_);
    const auto [expected, report] =
        build_model(cloud, nullptr, options.build, executor_, progress_, nullptr);
    ASSERT_EQ(model.size(), expected.size());
    ASSERT_GT(model.size(), 0U);
    for (std::size_t i = 0; i < model.size(); ++i)
      EXPECT_EQ(model.disks[i].center.x, expected.disks[i].center.x);
    EXPECT_EQ(result.built.primitives, report.primitives);
    EXPECT_EQ(result.loaded.points_read, cloud.size());
  }
}

TEST_F(MakeModelTest, LabelsAreNamedInTheModel) {
  ModelOptions options;
  options.labels = "semantickitti";
  options.build.recipe = MethodChoice{.method = SplatMethod::semantic}.recipe();
  const auto made = make_model(plane(), options, session_);
  EXPECT_EQ(made.first.label_scheme, "semantickitti");
  EXPECT_EQ(to_json(made.second)["primitives"], made.first.size());
  options.labels.clear();
  EXPECT_THROW(make_model(plane(), options, session_), Error);
}

// Oracle: the classes of PointClassifier as labels of the points.
TEST_F(MakeModelTest, SegmentedPointsGiveTheModelOfTheNetworksLabels) {
  ModelOptions options;
  options.segment.on = true;
  options.build.recipe = MethodChoice{.method = SplatMethod::semantic}.recipe();
  options.build.remove = DynamicRemoval::none;
  if (!can_segment()) {
    expect_error(ErrorKind::unavailable, {"OpenBLAS"},
                 [&] { make_model(plane(), options, session_); });
    return;
  }
  const PointCloud cloud = plane();
  const auto [model, result] = make_model(cloud, options, session_);
  PointCloud labelled = cloud;
  labelled.classes = PointClassifier("").classes_of(cloud, {}, session_).ids;
  ModelOptions by_labels = options;
  by_labels.segment.on = false;
  by_labels.labels = "semantickitti";
  const SplatModel expected = make_model(labelled, by_labels, session_).first;
  ASSERT_GT(model.size(), 0U);
  EXPECT_EQ(model.classes, expected.classes);
  EXPECT_EQ(model.groups, expected.groups);
  EXPECT_EQ(model.label_scheme, "semantickitti");
  EXPECT_EQ(model.network_sha256, default_network().sha256);
  EXPECT_EQ(expected.network_sha256, "");
  ASSERT_TRUE(result.segmented);
  EXPECT_TRUE(result.segmented->replaced_labels);
  EXPECT_EQ(to_json(result)["segmentation"]["network"]["name"], "default");
  EXPECT_FALSE(to_json(make_model(labelled, by_labels, session_).second).contains("segmentation"));
}

TEST_F(MakeModelTest, SegmentationThatCannotBeMeantIsRefusedFirst) {
  ModelOptions options;
  options.segment.on = true;
  options.labels = "semantickitti";
  expect_error(ErrorKind::usage, {"`labels`", "`segment`"},
               [&] { make_model(plane(), options, session_); });
  options.labels.clear();
  options.build.remove = DynamicRemoval::moving;
  if (can_segment()) {
    expect_error(ErrorKind::usage, {"`remove` moving"},
                 [&] { make_model(plane(), options, session_); });
  }
  SegmentChoice unused;
  EXPECT_EQ(unused_settings(unused).size(), 1U);
  unused.on = true;
  EXPECT_TRUE(unused_settings(unused).empty());
}

TEST_F(MakeModelTest, NoPointsAreAnError) {
  EXPECT_THROW(make_model(PointCloud(), ModelOptions(), session_), Error);
}

TEST_F(MakeModelTest, A2dScannerIsReported) {
  class Listener : public ProgressSink {
   public:
    void warn(std::string_view message) override { warnings += message; }
    std::string warnings;
  } listener;
  Session session{executor_, listener, 1, device_};
  PointCloud cloud = plane();
  make_model(cloud, {}, session);
  EXPECT_EQ(listener.warnings.find("2-D scanner"), std::string::npos);
  for (Vec3f& position : cloud.sensor_positions) position.z = 0;
  make_model(cloud, {}, session);
  EXPECT_NE(listener.warnings.find("2-D scanner"), std::string::npos);
}

}  // namespace
}  // namespace adasplats
