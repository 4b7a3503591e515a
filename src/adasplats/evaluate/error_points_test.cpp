// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/error_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/evaluate/cloud_metrics.h"

namespace adasplats {
namespace {

PointCloud three_points(Vec3d origin) {
  PointCloud cloud;
  cloud.origin = origin;
  cloud.positions = {{1, 2, 3}, {-4, 5.5F, -6}, {0.125F, 0, 7}};
  cloud.intensities = {0, 0.5F, 1};
  cloud.classes = {0, 40, 65535};
  return cloud;
}

// Oracle: what was written, near the world's origin and in UTM coordinates.
TEST(ErrorPoints, RoundTrip) {
  const TemporaryFolder folder;
  const std::vector<float> errors_m = {0.25F, kNaN, -1.5F};
  for (const Vec3d origin : {Vec3d{}, Vec3d{452'000, 5'411'000, 0}}) {
    const PointCloud cloud = three_points(origin);
    const auto file = folder.path() / "a b.ply";
    write_error_points(file, {cloud, errors_m, {7, Hit::kNone, 0}, 8});
    EXPECT_TRUE(has_error_points(file));
    const ErrorPoints read = read_error_points(file);
    ASSERT_EQ(read.cloud.size(), 3U);
    EXPECT_EQ(read.dropped, 0U);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT(length(read.cloud.world(i) - cloud.world(i)), 1e-4) << i;
    EXPECT_EQ(read.errors_m[0], 0.25F);
    EXPECT_TRUE(std::isnan(read.errors_m[1]));
    EXPECT_EQ(read.errors_m[2], -1.5F);
    EXPECT_EQ(read.primitive_count, 8U);
    EXPECT_EQ(read.primitives, (std::vector<std::uint32_t>{7, Hit::kNone, 0}));
    EXPECT_EQ(read.cloud.classes, cloud.classes);
    EXPECT_EQ(read.cloud.intensities, cloud.intensities);
    // It is a cloud to everything else.
    ProgressSink quiet;
    const std::filesystem::path inputs[] = {file};
    const PointCloud loaded = load_cloud(inputs, {}, Executor(1), quiet).first;
    EXPECT_EQ(loaded.classes, cloud.classes);
    EXPECT_EQ(loaded.origin, read.cloud.origin);
  }
}

TEST(ErrorPoints, WithoutAttributesAndWithoutPoints) {
  const TemporaryFolder folder;
  PointCloud cloud = three_points({});
  cloud.classes.clear();
  cloud.intensities.clear();
  const auto file = folder.path() / "p.ply";
  write_error_points(file, {cloud, std::vector<float>(3, 1), {}});
  const ErrorPoints plain = read_error_points(file);
  EXPECT_TRUE(plain.cloud.classes.empty());
  EXPECT_TRUE(plain.cloud.intensities.empty());
  EXPECT_TRUE(plain.primitives.empty());
  write_error_points(file, {});
  const ErrorPoints none = read_error_points(file);
  EXPECT_TRUE(none.cloud.empty());
  EXPECT_TRUE(none.errors_m.empty());
  EXPECT_THROW(write_error_points(file, {cloud, std::vector<float>(2, 1), {}}), std::logic_error);
  EXPECT_THROW(write_error_points(file, {cloud, std::vector<float>(3, 1), {1, 2}}),
               std::logic_error);
}

TEST(ErrorPoints, ReadsOtherProgramsFiles) {
  const TemporaryFolder folder;
  const auto compared =
      folder.write("c.PLY",
                   "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
                   "property double z\nproperty float scalar_C2C_absolute_distances\n"
                   "property uint label\nend_header\n1 2 3 0.5 655400\n4 5 6 inf 7\n");
  EXPECT_TRUE(has_error_points(compared));
  const ErrorPoints points = read_error_points(compared);
  EXPECT_EQ(points.errors_m[0], 0.5F);
  EXPECT_TRUE(std::isnan(points.errors_m[1]));
  EXPECT_EQ(points.cloud.classes, (std::vector<std::uint16_t>{40, 7}));  // 10 << 16 | 40
  const ErrorPoints text = read_error_points(folder.write("t.csv", "x,y,z,error_m\n1,2,3,0.75\n"));
  EXPECT_EQ(text.errors_m, std::vector<float>{0.75F});
}

TEST(ErrorPoints, DropsInvalidAndFarPoints) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("f.csv",
                   "x,y,z,error_m\n1,2,3,0.1\nnan,2,3,0.2\n2,2,3,0.3\n1e300,0,0,0.4\n3,2,3,0.5\n"
                   "inf,0,0,0.6\n200000,0,0,0.7\n");
  const ErrorPoints points = read_error_points(file);
  EXPECT_EQ(points.dropped, 4U);
  EXPECT_EQ(points.errors_m, (std::vector<float>{0.1F, 0.3F, 0.5F}));
  EXPECT_EQ(points.cloud.positions[2], (Vec3f{3, 2, 3}));
}

TEST(ErrorPoints, ErrorsNameTheFault) {
  const TemporaryFolder folder;
  const auto cloud =
      folder.write("c.ply",
                   "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                   "property float z\nend_header\n1 2 3\n");
  EXPECT_FALSE(has_error_points(cloud));
  expect_error(ErrorKind::data, {"c.ply", "error_m", "x, y, z"}, [&] { read_error_points(cloud); });
  expect_error(ErrorKind::data, {"column 'z'"},
               [&] { read_error_points(folder.write("y.csv", "x,y,error_m\n1,2,3\n")); });
  expect_error(ErrorKind::data, {"label", "point 0", "-1"}, [&] {
    read_error_points(folder.write("l.csv", "x,y,z,error_m,label\n1,2,3,4,-1\n"));
  });
  expect_error(ErrorKind::no_input, {"none.ply"},
               [&] { has_error_points(folder.path() / "none.ply"); });
  expect_error(ErrorKind::data, {"broken.ply"},
               [&] { has_error_points(folder.write("broken.ply", "ply\nformat")); });
  EXPECT_FALSE(has_error_points(folder.path() / "none.bin"));
}

// Oracle: the mean is the C2C of cloud_distance.
TEST(ErrorPoints, DistancesAreThoseOfC2C) {
  const PointCloud original = three_points({});
  PointCloud simulated = three_points({1000, 0, 0});
  for (Vec3f& p : simulated.positions) p.x -= 1000.25F;
  const Executor executor(2);
  const CloudDistance distance = cloud_distance(simulated, original, executor);
  const ErrorPoints points = distance_points(simulated, original, executor);
  ASSERT_EQ(points.errors_m.size(), 3U);
  double sum_m = 0;
  for (const float error_m : points.errors_m) sum_m += static_cast<double>(error_m);
  EXPECT_NEAR(sum_m / 3, distance.c2c_m, 1e-6);
  EXPECT_NEAR(points.errors_m[1], 0.25F, 1e-4F);
  EXPECT_EQ(points.cloud.positions, simulated.positions);
  EXPECT_EQ(points.cloud.classes, simulated.classes);
  expect_error(ErrorKind::data, {"no points"}, [&] { distance_points({}, original, executor); });
}

// Oracle: by hand; +x of the sensor is +y of the world.
TEST(ErrorPoints, BeamsAreInWorldCoordinates) {
  const Vec3d positions[] = {{7000, 100, 2}, {7001, 100, 2}};
  Trajectory trajectory(2);
  for (std::size_t k = 0; k < 2; ++k)
    trajectory[k].world_from_sensor = {{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}, positions[k]};
  const ScanErrors scan = {
      {{10, 0, 0}, {9.75F, 0, 0}, {-10, 0, 0}}, {0, 0.25F, kNaN}, {4, 2, Hit::kNone}};
  const ErrorPoints points = beam_points({scan, scan}, trajectory, 5);
  EXPECT_EQ(points.primitive_count, 5U);
  ASSERT_EQ(points.cloud.size(), 6U);
  ASSERT_EQ(points.errors_m.size(), 6U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT(length(points.cloud.world(3 * k) - (positions[k] + Vec3d{0, 10, 0})), 1e-4);
    EXPECT_LT(length(points.cloud.world(3 * k + 2) - (positions[k] - Vec3d{0, 10, 0})), 1e-4);
    EXPECT_EQ(points.errors_m[3 * k + 1], 0.25F);
    EXPECT_TRUE(std::isnan(points.errors_m[3 * k + 2]));
    EXPECT_EQ(points.primitives[3 * k], 4U);
    EXPECT_EQ(points.primitives[3 * k + 2], Hit::kNone);
  }
  EXPECT_TRUE(beam_points({}, {}, 5).cloud.empty());
  EXPECT_THROW(beam_points({scan}, trajectory, 5), std::logic_error);
}

}  // namespace
}  // namespace adasplats
