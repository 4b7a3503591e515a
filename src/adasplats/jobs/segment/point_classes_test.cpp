// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/segment/point_classes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

PointCloud floor_of_points() {
  PointCloud cloud;
  for (int i = 0; i < 900; ++i)
    cloud.positions.push_back(
        {0.1F * static_cast<float>(i % 30), 0.1F * static_cast<float>(i / 30), 0});
  return cloud;
}

TEST(PointClasses, IdsAreThoseOfSemanticKitti) {
  Network network;
  network.classes = {"road", "pole", "car"};
  EXPECT_EQ(semantickitti_ids(network, "n"), (std::vector<std::uint16_t>{40, 80, 10}));
  network.classes.emplace_back("dragon");
  expect_error(ErrorKind::data, {"n: ", "'dragon'"}, [&] { semantickitti_ids(network, "n"); });
}

TEST(PointClasses, AreThereWhereCanSegmentSaysSo) {
  if (can_segment()) {
    EXPECT_NO_THROW(PointClassifier(""));
  } else {
    expect_error(ErrorKind::unavailable, {"OpenBLAS"}, [] { PointClassifier(""); });
  }
}

// Oracle: segment_cloud.
TEST(PointClasses, AreTheNetworksAndCounted) {
  if (!can_segment()) GTEST_SKIP() << "built without OpenBLAS";
  const Executor executor(2);
  ProgressSink progress;
  DeviceChoice device;
  Session session{executor, progress, 1, device};
  const PointClassifier classifier("");
  const Network network = default_network();
  EXPECT_EQ(classifier.facts().name, "default");
  EXPECT_EQ(classifier.facts().card, network.card);
  EXPECT_EQ(to_json(classifier.facts())["sha256"], network.sha256);
  EXPECT_EQ(network.sha256.size(), 64U);

  const PointCloud cloud = floor_of_points();
  const SegmentOptions options{.confidences = true};
  const PointClasses classes = classifier.classes_of(cloud, options, session);
  const Segmentation expected = segment_cloud(cloud, network, options, executor);
  const std::vector<std::uint16_t> ids = semantickitti_ids(network, "n");
  ASSERT_EQ(classes.ids.size(), cloud.size());
  std::size_t counted = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    EXPECT_EQ(classes.ids[i], ids[expected.classes[i]]);
  EXPECT_EQ(classes.confidences, expected.confidences);
  ASSERT_EQ(classes.by_class.size(), network.classes.size());
  for (std::size_t c = 0; c < ids.size(); ++c) {
    EXPECT_EQ(classes.by_class[c].name, network.classes[c]);
    EXPECT_EQ(classes.by_class[c].points,
              static_cast<std::size_t>(std::ranges::count(classes.ids, ids[c])));
    counted += classes.by_class[c].points;
  }
  EXPECT_EQ(counted, cloud.size());
}

TEST(PointClasses, TheNetworkTellsWhatIsMovableButNotWhatMoves) {
  if (!can_segment()) GTEST_SKIP() << "built without OpenBLAS";
  const PointClassifier classifier("");
  EXPECT_TRUE(classifier.has_class_of(DynamicRemoval::movable));
  EXPECT_FALSE(classifier.has_class_of(DynamicRemoval::moving));
  EXPECT_FALSE(classifier.has_class_of(DynamicRemoval::none));
}

}  // namespace
}  // namespace adasplats
