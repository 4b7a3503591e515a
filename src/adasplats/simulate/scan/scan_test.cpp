// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "adasplats/simulate/scan/box_mesh_test.h"

namespace adasplats {
namespace {

/// The plane z = 0 as disks in a square grid that leaves no holes.
std::vector<Disk> ground_disks(int half_count, float spacing_m) {
  std::vector<Disk> disks;
  for (int y = -half_count; y <= half_count; ++y)
    for (int x = -half_count; x <= half_count; ++x)
      disks.push_back({{spacing_m * static_cast<float>(x), spacing_m * static_cast<float>(y), 0},
                       0.8F * spacing_m,
                       {0, 0, 1}});
  return disks;
}

/// A scan of one sensor in one scene with the defaults of these tests.
struct Drive {
  SceneView view;
  PrimitiveAttributes attributes;
  Vec3d scene_origin;
  LidarModel sensor = hdl_32_paper();
  TimedPose pose;
  std::uint64_t scan_index = 0;
  SimulateOptions options;

  Scan scan(int threads = 2) const {
    const Executor executor(threads);
    const auto tracer = make_embree_tracer(view, executor);
    return simulate_scan(*tracer, attributes, scene_origin, sensor, firings_of(sensor), {pose, {}},
                         scan_index, options, executor);
  }
};

// Oracle: analytic. A ray that looks down by e from the height h meets the plane at h / sin(e).
TEST(SimulateScan, RangesAboveAPlaneAreExact) {
  const auto disks = ground_disks(60, 0.5F);
  Drive drive;
  drive.view = {disks, nullptr};
  drive.sensor.max_range_m = 25;
  drive.pose.world_from_sensor.translation = {0, 0, 2};
  const Scan scan = drive.scan();

  std::size_t expected_returns = 0;
  std::size_t next = 0;
  for (const Firing& firing : firings_of(drive.sensor)) {
    const double range_m = -2.0 / static_cast<double>(firing.direction.z);
    if (!(range_m > 0 && range_m < 25)) continue;
    ++expected_returns;
    ASSERT_LT(next, scan.size());
    ASSERT_NEAR(static_cast<double>(scan.ranges_m[next]), range_m, 1e-5);
    ASSERT_NEAR(static_cast<double>(scan.positions[next].z), -2.0, 1e-5);
    ASSERT_EQ(scan.rings[next], firing.ring);
    ASSERT_EQ(scan.times_s[next], firing.time_s);
    ++next;
  }
  EXPECT_EQ(scan.size(), expected_returns);
  EXPECT_GT(scan.size(), 30'000U);
  EXPECT_EQ(scan.rays, 57'600U);
}

// Oracle: analytic. Inside a cube every ray ends on the side that it meets first.
TEST(SimulateScan, RangesInsideABoxAreExactForAnyPose) {
  const TriangleMesh mesh = box_mesh(10.0F);
  Drive drive;
  drive.view = {{}, &mesh};
  drive.sensor = hdl_64_paper();
  drive.pose.world_from_sensor = {rotation_from_yaw_pitch_roll(0.7, 0.4, -0.2), {1, -2, 3}};
  const Scan scan = drive.scan();
  ASSERT_EQ(scan.size(), 144'000U) << "a closed box lets no ray out";
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vec3d p = drive.pose.world_from_sensor * vec_cast<double>(scan.positions[i]);
    const double side = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    ASSERT_NEAR(side, 10.0, 2e-5) << "return " << i;
    ASSERT_NEAR(static_cast<double>(length(scan.positions[i])),
                static_cast<double>(scan.ranges_m[i]), 2e-5);
  }
}

// Oracle: the same scene at the origin. Millimetres survive coordinates of millions of metres.
TEST(SimulateScan, LargeWorldCoordinatesLoseNothing) {
  const TriangleMesh mesh = box_mesh(10.0F);
  Drive drive;
  drive.view = {{}, &mesh};
  drive.pose.world_from_sensor.translation = {0.25, 0.5, 1};
  const Scan expected = drive.scan();
  drive.scene_origin = {650'000, 6'860'000, 35};
  drive.pose.world_from_sensor.translation = {650'000.25, 6'860'000.5, 36};
  EXPECT_EQ(drive.scan().ranges_m, expected.ranges_m);
}

// Oracle: analytic. The paper's sensor is level; a tilted one is a matter of the pose.
TEST(SimulateScan, APositivePitchTurnsTheSensorDown) {
  const auto disks = ground_disks(60, 0.5F);
  Drive drive;
  drive.view = {disks, nullptr};
  drive.sensor.elevations_rad = {0.0};
  drive.sensor.columns = 4;
  drive.pose.world_from_sensor = {rotation_from_yaw_pitch_roll(0, 0.3, 0), {0, 0, 3}};
  const Scan scan = drive.scan();
  ASSERT_EQ(scan.size(), 1U) << "forward alone meets the ground";
  EXPECT_NEAR(static_cast<double>(scan.ranges_m[0]), 3 / std::sin(0.3), 1e-5);
  EXPECT_NEAR(static_cast<double>(scan.positions[0].z), 0.0, 1e-6) << "in the sensor's frame";
}

TEST(SimulateScan, TheRangeOfTheSensorIsKept) {
  const auto disks = ground_disks(60, 0.5F);
  Drive drive;
  drive.view = {disks, nullptr};
  drive.pose.world_from_sensor.translation = {0, 0, 2};
  drive.sensor.min_range_m = 6;
  drive.sensor.max_range_m = 9;
  const Scan scan = drive.scan();
  ASSERT_GT(scan.size(), 1000U);
  const auto [low, high] = std::ranges::minmax(scan.ranges_m);
  EXPECT_GT(low, 6.0F);
  EXPECT_LE(high, 9.0F);
}

// Oracle: by hand. Two columns of the upper ring end on the vehicle, one always, one half of the
// time.
TEST(SimulateScan, BeamsEndOnTheVehicleBody) {
  const auto disks = ground_disks(60, 0.5F);
  Drive drive;
  drive.view = {disks, nullptr};
  drive.pose.world_from_sensor.translation = {0, 0, 2};
  drive.sensor.elevations_rad = {-0.2, -0.3};
  drive.sensor.columns = 720;
  drive.sensor.first_azimuth_rad = 0.25 * std::numbers::pi / 180;  // between the cells' borders
  drive.sensor.min_range_m = 1;
  const Scan without = drive.scan();
  VehicleBody body;
  for (std::uint16_t column = 100; column < 300; ++column)
    body.cells.push_back({0, column, 1, 1.5F, 0.25F});
  for (std::uint16_t column = 400; column < 600; ++column)
    body.cells.push_back({0, column, 0.5F, 1.25F, 0.25F});
  body.cells.push_back({1, 5, 1, 0.5F, 0});  // nearer than the sensor reports
  drive.sensor.body = body;
  const Scan with = drive.scan();
  EXPECT_EQ(without.size(), 1440U);
  EXPECT_EQ(with.size(), 1439U);
  EXPECT_EQ(std::ranges::count(with.ranges_m, 1.5F), 200);
  const auto half = static_cast<double>(std::ranges::count(with.ranges_m, 1.25F));
  EXPECT_NEAR(half, 100, 5 * std::sqrt(50.0));
  EXPECT_EQ(std::ranges::count_if(with.ranges_m, [](float range_m) { return range_m < 4; }),
            200 + std::lround(half));
  drive.options.vehicle_body = false;
  EXPECT_EQ(drive.scan().ranges_m, without.ranges_m);
}

// Oracle: analytic. A sensor 2 m above the ground has a roof 0.5 m below it: a turned box whose rim
// hides the ground from beams that look down more than it does, and reports them if it is far
// enough.
TEST(SimulateScan, NoBeamPassesABoxOfTheVehicle) {
  const auto disks = ground_disks(60, 0.5F);
  Drive drive;
  drive.view = {disks, nullptr};
  drive.pose.world_from_sensor.translation = {0, 0, 2};
  drive.sensor.min_range_m = 1.2;
  const Scan without = drive.scan();
  const double yaw = 0.4;
  const Vec3d half = {2, 1, 0.25};
  const RigidTransform sensor_from_box = {rotation_from_yaw_pitch_roll(yaw, 0, 0), {0, 0, -0.75}};
  drive.sensor.body = VehicleBody{{}, {{sensor_from_box, half}}};
  const Scan with = drive.scan();
  const auto on_roof = [&](Vec3f direction) {  // where the beam passes the plane of the roof
    const Vec3d d = vec_cast<double>(direction);
    const Vec3d p = sensor_from_box.inverse() * ((-0.5 / d.z) * d);
    return d.z < 0 && std::fabs(p.x) < half.x && std::fabs(p.y) < half.y;
  };
  std::size_t next = 0, roof = 0, hidden = 0;
  for (std::size_t i = 0; i < without.size(); ++i) {
    const Vec3f direction = without.positions[i] / length(without.positions[i]);
    const bool meets = on_roof(direction);
    const auto to_roof_m = static_cast<float>(-0.5 / static_cast<double>(direction.z));
    if (meets && to_roof_m <= 1.2F) {
      ++hidden;
      continue;
    }
    ASSERT_LT(next, with.size());
    EXPECT_NEAR(with.ranges_m[next], meets ? to_roof_m : without.ranges_m[i], 1e-4F);
    roof += meets ? 1 : 0;
    ++next;
  }
  EXPECT_EQ(next, with.size());
  EXPECT_GT(roof, 1000U);
  EXPECT_GT(hidden, 0U);
  drive.options.vehicle_body = false;
  EXPECT_EQ(drive.scan().ranges_m, without.ranges_m);
}

// Oracle: by hand.
TEST(VehicleBody, RangesToBoxes) {
  const VehicleBody body = {{}, {{{{}, {5, 0, 0}}, {1, 2, 3}}, {{{}, {9, 0, 0}}, {1, 1, 1}}}};
  const double none = std::numeric_limits<double>::infinity();
  EXPECT_EQ(body.range_to_boxes({}, {1, 0, 0}), 4);  // the nearer one
  EXPECT_EQ(body.range_to_boxes({20, 0, 0}, {-1, 0, 0}), 10);
  EXPECT_EQ(body.range_to_boxes({}, {-1, 0, 0}), none);     // behind
  EXPECT_EQ(body.range_to_boxes({5, 1, 1}, {0, 0, 1}), 0);  // inside
  EXPECT_EQ(body.range_to_boxes({0, 2.5, 0}, {1, 0, 0}), none);
  EXPECT_EQ(body.range_to_boxes({0, 2, 0}, {1, 0, 0}), none);  // along a side
  EXPECT_EQ(VehicleBody().range_to_boxes({}, {1, 0, 0}), none);
}

TEST(SimulateScan, AttributesComeFromTheHitPrimitive) {
  const std::vector<Disk> disks = {{{5, 0, 0}, 1, {1, 0, 0}}, {{0, 7, 0}, 1, {0, 1, 0}}};
  const std::vector<std::uint16_t> classes = {40, 50}, instances = {3, 4};
  const std::vector<float> intensities = {0.25F, 0.75F};
  Drive drive;
  drive.view = {disks, nullptr};
  drive.attributes = {classes, instances, intensities, {}, nullptr};
  drive.sensor.elevations_rad = {0.0};
  drive.sensor.columns = 4;
  drive.pose.time_s = 12.5;
  const Scan scan = drive.scan();
  EXPECT_EQ(scan.time_s, 12.5);
  EXPECT_EQ(scan.ranges_m, (std::vector<float>{5, 7}));
  EXPECT_EQ(scan.classes, classes);
  EXPECT_EQ(scan.instances, instances);
  EXPECT_EQ(scan.intensities, intensities);

  drive.attributes = {};
  const Scan bare = drive.scan();
  EXPECT_EQ(bare.size(), 2U);
  EXPECT_TRUE(bare.classes.empty() && bare.instances.empty() && bare.intensities.empty());

  const std::vector<std::uint16_t> too_few = {1};
  drive.attributes.classes = too_few;
  EXPECT_THROW(drive.scan(), std::logic_error);
}

TEST(SimulateScan, EmptyScenesAndSensorsGiveEmptyScans) {
  Drive drive;
  EXPECT_EQ(drive.scan().size(), 0U);
  EXPECT_EQ(drive.scan().rays, 57'600U);
  drive.sensor.columns = 0;
  EXPECT_EQ(drive.scan().rays, 0U);
}

TEST(SimulateScan, ANonFinitePoseGivesNoReturns) {
  const TriangleMesh mesh = box_mesh(10.0F);
  Drive drive;
  drive.view = {{}, &mesh};
  drive.pose.world_from_sensor.translation.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(drive.scan().size(), 0U);
}

class ScanNoise : public testing::Test {
 protected:
  ScanNoise() {
    drive_.view = {{}, &mesh_};
    drive_.sensor.range_noise_m = 0.02;
    drive_.options.seed = 42;
  }
  TriangleMesh mesh_ = box_mesh(10.0F);
  Drive drive_;
};

// Oracle: moments of the normal distribution; 57,600 draws.
TEST_F(ScanNoise, IsWhiteAlongTheRay) {
  const Scan noisy = drive_.scan();
  drive_.options.noise = false;
  const Scan clean = drive_.scan();
  ASSERT_EQ(noisy.size(), clean.size());
  double sum = 0, squares = 0, neighbours = 0, before = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    const double noise =
        static_cast<double>(noisy.ranges_m[i]) - static_cast<double>(clean.ranges_m[i]);
    sum += noise;
    squares += noise * noise;
    neighbours += noise * before;
    before = noise;
    ASSERT_NEAR(static_cast<double>(length(noisy.positions[i])),
                static_cast<double>(noisy.ranges_m[i]), 2e-5);
  }
  const auto n = static_cast<double>(noisy.size());
  EXPECT_NEAR(sum / n, 0.0, 5 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.02, 0.02 * 5 / std::sqrt(2 * n));
  EXPECT_NEAR(neighbours / squares, 0.0, 5 / std::sqrt(n));
}

TEST_F(ScanNoise, DependsOnlyOnSeedScanAndRay) {
  const Scan first = drive_.scan();
  EXPECT_EQ(drive_.scan().ranges_m, first.ranges_m);
  drive_.scan_index = 1;
  EXPECT_NE(drive_.scan().ranges_m, first.ranges_m);
  drive_.scan_index = 0;
  drive_.options.seed = 43;
  EXPECT_NE(drive_.scan().ranges_m, first.ranges_m);
}

TEST_F(ScanNoise, NeverLeavesTheSensorsRange) {
  drive_.sensor.min_range_m = 10.5;
  drive_.sensor.max_range_m = 12;
  drive_.sensor.range_noise_m = 0.5;
  const Scan scan = drive_.scan();
  ASSERT_GT(scan.size(), 100U);
  const auto [low, high] = std::ranges::minmax(scan.ranges_m);
  EXPECT_GT(low, 10.5F);
  EXPECT_LE(high, 12.0F);
}

// Oracle: one thread.
TEST_F(ScanNoise, BytesDoNotDependOnThreads) {
  const Scan expected = drive_.scan(1);
  for (const int threads : {2, 3}) {
    const Scan scan = drive_.scan(threads);
    EXPECT_EQ(scan.ranges_m, expected.ranges_m);
    EXPECT_EQ(scan.positions, expected.positions);
    EXPECT_EQ(scan.rings, expected.rings);
    EXPECT_EQ(scan.times_s, expected.times_s);
  }
}

// Oracle: ranges of the same scan without noise; 2 %: five deviations of the root of 2,500 squares.
TEST_F(ScanNoise, RingsHaveTheirOwn) {
  const Scan without = [&] {
    Drive drive = drive_;
    drive.options.noise = false;
    return drive.scan();
  }();
  const double ring_noise_m[] = {0.001, 0.03};
  for (std::size_t ring = 0; ring < drive_.sensor.rings(); ++ring)
    drive_.sensor.ring_noise_m.push_back(ring_noise_m[ring % 2]);
  const Scan scan = drive_.scan();
  double squares[2] = {0, 0}, counts[2] = {0, 0};
  ASSERT_EQ(scan.size(), without.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double error_m = static_cast<double>(scan.ranges_m[i] - without.ranges_m[i]);
    squares[scan.rings[i] % 2] += error_m * error_m;
    ++counts[scan.rings[i] % 2];
  }
  for (const int odd : {0, 1})
    EXPECT_NEAR(std::sqrt(squares[odd] / counts[odd]) / ring_noise_m[odd], 1, 0.05);
}

// Oracle: the same scan without offsets. What is to be added to what a ring reports is what it
// reports too little.
TEST(SimulateScan, SensorOffsetsAreAppliedOnDemand) {
  const TriangleMesh mesh = box_mesh(10.0F);
  Drive drive;
  drive.view = {{}, &mesh};
  const Scan without = drive.scan();
  for (std::size_t ring = 0; ring < 32; ++ring)
    drive.sensor.range_offsets_m.push_back(0.01 * static_cast<double>(ring));
  EXPECT_EQ(drive.scan().ranges_m, without.ranges_m);
  drive.options.sensor_offsets = true;
  const Scan with = drive.scan();
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i)
    ASSERT_NEAR(static_cast<double>(without.ranges_m[i] - with.ranges_m[i]), 0.01 * with.rings[i],
                1e-5);
}

}  // namespace
}  // namespace adasplats
