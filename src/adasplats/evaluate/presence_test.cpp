// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/presence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/kitti_classes_test.h"

namespace adasplats {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The tests' own numbers: the defaults may be tuned.
PresenceOptions tested_options() {
  PresenceOptions options;
  options.within_m = 0.1;
  options.min_range_m = 2.5;
  options.max_range_m = 50;
  return options;
}

/// A wall across the x-axis, 10 m from the sensors: a disk of radius 2.
std::vector<Disk> wall() { return {{{10, 0, 0}, 2, {-1, 0, 0}}}; }

void add(PointCloud& cloud, Vec3f sensor, Vec3f point) {
  cloud.sensor_positions.push_back(sensor);
  cloud.positions.push_back(point);
}

PresenceResult run(const std::vector<Disk>& disks, const PointCloud& cloud,
                   const LabelScheme* labels = nullptr,
                   const PresenceOptions& options = tested_options(), Vec3d scene_origin = {},
                   int threads = 2) {
  const SceneView scene{disks, nullptr};
  const auto tracer = make_brute_force_tracer(scene);
  return presence(*tracer, scene_origin, cloud, labels, options, Executor(threads));
}

void expect_counts(const Presence& presence, std::size_t points, std::size_t present) {
  EXPECT_EQ(presence.points, points);
  EXPECT_EQ(presence.present, present);
}

/// Whether the wall is at a single point.
bool is_present(Vec3f point, const PresenceOptions& options = tested_options()) {
  PointCloud cloud;
  add(cloud, {0, 0, 0}, point);
  return run(wall(), cloud, nullptr, options).all.present == 1;
}

TEST(Presence, SurfacesCountNearThePointAlongItsRay) {
  EXPECT_TRUE(is_present({10, 0, 0}));
  EXPECT_TRUE(is_present({10.05F, 0, 0}));
  EXPECT_TRUE(is_present({9.95F, 0, 0}));
  EXPECT_FALSE(is_present({10.15F, 0, 0}));  // behind the wall
  EXPECT_FALSE(is_present({9.85F, 0, 0}));   // and behind it
  EXPECT_FALSE(is_present({-10, 0, 0}));
  EXPECT_FALSE(is_present({10, 2.1F, 0}));  // next to the wall
  EXPECT_TRUE(is_present({10, 1.9F, 0}));
  // At 45 degrees the ray is 0.07 m off the wall's plane by 0.1 m along it.
  std::vector<Disk> oblique = {{{10, 0, 0}, 2, {-std::sqrt(0.5F), std::sqrt(0.5F), 0}}};
  for (const auto& [off_m, present] : {std::pair{0.06F, true}, {0.08F, false}}) {
    PointCloud cloud;
    add(cloud, {0, 0, 0}, Vec3f{10, 0, 0} - off_m * oblique[0].normal);
    EXPECT_EQ(run(oblique, cloud).all.present, present ? 1U : 0U) << off_m;
  }
}

TEST(Presence, TheDistanceIsTheOneAskedFor) {
  PresenceOptions options = tested_options();
  options.within_m = 0.5;
  EXPECT_TRUE(is_present({10.45F, 0, 0}, options));
  EXPECT_FALSE(is_present({10.55F, 0, 0}, options));
  options.within_m = 0.01;
  EXPECT_FALSE(is_present({9.98F, 0, 0}, options));
  EXPECT_TRUE(is_present({9.995F, 0, 0}, options));
  options.within_m = 30;  // farther than the sensor: the part of the ray starts there
  EXPECT_TRUE(is_present({3, 0, 0}, options));
  EXPECT_FALSE(is_present({-3, 0, 0}, options));
}

TEST(Presence, SurfacesFarBeforeThePointDoNotHideThoseAtIt) {
  std::vector<Disk> disks = wall();
  disks.push_back({{5, 0, 0}, 2, {-1, 0, 0}});
  PointCloud cloud;
  add(cloud, {0, 0, 0}, {10.03F, 0, 0});
  add(cloud, {0, 0, 0}, {4.97F, 0, 0});
  add(cloud, {0, 0, 0}, {7, 0, 0});
  const PresenceResult result = run(disks, cloud);
  expect_counts(result.all, 3, 2);
  EXPECT_DOUBLE_EQ(result.all.share(), 2.0 / 3);
}

TEST(Presence, EveryPointHasItsOwnSensor) {
  PointCloud cloud;
  add(cloud, {10, 0, 5}, {10, 0, 0});  // within the wall's plane: meets it nowhere
  add(cloud, {20, 0, 0}, {10, 0, 0});  // from behind
  add(cloud, {0, 30, 0}, {10, 0, 0});
  add(cloud, {8, -3, 1}, {10, 1, -1});
  add(cloud, {8, -3, 1}, {10, -3, -1});
  expect_counts(run(wall(), cloud).all, 5, 3);
}

TEST(Presence, RangesChooseThePoints) {
  std::vector<Disk> disks;
  PointCloud cloud;
  for (const float range_m : {2.0F, 2.5F, 3.0F, 20.0F, 50.0F, 51.0F}) {
    disks.push_back({{range_m, 0, 0}, 1, {1, 0, 0}});
    add(cloud, {100, 0, 0}, {100 + range_m, 0, 0});
    add(cloud, {0, 0, 0}, {range_m, 0, 0});
  }
  expect_counts(run(disks, cloud).all, 8, 4);  // both bounds belong to them
  PresenceOptions options = tested_options();
  options.min_range_m = 0;
  options.max_range_m = kInfinity;
  add(cloud, {1, 2, 3}, {1, 2, 3});  // no direction: nothing is there
  expect_counts(run(disks, cloud, nullptr, options).all, 13, 6);
  options.min_range_m = 2.4;
  options.max_range_m = 2.6;
  expect_counts(run(disks, cloud, nullptr, options).all, 2, 1);
}

TEST(Presence, SceneAndCloudHaveTheirOwnOrigins) {
  const Vec3d sensor = {448262.25, 5411932.5, 212};
  const Vec3d scene_origin = {447000, 5412000, 0};
  const Vec3d center = sensor + Vec3d{10, 0, 0};
  const std::vector<Disk> disks = {{vec_cast<float>(center - scene_origin), 2, {-1, 0, 0}}};
  PointCloud cloud;
  cloud.origin = {448000, 5411000, 200};
  const auto local = [&](Vec3d world) { return vec_cast<float>(world - cloud.origin); };
  for (const double off_m : {0.0, 0.05, -0.05, 0.15, -0.15})
    add(cloud, local(sensor), local(center + Vec3d{off_m, 0, 0}));
  expect_counts(run(disks, cloud, nullptr, tested_options(), scene_origin).all, 5, 3);
  // With the wrong origin nothing matches.
  expect_counts(run(disks, cloud, nullptr, tested_options(), cloud.origin).all, 5, 0);
}

/// Points at the wall (true) or 1 m before it.
PointCloud labelled(const std::vector<std::pair<std::uint16_t, bool>>& points) {
  PointCloud cloud;
  for (const auto& [id, at_wall] : points) {
    add(cloud, {0, 0, 0}, {at_wall ? 10.0F : 9.0F, 0, 0});
    cloud.classes.push_back(id);
  }
  return cloud;
}

TEST(Presence, CountsByClassAndWhetherItMoves) {
  const LabelScheme labels = load_label_scheme("semantickitti");
  const PointCloud cloud = labelled({{kMovingPerson, true},
                                     {kRoad, true},
                                     {kMovingCar, false},
                                     {kPole, false},
                                     {kRoad, true},
                                     {kCar, true},
                                     {kRoad, false},
                                     {kMovingCar, false}});
  const PresenceResult result = run(wall(), cloud, &labels);
  expect_counts(result.all, 8, 4);
  expect_counts(result.moving, 3, 1);
  expect_counts(result.still, 5, 3);  // a parked car is one of them
  ASSERT_EQ(result.by_class.size(), 5U);
  const auto expect_class = [&](std::size_t i, const std::string& name, std::size_t points,
                                std::size_t present) {
    EXPECT_EQ(result.by_class[i].first, name);
    expect_counts(result.by_class[i].second, points, present);
  };
  expect_class(0, "car", 1, 1);
  expect_class(1, "road", 3, 2);
  expect_class(2, "pole", 1, 0);
  expect_class(3, "moving-car", 2, 0);
  expect_class(4, "moving-person", 1, 1);
  EXPECT_EQ(result.by_class[2].second.share(), 0.0);
}

TEST(Presence, WithoutLabelsAllIsStill) {
  const LabelScheme labels = load_label_scheme("semantickitti");
  PointCloud cloud = labelled({{kMovingCar, true}, {kRoad, false}, {9999, true}});
  const auto check = [](const PresenceResult& result) {
    expect_counts(result.all, 3, 2);
    expect_counts(result.still, 3, 2);
    expect_counts(result.moving, 0, 0);
    EXPECT_TRUE(std::isnan(result.moving.share()));
    EXPECT_TRUE(result.by_class.empty());
  };
  check(run(wall(), cloud));
  cloud.classes.clear();
  check(run(wall(), cloud, &labels));
}

TEST(Presence, NoSurfacesAtAll) {
  const PresenceResult result = run({}, labelled({{kRoad, true}, {kRoad, false}}));
  expect_counts(result.all, 2, 0);
  EXPECT_EQ(result.all.share(), 0.0);
}

std::optional<ErrorKind> kind_of_error(const PointCloud& cloud, const PresenceOptions& options,
                                       const LabelScheme* labels = nullptr) {
  try {
    run(wall(), cloud, labels, options);
  } catch (const Error& error) {
    return error.kind();
  }
  return std::nullopt;
}

TEST(Presence, InvalidOptionsAreAnError) {
  const PointCloud cloud = labelled({{kRoad, true}});
  const auto kind_with = [&](double within_m, double min_range_m, double max_range_m) {
    return kind_of_error(cloud, {within_m, min_range_m, max_range_m});
  };
  EXPECT_EQ(kind_with(0.1, 0, kInfinity), std::nullopt);
  for (const double within_m : {0.0, -0.1, std::nan(""), kInfinity})
    EXPECT_EQ(kind_with(within_m, 2.5, 50), ErrorKind::usage) << within_m;
  EXPECT_EQ(kind_with(0.1, -1, 50), ErrorKind::usage);
  EXPECT_EQ(kind_with(0.1, 50, 50), ErrorKind::usage);
  EXPECT_EQ(kind_with(0.1, 50, 2.5), ErrorKind::usage);
  EXPECT_EQ(kind_with(0.1, std::nan(""), 50), ErrorKind::usage);
  EXPECT_EQ(kind_with(0.1, 2.5, std::nan("")), ErrorKind::usage);
}

TEST(Presence, CloudsWithoutRaysAreAnError) {
  const LabelScheme labels = load_label_scheme("semantickitti");
  const PresenceOptions options = tested_options();
  EXPECT_EQ(kind_of_error({}, options), ErrorKind::data);
  PointCloud cloud = labelled({{kRoad, true}, {9999, true}});
  EXPECT_EQ(kind_of_error(cloud, options), std::nullopt);
  EXPECT_EQ(kind_of_error(cloud, options, &labels), ErrorKind::data);  // no class 9999
  try {
    run(wall(), cloud, &labels);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("class 9999"), std::string::npos) << error.what();
  }
  cloud.classes = {kRoad, kRoad};
  EXPECT_EQ(kind_of_error(cloud, options, &labels), std::nullopt);
  EXPECT_EQ(kind_of_error(cloud, {0.1, 2.5, 8}), ErrorKind::data);  // all are farther
  EXPECT_EQ(kind_of_error(cloud, {0.1, 12, 50}), ErrorKind::data);  // or nearer
  cloud.sensor_positions.clear();
  EXPECT_EQ(kind_of_error(cloud, options), ErrorKind::data);
}

/// Oracle: more points than are cast at once, each on its own way to the wall's plane; whether the
/// wall is within 0.1 m of it along that way follows from its position alone.
TEST(Presence, SameForEveryNumberOfThreads) {
  const LabelScheme labels = load_label_scheme("semantickitti");
  constexpr std::size_t kPoints = 300000;
  PointCloud cloud;
  std::size_t moving = 0, moving_present = 0, still_present = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    Random random(6, 0, i);
    const double y = random.uniform(-3, 3), z = random.uniform(-3, 3);
    const double slant = std::sqrt(100 + y * y + z * z) / 10;
    const double off_m = std::floor(random.uniform(-4, 5)) * 0.04;  // -0.16 to 0.16 along the ray
    const double share = 1 + off_m / (10 * slant);
    add(cloud, {0, 0, 0}, vec_cast<float>(share * Vec3d{10, y, z}));
    const bool moves = random.uniform() < 0.25;
    cloud.classes.push_back(moves ? kMovingCar : kRoad);
    const bool present = std::fabs(off_m) < 0.1 && std::hypot(y, z) < 2;
    if (moves) ++moving;
    if (present) ++(moves ? moving_present : still_present);
  }
  for (const int threads : {1, 2, 3}) {
    const PresenceResult result = run(wall(), cloud, &labels, tested_options(), {}, threads);
    expect_counts(result.all, kPoints, moving_present + still_present);
    expect_counts(result.moving, moving, moving_present);
    expect_counts(result.still, kPoints - moving, still_present);
  }
}

}  // namespace
}  // namespace adasplats
