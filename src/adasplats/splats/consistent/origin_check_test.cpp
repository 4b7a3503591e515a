// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/origin_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/splats/build_model.h"
#include "adasplats/splats/consistent/consistent_steps.h"

namespace adasplats::origins {
namespace {

/// Of 20 times as many crossed seeds; from each place so many times as many are contradicted.
MovedEvidence part(std::uint64_t contradicted, std::array<double, kOriginMoves.size()> times) {
  MovedEvidence made;
  made.given = {20 * contradicted, contradicted};
  for (std::size_t k = 0; k < times.size(); ++k)
    made.moved[k] = {made.given.crossed,
                     static_cast<std::uint64_t>(times[k] * static_cast<double>(contradicted))};
  return made;
}

constexpr std::array<double, kOriginMoves.size()> kRight = {1.2, 1.25, 1.3, 1.4, 2, 1.5, 1.8, 2};
constexpr std::array<double, kOriginMoves.size()> kEast = {0.5, 1.5, 1.1, 1.1, 0.75, 2, 1.5, 1.5};
constexpr std::array<double, kOriginMoves.size()> kWest = {1.5, 0.5, 1.1, 1.1, 2, 0.75, 1.5, 1.5};

// Expected: counted by hand.
TEST(OriginCheck, EveryPartHasABestPlaceOfItsOwn) {
  const std::vector<MovedEvidence> parts = {part(2000, kEast), part(2000, kWest)};
  const OriginCheck check = origin_check(parts);
  EXPECT_EQ(check.seeds, 80'000U);
  EXPECT_EQ(check.contradicted, 4000U);
  EXPECT_DOUBLE_EQ(check.share(), 0.05);
  EXPECT_DOUBLE_EQ(check.near_rise, 0.5);
  EXPECT_DOUBLE_EQ(check.far_rise, 0.75);
}

// Few contradicted seeds are joined with those of the parts behind them: 0.5 and 1.5 are 1.
TEST(OriginCheck, SmallPiecesAreJoined) {
  const std::vector<MovedEvidence> parts = {part(600, kEast), part(600, kWest), part(800, kRight)};
  const OriginCheck check = origin_check(parts);
  EXPECT_DOUBLE_EQ(check.near_rise, (600 * 0.5 + 600 * 1.5 + 800 * 1.2) / 2000);
}

TEST(OriginCheck, TooFewContradictedSeedsAreInconclusive) {
  const std::vector<MovedEvidence> parts = {part(300, kEast), part(1100, kEast)};
  const OriginCheck check = origin_check(parts);
  EXPECT_EQ(check.contradicted, 1400U);
  EXPECT_EQ(check.near_rise, 0);
  EXPECT_EQ(origin_objection(check), "");
  EXPECT_EQ(origin_doubt(check), "");
  EXPECT_EQ(origin_check({}).share(), 0);
}

TEST(OriginCheck, CorrectWrongAndDoubtfulPositions) {
  const auto of = [](double near, double far) { return OriginCheck{100'000, 5000, near, far}; };
  EXPECT_EQ(origin_objection(of(1.2, 1.4)) + origin_doubt(of(1.2, 1.4)), "");
  const std::string wrong = origin_objection(of(0.76, 1.22));
  EXPECT_NE(wrong.find("0.76 times"), std::string::npos) << wrong;
  EXPECT_NE(wrong.find("1.22 times"), std::string::npos) << wrong;
  EXPECT_EQ(origin_doubt(of(0.76, 1.22)), "");
  EXPECT_NE(origin_objection(of(1.01, 0.9)), "");
  EXPECT_EQ(origin_objection(of(1.0, 1.05)), "");
  EXPECT_NE(origin_doubt(of(1.0, 1.05)), "");
}

/// A street of 60 m between houses with columns before them, driven through and seen from every
/// metre; ahead of the sensor goes a van, which rays from elsewhere go through. Oracle of the
/// beams: the first surface along the ray.
struct Street {
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  /// Where a ray meets an upright cylinder around (x, y).
  static double cylinder_m(Vec3d origin, Vec3d direction, double x, double y, double radius_m) {
    const double dx = x - origin.x, dy = y - origin.y;
    const double across = direction.x * direction.x + direction.y * direction.y;
    const double t = (dx * direction.x + dy * direction.y) / across;
    const double inside = radius_m * radius_m - (dx * dx + dy * dy - t * t * across);
    return t > 0 && inside > 0 ? t - std::sqrt(inside / across) : kNone;
  }
  static double range_m(Vec3d origin, Vec3d direction) {
    const double house_y = direction.y > 0 ? 6 : -6;
    double nearest = direction.y == 0 ? kNone : (house_y - origin.y) / direction.y;
    if (direction.z < 0) nearest = std::min(nearest, -origin.z / direction.z);
    for (int k = -2; k <= 14; ++k)
      for (const double y : {-5.0, 5.0})
        nearest = std::min(nearest, cylinder_m(origin, direction, 5.0 * k, y, 0.3));
    return std::min(nearest, cylinder_m(origin, direction, origin.x + 6, 0.5, 0.8));
  }
};

PointCloud street() {
  PointCloud cloud;
  for (std::uint64_t i = 0; i < 160'000; ++i) {
    Random random(5, 0, i);
    const Vec3d sensor = {std::floor(random.uniform(0, 60)), 1.5, 1.8};
    const double azimuth = random.uniform(0, 6.283185), elevation = random.uniform(-0.4, 0.3);
    const Vec3d direction = {std::cos(elevation) * std::cos(azimuth),
                             std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
    const double range = Street::range_m(sensor, direction) + 0.01 * random.normal();
    if (range > 30) continue;
    cloud.positions.push_back(vec_cast<float>(sensor + range * direction));
    cloud.sensor_positions.push_back(vec_cast<float>(sensor));
  }
  return cloud;
}

OriginCheck check_of(const PointCloud& cloud, const std::vector<std::uint8_t>& removed = {}) {
  const Executor executor(2);
  const auto steps = make_cpu_consistent_steps(executor);
  steps->load(cloud, ClassTables{removed, {}});
  steps->fuse({});
  steps->fit_seeds({});
  return origin_check(steps->check_origins({}));
}

PointCloud moved(PointCloud cloud, const std::function<Vec3f(Vec3f)>& place) {
  for (Vec3f& sensor : cloud.sensor_positions) sensor = place(sensor);
  return cloud;
}

struct WrongPlaces {
  const char* name;
  std::function<Vec3f(Vec3f)> place;
};

const std::vector<WrongPlaces>& wrong_places() {
  static const std::vector<WrongPlaces> all = {{"x and y exchanged",
                                                [](Vec3f p) {
                                                  return Vec3f{p.y, p.x, p.z};
                                                }},
                                               {"y mirrored",
                                                [](Vec3f p) {
                                                  return Vec3f{p.x, -p.y, p.z};
                                                }},
                                               {"2 m along",
                                                [](Vec3f p) {
                                                  return p + Vec3f{2, 0, 0};
                                                }},
                                               {"backwards",
                                                [](Vec3f p) {
                                                  return Vec3f{60 - p.x, p.y, p.z};
                                                }},
                                               {"one place", [](Vec3f) {
                                                  return Vec3f{30, 1.5F, 1.8F};
                                                }}};
  return all;
}

BuildReport build_report(const PointCloud& cloud, bool trust_origins = false) {
  BuildOptions options;
  options.trust_origins = trust_origins;
  ProgressSink quiet;
  return build_model(cloud, nullptr, options, Executor(2), quiet).second;
}

TEST(OriginCheck, RaysGoThroughFewestSeedsFromWhereTheSensorWas) {
  const OriginCheck check = check_of(street());
  EXPECT_GT(check.contradicted, 1500U);
  EXPECT_GT(check.near_rise, 1.1);
  EXPECT_GT(check.far_rise, 1.3);
  for (const WrongPlaces& wrong : wrong_places()) {
    const OriginCheck other = check_of(moved(street(), wrong.place));
    EXPECT_NE(origin_objection(other), "")
        << wrong.name << ": " << other.near_rise << ", " << other.far_rise;
  }
}

TEST(OriginCheck, WrongSensorPositionsAreAnErrorUnlessTheyAreTrusted) {
  const BuildReport checked = build_report(street()), unchecked = build_report(street(), true);
  const std::optional<ConsistentReport>& right = checked.consistent;
  ASSERT_TRUE(right->origins.has_value());
  EXPECT_EQ(checked.primitives, unchecked.primitives);
  EXPECT_EQ(right->seeds_removed, unchecked.consistent->seeds_removed);
  EXPECT_EQ(right->origins->contradicted, check_of(street()).contradicted);
  const PointCloud wrong = moved(street(), wrong_places()[0].place);
  try {
    build_report(wrong);
    ADD_FAILURE() << "wrong sensor positions are taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data);
    EXPECT_NE(std::string(error.what()).find("sensor positions"), std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(build_report(wrong, true).consistent->origins.has_value());
}

// Points are looked at in the order that they have in space, so theirs in the cloud is no matter.
TEST(OriginCheck, TheOrderOfPointsIsNoMatter) {
  const PointCloud cloud = street();
  std::vector<std::uint32_t> backwards(cloud.size());
  std::iota(backwards.rbegin(), backwards.rend(), 0U);
  const OriginCheck one = check_of(cloud), other = check_of(gather(cloud, backwards));
  EXPECT_EQ(one.seeds, other.seeds);
  EXPECT_EQ(one.contradicted, other.contradicted);
  EXPECT_EQ(one.near_rise, other.near_rise);
  EXPECT_EQ(one.far_rise, other.far_rise);
}

TEST(SampleBeams, HasMeasuredBeamsOfKeptClassesAndAsManyAsAreEnough) {
  PointCloud cloud = street();
  const std::size_t all = cloud.size();
  EXPECT_EQ(sample_beams(cloud, {}, all).size(), all);
  // Of 10 million points 400,000 are enough.
  const double expected = 0.04 * static_cast<double>(all);
  EXPECT_NEAR(static_cast<double>(sample_beams(cloud, {}, 10'000'000).size()), expected,
              5 * std::sqrt(expected));
  cloud.classes.resize(all, 1);
  cloud.origin_kinds.resize(all, OriginKind::measured);
  cloud.classes[7] = 2;
  cloud.origin_kinds[8] = OriginKind::guessed;
  std::vector<std::uint8_t> removed(1 << 16);
  removed[2] = 1;
  EXPECT_EQ(sample_beams(cloud, removed, all).size(), all - 2);
  cloud.sensor_positions.clear();
  EXPECT_TRUE(sample_beams(cloud, removed, all).empty());
}

// Median by hand; what is near counts as 10 m.
TEST(SampleBeams, UnitOfMovesIsTheMedianRangeAndNotLessThanTenMetres) {
  PointCloud beams;
  for (const float range_m : {4.0F, 30.0F, 50.0F}) {
    beams.positions.push_back({range_m, 0, 0});
    beams.sensor_positions.push_back({0, 0, 0});
  }
  EXPECT_EQ(origin_unit_m(beams), 30);
  beams.positions[1].x = beams.positions[2].x = 5;
  EXPECT_EQ(origin_unit_m(beams), 10);
  EXPECT_EQ(origin_unit_m({}), 10);
}

}  // namespace
}  // namespace adasplats::origins
