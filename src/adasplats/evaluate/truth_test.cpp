// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/truth.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "adasplats/core/error.h"
#include "adasplats/evaluate/kitti_classes_test.h"

namespace adasplats {
namespace {

/// Position of the sensor; the tests' coordinates are relative to it.
constexpr Vec3d kSensor = {7000, 100, 2};

/// A square plate as two triangles: `middle`, half the side, unit axes of the plane.
void add_plate(MeshModel& model, Vec3d middle, double half_m, Vec3d u, Vec3d v,
               std::uint16_t class_id = kBuilding) {
  const auto first = static_cast<std::uint32_t>(model.mesh.vertices.size());
  for (const auto& [a, b] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
    const Vec3d corner = kSensor + middle + half_m * (a * u + b * v);
    model.mesh.vertices.push_back(vec_cast<float>(corner - model.origin));
  }
  model.mesh.triangles.push_back({first, first + 1, first + 2});
  model.mesh.triangles.push_back({first, first + 2, first + 3});
  model.mesh.classes.insert(model.mesh.classes.end(), 2, class_id);
}

/// A wall perpendicular to a direction in the xy-plane, `range_m` away.
void add_wall(MeshModel& model, Vec3d direction, double range_m, double half_m,
              std::uint16_t class_id = kBuilding) {
  const Vec3d ahead = normalized(direction);
  add_plate(model, range_m * ahead, half_m, {-ahead.y, ahead.x, 0}, {0, 0, 1}, class_id);
}

MeshModel true_mesh() {
  MeshModel model;
  model.origin = {7000, 0, 0};
  return model;
}
/// The model's local origin is another one than that of the truth.
MeshModel other_mesh() {
  MeshModel model;
  model.origin = {6000, 0, 0};
  return model;
}

/// Rays in these directions, all on ring 0.
LidarModel sensor_with(const std::vector<Vec3d>& directions) {
  LidarModel sensor;
  sensor.max_range_m = 50;
  for (const Vec3d direction : directions)
    sensor.free_pattern.push_back({vec_cast<float>(normalized(direction)), 0, 0, 0.0F});
  return sensor;
}

TruthResult run(const MeshModel& model, const MeshModel& truth, const LidarModel& sensor,
                const TruthOptions& options = {}, int threads = 2) {
  const SceneView view = model.view();
  const auto tracer = make_brute_force_tracer(view);
  Trajectory poses(1);
  poses[0].world_from_sensor.translation = kSensor;
  ProgressSink quiet;
  return compare_with_truth(*tracer, model.origin, truth, &semantickitti_labels(), sensor, poses,
                            options, Executor(threads), quiet);
}

constexpr Vec3d kEast = {1, 0, 0}, kWest = {-1, 0, 0}, kNorth = {0, 1, 0}, kSouth = {0, -1, 0};

// Analytic: four walls, each moved along the ray that meets it.
TEST(Truth, MovedWallsGiveExactErrors) {
  MeshModel truth = true_mesh();
  MeshModel model = other_mesh();
  for (const Vec3d direction : {kEast, kWest, kNorth, kSouth}) add_wall(truth, direction, 10, 2);
  add_wall(model, kEast, 9.75, 2);      // 25 cm too early
  add_wall(model, kWest, 10.75, 2);     // 75 cm too late
  add_wall(model, kNorth, 9.96875, 2);  // 3 cm too early
  add_wall(model, kSouth, 9, 2);        // 1 m too early
  const TruthResult r = run(model, truth, sensor_with({kEast, kWest, kNorth, kSouth}));
  EXPECT_EQ(r.rays, 4U);
  EXPECT_EQ(r.all.range.rays, 4U);
  EXPECT_DOUBLE_EQ(r.all.range.early_50cm, 0.25);
  EXPECT_DOUBLE_EQ(r.all.range.late_50cm, 0.25);
  EXPECT_DOUBLE_EQ(r.all.range.within.at(0.02), 0.0);
  EXPECT_DOUBLE_EQ(r.all.range.within.at(0.05), 0.25);
  EXPECT_DOUBLE_EQ(r.all.range.within.at(0.50), 0.5);
  EXPECT_NEAR(r.all.range.median_m, 0.5, 1e-4);
  EXPECT_NEAR(r.all.range.mae_m, (0.25 + 0.75 + 0.03125 + 1) / 4, 1e-4);
  EXPECT_DOUBLE_EQ(r.all.hole_share, 0.25);
  // Each point is as far from the surface as its range is wrong.
  EXPECT_EQ(r.all.surface.points, 4U);
  EXPECT_NEAR(r.all.surface.mean_m, (0.25 + 0.75 + 0.03125 + 1) / 4, 1e-4);
  EXPECT_NEAR(r.all.surface.median_m, 0.5, 1e-4);
  EXPECT_NEAR(r.all.surface.p95_m, 1.0, 1e-4);
  EXPECT_NEAR(r.all.surface.rmse_m, std::sqrt((0.0625 + 0.5625 + 0.03125 * 0.03125 + 1) / 4), 1e-4);
  EXPECT_TRUE(std::isnan(r.ghost_share));  // every ray meets the truth
  EXPECT_DOUBLE_EQ(r.bleeding_share, 0.0);
}

// Analytic: errors along the ray are not distances to the surface where it is met at an angle.
TEST(Truth, SurfaceDistanceIsAcross) {
  MeshModel truth = true_mesh();
  MeshModel model = other_mesh();
  add_wall(truth, kEast, 10, 20);
  add_wall(model, kEast, 10.125, 20);
  const TruthResult r = run(model, truth, sensor_with({{1, 1, 0}}));
  EXPECT_NEAR(r.all.range.mae_m, 0.125 * std::numbers::sqrt2, 1e-4);
  EXPECT_NEAR(r.all.surface.mean_m, 0.125, 1e-4);
}

// Analytic: of ten rays on a wall three fall through a hole and one meets something 1 m behind it.
TEST(Truth, HoleOfKnownShare) {
  MeshModel truth = true_mesh();
  MeshModel model = other_mesh();
  add_wall(truth, kEast, 10, 20);
  std::vector<Vec3d> directions;
  for (int i = 0; i < 10; ++i) {
    const Vec3d there = {10, i - 4.5, 0};
    directions.push_back(there);
    if (i == 2 || i == 3 || i == 7) continue;
    const double scale = i == 5 ? 1.1 : 1.0;
    add_plate(model, scale * there, 0.2, {0, 1, 0}, {0, 0, 1});
  }
  const TruthResult r = run(model, truth, sensor_with(directions));
  EXPECT_DOUBLE_EQ(r.all.hole_share, 0.4);
  EXPECT_DOUBLE_EQ(r.all.range.no_hit, 0.3);
  EXPECT_DOUBLE_EQ(r.all.range.late_50cm, 0.1);
  EXPECT_DOUBLE_EQ(r.all.range.within.at(0.02), 0.6);
  EXPECT_EQ(r.all.surface.points, 7U);
}

// Analytic: five rays into the sky, two of which hit a wall that does not exist.
TEST(Truth, GhostWall) {
  MeshModel truth = true_mesh();
  MeshModel model = other_mesh();
  add_wall(truth, kEast, 10, 2);
  add_wall(model, kEast, 10, 2);
  add_plate(model, {0, 0, 20}, 1, {1, 0, 0}, {0, 1, 0});
  const TruthResult r =
      run(model, truth,
          sensor_with({kEast, {0, 0, 1}, {0, 0.01, 1}, {0, 1, 1}, {1, 0, 1}, {-1, 0, 1}}));
  EXPECT_EQ(r.rays, 6U);
  EXPECT_EQ(r.all.range.rays, 1U);
  EXPECT_DOUBLE_EQ(r.ghost_share, 0.4);
  EXPECT_DOUBLE_EQ(r.all.hole_share, 0.0);
  EXPECT_EQ(r.all.surface.points, 3U);  // the ghosts' points count for the surface
  ASSERT_EQ(r.by_class.size(), 1U);
  EXPECT_EQ(r.by_class[0].second.surface.points, 1U);  // and for no class
}

/// A near wall at 5 m right of the axis and a far one at 10 m left of it, true and modelled, and a
/// small plate in the model on the ray in `direction` at `range_m`.
TruthResult with_stray_point(Vec3d direction, double range_m) {
  MeshModel truth = true_mesh();
  MeshModel model = other_mesh();
  for (MeshModel* mesh : {&truth, &model}) {
    add_plate(*mesh, {5, -20, 0}, 20, {0, 1, 0}, {0, 0, 1});
    add_plate(*mesh, {10, 20, 0}, 20, {0, 1, 0}, {0, 0, 1});
  }
  add_plate(model, range_m * normalized(direction), 0.02, {0, 1, 0}, {0, 0, 1});
  return run(model, truth,
             sensor_with({{1, -0.3, 0}, {1, -0.1, 0}, {1, 0.1, 0}, {1, 0.3, 0}, {1, 0.5, 0}}));
}

// Analytic: a point in the gap bleeds where one of its beam's neighbours is on the other wall.
TEST(Truth, BleedingOfASinglePoint) {
  EXPECT_DOUBLE_EQ(with_stray_point({1, 0.1, 0}, 7.5).bleeding_share, 0.2);
  // The same next to the edge, but with all beams around it on the far wall.
  EXPECT_DOUBLE_EQ(with_stray_point({1, 0.3, 0}, 7.5).bleeding_share, 0.0);
  // 6 cm before the far wall; a point nearer than both walls.
  EXPECT_DOUBLE_EQ(with_stray_point({1, 0.1, 0}, 9.99).bleeding_share, 0.0);
  EXPECT_DOUBLE_EQ(with_stray_point({1, 0.1, 0}, 3).bleeding_share, 0.0);
  EXPECT_DOUBLE_EQ(with_stray_point({1, 0.1, 0}, 3).all.range.early_50cm, 0.2);
}

TEST(Truth, ClassesAreThoseOfTheTruthAndCanBeDropped) {
  MeshModel truth = true_mesh();
  MeshModel model = other_mesh();
  add_wall(truth, kEast, 10, 2, kRoad);
  add_wall(truth, kWest, 10, 2, kCar);
  add_wall(truth, kNorth, 10, 2, kMovingCar);
  add_wall(truth, kSouth, 10, 2, kPole);
  add_wall(model, kEast, 10.25, 2, kPole);  // the model's own classes do not matter
  add_wall(model, kWest, 10, 2);
  const LidarModel sensor = sensor_with({kEast, kWest, kNorth, kSouth, {0, 0, 1}});
  TruthOptions options;
  TruthResult r = run(model, truth, sensor, options);
  EXPECT_EQ(r.rays, 4U);  // the moving car is left out, the sky is not
  ASSERT_EQ(r.by_class.size(), 3U);
  EXPECT_EQ(r.by_class[0].first, "car");
  EXPECT_DOUBLE_EQ(r.by_class[0].second.range.within.at(0.02), 1.0);
  EXPECT_EQ(r.by_class[1].first, "road");
  EXPECT_NEAR(r.by_class[1].second.range.mae_m, 0.25, 1e-4);
  EXPECT_NEAR(r.by_class[1].second.surface.mean_m, 0.25, 1e-4);
  EXPECT_EQ(r.by_class[2].first, "pole");
  EXPECT_DOUBLE_EQ(r.by_class[2].second.hole_share, 1.0);
  EXPECT_TRUE(std::isnan(r.by_class[2].second.surface.mean_m));
  options.drop_movable = true;
  r = run(model, truth, sensor, options);
  EXPECT_EQ(r.rays, 3U);
  EXPECT_EQ(r.by_class.size(), 2U);
  options = {false, false};
  EXPECT_EQ(run(model, truth, sensor, options).rays, 5U);
}

TEST(Truth, RangesOfTheSensorLimitTheTruth) {
  MeshModel truth = true_mesh();
  add_wall(truth, kEast, 10, 2);
  add_wall(truth, kWest, 60, 2);  // beyond 50 m: no true surface
  const TruthResult r = run(truth, truth, sensor_with({kEast, kWest}));
  EXPECT_EQ(r.all.range.rays, 1U);
  EXPECT_DOUBLE_EQ(r.ghost_share, 0.0);
}

TEST(Truth, SameNumbersForAnyThreads) {
  MeshModel truth = true_mesh();
  MeshModel model = other_mesh();
  add_plate(truth, {0, 0, -2}, 40, {1, 0, 0}, {0, 1, 0}, kRoad);
  add_plate(model, {0, 0, -2.01}, 40, normalized(Vec3d{1, 0, 0.001}), {0, 1, 0}, kRoad);
  LidarModel sensor = hdl_64_paper();
  sensor.columns = 360;
  const TruthResult one = run(model, truth, sensor, {}, 1);
  EXPECT_GT(one.all.surface.points, 10'000U);
  for (const int threads : {2, 3}) {
    const TruthResult other = run(model, truth, sensor, {}, threads);
    EXPECT_EQ(one.all.range.rmse_m, other.all.range.rmse_m);
    EXPECT_EQ(one.all.surface.mean_m, other.all.surface.mean_m);
    EXPECT_EQ(one.bleeding_share, other.bleeding_share);
  }
}

TEST(Truth, Errors) {
  MeshModel truth = true_mesh();
  EXPECT_THROW(run(truth, truth, sensor_with({kEast})), Error);  // no triangles
  add_wall(truth, kEast, 10, 2, 12345);                          // not in the label scheme
  EXPECT_THROW(run(truth, truth, sensor_with({kEast})), Error);
  truth.mesh.classes.assign(2, kRoad);
  const SceneView view = truth.view();
  const auto tracer = make_brute_force_tracer(view);
  ProgressSink quiet;
  EXPECT_THROW(compare_with_truth(*tracer, truth.origin, truth, nullptr, sensor_with({kEast}), {},
                                  {}, Executor(1), quiet),
               Error);
}

TEST(BeamNeighbors, GridGoesAroundAndEndsAboveAndBelow) {
  LidarModel sensor;
  sensor.elevations_rad = {0.1, 0.0, -0.1};
  sensor.columns = 4;
  const auto n = beam_neighbors(sensor);
  ASSERT_EQ(n.size(), 12U);
  EXPECT_EQ(n[0], (std::array<std::uint32_t, 4>{3, 1, kNoBeam, 4}));
  EXPECT_EQ(n[7], (std::array<std::uint32_t, 4>{6, 4, 3, 11}));
  EXPECT_EQ(n[10], (std::array<std::uint32_t, 4>{9, 11, 6, kNoBeam}));
}

TEST(BeamNeighbors, FreePatternFollowsItsRings) {
  LidarModel sensor;
  for (const std::uint16_t ring : std::array<std::uint16_t, 5>{0, 1, 0, 1, 0})
    sensor.free_pattern.push_back({{1, 0, 0}, ring, 0, 0.0F});
  const auto n = beam_neighbors(sensor);
  EXPECT_EQ(n[0], (std::array<std::uint32_t, 4>{kNoBeam, 2, kNoBeam, kNoBeam}));
  EXPECT_EQ(n[2], (std::array<std::uint32_t, 4>{0, 4, kNoBeam, kNoBeam}));
  EXPECT_EQ(n[3], (std::array<std::uint32_t, 4>{1, kNoBeam, kNoBeam, kNoBeam}));
}

}  // namespace
}  // namespace adasplats
