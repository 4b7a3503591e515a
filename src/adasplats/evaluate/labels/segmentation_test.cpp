// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/labels/segmentation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

using Ids = std::vector<std::uint16_t>;

SegmentationConfusion confusion_of(const Ids& predicted, const Ids& truth, int threads = 1) {
  const BenchmarkClasses classes(semantickitti_labels());
  SegmentationConfusion confusion(classes.classes().size());
  confusion.add(predicted, truth, classes, Executor(threads));
  return confusion;
}

std::size_t number_of(std::uint16_t id) {
  return *BenchmarkClasses(semantickitti_labels()).find(id);
}

// Oracle: by hand. True: 4 road (one of them a lane marking), 2 poles, 1 moving car, 2 of no class.
TEST(SegmentationConfusion, FiguresByHand) {
  const Ids truth = {40, 40, 40, 60, 80, 80, 252, 0, 52};
  const Ids predicted = {40, 40, 72, 40, 80, 0, 10, 40, 80};
  const SegmentationConfusion confusion = confusion_of(predicted, truth);
  EXPECT_EQ(confusion.points(), 7U);
  EXPECT_EQ(confusion.ignored(), 2U);
  EXPECT_DOUBLE_EQ(confusion.accuracy(), 5.0 / 7);
  const std::size_t road = number_of(40), pole = number_of(80), car = number_of(10),
                    terrain = number_of(72), fence = number_of(51);
  EXPECT_DOUBLE_EQ(confusion.iou(road), 3.0 / 4);
  EXPECT_DOUBLE_EQ(confusion.precision(road), 1);  // what has no class makes nothing wrong
  EXPECT_DOUBLE_EQ(confusion.recall(road), 3.0 / 4);
  EXPECT_DOUBLE_EQ(confusion.share(road), 4.0 / 7);
  EXPECT_DOUBLE_EQ(confusion.iou(pole), 1.0 / 2);  // predicted to be of no class: a miss
  EXPECT_EQ(confusion.count(pole, confusion.classes()), 1U);
  EXPECT_DOUBLE_EQ(confusion.iou(car), 1);
  EXPECT_DOUBLE_EQ(confusion.iou(terrain), 0);  // predicted alone: not in the mean
  EXPECT_TRUE(std::isnan(confusion.iou(fence)));
  EXPECT_TRUE(std::isnan(confusion.recall(terrain)));
  EXPECT_DOUBLE_EQ(confusion.mean_iou(), (0.75 + 0.5 + 1) / 3);
  // A seventh of the points is the car's.
  EXPECT_TRUE(confusion.is_rare(car, 0.15));
  EXPECT_FALSE(confusion.is_rare(car, 1.0 / 7));
  EXPECT_FALSE(confusion.is_rare(fence, 0.15));
  EXPECT_DOUBLE_EQ(confusion.mean_iou(0.15), (0.75 + 0.5) / 2);
  EXPECT_TRUE(std::isnan(confusion.mean_iou(1)));
}

// Oracle: by hand: terrain is ground as road is, a car is as movable as another vehicle.
TEST(SegmentationConfusion, GroupsForgiveWithinThemselves) {
  const Ids truth = {40, 40, 80, 10, 70, 50, 50, 0};
  const Ids predicted = {72, 40, 70, 259, 70, 50, 10, 40};
  const BenchmarkClasses classes(semantickitti_labels());
  const SegmentationConfusion groups = grouped(confusion_of(predicted, truth), classes);
  EXPECT_EQ(segmentation_groups(),
            (std::vector<std::string>{"ground", "surface", "linear", "non-surface", "movable"}));
  ASSERT_EQ(groups.classes(), 5U);
  const std::vector<double> expected = {1, 0.5, 0, 0.5, 0.5};
  for (std::size_t g = 0; g < 5; ++g) EXPECT_DOUBLE_EQ(groups.iou(g), expected[g]) << g;
  EXPECT_DOUBLE_EQ(groups.mean_iou(), 0.5);
  EXPECT_EQ(groups.points(), 7U);
  EXPECT_EQ(groups.ignored(), 1U);
}

// Oracle: one loop, and the same points in two parts.
TEST(SegmentationConfusion, AnyThreadsAndParts) {
  std::mt19937 random(7);
  const auto classes = semantickitti_labels().classes();
  const std::size_t points = 3 * kCoarseGrain + 5;
  Ids predicted, truth;
  for (std::size_t i = 0; i < points; ++i) {
    predicted.push_back(classes[random() % classes.size()].id);
    truth.push_back(classes[random() % classes.size()].id);
  }
  const BenchmarkClasses judged(semantickitti_labels());
  SegmentationConfusion expected(19), parts(19);
  for (std::size_t i = 0; i < points; ++i)
    expected.add(*judged.find(truth[i]), *judged.find(predicted[i]), 1);
  const std::span<const std::uint16_t> all_predicted = predicted, all_true = truth;
  SegmentationConfusion rest(19);
  parts.add(all_predicted.first(1000), all_true.first(1000), judged, Executor(1));
  rest.add(all_predicted.subspan(1000), all_true.subspan(1000), judged, Executor(3));
  parts += rest;
  const SegmentationConfusion one = confusion_of(predicted, truth, 1);
  const SegmentationConfusion four = confusion_of(predicted, truth, 4);
  for (std::size_t t = 0; t <= 19; ++t) {
    for (std::size_t p = 0; p <= 19; ++p) {
      EXPECT_EQ(one.count(t, p), expected.count(t, p));
      EXPECT_EQ(four.count(t, p), expected.count(t, p));
      EXPECT_EQ(parts.count(t, p), expected.count(t, p));
    }
  }
}

TEST(SegmentationConfusion, NoPointsAndOne) {
  const SegmentationConfusion nothing = confusion_of({}, {});
  EXPECT_EQ(nothing.points(), 0U);
  EXPECT_TRUE(std::isnan(nothing.accuracy()));
  EXPECT_TRUE(std::isnan(nothing.mean_iou()));
  EXPECT_TRUE(std::isnan(confusion_of({40}, {0}).mean_iou()));
  EXPECT_DOUBLE_EQ(confusion_of({40}, {40}).mean_iou(), 1);
  EXPECT_DOUBLE_EQ(confusion_of({0}, {40}).mean_iou(), 0);
}

TEST(SegmentationConfusion, WrongLabels) {
  expect_error(ErrorKind::data, {"2 predicted labels", "1 true"}, [] {
    confusion_of({40, 40}, {40});
  });
  expect_error(ErrorKind::data, {"class 2 of the predicted", "'semantickitti'"}, [] {
    confusion_of({7, 2, 40}, {40, 40, 3});
  });
  expect_error(ErrorKind::data, {"class 65535 of the true"}, [] { confusion_of({0}, {65535}); });
  for (const double share : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()})
    expect_error(ErrorKind::usage, {"min_share"}, [&] { check({.min_share = share}); });
  check({.min_share = 0});
  check({.min_share = 1});
}

}  // namespace
}  // namespace adasplats
