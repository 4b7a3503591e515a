// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/point_origins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "adasplats/cloud/origins/origin_check.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/e57/e57_file_test.h"

namespace adasplats {
namespace {

using enum OriginKind;

const std::string kPoseNames = "time,x,y,z,qw,qx,qy,qz\n";

std::pair<PointCloud, LoadReport> load_quietly(const std::vector<std::filesystem::path>& inputs,
                                               const LoadOptions& options = {}) {
  ProgressSink quiet;
  return load_cloud(inputs, options, Executor(2), quiet);
}

/// What a station at `station` sees of a round wall of radius 10 m around the origin, 1 degree by
/// 1 degree.
std::vector<Vec3f> wall_seen_from(Vec3f station) {
  std::vector<Vec3f> points;
  for (int a = 0; a < 360; ++a) {
    for (int e = -20; e <= 20; ++e) {
      const double azimuth = a * std::numbers::pi / 180, elevation = e * std::numbers::pi / 180;
      const double dx = std::cos(azimuth), dy = std::sin(azimuth);
      const auto sx = static_cast<double>(station.x), sy = static_cast<double>(station.y);
      const double b = sx * dx + sy * dy;
      const double t = -b + std::sqrt(b * b + 100 - sx * sx - sy * sy);
      points.push_back(
          {static_cast<float>(sx + t * dx), static_cast<float>(sy + t * dy),
           static_cast<float>(static_cast<double>(station.z) + t * std::tan(elevation))});
    }
  }
  return points;
}

std::vector<Vec3f> as_seen_from(const std::vector<Vec3f>& points, Vec3f station) {
  std::vector<Vec3f> offsets;
  for (const Vec3f p : points) offsets.push_back(p - station);
  return offsets;
}

std::string csv_of(const std::vector<Vec3f>& points, const std::string& sensor = "") {
  std::string text = sensor.empty() ? "x,y,z\n" : "x,y,z,sensor_x,sensor_y,sensor_z\n";
  for (const Vec3f p : points) {
    text += std::to_string(p.x) + "," + std::to_string(p.y) + "," + std::to_string(p.z) +
            (sensor.empty() ? "" : "," + sensor) + "\n";
  }
  return text;
}

TEST(PointOrigins, KindsByWhereTheyComeFrom) {
  const TemporaryFolder folder;
  const auto bare = folder.write("bare.xyz", "1 0 0\n9 5 0\n");
  const auto own = folder.write("own.csv", "x,y,z,sensor_x,sensor_y,sensor_z\n1,2,3,7,8,9\n");
  EXPECT_TRUE(load_quietly({bare}).first.sensor_positions.empty());
  EXPECT_TRUE(load_quietly({own}).first.origin_kinds.empty());  // all measured

  LoadOptions options;
  options.viewpoint = Vec3d{1, 2, 30};
  const auto [stated_cloud, report] = load_quietly({bare, own}, options);
  EXPECT_EQ(stated_cloud.origin_kinds, (std::vector<OriginKind>{stated, stated, measured}));
  EXPECT_EQ(report.origins, (OriginCounts{0, 0, 2, 1}));
  EXPECT_TRUE(stated_cloud.has_beams() && stated_cloud.has_all_origins());

  options.viewpoint.reset();
  options.trajectory = folder.write("t.csv", kPoseNames + "0,0,0,2,1,0,0,0\n1,10,0,3,1,0,0,0\n");
  const PointCloud driven = load_quietly({bare}, options).first;
  EXPECT_EQ(driven.origin_kinds, (std::vector<OriginKind>{guessed, guessed}));
  EXPECT_FALSE(driven.has_beams());
  EXPECT_TRUE(driven.has_all_origins());
}

// Oracle: a sensor is on the side that a normal points to.
TEST(PointOrigins, NormalsOfTheFileOrientPoints) {
  const TemporaryFolder folder;
  for (const char* const names :
       {"x,y,z,nx,ny,nz", "X,Y,Z,normal_x,normal_y,normal_z", "x,y,z,NormalX,NormalY,NormalZ"}) {
    const auto file = folder.write(
        "a.csv", std::string(names) + "\n1,2,3,0,0,2\n4,5,6,0,-1,0\n7,8,9,0,0,0\n1,1,1,nan,0,1\n");
    const PointCloud cloud = load_quietly({file}).first;
    EXPECT_EQ(cloud.origin_kinds, (std::vector<OriginKind>{guessed, guessed, none, none})) << names;
    EXPECT_GT(cloud.sensor_positions[0].z, cloud.positions[0].z);
    EXPECT_LT(cloud.sensor_positions[1].y, cloud.positions[1].y);
    EXPECT_TRUE(cloud.sensor_positions[2] == cloud.positions[2]);
    EXPECT_FALSE(cloud.has_beams());
    LoadOptions options;
    options.viewpoint = Vec3d{0, 0, 30};
    EXPECT_EQ(load_quietly({file}, options).first.origin_kinds,
              (std::vector<OriginKind>(4, stated)));
    options = {};
    options.other_columns = KeptColumns::all;
    const PointCloud kept = load_quietly({file}, options).first;
    EXPECT_TRUE(kept.sensor_positions.empty());
    EXPECT_EQ(kept.others.columns.size(), 3U);
  }
}

TEST(PointOrigins, OnesThatAreNotFiniteAreNotKnownAndLoseNoPoint) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("a.csv", "x,y,z,sensor_x,sensor_y,sensor_z\n1,2,3,7,8,9\n4,5,6,nan,8,9\n");
  const auto [cloud, report] = load_quietly({file});
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.origin_kinds, (std::vector<OriginKind>{measured, none}));
  EXPECT_TRUE(cloud.sensor_positions[1] == cloud.positions[1]);
  EXPECT_EQ(report.dropped_not_finite, 0U);
  LoadOptions options;
  options.viewpoint = Vec3d{0, 0, 1};
  EXPECT_EQ(load_quietly({file}, options).first.origin_kinds,
            (std::vector<OriginKind>{measured, stated}));
}

// One scan with a pose, one cloud without; the colours of one are said to be left out.
TEST(PointOrigins, ScansOfE57AreMeasuredFromTheirPoses) {
  const TemporaryFolder folder;
  io_test::E57Composer composer;
  const std::string reals = io_test::stream_of<double>({3});
  composer.add_scan(1, io_test::xyz_fields() + io_test::integer_field("colorRed", 0, 255),
                    {reals, reals, reals, "r"},
                    io_test::pose_element({"1", "0", "0", "0", "500", "5000", "7"}));
  composer.add_scan(1, io_test::xyz_fields(), {reals, reals, reals},
                    "<name type=\"String\">cloud</name>");
  const auto file = folder.write("a.e57", composer.file());
  class Warnings : public ProgressSink {
   public:
    void warn(std::string_view message) override { text += message; }
    std::string text;
  } warnings;
  const PointCloud cloud = load_cloud(std::span(&file, 1), {}, Executor(2), warnings).first;
  EXPECT_EQ(cloud.origin_kinds, (std::vector<OriginKind>{measured, none}));
  EXPECT_TRUE(cloud.origin + vec_cast<double>(cloud.sensor_positions.at(0)) ==
              (Vec3d{500, 5000, 7}));
  EXPECT_NE(warnings.text.find("a.e57: left out: column 'red', which only 1 of 2 scans have"),
            std::string::npos)
      << warnings.text;
}

TEST(PointOrigins, KindsSurviveSavingAndAreCheckedWhenRead) {
  const TemporaryFolder folder;
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  cloud.sensor_positions = {{0, 0, 1}, {0, 0, 2}, {7, 8, 9}};
  cloud.origin_kinds = {measured, guessed, none};
  save_cloud_ply(folder.path() / "a.ply", cloud);
  EXPECT_EQ(load_quietly({folder.path() / "a.ply"}).first.origin_kinds, cloud.origin_kinds);
  const auto wrong =
      folder.write("b.csv", "x,y,z,sensor_x,sensor_y,sensor_z,origin_kind\n1,2,3,7,8,9,4\n");
  expect_error(ErrorKind::data, {"b.csv", "'origin_kind'", "3 (measured)"},
               [&] { load_quietly({wrong}); });
}

TEST(PointOrigins, FartherThanAnyLidarMeasuresIsAnError) {
  const TemporaryFolder folder;
  const auto bare = folder.write("bare.xyz", "1 0 0\n9 5 0\n");
  LoadOptions options;
  options.viewpoint = Vec3d{5e6, 0, 0};  // 5,000 km
  expect_error(ErrorKind::usage, {"`viewpoint` 5000000.00,0.00,0.00", "bare.xyz", "5000 km"},
               [&] { load_quietly({bare}, options); });
  options.viewpoint.reset();
  options.trajectory = folder.write("t.csv", kPoseNames + "0,400000,5500000,2,1,0,0,0\n");
  expect_error(ErrorKind::usage, {"trajectory", "bare.xyz", "km"},
               [&] { load_quietly({bare}, options); });
  const auto own = folder.write("own.csv", "x,y,z,sensor_x,sensor_y,sensor_z\n1,2,3,0,20000,0\n");
  expect_error(ErrorKind::data, {"own.csv", "point 0", "20 km"}, [&] { load_quietly({own}); });
}

// The file says that it was stated or guessed: --viewpoint and --trajectory were never given.
TEST(PointOrigins, ImpossibleOnesOfAFileAreTheFiles) {
  const TemporaryFolder folder;
  for (const char* kind : {"1", "2", "3"}) {
    const auto file = folder.write(
        "a.csv", std::string("x,y,z,sensor_x,sensor_y,sensor_z,origin_kind\n1,2,3,0,20000,0,") +
                     kind + "\n");
    expect_error(ErrorKind::data, {"a.csv", "point 0", "20 km"}, [&] { load_quietly({file}); });
  }
}

TEST(PointOrigins, BeyondEveryPlaceIsAnErrorOfItsOwn) {
  const TemporaryFolder folder;
  const std::string names = "x,y,z,sensor_x,sensor_y,sensor_z\n1,2,3,0,0,0\n";
  for (const char* sensor : {"0,1e13,0", "0,0,-1e300"}) {
    const auto file = folder.write("a.csv", names + "1,2,3," + sensor + "\n");
    expect_error(ErrorKind::data, {"a.csv", "point 1", "beyond 1e12 m"},
                 [&] { load_quietly({file}); });
  }
  LoadOptions options;
  options.viewpoint = Vec3d{0, 0, 1e300};
  const auto bare = folder.write("bare.xyz", "1 0 0\n");
  expect_error(ErrorKind::usage, {"viewpoint", "1e12"}, [&] { load_quietly({bare}, options); });
  options.viewpoint.reset();
  options.trajectory = folder.write("t.csv", kPoseNames + "0,0,0,1e300,1,0,0,0\n");
  expect_error(ErrorKind::data, {"t.csv", "1e12"}, [&] { load_quietly({bare}, options); });
}

TEST(PointOrigins, AStationMustSeeItsPoints) {
  const Executor executor(2);
  const Vec3f here = {3, 0, 0};
  const std::vector<Vec3f> wall = wall_seen_from(here);
  EXPECT_LT(view_from_station(as_seen_from(wall, here), executor).share_behind, 0.01);
  // From outside, the far half of the wall is behind the near one.
  const Vec3f outside = {40, 0, 0};
  const StationView view = view_from_station(as_seen_from(wall, outside), executor);
  EXPECT_GT(view.share_behind, 0.2);
  EXPECT_NE(station_objection(view), "");

  const TemporaryFolder folder;
  const auto file = folder.write("wall.csv", csv_of(wall));
  LoadOptions options;
  options.viewpoint = Vec3d{3, 0, 0};
  EXPECT_EQ(load_quietly({file}, options).first.origin_kinds.at(0), stated);
  options.viewpoint = Vec3d{40, 0, 0};
  expect_error(ErrorKind::usage, {"`viewpoint` 40.00,0.00,0.00", "wall.csv", "%", "trajectory"},
               [&] { load_quietly({file}, options); });
  const auto wrong = folder.write("wrong.csv", csv_of(wall, "40,0,0"));
  expect_error(ErrorKind::data, {"wrong.csv", "40.00,0.00,0.00"}, [&] { load_quietly({wrong}); });
  EXPECT_EQ(load_quietly({folder.write("right.csv", csv_of(wall, "3,0,0"))}).second.origins[3],
            wall.size());
}

/// What a sensor sees of the round wall on its way along x, and where it was.
std::pair<std::vector<Vec3f>, std::vector<Vec3f>> wall_seen_on_the_way() {
  std::pair<std::vector<Vec3f>, std::vector<Vec3f>> seen;
  for (int step = -8; step <= 8; ++step) {
    const Vec3f here = {0.5F * static_cast<float>(step), 0, 0};
    for (const Vec3f p : wall_seen_from(here)) {
      seen.first.push_back(p);
      seen.second.push_back(here);
    }
  }
  return seen;
}

TEST(PointOrigins, APathMustSeeItsPoints) {
  const Executor executor(2);
  auto [points, origins] = wall_seen_on_the_way();
  const PathView inside = view_from_path(points, origins, executor);
  EXPECT_EQ(inside.places, 16U);
  EXPECT_LT(inside.share_behind, 0.01);
  EXPECT_EQ(path_objection(inside), "");
  for (Vec3f& origin : origins) origin.x += 30;
  const PathView outside = view_from_path(points, origins, executor);
  EXPECT_GT(outside.share_behind, 0.2);
  EXPECT_EQ(outside.share_behind, view_from_path(points, origins, Executor(1)).share_behind);
  EXPECT_NE(path_objection(outside), "");
}

TEST(PointOrigins, FilesWithThePathOfAnotherPlaceAreRefused) {
  const auto [points, origins] = wall_seen_on_the_way();
  const auto csv_from = [&, &points = points, &origins = origins](float shift_m) {
    std::string text = "x,y,z,sensor_x,sensor_y,sensor_z\n";
    for (std::size_t i = 0; i < points.size(); ++i)
      text += std::to_string(points[i].x) + "," + std::to_string(points[i].y) + "," +
              std::to_string(points[i].z) + "," + std::to_string(origins[i].x + shift_m) + ",0,0\n";
    return text;
  };
  const TemporaryFolder folder;
  EXPECT_EQ(load_quietly({folder.write("right.csv", csv_from(0))}).second.origins[3],
            points.size());
  const auto wrong = folder.write("wrong.csv", csv_from(30));
  expect_error(ErrorKind::data, {"wrong.csv", "sensor positions", "%"},
               [&] { load_quietly({wrong}); });
  LoadOptions trusting;
  trusting.trust_origins = true;
  EXPECT_EQ(load_quietly({wrong}, trusting).second.origins[3], points.size());
}

TEST(PointOrigins, SmallViewsAreNotJudged) {
  const Executor executor(1);
  EXPECT_EQ(station_objection(view_from_station({}, executor)), "");
  const std::vector<Vec3f> one = {{1, 0, 0}};
  EXPECT_EQ(station_objection(view_from_station(one, executor)), "");
  const std::vector<Vec3f> behind = {{5, 0, 0}, {10, 0, 0}};  // half of them
  EXPECT_EQ(station_objection(view_from_station(behind, executor)), "");
  const std::vector<Vec3f> same(100, Vec3f{0, 0, 0});
  EXPECT_EQ(station_objection(view_from_station(same, executor)), "");
  EXPECT_EQ(path_objection(view_from_path({}, {}, executor)), "");
  EXPECT_EQ(path_objection(view_from_path(behind, behind, executor)), "");
}

}  // namespace
}  // namespace adasplats
