// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/world/world.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/synth/world/world_plan.h"

namespace adasplats {
namespace {

constexpr std::array kKinds = {WorldKind::residential, WorldKind::suburban, WorldKind::rural,
                               WorldKind::motorway, WorldKind::city};

std::set<std::uint16_t> classes_of(const SynthWorld& world) {
  std::set<std::uint16_t> classes(world.street.fixed.classes.begin(),
                                  world.street.fixed.classes.end());
  for (const MovingObject& object : world.street.moving)
    classes.insert(object.mesh.classes.begin(), object.mesh.classes.end());
  return classes;
}

// Oracle: SemanticKITTI's list of learned classes (semantic-kitti.yaml), moving or not.
TEST(SynthWorld, KindsTogetherHaveEveryClass) {
  std::set<std::uint16_t> seen;
  for (const WorldKind kind : kKinds)
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
      seen.merge(classes_of(make_world({.seed = seed, .kind = kind, .length_m = 120})));
  constexpr std::array<std::pair<int, int>, 20> kLearnt = {
      {{10, 252}, {11, 11},  {15, 15}, {18, 258}, {13, 257}, {20, 259}, {30, 254},
       {31, 253}, {32, 255}, {40, 60}, {44, 44},  {48, 48},  {49, 49},  {50, 50},
       {51, 51},  {70, 70},  {71, 71}, {72, 72},  {80, 80},  {81, 81}}};
  for (const auto& [standing, moving] : kLearnt)
    EXPECT_TRUE(seen.count(static_cast<std::uint16_t>(standing)) > 0 ||
                seen.count(static_cast<std::uint16_t>(moving)) > 0)
        << standing;
}

TEST(SynthWorld, DependsOnlyOnItsOptions) {
  const WorldOptions options = {.seed = 4, .kind = WorldKind::residential, .length_m = 80};
  const SynthWorld one = make_world(options);
  const SynthWorld same = make_world(options);
  const SynthWorld other = make_world({.seed = 5, .kind = options.kind, .length_m = 80});
  EXPECT_EQ(one.street.fixed.vertices, same.street.fixed.vertices);
  EXPECT_EQ(one.street.fixed.classes, same.street.fixed.classes);
  EXPECT_EQ(one.street.moving.size(), same.street.moving.size());
  EXPECT_NE(one.street.fixed.vertices, other.street.fixed.vertices);
}

TEST(SynthWorld, EveryTriangleIsFiniteAndHasItsAttributes) {
  for (const WorldKind kind : kKinds) {
    const SynthWorld world = make_world({.seed = 2, .kind = kind, .length_m = 80});
    const TriangleMesh& mesh = world.street.fixed;
    EXPECT_GT(mesh.triangles.size(), 10'000U);
    ASSERT_EQ(mesh.classes.size(), mesh.triangles.size());
    ASSERT_EQ(world.street.instances.size(), mesh.triangles.size());
    ASSERT_EQ(world.street.reflectances.size(), mesh.triangles.size());
    for (const Vec3f& v : mesh.vertices)
      ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
    for (const float reflectance : world.street.reflectances)
      ASSERT_TRUE(reflectance > 0 && reflectance <= 1) << reflectance;
  }
}

// Oracle: the plan's own height in the driven lane.
TEST(SynthWorld, DriveIsOnTheRoad) {
  for (const WorldKind kind : kKinds) {
    const WorldOptions options = {.seed = 3, .kind = kind, .length_m = 80};
    const WorldPlan plan(options);
    const SynthWorld world = make_world(options);
    ASSERT_EQ(world.drive.size(), 160U);
    const double lane = plan.driven_line();
    for (std::size_t k = 0; k < world.drive.size(); ++k) {
      const double s = 0.5 * static_cast<double>(k);
      EXPECT_EQ(plan.cell_at(s, -lane).ground, Ground::road);
      EXPECT_NEAR(world.drive[k].world_from_sensor.translation.z, plan.height(s, -lane), 1e-9);
    }
  }
}

TEST(SynthWorld, RejectsALengthOutOfRange) {
  for (const double length_m : {0.0, 79.0, 1001.0, std::nan("")}) {
    expect_error(ErrorKind::usage, {}, [&] { make_world({.length_m = length_m}); });
  }
}

// Oracle: a displacement of d along the normal of the axis has length d and keeps the heading.
TEST(WorldRoute, PositionsBesideTheAxisHaveTheirDistance) {
  const WorldRoute route(200, {90, 0.05}, Random(1, 2, 3));
  EXPECT_EQ(route.at(0, 0), (Vec3d{0, 0, 0}));
  for (const double s : {0.0, 33.3, 100.0, 199.0}) {
    const Vec3d off = route.at(s, 12) - route.at(s, 0);
    EXPECT_NEAR(length(off), 12, 1e-9);
    EXPECT_NEAR(off.x * std::cos(route.heading(s)) + off.y * std::sin(route.heading(s)), 0, 1e-9);
    EXPECT_NEAR(length(route.at(s + 0.5, 0) - route.at(s, 0)), 0.5, 1e-3);
    // The radius stays above its limit: inner positions are passed only once.
    EXPECT_LT(std::fabs(route.heading(s + 1) - route.heading(s)), 1 / 90.0 + 1e-9);
  }
}

}  // namespace
}  // namespace adasplats
