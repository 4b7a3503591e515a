// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/synth/street.h"
#include "adasplats/synth/street_plan.h"
#include "adasplats/synth/street_scan.h"

namespace adasplats {
namespace {

constexpr StreetOptions kShortStreet = {.seed = 3, .length_m = 50};

StreetScanOptions exact_scan(std::size_t points) {
  return {.points = points,
          .range_noise_m = 0,
          .pose_error_m = 0,
          .pose_error_rad = 0,
          .driving_spacing_m = 0};
}

StreetRecording scan(const Street& street, const StreetScanOptions& options, int threads = 2) {
  const Executor executor(threads);
  ProgressSink progress;
  return scan_street(
      street, options, [](std::size_t, const Scan&) {}, executor, progress);
}

/// Distance from a point to a triangle in double: to the plane if its foot is inside, else to the
/// nearest edge.
double distance(Vec3d p, const Triangle& triangle) {
  const Vec3d corners[3] = {vec_cast<double>(triangle.a), vec_cast<double>(triangle.b),
                            vec_cast<double>(triangle.c)};
  const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  bool inside = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec3d a = corners[k];
    const Vec3d edge = corners[(k + 1) % 3] - a;
    inside = inside && dot(cross(edge, p - a), normal) >= 0;
    const double share = std::clamp(dot(p - a, edge) / dot(edge, edge), 0.0, 1.0);
    nearest = std::min(nearest, length(p - a - share * edge));
  }
  return inside ? std::fabs(dot(p - corners[0], normal)) / length(normal) : nearest;
}

double distance(Vec3d p, const TriangleMesh& mesh, std::uint16_t class_id) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (mesh.classes[i] == class_id) nearest = std::min(nearest, distance(p, mesh.triangle(i)));
  return nearest;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// Oracle: brute-force distance to the triangles of the point's class, with movers at their poses.
TEST(ScanStreet, ExactPointsAreOnTheSurfaceOfTheirClass) {
  const Street street = make_street(kShortStreet);
  const StreetRecording recording = scan(street, exact_scan(20'000));
  const PointCloud& cloud = recording.mapping;
  ASSERT_EQ(recording.mapping_trajectory.size(), recording.true_mapping_trajectory.size());
  std::size_t checked_moving = 0;
  // Every 101st point, and every 5th point of the few movers.
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool moving = cloud.classes[i] > 250;
    if (i % (moving ? 5 : 101) != 0) continue;
    const TimedPose& pose = recording.true_mapping_trajectory[cloud.scan_indices[i]];
    const BuiltMesh movers = movers_at(street, pose.time_s, pose.world_from_sensor.translation);
    const TriangleMesh& mesh = moving ? movers.mesh : street.fixed;
    ASSERT_LT(distance(cloud.world(i), mesh, cloud.classes[i]), 1e-3)
        << "point " << i << " of class " << cloud.classes[i];
    checked_moving += moving ? 1U : 0U;
  }
  EXPECT_GT(checked_moving, 3U);
}

TEST(ScanStreet, CloudHasTheTargetNumberOfPointsAndEveryAttribute) {
  for (const auto& [points, passes] :
       {std::pair<std::size_t, int>{5'000, 1}, {50'000, 2}, {100'000, 3}, {300'000, 2}}) {
    const Street street = make_street({1, street_length_for(points)});
    StreetScanOptions options = exact_scan(points);
    options.passes = passes;
    const PointCloud cloud = scan(street, options).mapping;
    const auto wanted = static_cast<double>(points);
    EXPECT_NEAR(static_cast<double>(cloud.size()), wanted, 0.1 * wanted);
    EXPECT_EQ(cloud.sensor_positions.size(), cloud.size());
    EXPECT_EQ(cloud.intensities.size(), cloud.size());
    EXPECT_EQ(cloud.classes.size(), cloud.size());
    EXPECT_EQ(cloud.instances.size(), cloud.size());
    EXPECT_EQ(cloud.scan_indices.size(), cloud.size());
    for (const float intensity : cloud.intensities)
      ASSERT_TRUE(intensity >= 0 && intensity <= 1) << intensity;
  }
}

TEST(ScanStreet, SameBytesForEveryNumberOfThreads) {
  const Street street = make_street(kShortStreet);
  StreetScanOptions options;
  options.points = 30'000;
  options.driving_spacing_m = 15;
  std::vector<StreetRecording> recordings;
  std::vector<std::vector<Scan>> driving(3);
  for (int threads = 1; threads <= 3; ++threads) {
    const Executor executor(threads);
    ProgressSink progress;
    recordings.push_back(scan_street(
        street, options,
        [&](std::size_t index, const Scan& s) {
          auto& scans = driving[static_cast<std::size_t>(threads - 1)];
          EXPECT_EQ(index, scans.size());
          scans.push_back(s);
        },
        executor, progress));
  }
  for (std::size_t k = 1; k < 3; ++k) {
    const PointCloud& one = recordings[0].mapping;
    const PointCloud& other = recordings[k].mapping;
    EXPECT_TRUE(same_bytes(one.positions, other.positions));
    EXPECT_TRUE(same_bytes(one.sensor_positions, other.sensor_positions));
    EXPECT_TRUE(same_bytes(one.intensities, other.intensities));
    EXPECT_TRUE(same_bytes(one.classes, other.classes));
    EXPECT_TRUE(same_bytes(one.instances, other.instances));
    ASSERT_EQ(driving[0].size(), driving[k].size());
    for (std::size_t s = 0; s < driving[0].size(); ++s)
      EXPECT_TRUE(same_bytes(driving[0][s].positions, driving[k][s].positions));
  }
}

// Oracle: each mover's trajectory. Its points, in its own frame, are inside its bounding box, and
// they move in the world.
TEST(ScanStreet, MovingObjectsFollowTheirTrajectory) {
  const Street street = make_street({1, 60});
  const StreetRecording recording = scan(street, exact_scan(60'000));
  const PointCloud& cloud = recording.mapping;
  std::map<std::uint16_t, const MovingObject*> movers;
  for (const MovingObject& object : street.moving) movers[object.instance] = &object;

  std::map<std::uint16_t, std::map<std::uint32_t, Vec3d>> positions;  // by instance and scan
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.classes[i] < 250) continue;
    ASSERT_TRUE(movers.contains(cloud.instances[i]));
    const MovingObject& object = *movers[cloud.instances[i]];
    const double time_s = recording.true_mapping_trajectory[cloud.scan_indices[i]].time_s;
    const RigidTransform world_from_object =
        interpolate(object.world_from_object, std::fmod(time_s, street.traffic_period_s));
    const Vec3d p = world_from_object.inverse() * cloud.world(i);
    EXPECT_LT(std::fabs(p.x), 2.6);
    EXPECT_LT(std::fabs(p.y), 1.3);
    positions[cloud.instances[i]][cloud.scan_indices[i]] = world_from_object.translation;
  }
  std::size_t moved = 0;
  for (const auto& [instance, by_scan] : positions) {
    if (by_scan.size() < 2) continue;
    const Vec3d way = by_scan.rbegin()->second - by_scan.begin()->second;
    moved += length(way) > 0.1 ? 1U : 0U;
  }
  EXPECT_GE(moved, 5U);
}

// Oracle: the same rays without noise; the differences have the requested mean and deviation.
TEST(ScanStreet, RangeNoiseIsWhite) {
  const Street street = make_street(kShortStreet);
  StreetScanOptions options = exact_scan(20'000);
  const PointCloud exact = scan(street, options).mapping;
  options.range_noise_m = 0.03;
  const PointCloud noisy = scan(street, options).mapping;
  ASSERT_EQ(exact.size(), noisy.size());
  double sum = 0, square = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double along =
        static_cast<double>(length(noisy.positions[i] - noisy.sensor_positions[i])) -
        static_cast<double>(length(exact.positions[i] - exact.sensor_positions[i]));
    sum += along;
    square += along * along;
  }
  const auto n = static_cast<double>(exact.size());
  EXPECT_NEAR(sum / n, 0, 4 * 0.03 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(square / n), 0.03, 4 * 0.03 / std::sqrt(2 * n));
}

// Oracle: recorded points are the exact ones moved by one rigid transform per pass.
TEST(ScanStreet, PoseErrorIsOneRigidTransformPerPass) {
  const Street street = make_street(kShortStreet);
  StreetScanOptions options = exact_scan(20'000);
  const StreetRecording exact = scan(street, options);
  options.pose_error_m = 0.05;
  options.pose_error_rad = 0.001;
  const StreetRecording off = scan(street, options);
  ASSERT_EQ(exact.mapping.size(), off.mapping.size());
  const std::size_t scans = off.mapping_trajectory.size();
  ASSERT_GE(scans, 4U);
  const auto error_of = [&](std::size_t s) {
    return off.mapping_trajectory[s].world_from_sensor *
           exact.mapping_trajectory[s].world_from_sensor.inverse();
  };
  const RigidTransform forth = error_of(0);
  const RigidTransform back = error_of(scans - 1);
  const Vec3d middle = {25, 0, 0};
  EXPECT_GT(length(forth * middle - middle), 0.005);
  EXPECT_GT(length(forth * middle - back * middle), 0.005);
  double worst = 0;
  for (std::size_t i = 0; i < off.mapping.size(); ++i) {
    const std::uint32_t s = off.mapping.scan_indices[i];
    const RigidTransform& error = s < scans / 2 ? forth : back;
    worst = std::max(worst, length(error * exact.mapping.world(i) - off.mapping.world(i)));
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(ScanStreet, MappingSensorIsPitchedAndDrivingSensorLevel) {
  const Street street = make_street(kShortStreet);
  StreetScanOptions options = exact_scan(5'000);
  options.driving_spacing_m = 5;
  const Executor executor(2);
  ProgressSink progress;
  std::vector<Scan> scans;
  const StreetRecording recording = scan_street(
      street, options, [&](std::size_t, const Scan& s) { scans.push_back(s); }, executor, progress);

  for (const TimedPose& pose : recording.true_mapping_trajectory) {
    const RigidTransform& t = pose.world_from_sensor;
    EXPECT_NEAR(t.rotation.rows[2].z, std::cos(0.7854), 0.01);  // its z axis is 45 degrees off
    EXPECT_NEAR(t.rotation.rows[2].x, std::sin(0.7854), 0.01);  // its x axis points up in front
    EXPECT_NEAR(t.translation.z - road_height(t.translation.x, t.translation.y), 2.0, 0.03);
  }
  ASSERT_EQ(scans.size(), 9U);  // 46 m driven, one every 5 m
  ASSERT_EQ(recording.driving_trajectory.size(), scans.size());
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const RigidTransform& t = scans[s].world_from_sensor;
    EXPECT_GT(t.rotation.rows[2].z, 0.999);
    EXPECT_LT(t.rotation.rows[0].x, -0.99);  // the second pass comes back
    EXPECT_NEAR(t.translation.z - road_height(t.translation.x, t.translation.y), 1.73, 0.01);
    EXPECT_EQ(scans[s].time_s, recording.driving_trajectory[s].time_s);
    EXPECT_EQ(scans[s].rays, 64U * 2250U);
    ASSERT_GT(scans[s].size(), scans[s].rays / 2);
    ASSERT_EQ(scans[s].ranges_m.size(), scans[s].size());
    ASSERT_EQ(scans[s].rings.size(), scans[s].size());
    ASSERT_EQ(scans[s].times_s.size(), scans[s].size());
    ASSERT_EQ(scans[s].classes.size(), scans[s].size());
    ASSERT_EQ(scans[s].instances.size(), scans[s].size());
    ASSERT_EQ(scans[s].intensities.size(), scans[s].size());
    for (std::size_t i = 0; i < scans[s].size(); i += 97) {
      EXPECT_NEAR(length(scans[s].positions[i]), scans[s].ranges_m[i], 1e-4);
      EXPECT_LT(scans[s].rings[i], 64);
    }
  }
}

// Oracle: analytic. The second pass is the first one seen from the other end.
TEST(ScanStreet, PassesWithTurnsStartInTheCrossStreet) {
  const Street street = make_street(kShortStreet);
  StreetScanOptions options = exact_scan(2'000);
  options.turns = true;
  options.driving_spacing_m = 1;
  const Executor executor(2);
  ProgressSink progress;
  const Trajectory poses = scan_street(
                               street, options, [](std::size_t, const Scan&) {}, executor, progress)
                               .true_driving_trajectory;
  ASSERT_GT(poses.size(), 70U);
  const RigidTransform& first = poses.front().world_from_sensor;
  const RigidTransform& last = poses.back().world_from_sensor;
  EXPECT_LT(first.rotation.rows[1].x, -0.99);  // towards -y, right into the street...
  EXPECT_LT(poses[poses.size() / 2].world_from_sensor.rotation.rows[0].x, -0.99);
  EXPECT_LT(last.rotation.rows[1].x, -0.99);  // ...and left out of it
  EXPECT_NEAR(first.translation.x, 50 + 3.75, 1e-9);
  EXPECT_NEAR(last.translation.x, -3.75, 1e-9);
  double longest_m = 0, sharpest_rad = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const RigidTransform &a = poses[k - 1].world_from_sensor, &b = poses[k].world_from_sensor;
    longest_m = std::max(longest_m, length(b.translation - a.translation));
    sharpest_rad = std::max(sharpest_rad, angle_between(a.rotation, b.rotation));
    EXPECT_NEAR(b.translation.z - road_height(b.translation.x, b.translation.y), 1.73, 0.01);
  }
  EXPECT_NEAR(longest_m, 1, 0.05);
  EXPECT_NEAR(sharpest_rad, 1.0 / 6, 0.02);  // a turning radius of 6 m
}

TEST(ScanStreet, MaxDrivingScansLimitsTheirNumber) {
  const Street street = make_street(kShortStreet);
  StreetScanOptions options = exact_scan(2'000);
  options.driving_spacing_m = 1;
  options.max_driving_scans = 3;
  EXPECT_EQ(scan(street, options).driving_trajectory.size(), 3U);
  options.driving_spacing_m = 0;
  EXPECT_TRUE(scan(street, options).driving_trajectory.empty());
}

TEST(ScanStreet, RejectsOptionsOutOfRange) {
  const Street street = make_street(kShortStreet);
  const auto expect_usage = [&](auto change) {
    StreetScanOptions options = exact_scan(2'000);
    change(options);
    expect_error(ErrorKind::usage, {}, [&] { scan(street, options); });
  };
  expect_usage([](StreetScanOptions& o) { o.points = 999; });
  expect_usage([](StreetScanOptions& o) { o.passes = 0; });
  expect_usage([](StreetScanOptions& o) { o.speed_m_per_s = 0; });
  expect_usage([](StreetScanOptions& o) { o.range_noise_m = -1; });
  expect_usage([](StreetScanOptions& o) { o.pose_error_m = kNaN; });
  expect_usage([](StreetScanOptions& o) { o.pose_error_rad = -1e-9; });
  expect_usage([](StreetScanOptions& o) { o.driving_spacing_m = kNaN; });
}

}  // namespace
}  // namespace adasplats
