// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/street.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/synth/street_plan.h"

namespace adasplats {
namespace {

void expect_well_formed(const TriangleMesh& mesh, std::span<const float> reflectances) {
  ASSERT_FALSE(mesh.triangles.empty());
  ASSERT_EQ(mesh.classes.size(), mesh.triangles.size());
  ASSERT_EQ(reflectances.size(), mesh.triangles.size());
  std::size_t bad_index = 0, degenerate = 0, unknown_class = 0, bad_reflectance = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    bool inside = true;
    for (const std::uint32_t v : mesh.triangles[i]) inside = inside && v < mesh.vertices.size();
    if (!inside) {
      ++bad_index;
      continue;
    }
    const Triangle t = mesh.triangle(i);
    if (!(0.5F * length(cross(t.b - t.a, t.c - t.a)) > 0.5e-8F)) ++degenerate;
    if (semantickitti_labels().find(mesh.classes[i]) == nullptr) ++unknown_class;
    if (!(reflectances[i] >= 0 && reflectances[i] <= 1)) ++bad_reflectance;
  }
  EXPECT_EQ(bad_index, 0U);
  EXPECT_EQ(degenerate, 0U);
  EXPECT_EQ(unknown_class, 0U);
  EXPECT_EQ(bad_reflectance, 0U);
  std::size_t not_finite = 0;
  for (const Vec3f& v : mesh.vertices) not_finite += is_finite(v) ? 0U : 1U;
  EXPECT_EQ(not_finite, 0U);
}

class StreetOf : public testing::TestWithParam<std::pair<std::uint64_t, double>> {};

TEST_P(StreetOf, IsWellFormedAndHasEveryDocumentedClass) {
  const auto [seed, length_m] = GetParam();
  const Street street = make_street({seed, length_m});
  EXPECT_EQ(street.length_m, length_m);
  expect_well_formed(street.fixed, street.reflectances);
  ASSERT_EQ(street.instances.size(), street.fixed.triangles.size());

  const std::set<std::uint16_t> fixed(street.fixed.classes.begin(), street.fixed.classes.end());
  EXPECT_EQ(fixed, (std::set<std::uint16_t>{10, 40, 48, 49, 50, 51, 52, 70, 71, 72, 80, 81, 99}));
  std::set<std::uint16_t> moving;
  for (const MovingObject& object : street.moving) {
    expect_well_formed(object.mesh, object.reflectances);
    moving.insert(object.mesh.classes.begin(), object.mesh.classes.end());
  }
  EXPECT_EQ(moving, (std::set<std::uint16_t>{252, 254}));
}

TEST_P(StreetOf, EachCarAndMoverHasItsOwnInstance) {
  const auto [seed, length_m] = GetParam();
  const Street street = make_street({seed, length_m});
  std::set<std::uint16_t> parked;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < street.instances.size(); ++i) {
    const bool car = street.fixed.classes[i] == label::kCar;
    if (car != (street.instances[i] != 0)) ++wrong;
    if (car) parked.insert(street.instances[i]);
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_GE(parked.size(), 3U);
  std::set<std::uint16_t> all = parked;
  for (const MovingObject& object : street.moving) {
    EXPECT_TRUE(all.insert(object.instance).second) << object.instance;
    for (std::size_t k = 1; k < object.world_from_object.size(); ++k)
      EXPECT_LT(object.world_from_object[k - 1].time_s, object.world_from_object[k].time_s);
  }
}

// Oracle: the analytic height of the road.
TEST_P(StreetOf, RoadFollowsItsHeight) {
  const auto [seed, length_m] = GetParam();
  const Street street = make_street({seed, length_m});
  std::size_t corners = 0;
  double worst = 0;
  for (std::size_t i = 0; i < street.fixed.triangles.size(); ++i) {
    if (street.fixed.classes[i] != label::kRoad) continue;
    for (const std::uint32_t v : street.fixed.triangles[i]) {
      const Vec3d p = vec_cast<double>(street.fixed.vertices[v]);
      worst = std::max(worst, std::fabs(p.z - road_height(p.x, p.y)));
      ++corners;
    }
  }
  EXPECT_GT(corners, 1000U);
  EXPECT_LT(worst, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(SeedsAndLengths, StreetOf,
                         testing::Values(std::pair{1, 50.0}, std::pair{1, 60.0}, std::pair{2, 60.0},
                                         std::pair{3, 75.5}, std::pair{4, 180.0}));

TEST(Street, RoadHasCrossfallToTheKerbs) {
  for (const double x : {0.0, 17.3, 42.0}) {
    EXPECT_NEAR(road_height(x, 0) - road_height(x, kRoadHalfWidth), 0.02 * kRoadHalfWidth, 1e-12);
    EXPECT_NEAR(road_height(x, 3), road_height(x, -3), 1e-12);
  }
}

TEST(Street, DependsOnlyOnItsOptions) {
  const Street one = make_street({7, 60});
  const Street again = make_street({7, 60});
  const Street other = make_street({8, 60});
  EXPECT_EQ(one.fixed.vertices, again.fixed.vertices);
  EXPECT_EQ(one.fixed.triangles, again.fixed.triangles);
  EXPECT_EQ(one.fixed.classes, again.fixed.classes);
  EXPECT_EQ(one.reflectances, again.reflectances);
  EXPECT_NE(one.fixed.vertices, other.fixed.vertices);
}

TEST(Street, RejectsLengthsOutOfRange) {
  for (const double length_m : {0.0, -5.0, 49.0, 2001.0, std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN()}) {
    expect_error(ErrorKind::usage, {}, [&] { make_street({1, length_m}); });
  }
}

TEST(Street, LengthGrowsWithThePoints) {
  EXPECT_NEAR(street_length_for(300'000), 60, 1e-9);
  EXPECT_NEAR(street_length_for(12'300'000), 265, 0.5);
  EXPECT_EQ(street_length_for(0), kMinStreetLength_m);
}

}  // namespace
}  // namespace adasplats
