// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/simulate/scan/scan_rules.h"
#include "adasplats/simulate/world/scene_caster.h"

namespace adasplats {
namespace {

constexpr Vec3d kSceneOrigin = {650'000, 6'860'000, 30};
constexpr double kRevolution_s = 0.1;
constexpr std::uint32_t kPlacePrimitives = 1000;

/// A box of these half sizes around the origin, outside of triangles 12.
MeshModel box_mesh(Vec3f half) {
  MeshModel model;
  for (int corner = 0; corner < 8; ++corner)
    model.mesh.vertices.push_back({(corner & 1) != 0 ? half.x : -half.x,
                                   (corner & 2) != 0 ? half.y : -half.y,
                                   (corner & 4) != 0 ? half.z : -half.z});
  model.mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                          {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  return model;
}

/// Two triangles in the plane x = 0.
MeshModel wall_mesh(float half_width, float half_height) {
  MeshModel model;
  model.mesh.vertices = {{0, -half_width, -half_height},
                         {0, half_width, -half_height},
                         {0, half_width, half_height},
                         {0, -half_width, half_height}};
  model.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return model;
}

RigidTransform pose(double x, double y, double z, double yaw_rad = 0) {
  return {rotation_from_yaw_pitch_roll(yaw_rad, 0, 0), Vec3d{x, y, z}};
}

RigidTransform in_world(RigidTransform local) {
  local.translation = local.translation + kSceneOrigin;
  return local;
}

WorldObject object(std::size_t geometry, Trajectory local) {
  WorldObject result;
  result.geometry = geometry;
  for (TimedPose& timed : local) timed.world_from_sensor = in_world(timed.world_from_sensor);
  result.trajectory = std::move(local);
  return result;
}

Vec3d turned(Vec3d v, double yaw_rad) {
  return {std::cos(yaw_rad) * v.x - std::sin(yaw_rad) * v.y,
          std::sin(yaw_rad) * v.x + std::cos(yaw_rad) * v.y, v.z};
}

struct SlabHits {
  double near_m = 0;
  double far_m = -1;  ///< below near_m: a miss
  bool at_rim = false;
};

/// The oracle for boxes: Kay and Kajiya's slabs, in double.
SlabHits slabs(Vec3d origin, Vec3d direction, Vec3d half) {
  constexpr double kRim_m = 1e-3;
  SlabHits hits = {-1e300, 1e300};
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (-half[axis] - origin[axis]) / direction[axis];
    const double b = (half[axis] - origin[axis]) / direction[axis];
    hits.near_m = std::max(hits.near_m, std::min(a, b));
    hits.far_m = std::min(hits.far_m, std::max(a, b));
  }
  hits.at_rim = std::fabs(hits.far_m - hits.near_m) < kRim_m;
  return hits;
}

class WorldTest : public testing::Test {
 protected:
  WorldTest() {
    sensor_.columns = 360;
    sensor_.min_range_m = 0.5;
    sensor_.rotation_hz = 1 / kRevolution_s;
    sensor_.range_noise_m = 0;
    firings_ = firings_of(sensor_);
  }

  /// Drives along x and turns to the left, at the scene's origin at time 0 in the scan's middle.
  ScanMotion driving(double speed_m_per_s, double turn_rad_per_s) const {
    const auto at = [&](double time_s) {
      return TimedPose{time_s,
                       in_world(pose(speed_m_per_s * time_s, 0, 0, turn_rad_per_s * time_s))};
    };
    const Trajectory motion = {at(-1), at(1)};
    const Trajectory middle = {at(0)};
    return moving_scans(middle, motion, kRevolution_s).front();
  }
  static ScanMotion standing() { return {{0.0, in_world({})}, {}}; }

  std::vector<Hit> nothing(int depth = 1) const {
    return std::vector<Hit>(firings_.size() * static_cast<std::size_t>(depth));
  }
  std::vector<Hit> hits_of(const World& world, const ScanMotion& motion, std::uint64_t scan = 0,
                           int depth = 1) const {
    std::vector<Hit> hits = nothing(depth);
    world.add_hits(scan, sensor_, firings_, motion, kRevolution_s, depth, hits, executor_);
    return hits;
  }
  static World world() { return {kPlacePrimitives, kSceneOrigin}; }
  /// After the middle of the scan.
  double time_of(const Firing& firing) const {
    return static_cast<double>(firing.time_s) - 0.5 * kRevolution_s;
  }

  Executor executor_{2};
  LidarModel sensor_ = hdl_32_paper();
  std::vector<Firing> firings_;
};

// Oracle: a world in which it has stood there from the first.
TEST_F(WorldTest, MovingAnObjectEqualsAddingItThere) {
  World moved = world(), there = world();
  for (World* const each : {&moved, &there})
    each->add_object(object(each->add_geometry(wall_mesh(4, 3)), {{0, pose(20, 0, 0)}}));
  const Trajectory place = {{0, in_world(pose(9, 2, 0.5))}};
  moved.move_object(0, place);
  World fresh = world();
  fresh.add_object(object(fresh.add_geometry(wall_mesh(4, 3)), {{0, pose(9, 2, 0.5)}}));
  const std::vector<Hit> hits = hits_of(moved, standing());
  EXPECT_TRUE(std::ranges::any_of(hits, [](const Hit& hit) { return hit.valid(); }));
  EXPECT_EQ(hits, hits_of(fresh, standing()));
  EXPECT_NE(hits, hits_of(there, standing()));
  EXPECT_EQ(moved.object(0).trajectory.size(), 1U);
  EXPECT_THROW(moved.move_object(1, place), std::logic_error);
  EXPECT_THROW(moved.move_object(0, {}), Error);
}

TEST_F(WorldTest, AHiddenObjectIsAsIfItWereFarAway) {
  World hidden = world();
  hidden.add_object(object(hidden.add_geometry(wall_mesh(4, 3)), {{0, pose(9, 2, 0.5)}}));
  const std::vector<Hit> seen = hits_of(hidden, standing());
  hidden.set_present(0, false);
  EXPECT_TRUE(
      std::ranges::none_of(hits_of(hidden, standing()), [](const Hit& h) { return h.valid(); }));
  EXPECT_TRUE(hidden.boxes(0, 0).empty());
  hidden.set_present(0, true);
  EXPECT_EQ(hits_of(hidden, standing()), seen);
  EXPECT_THROW(hidden.set_present(1, true), std::logic_error);
}

// Oracle: the ray of each firing, at its time, against the plane where the wall is then.
TEST_F(WorldTest, MovingWallBesideADrivingSensor) {
  constexpr double kSpeed = 12, kTurn = 0.6, kWallSpeed = -20, kWall_m = 25;
  World world = this->world();
  const std::size_t wall = world.add_geometry(wall_mesh(40, 15));
  world.add_object(object(
      wall, {{-1, pose(kWall_m - kWallSpeed, 0, 0)}, {1, pose(kWall_m + kWallSpeed, 0, 0)}}));
  const std::vector<Hit> hits = hits_of(world, driving(kSpeed, kTurn));
  std::size_t hit_count = 0;
  for (std::size_t i = 0; i < firings_.size(); ++i) {
    const double time_s = time_of(firings_[i]);
    const Vec3d direction = turned(vec_cast<double>(firings_[i].direction), kTurn * time_s);
    const double t = (kWall_m + kWallSpeed * time_s - kSpeed * time_s) / direction.x;
    const Vec3d at = t * direction;
    const double inside_m = std::min(40 - std::fabs(at.y), 15 - std::fabs(at.z));
    if (std::fabs(inside_m) < 1e-3) continue;
    const bool hit = t > sensor_.min_range_m && t < sensor_.max_range_m && inside_m > 0;
    ASSERT_EQ(hits[i].valid(), hit) << "firing " << i << " at " << time_s;
    if (!hit) continue;
    EXPECT_NEAR(static_cast<double>(hits[i].t), t, 2e-4) << "firing " << i;
    EXPECT_TRUE(hits[i].primitive == kPlacePrimitives || hits[i].primitive == kPlacePrimitives + 1);
    ++hit_count;
  }
  EXPECT_GT(hit_count, 2000U);
  // The distortion: what the wall moves during the revolution is far more than the tolerance.
  EXPECT_GT(std::fabs(kWallSpeed - kSpeed) * kRevolution_s, 3.0);
}

// Oracle: the plane through the wall's centre, turned as it is when the firing leaves.
TEST_F(WorldTest, TurningWallBesideAStandingSensor) {
  constexpr double kTurn = 2.5;
  World world = this->world();
  const std::size_t wall = world.add_geometry(wall_mesh(6, 6));
  Trajectory turning;
  for (int i = -2; i <= 2; ++i) turning.push_back({0.5 * i, pose(12, 3, 0, kTurn * 0.5 * i)});
  world.add_object(object(wall, turning));
  const std::vector<Hit> hits = hits_of(world, driving(0, 0));
  std::size_t hit_count = 0;
  for (std::size_t i = 0; i < firings_.size(); ++i) {
    if (!hits[i].valid()) continue;
    const Vec3d normal = turned({1, 0, 0}, kTurn * time_of(firings_[i]));
    const Vec3d direction = vec_cast<double>(firings_[i].direction);
    const double t = dot(normal, Vec3d{12, 3, 0}) / dot(normal, direction);
    EXPECT_NEAR(static_cast<double>(hits[i].t), t, 1e-4) << "firing " << i;
    ++hit_count;
  }
  EXPECT_GT(hit_count, 500U);
}

// Oracle: slabs. The box drives past, turns and has its centre off its origin.
TEST_F(WorldTest, APassingBoxHasTheOutlineOfItsTimes) {
  constexpr double kSpeed = 30, kTurn = 1.0;
  const Vec3d half = {2.25, 0.9, 0.75};
  const Vec3d off = {1.5, -0.5, 0.25};
  MeshModel box = box_mesh(vec_cast<float>(half));
  box.origin = off;
  World world = this->world();
  const std::size_t geometry = world.add_geometry(std::move(box));
  world.add_object(
      object(geometry, {{-1, pose(-kSpeed, 8, 0, -kTurn)}, {1, pose(kSpeed, 8, 0, kTurn)}}));
  const std::vector<Hit> hits = hits_of(world, driving(0, 0), 0, 5);
  std::size_t hit_count = 0;
  for (std::size_t i = 0; i < firings_.size(); ++i) {
    const double time_s = time_of(firings_[i]);
    const Vec3d origin = turned(Vec3d{-kSpeed * time_s, -8, 0}, -kTurn * time_s) - off;
    const Vec3d direction = turned(vec_cast<double>(firings_[i].direction), -kTurn * time_s);
    const SlabHits expected = slabs(origin, direction, half);
    if (expected.at_rim) continue;
    const bool hit = expected.far_m > expected.near_m && expected.near_m > 0;
    ASSERT_EQ(hits[5 * i].valid(), hit) << "firing " << i;
    if (!hit) continue;
    EXPECT_NEAR(static_cast<double>(hits[5 * i].t), expected.near_m, 1e-4);
    EXPECT_NEAR(static_cast<double>(hits[5 * i + 1].t), expected.far_m, 2e-4);
    ++hit_count;
  }
  EXPECT_GT(hit_count, 200U);
}

// A scan that stands still is a snapshot of its reference time.
TEST_F(WorldTest, AScanAtRestSeesASnapshot) {
  World world = this->world();
  const std::size_t wall = world.add_geometry(wall_mesh(40, 15));
  world.add_object(object(wall, {{-1, pose(5, 0, 0)}, {1, pose(45, 0, 0)}}));
  const std::vector<Hit> hits = hits_of(world, standing());
  for (std::size_t i = 0; i < firings_.size(); ++i) {
    if (!hits[i].valid()) continue;
    const double expected_m = 25 / static_cast<double>(firings_[i].direction.x);
    EXPECT_NEAR(static_cast<double>(hits[i].t), expected_m, 1e-4);
  }
  EXPECT_GT(std::ranges::count_if(hits, &Hit::valid), 2000);
}

TEST_F(WorldTest, ABoxHidesOnlyWhatIsBehindIt) {
  World world = this->world();
  world.add_object(object(world.add_geometry(box_mesh({1, 1, 1})), {{0, pose(10, 0, 0)}}));
  const std::vector<Hit> box = hits_of(world, standing());
  for (const float place_m : {30.0F, 5.0F}) {
    std::vector<Hit> hits(firings_.size(), Hit{place_m, 7});
    world.add_hits(0, sensor_, firings_, standing(), kRevolution_s, 1, hits, executor_);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const bool hidden = box[i].valid() && box[i].t < place_m;
      EXPECT_EQ(hits[i], hidden ? box[i] : (Hit{place_m, 7}));
    }
  }
  EXPECT_GT(std::ranges::count_if(box, &Hit::valid), 20);
}

// Oracle: sorting all hits of both.
TEST_F(WorldTest, DeeperHitsAreMerged) {
  constexpr std::size_t kDepth = 5;
  World world = this->world();
  world.add_object(object(world.add_geometry(box_mesh({1, 1, 1})), {{0, pose(10, 0, 0)}}));
  const std::vector<Hit> box = hits_of(world, standing(), 0, kDepth);
  const std::vector<std::vector<Hit>> places = {
      {}, {{10, 1}}, {{2, 1}, {10, 4}, {30, 2}}, {{1, 1}, {2, 1}, {3, 1}, {10, 4}, {30, 2}}};
  std::size_t with_box = 0;
  for (const std::vector<Hit>& place : places) {
    std::vector<Hit> hits = nothing(kDepth);
    for (std::size_t i = 0; i < firings_.size(); ++i)
      std::ranges::copy(place, hits.begin() + static_cast<std::ptrdiff_t>(kDepth * i));
    world.add_hits(0, sensor_, firings_, standing(), kRevolution_s, kDepth, hits, executor_);
    for (std::size_t i = 0; i < firings_.size(); ++i) {
      std::vector<Hit> expected = place;
      for (std::size_t k = 0; k < kDepth; ++k) expected.push_back(box[kDepth * i + k]);
      std::sort(expected.begin(), expected.end());
      for (std::size_t k = 0; k < kDepth; ++k) EXPECT_EQ(hits[kDepth * i + k], expected[k]);
      with_box += box[kDepth * i].valid() ? 1 : 0;
    }
  }
  EXPECT_GT(with_box, 80U);
}

// Oracle: brute force over place and objects as one scene.
TEST_F(WorldTest, HitsMatchASingleScene) {
  constexpr int kDepth = 5;
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < 2000; ++i) {
    Random random(3, i, 0);
    const auto draw = [&](double scale) { return static_cast<float>(scale * random.normal()); };
    disks.push_back(
        {{draw(15), draw(15), draw(3)}, 0.5F, normalized(Vec3f{draw(1), draw(1), draw(1)})});
  }
  const auto whole = make_brute_force_tracer({disks, nullptr});
  const auto rays = scan_rays(sensor_, firings_, standing(), kSceneOrigin, executor_);
  std::vector<Hit> expected = nothing(kDepth);
  whole->nearest_hits(rays, kDepth, expected, executor_);

  const std::vector<Disk> first(disks.begin(), disks.begin() + kPlacePrimitives);
  const auto place = make_brute_force_tracer({first, nullptr});
  for (const std::size_t disks_an_object : {1000U, 40U, 1U}) {
    World world = this->world();
    for (std::size_t i = kPlacePrimitives; i < disks.size(); i += disks_an_object) {
      SplatModel splats;
      splats.disks.assign(&disks[i], &disks[i] + disks_an_object);
      world.add_object(object(world.add_geometry(splats), {{0, pose(0, 0, 0)}}));
    }
    std::vector<Hit> hits = nothing(kDepth);
    place->nearest_hits(rays, kDepth, hits, executor_);
    world.add_hits(0, sensor_, firings_, standing(), kRevolution_s, kDepth, hits, executor_);
    std::size_t others = 0;  // rounding may turn the order and the rims of disks
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (hits[i].primitive != expected[i].primitive) {
        ++others;
      } else if (hits[i].valid()) {
        EXPECT_NEAR(hits[i].t, expected[i].t, 2e-4F);
      }
    }
    EXPECT_LE(others, 10U) << disks_an_object << " disks an object";
  }
}

TEST_F(WorldTest, ObjectsOfOneScanAreSeenOnlyInIt) {
  World world = this->world();
  const std::size_t near_box = world.add_geometry(box_mesh({1, 1, 1}));
  for (const std::uint64_t scan : {3U, 7U}) {
    WorldObject of_scan = object(near_box, {{0, pose(10 + static_cast<double>(scan), 0, 0)}});
    of_scan.only_scan = scan;
    world.add_object(of_scan);
  }
  for (std::uint64_t scan = 0; scan < 10; ++scan) {
    const std::vector<Hit> hits = hits_of(world, standing(), scan);
    const auto first = std::ranges::find_if(hits, &Hit::valid);
    const bool there = scan == 3 || scan == 7;
    ASSERT_EQ(first != hits.end(), there) << "scan " << scan;
    if (!there) continue;
    EXPECT_NEAR(first->t, 9 + static_cast<float>(scan), 1);
    const std::uint32_t object_begin = kPlacePrimitives + (scan == 7 ? 12 : 0);
    EXPECT_TRUE(first->primitive >= object_begin && first->primitive < object_begin + 12);
  }
}

// Oracle: the times of the firings.
TEST_F(WorldTest, AnObjectThatAppearsDuringAScan) {
  World world = this->world();
  const std::size_t box = world.add_geometry(box_mesh({30, 30, 30}));
  WorldObject coming = object(box, {{0.01, pose(0, 0, 0)}, {5, pose(0, 0, 0)}});
  world.add_object(coming);
  EXPECT_EQ(std::ranges::count_if(hits_of(world, driving(0, 0)), &Hit::valid), std::ssize(firings_))
      << "it stands before its first pose";
  World during = this->world();
  during.add_geometry(box_mesh({30, 30, 30}));
  coming.only_during = true;
  during.add_object(coming);
  const std::vector<Hit> hits = hits_of(during, driving(0, 0));
  for (std::size_t i = 0; i < firings_.size(); ++i) {
    if (std::fabs(time_of(firings_[i]) - 0.01) < 1e-6) continue;
    EXPECT_EQ(hits[i].valid(), time_of(firings_[i]) > 0.01);
  }
  EXPECT_EQ(std::ranges::count_if(hits_of(during, standing()), &Hit::valid), 0);
  EXPECT_TRUE(during.boxes(0, 0.0).empty());
  EXPECT_EQ(during.boxes(0, 0.01).size(), 1U);
  EXPECT_EQ(during.boxes(0, 5.1).size(), 0U);
}

// Oracle: slabs of the box in metres. In millimetres it is 2,000 units wide and up to 60,000 away.
TEST_F(WorldTest, ScaledObjectsHaveTheirSizeAndRange) {
  for (const double scale : {1e-3, 1.0, 250.0}) {
    for (const double range_m : {5.0, 60.0}) {
      World world = this->world();
      const auto half = static_cast<float>(1 / scale);
      WorldObject scaled =
          object(world.add_geometry(box_mesh({half, half, half})), {{0, pose(range_m, 2, 0, 0.4)}});
      scaled.scale = scale;
      world.add_object(scaled);
      const std::vector<Hit> hits = hits_of(world, standing(), 0, 2);
      EXPECT_GT(std::ranges::count_if(hits, &Hit::valid), 4);
      for (std::size_t i = 0; i < firings_.size(); ++i) {
        const Vec3d direction = turned(vec_cast<double>(firings_[i].direction), -0.4);
        const SlabHits expected = slabs(turned({-range_m, -2, 0}, -0.4), direction, {1, 1, 1});
        if (expected.at_rim) continue;
        const bool hit = expected.far_m > expected.near_m && expected.near_m > 0;
        ASSERT_EQ(hits[2 * i].valid(), hit) << "firing " << i << ", scale " << scale;
        if (!hit) continue;
        EXPECT_NEAR(static_cast<double>(hits[2 * i].t), expected.near_m, 1e-4);
        EXPECT_NEAR(static_cast<double>(hits[2 * i + 1].t), expected.far_m, 1e-4);
      }
      EXPECT_NEAR(length(world.boxes(0, 0).front().size_m - Vec3d{2, 2, 2}), 0, 1e-5);
    }
  }
}

// What the object's unit keeps apart may be one float in metres; then the lower number comes first.
TEST_F(WorldTest, EqualRangesComeByNumber) {
  World world = this->world();
  SplatModel splats;
  for (const float x : {0.001F, 0.0005F, 0.0F})
    splats.disks.push_back({{x, 0, 0}, 1000, {1, 0, 0}});
  WorldObject sheets = object(world.add_geometry(splats), {{0, pose(60, 0, 0)}});
  sheets.scale = 1e-3;
  world.add_object(sheets);
  const std::vector<Hit> hits = hits_of(world, standing(), 0, 3);
  std::size_t ties = 0;
  for (std::size_t i = 0; i < firings_.size(); ++i) {
    EXPECT_TRUE(std::is_sorted(&hits[3 * i], &hits[3 * i] + 3));
    ties += hits[3 * i].valid() && hits[3 * i].t == hits[3 * i + 1].t ? 1 : 0;
  }
  EXPECT_GT(ties, 0U);
}

// Oracle: the sensor's range. Inside a box, and beside what is out of reach.
TEST_F(WorldTest, RangeLimitsHold) {
  World world = this->world();
  const std::size_t box = world.add_geometry(box_mesh({0.45F, 0.45F, 0.45F}));
  world.add_object(object(box, {{0, pose(0, 0, 0)}}));
  world.add_object(object(box, {{0, pose(sensor_.max_range_m + 0.5, 0, 0)}}));
  for (const Hit& hit : hits_of(world, standing(), 0, 3)) {
    EXPECT_TRUE(!hit.valid() || (hit.t > 0.5F && hit.t <= 100.0F));
  }
}

TEST_F(WorldTest, SameBytesOnAnyThreads) {
  World world = this->world();
  const std::size_t wall = world.add_geometry(wall_mesh(20, 5));
  const std::size_t box = world.add_geometry(box_mesh({2, 1, 1}));
  world.add_object(object(wall, {{-1, pose(20, 0, 0, 0)}, {1, pose(25, 0, 0, 1)}}));
  world.add_object(object(box, {{-1, pose(-9, -9, 0)}, {1, pose(9, 9, 0)}}));
  world.add_object(object(box, {{0, pose(-9, 3, 0)}}));
  const ScanMotion motion = driving(10, 1);
  const std::vector<Hit> expected = hits_of(world, motion, 0, 4);
  for (const int threads : {1, 3, 7}) {
    const Executor executor(threads);
    std::vector<Hit> hits = nothing(4);
    world.add_hits(0, sensor_, firings_, motion, kRevolution_s, 4, hits, executor);
    EXPECT_EQ(hits, expected) << threads << " threads";
  }
}

TEST_F(WorldTest, AttributesFollowThoseOfTheScene) {
  World world(2, {});
  SplatModel splats;
  splats.disks.resize(3, {{0, 0, 0}, 1, {1, 0, 0}});
  splats.classes = {252, 254, 252};
  splats.intensities = {0.1F, 0.2F, 0.3F};
  const std::size_t moving = world.add_geometry(splats, {11, 12, 13});
  const std::size_t wall = world.add_geometry(wall_mesh(1, 1));
  const auto add = [&](std::size_t geometry, std::optional<std::uint16_t> class_id,
                       std::uint16_t instance) {
    WorldObject added = object(geometry, {{0, {}}});
    added.class_id = class_id;
    added.instance = instance;
    world.add_object(added);
  };
  add(moving, {}, 0);
  add(wall, {}, 0);
  add(wall, 10, 5);
  add(moving, 18, 6);

  const std::vector<std::uint16_t> classes = {40, 50};
  PrimitiveAttributes place;
  place.classes = classes;
  const PrimitiveAttributes all = world.attributes(place);
  using Ids = std::vector<std::uint16_t>;
  EXPECT_EQ(Ids(all.classes.begin(), all.classes.end()),
            (Ids{40, 50, 252, 254, 252, 0, 0, 10, 10, 18, 18, 18}));
  EXPECT_EQ(Ids(all.instances.begin(), all.instances.end()),
            (Ids{0, 0, 11, 12, 13, 0, 0, 5, 5, 6, 6, 6}));
  ASSERT_EQ(all.intensities.size(), 12U);
  for (const std::size_t i : {0U, 1U, 5U, 6U, 7U, 8U}) EXPECT_TRUE(std::isnan(all.intensities[i]));
  EXPECT_EQ(all.intensities[3], 0.2F);
  EXPECT_EQ(all.intensities[11], 0.3F);

  const std::vector<std::uint16_t> wrong = {40};
  place.classes = wrong;
  EXPECT_THROW(world.attributes(place), std::logic_error);
}

TEST_F(WorldTest, MissingAttributesStayEmpty) {
  World world(2, {});
  EXPECT_TRUE(world.empty());
  const std::vector<std::uint16_t> classes = {40, 50};
  PrimitiveAttributes place;
  place.classes = classes;
  EXPECT_EQ(world.attributes(place).classes.data(), classes.data()) << "nothing to add";
  world.add_object(object(world.add_geometry(wall_mesh(1, 1)), {{0, {}}}));
  EXPECT_FALSE(world.empty());
  EXPECT_EQ(world.attributes(place).classes.size(), 4U);
  EXPECT_TRUE(world.attributes(place).instances.empty());
  EXPECT_TRUE(world.attributes(place).intensities.empty());
  EXPECT_TRUE(world.attributes({}).classes.empty());
}

TEST_F(WorldTest, BoxesEncloseTheObjects) {
  World world = this->world();
  MeshModel car = box_mesh({2, 0.75F, 0.5F});
  car.origin = {0, 0, 0.5};
  car.mesh.classes.assign(12, 10);
  car.mesh.classes[0] = 18;
  const std::size_t geometry = world.add_geometry(car);
  WorldObject moving = object(geometry, {{0, pose(0, 0, 0, 0)}, {2, pose(10, 0, 0, 1)}});
  moving.instance = 9;
  moving.scale = 2;
  world.add_object(moving);
  SplatModel splats;
  splats.disks = {{{0, 0, 0}, 1, {1, 0, 0}}};
  WorldObject points = object(world.add_geometry(splats, {3}), {{0, {}}});
  points.only_scan = 4;
  world.add_object(points);
  const std::vector<ObjectBox> boxes = world.boxes(4, 1.0);
  ASSERT_EQ(boxes.size(), 1U) << "points of many objects have no box";
  EXPECT_EQ(boxes[0].class_id, 10);
  EXPECT_EQ(boxes[0].instance, 9);
  EXPECT_NEAR(length(boxes[0].size_m - Vec3d{8, 3, 2}), 0, 1e-9);
  EXPECT_NEAR(length(boxes[0].world_from_box.translation - kSceneOrigin - Vec3d{5, 0, 1}), 0, 1e-9);
  EXPECT_NEAR(std::atan2(boxes[0].world_from_box.rotation.rows[1].x,
                         boxes[0].world_from_box.rotation.rows[0].x),
              0.5, 1e-9);
}

TEST_F(WorldTest, InvalidObjects) {
  World world = this->world();
  const std::size_t wall = world.add_geometry(wall_mesh(1, 1));
  const auto expect_refused = [&](const WorldObject& wrong, const std::string& why) {
    try {
      world.add_object(wrong);
      ADD_FAILURE() << why;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  expect_refused(object(wall, {}), "no pose");
  expect_refused(object(wall, {{0, {}}, {0, {}}}), "ascend");
  expect_refused(object(wall, {{0, pose(NAN, 0, 0)}}), "not finite");
  for (const double scale : {0.0, -1.0, static_cast<double>(NAN), HUGE_VAL}) {
    WorldObject scaled = object(wall, {{0, {}}});
    scaled.scale = scale;
    expect_refused(scaled, "scale");
  }
  EXPECT_THROW(world.add_object(object(1, {{0, {}}})), std::logic_error);
  EXPECT_THROW(world.add_geometry(SplatModel{}, {1}), std::logic_error);
  EXPECT_TRUE(world.empty());
  World full(Hit::kNone - 2, {});
  EXPECT_THROW(full.add_object(object(full.add_geometry(wall_mesh(1, 1)), {{0, {}}})), Error);
}

// Oracle: opaque_disks().
TEST_F(WorldTest, SoftSplatsOfObjectsBecomeOpaque) {
  SplatModel soft;
  soft.disks.assign(2, {{1, 0, 0}, 0.5F, {1, 0, 0}});
  soft.opacities = {0.9F, 0.1F};
  World world(0, {});
  const SceneView placed = world.geometry_view(world.add_geometry(soft));
  EXPECT_TRUE(placed.opacities.empty());
  ASSERT_EQ(placed.disks.size(), 2U);
  EXPECT_EQ(placed.disks[0].radius, opaque_disks(soft)[0].radius);
  EXPECT_EQ(placed.disks[1].radius, 0);
}

// Oracle: one geometry after the other.
TEST_F(WorldTest, ConcurrentGeometriesAreNumberedInOrder) {
  constexpr std::size_t kCount = 40;
  const auto box = [](std::size_t i) {
    const float half = 0.5F + 0.02F * static_cast<float>(i);
    return box_mesh({half, half, half});
  };
  const auto add_boxes = [](World& world, std::size_t first) {
    for (std::size_t i = 0; i < kCount; ++i) {
      WorldObject placed = object(first + i, {{0, pose(8, 0.1 * static_cast<double>(i), 0)}});
      placed.only_scan = i;
      world.add_object(std::move(placed));
    }
  };
  World single = world(), several = world();
  single.add_geometry(wall_mesh(1, 1));
  for (std::size_t i = 0; i < kCount; ++i) single.add_geometry(box(i));
  add_boxes(single, 1);
  several.add_geometry(wall_mesh(1, 1));
  const std::size_t first = several.add_geometries(
      kCount,
      [&](std::size_t i) {
        return NewGeometry{box(i), {}};
      },
      executor_);
  ASSERT_EQ(first, 1U);
  add_boxes(several, first);
  for (std::size_t scan = 0; scan < kCount; ++scan) {
    const std::vector<Hit> hits = hits_of(several, standing(), scan);
    EXPECT_NE(hits, nothing());
    EXPECT_EQ(hits, hits_of(single, standing(), scan));
  }
}

TEST_F(WorldTest, EmptyInputsOfManyKinds) {
  World world = this->world();
  EXPECT_EQ(hits_of(world, standing()), nothing());
  world.add_object(object(world.add_geometry(SplatModel{}), {{0, {}}}));
  world.add_object(object(world.add_geometry(MeshModel{}), {{0, {}}}));
  EXPECT_EQ(hits_of(world, standing()), nothing());
  EXPECT_TRUE(world.boxes(0, 0).empty());
  std::vector<Hit> none;
  world.add_hits(0, sensor_, {}, standing(), kRevolution_s, 1, none, executor_);
  EXPECT_THROW(world.add_hits(0, sensor_, firings_, standing(), kRevolution_s, 1, none, executor_),
               std::logic_error);
  EXPECT_THROW(world.add_hits(0, sensor_, {}, standing(), kRevolution_s, 0, none, executor_),
               std::logic_error);
}

// Oracle: scan_of_hits() of the scene's hits and add_hits().
TEST_F(WorldTest, CasterAddsTheWorldToTheScene) {
  SplatModel ground;
  ground.disks = {{{0, 0, -2}, 90, {0, 0, 1}}};
  const auto tracer = make_brute_force_tracer(ground.view());
  const auto scene = make_cpu_scene_caster(*tracer, kSceneOrigin, executor_);
  World world(1, kSceneOrigin);
  WorldObject box = object(world.add_geometry(box_mesh({1, 1, 2})), {{0, pose(8, 0, 0)}});
  box.only_scan = 11;
  world.add_object(box);
  const std::vector<ScanMotion> scans(3, driving(5, 0));
  SimulateOptions options;
  options.beam.depth = 2;
  const ScanRules rules(sensor_, firings_, options,
                        std::make_shared<PrimitiveTable>(primitive_table({}, executor_)));
  std::vector<std::vector<Hit>> hits;
  scene->cast(sensor_, firings_, scans, 2, [&](std::size_t scan, std::span<const Hit> found) {
    EXPECT_EQ(scan, hits.size());
    hits.emplace_back(found.begin(), found.end());
  });
  const auto scan_of = [&](std::size_t i) {
    return scan_of_hits(hits[i], {}, sensor_, firings_, scans[i], 10 + i, options, executor_);
  };
  const std::vector<Vec3f> alone = scan_of(1).positions;
  world.add_hits(11, sensor_, firings_, scans[1], kRevolution_s, 2, hits[1], executor_);
  EXPECT_NE(scan_of(1).positions, alone);
  std::size_t count = 0;
  const ReportTimes times =
      scene->report_world(rules, scans, 10, &world, executor_, [&](std::size_t i, Scan&& scan) {
        EXPECT_EQ(i, count++);
        EXPECT_EQ(scan.positions, scan_of(i).positions) << i;
      });
  EXPECT_EQ(count, scans.size());
  EXPECT_GT(times.traced_s, 0);
}

}  // namespace
}  // namespace adasplats
