// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/beams/scan_rings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/cloud/beams/spinning_sensor_test.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

SpinningSensor tilted(double pitch_deg) {
  SpinningSensor sensor = SpinningSensor::with(24, 12, -34);
  sensor.world_from_sensor = rotation_from_yaw_pitch_roll(1.1, pitch_deg * kDegree, -0.03);
  return sensor;
}

double degrees_between(Vec3d a, Vec3d b) { return std::asin(length(cross(a, b))) / kDegree; }

/// Rings and axis against those that the points were made with.
void expect_found(const RecordingRings& found, const SpinningSensor& sensor,
                  const std::vector<TestBeam>& beams, double axis_deg) {
  ASSERT_EQ(found.elevations_rad.size(), sensor.elevations_rad.size());
  for (std::size_t k = 0; k < sensor.elevations_rad.size(); ++k)
    EXPECT_NEAR(found.elevations_rad[k], sensor.elevations_rad[k], 0.05 * kDegree) << k;
  std::vector<std::uint16_t> rings;
  for (const TestBeam& beam : beams)
    if (beam.returned()) rings.push_back(beam.ring);
  const Vec3d axis = sensor.world_from_sensor.transposed().rows[2];
  std::size_t points = 0, wrong = 0;
  for (const ScanRings& scan : found.scans) {
    EXPECT_LT(degrees_between(scan.world_from_sensor.transposed().rows[2], axis), axis_deg);
    for (std::size_t k = 0; k < scan.points.size(); ++k)
      wrong += scan.rings[k] != rings[scan.points[k]] ? 1 : 0;
    points += scan.points.size();
  }
  EXPECT_EQ(points, rings.size());
  EXPECT_EQ(wrong, 0U);
}

TEST(ScanRings, LasersAndPosesSayThem) {
  const SpinningSensor sensor = tilted(10);
  const auto beams = sensor.scans(3);
  PointCloud cloud = cloud_of(beams);
  add_lasers_and_poses(cloud, beams, sensor.world_from_sensor);
  const auto found = find_scan_rings(cloud, {}, Executor(2));
  EXPECT_EQ(found.scans.size(), 3U);
  expect_found(found, sensor, beams, 1e-6);
}

TEST(ScanRings, PointsWithoutALaserGoToTheNearestRing) {
  const SpinningSensor sensor = tilted(10);
  const auto beams = sensor.scans(2);
  PointCloud cloud = cloud_of(beams);
  add_lasers_and_poses(cloud, beams, sensor.world_from_sensor);
  for (std::size_t i = 0; i < cloud.size(); i += 10) cloud.lasers[i] = kNoLaser;
  expect_found(find_scan_rings(cloud, {}, Executor(2)), sensor, beams, 1e-6);
}

TEST(ScanRings, AreFoundFromDirectionsOfALevelAndATiltedSensor) {
  for (const double pitch_deg : {0.0, 7.0, 45.0}) {
    const SpinningSensor sensor = tilted(pitch_deg);
    const auto beams = sensor.scans(3);
    const auto found = find_scan_rings(cloud_of(beams), {}, Executor(2));
    EXPECT_EQ(found.scans.size(), 3U);
    expect_found(found, sensor, beams, 0.05);
  }
}

TEST(ScanRings, TwoSensorsInOneScanHaveNone) {
  const auto beams = tilted(20).scans(3), others = tilted(-20).scans(3);
  PointCloud cloud = cloud_of(beams);
  append(cloud, cloud_of(others));
  EXPECT_TRUE(find_scan_rings(cloud, {}, Executor(2)).scans.empty());
}

TEST(ScanRings, DirectionsAtRandomHaveNone) {
  PointCloud cloud;
  for (std::uint64_t k = 0; k < 20'000; ++k) {
    Random random(1, 0, k);
    const double azimuth_rad = random.uniform(0, 6.28), z = random.uniform(-0.5, 0.3);
    const double flat = std::sqrt(1 - z * z);
    cloud.positions.push_back(vec_cast<float>(
        20.0 * Vec3d{flat * std::cos(azimuth_rad), flat * std::sin(azimuth_rad), z}));
  }
  cloud.sensor_positions.resize(cloud.size());
  cloud.scan_indices.resize(cloud.size());
  EXPECT_TRUE(find_scan_rings(cloud, {}, Executor(2)).scans.empty());
}

TEST(ScanRings, NothingWithoutPointsScansOrOrigins) {
  EXPECT_TRUE(find_scan_rings({}, {}, Executor(1)).scans.empty());
  const PointCloud cloud = cloud_of(tilted(0).scans(1));
  PointCloud without = cloud;
  without.scan_indices.clear();
  EXPECT_TRUE(find_scan_rings(without, {}, Executor(1)).scans.empty());
  without = cloud;
  without.sensor_positions.clear();
  EXPECT_TRUE(find_scan_rings(without, {}, Executor(1)).scans.empty());
  without = cloud;
  without.origin_kinds.assign(cloud.size(), OriginKind::guessed);
  EXPECT_TRUE(find_scan_rings(without, {}, Executor(1)).scans.empty());
  without = cloud;  // every point is where its sensor is
  without.positions = without.sensor_positions;
  EXPECT_TRUE(find_scan_rings(without, {}, Executor(1)).scans.empty());
  ScanRingOptions options;
  options.min_points = cloud.size() + 1;
  EXPECT_TRUE(find_scan_rings(cloud, options, Executor(1)).scans.empty());
}

}  // namespace
}  // namespace adasplats
