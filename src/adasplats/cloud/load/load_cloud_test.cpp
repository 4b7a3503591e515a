// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/load_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/recorded_progress_test.h"
#include "adasplats/core/recordings_test.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/las/las_writer.h"

namespace adasplats {
namespace {

std::pair<PointCloud, LoadReport> load(const std::vector<std::filesystem::path>& inputs,
                                       const LoadOptions& options = {}, int threads = 2) {
  ProgressSink quiet;
  return load_cloud(inputs, options, Executor(threads), quiet);
}

void expect_same_vectors(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(a[i] == b[i]) << i;
}

void expect_same(const PointCloud& a, const PointCloud& b) {
  EXPECT_TRUE(a.origin == b.origin);
  expect_same_vectors(a.positions, b.positions);
  expect_same_vectors(a.sensor_positions, b.sensor_positions);
  EXPECT_EQ(a.origin_kinds, b.origin_kinds);
  EXPECT_EQ(a.intensities, b.intensities);
  EXPECT_EQ(a.classes, b.classes);
  EXPECT_EQ(a.instances, b.instances);
  EXPECT_EQ(a.scan_indices, b.scan_indices);
}

/// Poses are the LiDAR's own.
constexpr const char* kSensorPoses = "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n";

/// A sequence whose scan k has k + 1 points, turned by 90 degrees to the left and moved along x.
void write_sequence(const TemporaryFolder& folder, int scans, double x0_m = 0,
                    const std::string& name = "") {
  std::string poses;
  for (int k = 0; k < scans; ++k) {
    std::vector<float> values;
    std::vector<std::uint32_t> labels;
    for (int i = 0; i <= k; ++i) {
      values.insert(values.end(), {static_cast<float>(i), 0.5F, 2.0F, 0.25F});
      labels.push_back(static_cast<std::uint32_t>((7 << 16) + 40 + i));
    }
    const std::string stem = "00000" + std::to_string(k);
    folder.write(name + "velodyne/" + stem + ".bin", values);
    folder.write(name + "labels/" + stem + ".label", labels);
    poses += "0 -1 0 " + std::to_string(x0_m + 10 * k) + " 1 0 0 0 0 0 1 0\n";
  }
  folder.write(name + "poses.txt", poses);
  folder.write(name + "calib.txt", kSensorPoses);
}

// Oracle: analytic. A point (i, 0.5, 2) seen from (10 k, 0, 0) facing +y is at (10 k - 0.5, i, 2).
TEST(LoadCloud, SequenceInWorldCoordinates) {
  const TemporaryFolder folder;
  write_sequence(folder, 3);
  const auto [cloud, report] = load({folder.path()});
  ASSERT_EQ(cloud.size(), 6U);
  EXPECT_EQ(report.points_read, 6U);
  EXPECT_EQ(report.dropped_not_finite + report.dropped_far, 0U);
  std::size_t n = 0;
  for (std::uint32_t k = 0; k < 3; ++k) {
    for (std::uint32_t i = 0; i <= k; ++i, ++n) {
      const auto x = static_cast<float>(10 * k), y = static_cast<float>(i);
      EXPECT_LT(length(cloud.positions[n] - Vec3f{x - 0.5F, y, 2}), 1e-5F);
      EXPECT_LT(length(cloud.sensor_positions[n] - Vec3f{x, 0, 0}), 1e-5F);
      EXPECT_EQ(cloud.intensities[n], 0.25F);
      EXPECT_EQ(cloud.classes[n], 40 + i);
      EXPECT_EQ(cloud.instances[n], 7);
      EXPECT_EQ(cloud.scan_indices[n], k);
    }
  }
}

TEST(LoadCloud, ChosenScansAreRenumbered) {
  const TemporaryFolder folder;
  write_sequence(folder, 6);
  LoadOptions options;
  options.first_scan = 1;
  options.scan_count = 2;
  options.scan_stride = 2;
  const PointCloud cloud = load({folder.path()}, options).first;
  ASSERT_EQ(cloud.size(), 2U + 4U);  // scans 1 and 3
  EXPECT_NEAR(cloud.sensor_positions[1].x, 10, 1e-5);
  EXPECT_NEAR(cloud.sensor_positions[2].x, 30, 1e-5);
  EXPECT_EQ(cloud.scan_indices[1], 0U);
  EXPECT_EQ(cloud.scan_indices[2], 1U);
  options.scan_count = 4;  // more than are there: 1, 3 and 5
  const PointCloud more = load({folder.path()}, options).first;
  ASSERT_EQ(more.size(), 2U + 4U + 6U);
  EXPECT_NEAR(more.sensor_positions[6].x, 50, 1e-5);
  EXPECT_EQ(more.scan_indices[6], 2U);
  options.scan_stride = static_cast<std::size_t>(-1);
  EXPECT_EQ(load({folder.path()}, options).first.size(), 2U);
  options.first_scan = 6;
  expect_error(ErrorKind::usage, {"6 scans", "first scan is set to 6"},
               [&] { load({folder.path()}, options); });
}

TEST(LoadCloud, ScansThatAreNotChosenMayBeBroken) {
  const TemporaryFolder folder;
  write_sequence(folder, 6);
  folder.write("velodyne/000004.bin", std::string(17, 'x'));
  LoadOptions options;
  options.scan_count = 2;
  EXPECT_EQ(load({folder.path()}, options).first.size(), 3U);
  expect_error(ErrorKind::data, {"000004.bin"}, [&] { load({folder.path()}); });
}

TEST(LoadCloud, TwoSequencesCountScansOn) {
  const TemporaryFolder folder;
  write_sequence(folder, 2, 0, "a/");
  write_sequence(folder, 2, 100, "b/");
  const PointCloud cloud = load({folder.path() / "a", folder.path() / "b"}).first;
  EXPECT_EQ(cloud.scan_indices, (std::vector<std::uint32_t>{0, 1, 1, 2, 3, 3}));
}

// Two drives of SemanticKITTI lie one on the other; a sequence named twice has every point twice.
TEST(LoadCloud, SequencesNamedOneByOneAreOneWorldToo) {
  const TemporaryFolder folder;
  write_sequence(folder, 2, 0, "a/");
  write_sequence(folder, 2, 0, "b/");
  const auto a = folder.path() / "a", b = folder.path() / "b";
  expect_error(ErrorKind::usage, {a.string(), b.string(), "start at the same pose"}, [&] {
    load({a, b});
  });
  expect_error(ErrorKind::usage, {a.string(), "start at the same pose"}, [&] { load({a, a}); });
}

// Oracle: analytic; float steps at 1 km are 0.06 mm.
TEST(LoadCloud, UtmCoordinatesKeepMillimetres) {
  const TemporaryFolder folder;
  write_sequence(folder, 3, 448262.123);
  const PointCloud sequence = load({folder.path()}).first;
  EXPECT_TRUE((sequence.origin == Vec3d{448000, 0, 0}));
  EXPECT_LT(length(sequence.world(5) - Vec3d{448262.123 + 19.5, 2, 2}), 1e-4);
  EXPECT_LT(std::fabs(sequence.sensor_positions[5].x - 282.123F), 1e-4F);
  const auto file = folder.write("a.xyz",
                                 "448262.1234 5411932.5678 212.001\n"
                                 "448263.1234 5411933.5678 212.002\n");
  const PointCloud points = load({file}).first;
  EXPECT_TRUE((points.origin == Vec3d{448000, 5412000, 0}));
  EXPECT_LT(length(points.world(1) - Vec3d{448263.1234, 5411933.5678, 212.002}), 1e-4);
}

TEST(LoadCloud, SameForEveryNumberOfThreads) {
  const TemporaryFolder folder;
  std::vector<float> values;
  for (std::uint64_t i = 0; i < 4 * 200'000; ++i)
    values.push_back(static_cast<float>(i % 4 == 3 ? 0.5 : Random(1, 0, i).uniform(-3000, 3000)));
  folder.write("velodyne/000000.bin", values);
  folder.write("calib.txt", kSensorPoses);
  folder.write("velodyne/000001.bin", std::vector<float>(values.begin(), values.begin() + 40));
  folder.write("poses.txt", "0 -1 0 1000 1 0 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n");
  LoadOptions options;
  options.max_dropped = 1;
  options.max_distance_m = 2500;
  const auto [one, report] = load({folder.path()}, options, 1);
  EXPECT_GT(report.dropped_far, 0U);
  EXPECT_GT(one.size(), 0U);
  for (const int threads : {2, 3}) expect_same(load({folder.path()}, options, threads).first, one);
}

/// Options that take whatever is dropped.
LoadOptions any_share() {
  LoadOptions options;
  options.max_dropped = 1;
  return options;
}

TEST(LoadCloud, PointsThatAreNotFiniteAreCounted) {
  const TemporaryFolder folder;
  const float inf = std::numeric_limits<float>::infinity();
  const auto file = folder.write(
      "a.bin",
      std::vector<float>{1, 2, 3, 4, kNaN, 2, 3, 4, 1, 2, -inf, 4, 5, 6, 7, 8, 0, 0, 0, kNaN});
  const auto [cloud, report] = load({file}, any_share());
  ASSERT_EQ(cloud.size(), 3U);
  EXPECT_TRUE((cloud.positions[1] == Vec3f{5, 6, 7}));
  EXPECT_EQ(cloud.intensities[1], 8.0F);
  EXPECT_TRUE(std::isnan(cloud.intensities[2]));  // not known: no reason to lose the point
  EXPECT_EQ(report.points_read, 5U);
  EXPECT_EQ(report.dropped_not_finite, 2U);
  EXPECT_EQ(report.unknown_intensities, 1U);
  expect_error(ErrorKind::data, {"a.bin", "2 of 5 points (40 %)", "not finite", "`max_dropped`"},
               [&] { load({file}); });
  LoadOptions strict;
  strict.strict = true;
  expect_error(ErrorKind::data, {"a.bin", "point 1 "}, [&] { load({file}, strict); });

  write_sequence(folder, 2, 0, "s/");
  folder.write("s/velodyne/000001.bin", std::vector<float>{1, 2, 3, 4, 1, kNaN, 3, 4});
  EXPECT_EQ(load({folder.path() / "s"}, any_share()).second.dropped_not_finite, 1U);
  expect_error(ErrorKind::data, {"000001.bin", "point 1 "},
               [&] { load({folder.path() / "s"}, strict); });
}

TEST(LoadCloud, NothingLeft) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.bin", std::vector<float>{kNaN, 2, 3, 4});
  const auto [cloud, report] = load({file}, any_share());
  EXPECT_TRUE(cloud.empty());
  EXPECT_EQ(report.dropped_not_finite, 1U);
}

// Organised clouds hold NaN, NaN, NaN where no beam returned: said, however many there are.
TEST(LoadCloud, NoReturnsAreSaid) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.xyz", "nan nan nan\n1 2 3\nnan nan nan\n");
  RecordedProgress listener;
  const auto [cloud, report] = load_cloud(std::span(&file, 1), {}, Executor(1), listener);
  EXPECT_EQ(cloud.size(), 1U);
  EXPECT_EQ(report.no_returns, 2U);
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_NE(listener.warnings[0].find("2 of 3 points (66.7 %) are missing returns"),
            std::string::npos)
      << listener.warnings[0];
}

TEST(LoadCloud, SeveralScansWithoutPosesAreAnError) {
  const TemporaryFolder folder;
  std::string text = "x,y,z,range\n";
  for (int k = 3; k < 20; ++k) text += std::to_string(k) + ",0,0," + std::to_string(k) + "\n";
  const auto a = folder.write("a.csv", text), b = folder.write("b.csv", text);
  EXPECT_EQ(load({a}).first.size(), 17U);
  LoadOptions options;
  for (const bool describes : {false, true}) {
    options.accept_sensor_frame = describes;
    expect_error(ErrorKind::data,
                 {"2 of its files are scans in the sensor frame", "a.csv: its column 'range'",
                  "`trajectory`", "`viewpoint`"},
                 [&] {
                   load({a, b}, options);
                 });
  }
  options.viewpoint = Vec3d{};
  EXPECT_EQ(load({a, b}, options).first.size(), 34U);
}

/// `near` points of a place and `far` of another, 500 km away.
std::string two_places(int near, int far) {
  std::string text;
  for (int i = 0; i < near + far; ++i)
    text += std::to_string(i < near ? 1000 + i : 501000 + i) + " 2000 3\n";
  return text;
}

TEST(LoadCloud, TwoPlacesAreAnError) {
  const TemporaryFolder folder;
  const auto half = folder.write("half.xyz", two_places(52, 48));
  expect_error(ErrorKind::data,
               {"half.xyz", "48 of 100 points (48 %)", "100000 m", "`max_distance`"},
               [&] { load({half}); });
  LoadOptions options;
  options.max_dropped = 0.5;
  EXPECT_EQ(load({half}, options).second.dropped_far, 48U);
  options = {};
  options.max_distance_m = 1e6;
  EXPECT_EQ(load({half}, options).first.size(), 100U);
  const auto few = folder.write("few.xyz", two_places(198, 2));
  RecordedProgress listener;
  EXPECT_EQ(load_cloud(std::span(&few, 1), {}, Executor(1), listener).first.size(), 198U);
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_NE(listener.warnings[0].find("2 of 200 points (1 %) are farther"), std::string::npos);
}

TEST(LoadCloud, LongitudesAndLatitudesAreNoMetres) {
  const TemporaryFolder folder;
  // 50 m of a street in Paris, 12 m high.
  const auto degrees =
      folder.write("d.xyz", "2.34000 48.84000 35\n2.34060 48.84010 36.5\n2.34030 48.84040 47\n");
  expect_error(ErrorKind::data, {"d.xyz", "longitudes and latitudes", "project"},
               [&] { load({degrees}); });
  // A pole of 10 cm and 30 m in its own frame, and a place of one point, are metres.
  EXPECT_EQ(load({folder.write("p.xyz", "5 6 0\n5.1 6.1 30\n")}).first.size(), 2U);
  EXPECT_EQ(load({folder.write("s.xyz", "-0.001 -0.001 0\n0.001 0.001 30\n")}).first.size(), 2U);
  EXPECT_EQ(load({folder.write("one.xyz", "2.34 48.84 35\n")}).first.size(), 1U);
  // A kilometre with 3 m of height could be a pole, too: taken, and said.
  const auto warnings_of = [&](const std::string& text) {
    RecordedProgress listener;
    load_cloud(std::vector{folder.write("doubtful.xyz", text)}, {}, Executor(1), listener);
    return listener.warnings;
  };
  const std::string kilometre = "2.34 48.84 35\n2.35 48.84 36\n2.34 48.85 38\n2.35 48.85 37\n";
  ASSERT_EQ(warnings_of(kilometre).size(), 1U);
  EXPECT_NE(
      warnings_of(kilometre)[0].find("assumed to be metres; if they are longitudes and latitudes"),
      std::string::npos);
  EXPECT_EQ(warnings_of("5 6 0\n5.1 6.1 30\n").size(), 1U);
  EXPECT_TRUE(warnings_of("5 6 0\n5.5 6.5 4\n").empty());  // a statue
  EXPECT_TRUE(warnings_of("-5 -6 0\n5 6 2\n").empty());
}

/// A PLY of two points whose comments say a coordinate system, or none.
std::string ply_in(const std::string& crs) {
  return "ply\nformat ascii 1.0\n" +
         (crs.empty() ? "" : "comment adasplats.crs_wkt " + crs + "\n") +
         "element vertex 2\nproperty double x\nproperty double y\nproperty double z\n"
         "end_header\n500000 5000000 10\n500001 5000000 10\n";
}

TEST(LoadCloud, CoordinateSystemsAreKeptAndNotMixed) {
  const TemporaryFolder folder;
  const auto a = folder.write("a.ply", ply_in("EPSG:32632"));
  const auto b = folder.write("b.ply", ply_in("EPSG:32633"));
  const auto none = folder.write("none.ply", ply_in(""));
  EXPECT_EQ(load({a}).first.crs.name(), "EPSG:32632");
  EXPECT_TRUE(load({none}).first.crs.empty());
  expect_error(ErrorKind::data, {"b.ply", "EPSG:32633", "a.ply", "EPSG:32632"}, [&] {
    load({a, none, b});
  });
  RecordedProgress listener;
  const std::vector both = {none, a};
  const PointCloud cloud = load_cloud(both, {}, Executor(1), listener).first;
  EXPECT_EQ(cloud.crs.name(), "EPSG:32632");
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_EQ(listener.warnings[0], "no coordinate system in 1 of 2 inputs (" + none.string() +
                                      "); assumed EPSG:32632 of " + a.string());
  // What is saved says it again.
  const auto saved = folder.path() / "saved.ply";
  save_cloud_ply(saved, cloud);
  EXPECT_EQ(load({saved}).first.crs, cloud.crs);
  const std::vector<std::uint32_t> first = {0};
  EXPECT_EQ(gather(cloud, first).crs, cloud.crs);
}

// A LAS 1.2 file of one point of format 0 with GeoTIFF keys.
TEST(LoadCloud, LasInFeetAndWithheldPoints) {
  const TemporaryFolder folder;
  std::string content(227 + 54 + 16 + 20, '\0');
  const auto put = [&content](std::size_t place, auto value) {
    std::memcpy(content.data() + place, &value, sizeof(value));
  };
  std::memcpy(content.data(), "LASF", 4);
  put(24, std::uint16_t{0x0201});
  put(94, std::uint16_t{227});
  put(96, std::uint32_t{227 + 54 + 16});
  put(100, std::uint32_t{1});
  put(105, std::uint16_t{20});
  put(107, std::uint32_t{1});
  for (const std::size_t axis : {0U, 1U, 2U}) put(131 + 8 * axis, 0.01);
  std::memcpy(content.data() + 229, "LASF_Projection", 15);
  put(245, std::uint16_t{34735});
  put(247, std::uint16_t{16});
  put(281 + 8, std::uint16_t{3076});
  put(281 + 14, std::uint16_t{9001});
  EXPECT_EQ(load({folder.write("metres.las", content)}).first.size(), 1U);
  put(281 + 16 + 15, std::uint8_t{0x80});
  const auto withheld = folder.write("withheld.las", content);
  RecordedProgress listener;
  EXPECT_TRUE(load_cloud(std::span(&withheld, 1), {}, Executor(1), listener).first.empty());
  EXPECT_NE(listener.warnings.at(0).find("1 of 1 points are flagged as withheld"),
            std::string::npos);
  put(281 + 16 + 15, std::uint8_t{0});
  put(281 + 14, std::uint16_t{9003});
  const auto feet = folder.write("feet.las", content);
  expect_error(ErrorKind::data, {"feet.las", "not in metres", "US survey feet", "pdal translate"},
               [&] { load({feet}); });
}

// Oracle: analytic. Outliers move neither the origin nor the rest.
TEST(LoadCloud, FarPointsAreDroppedAndDoNotMoveTheOrigin) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.bin", std::vector<float>{1, 2, 3,     4, 1e30F, 0, 0, 0, 2, 3,
                                                             4, 5, -2e6F, 0, 0,     0, 3, 4, 5, 6});
  const auto [cloud, report] = load({file}, any_share());
  ASSERT_EQ(cloud.size(), 3U);
  EXPECT_TRUE(cloud.origin == Vec3d{});
  EXPECT_EQ(cloud.intensities, (std::vector<float>{4, 5, 6}));
  EXPECT_EQ(report.dropped_far, 2U);
  EXPECT_EQ(report.dropped_not_finite, 0U);
}

TEST(LoadCloud, DistancesCountFromTheMedian) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.xyz", "3 4 5\n1 2 3\n2 3 4\n");
  LoadOptions options = any_share();
  options.max_distance_m = 1.74;  // the median is (2, 3, 4), the others are sqrt(3) away
  EXPECT_EQ(load({file}, options).first.size(), 3U);
  options.max_distance_m = 1.73;
  EXPECT_EQ(load({file}, options).first.size(), 1U);
}

TEST(LoadCloud, CoordinatesThatNoPlaceHasAreFar) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.xyz", "1e300 0 0\n-1e308 0 0\n1e308 1e308 1e308\n");
  LoadOptions options = any_share();
  options.max_distance_m = std::numeric_limits<double>::infinity();
  const auto [cloud, report] = load({file}, options);
  EXPECT_TRUE(cloud.empty());
  EXPECT_EQ(report.dropped_far, 3U);
}

TEST(LoadCloud, ColumnsOfFiles) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv",
                                 "x,y,z,Reflectance,class,instance,sensor_x,sensor_y,sensor_z\n"
                                 "1,2,3,0.5,40,3,10,20,30\n4,5,6,0.75,65535,0,11,21,31\n");
  const PointCloud cloud = load({file}).first;
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.intensities, (std::vector<float>{0.5F, 0.75F}));
  EXPECT_EQ(cloud.classes, (std::vector<std::uint16_t>{40, 65535}));
  EXPECT_EQ(cloud.instances, (std::vector<std::uint16_t>{3, 0}));
  EXPECT_TRUE((cloud.sensor_positions[1] == Vec3f{11, 21, 31}));
  EXPECT_TRUE(cloud.scan_indices.empty());
}

TEST(LoadCloud, MisspeltColumnsAreWarnedAbout) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv", "x,y,z,intensty,other\n1,2,3,4,5\n");
  RecordedProgress listener;
  EXPECT_TRUE(load_cloud(std::span(&file, 1), {}, Executor(1), listener).first.intensities.empty());
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_NE(listener.warnings[0].find("a.csv: column 'intensty' is not read, did you mean "
                                      "'intensity'?"),
            std::string::npos);
}

TEST(LoadCloud, NamedColumns) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv", "x,y,z,label,kind,px,py,pz\n1,2,3,40,9,7,8,9\n");
  LoadOptions options;
  options.label_field = "kind";
  options.sensor_x_field = "px";
  options.sensor_y_field = "py";
  options.sensor_z_field = "pz";
  const PointCloud cloud = load({file}, options).first;
  EXPECT_EQ(cloud.classes.at(0), 9);
  EXPECT_TRUE((cloud.sensor_positions.at(0) == Vec3f{7, 8, 9}));
  options.label_field = "kint";
  expect_error(ErrorKind::usage, {"a.csv", "'kint'", "'kind'", "x, y, z, label, kind, px, py, pz"},
               [&] { load({file}, options); });
  options.label_field.clear();
  options.sensor_z_field = "absent_field";
  expect_error(ErrorKind::usage, {"'absent_field'"}, [&] { load({file}, options); });
  options.sensor_z_field.clear();
  expect_error(ErrorKind::usage, {"three"}, [&] { load({file}, options); });
}

TEST(LoadCloud, PackedLabelsAreSplit) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv", "x,y,z,label\n0,0,0,196648\n0,0,1,4294967295\n0,0,2,0\n");
  const PointCloud cloud = load({file}).first;
  EXPECT_EQ(cloud.classes, (std::vector<std::uint16_t>{40, 65535, 0}));
  EXPECT_EQ(cloud.instances, (std::vector<std::uint16_t>{3, 65535, 0}));
}

// LAS's own field holds 8 bits; what our scans have beside it holds all.
TEST(LoadCloud, ClassesAbove255ComeBackFromLas) {
  const TemporaryFolder folder;
  const std::vector<float> xyz = {1, 2, 3};
  const std::vector<std::uint8_t> cut = {0};
  const std::vector<std::uint16_t> label = {259};
  const ColumnView columns[] = {{"x", ColumnType::f32, &xyz[0], 4},
                                {"y", ColumnType::f32, &xyz[1], 4},
                                {"z", ColumnType::f32, &xyz[2], 4},
                                {"classification", ColumnType::u8, cut.data(), 1},
                                {"label", ColumnType::u16, label.data(), 2}};
  const auto file = folder.path() / "a.las";
  write_las(file, 1, columns);
  EXPECT_EQ(load({file}).first.classes, std::vector<std::uint16_t>{259});
}

TEST(LoadCloud, LabelsThatAreNoClassesAreErrors) {
  const TemporaryFolder folder;
  for (const std::string value : {"1.5", "-1", "4294967296", "nan", "inf", "1e300"}) {
    const auto file = folder.write("a.csv", "x,y,z,label\n1,2,3,7\n1,2,3," + value + "\n");
    expect_error(ErrorKind::data, {"a.csv", "'label'", "point 1 "}, [&] { load({file}); });
  }
}

TEST(LoadCloud, FileWithoutPositions) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv", "x,y,height\n1,2,3\n");
  expect_error(ErrorKind::data, {"a.csv", "x, y, height"}, [&] { load({file}); });
}

TEST(LoadCloud, ViewpointAndTrajectoryFillSensorPositions) {
  const TemporaryFolder folder;
  const auto bare = folder.write("bare.xyz", "0.9 0 0\n9 5 0\n");
  const auto own = folder.write("own.csv", "x,y,z,sensor_x,sensor_y,sensor_z\n1,2,3,7,8,9\n");
  LoadOptions options;
  options.viewpoint = Vec3d{1, 2, 30};
  const PointCloud seen = load({bare, own}, options).first;
  EXPECT_TRUE((seen.sensor_positions.at(1) == Vec3f{1, 2, 30}));
  EXPECT_TRUE((seen.sensor_positions.at(2) == Vec3f{7, 8, 9}));
  options.trajectory =
      folder.write("t.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,2,1,0,0,0\n1,10,0,3,1,0,0,0\n");
  expect_error(ErrorKind::usage, {"viewpoint", "trajectory"}, [&] { load({bare}, options); });
  options.viewpoint.reset();
  const PointCloud driven = load({bare}, options).first;
  EXPECT_TRUE((driven.sensor_positions.at(0) == Vec3f{0, 0, 2}));
  EXPECT_TRUE((driven.sensor_positions.at(1) == Vec3f{10, 0, 3}));
}

TEST(LoadCloud, AttributesThatSomeInputsLackAreLostWithAWarning) {
  const TemporaryFolder folder;
  write_sequence(folder, 2, 0, "s/");
  const auto bare = folder.write("bare.xyz", "1 2 3\n");
  const auto none = folder.write("none.bin", std::vector<float>{kNaN, 0, 0, 0});
  RecordedProgress listener;
  const std::filesystem::path inputs[] = {folder.path() / "s", bare, none};
  LoadOptions options;
  options.max_dropped = 1;
  const PointCloud cloud = load_cloud(inputs, options, Executor(1), listener).first;
  EXPECT_EQ(cloud.size(), 4U);
  EXPECT_TRUE(cloud.intensities.empty() && cloud.classes.empty() && cloud.instances.empty() &&
              cloud.scan_indices.empty());
  EXPECT_EQ(listener.warnings.size(), 4U + 1U);  // and a point that is not finite
  // But origins stay: those of the file's point are not known.
  constexpr OriginKind kKnown = OriginKind::measured;
  EXPECT_EQ(cloud.origin_kinds,
            (std::vector<OriginKind>{kKnown, kKnown, kKnown, OriginKind::none}));
  // An input without points has no say.
  listener.warnings.clear();
  const std::filesystem::path others[] = {folder.path() / "s", none};
  EXPECT_FALSE(load_cloud(others, options, Executor(1), listener).first.classes.empty());
  EXPECT_EQ(listener.warnings.size(), 1U);
}

TEST(LoadCloud, FoldersOfFilesByName) {
  const TemporaryFolder folder;
  folder.write("files/b.xyz", "2 0 0\n");
  folder.write("files/a.XYZ", "1 0 0\n");
  folder.write("files/.hidden.xyz", "9 9 9\n");
  folder.write("files/notes.md", "no points\n");
  const PointCloud cloud = load({folder.path() / "files"}).first;
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.positions[0].x, 1.0F);
  folder.write("empty/notes.md", "no points\n");
  expect_error(ErrorKind::no_input, {"empty", "velodyne"},
               [&] { load({folder.path() / "empty"}); });
  expect_error(ErrorKind::no_input, {"absent"}, [&] { load({folder.path() / "absent.ply"}); });
  folder.write("files/c.csv", "x,y,z\n3,0,0\n");
  expect_error(ErrorKind::usage, {"files", "a.XYZ", "c.csv"},
               [&] { load({folder.path() / "files"}); });
}

TEST(LoadCloud, OptionsThatFitNothing) {
  const TemporaryFolder folder;
  write_sequence(folder, 1);
  const std::vector<std::filesystem::path> sequence = {folder.path()};
  const std::vector<std::filesystem::path> file = {folder.write("a.xyz", "1 2 3\n")};
  const auto reject = [](const std::vector<std::filesystem::path>& inputs, auto&& change) {
    LoadOptions options;
    change(options);
    expect_error(ErrorKind::usage, {}, [&] { load(inputs, options); });
  };
  reject({}, [](LoadOptions&) {});
  reject(file, [](LoadOptions& o) { o.first_scan = 1; });
  reject(file, [](LoadOptions& o) { o.scan_stride = 2; });
  reject(sequence, [](LoadOptions& o) { o.scan_stride = 0; });
  reject(sequence, [](LoadOptions& o) { o.scan_count = 0; });
  reject(sequence, [](LoadOptions& o) { o.label_field = "label"; });
  reject(sequence, [](LoadOptions& o) { o.viewpoint = Vec3d{}; });
  reject(file, [](LoadOptions& o) { o.viewpoint = Vec3d{NAN, 0, 0}; });
  reject(file, [](LoadOptions& o) { o.max_distance_m = NAN; });
}

/// Cancels at the first step forward.
class Canceller : public ProgressSink {
  void advance(std::uint64_t) override { throw std::runtime_error("cancelled"); }
};

TEST(LoadCloud, CanBeCancelled) {
  const TemporaryFolder folder;
  write_sequence(folder, 3);
  Canceller canceller;
  const std::filesystem::path inputs[] = {folder.path()};
  EXPECT_THROW(load_cloud(inputs, {}, Executor(2), canceller), std::runtime_error);
}

TEST(SaveCloud, RoundTrip) {
  const TemporaryFolder folder;
  for (const double x0_m : {0.0, 448262.125}) {
    write_sequence(folder, 3, x0_m);
    const PointCloud cloud = load({folder.path()}).first;
    const auto file = folder.path() / "cloud.ply";
    save_cloud_ply(file, cloud);
    expect_same(load({file}).first, cloud);
  }
}

// Oracle: the cloud, to the half millimetre that LAS rounds by.
TEST(SaveCloud, LasAndLazHoldTheCloud) {
  const TemporaryFolder folder;
  write_sequence(folder, 3, 448262.125);
  PointCloud cloud = load({folder.path()}).first;
  cloud.crs = crs_of_wkt("LOCAL_CS[\"here\"]");
  const auto las = folder.path() / "a.las", laz = folder.path() / "a.laz";
  save_cloud_las(las, cloud);
  save_cloud_las(laz, cloud);
  const PointCloud found = load({laz}).first;
  expect_same(load({las}).first, found);
  ASSERT_EQ(found.size(), cloud.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_LT(length(found.world(i) - cloud.world(i)), 0.001);
  EXPECT_EQ(found.classes, cloud.classes);
  EXPECT_EQ(found.scan_indices, cloud.scan_indices);
  EXPECT_EQ(found.sensor_positions.size(), cloud.sensor_positions.size());
  EXPECT_EQ(found.crs, cloud.crs);
  EXPECT_NE(read_file(laz).find("laszip encoded"), std::string::npos);
  save_cloud_las(folder.path() / "empty.laz", {});
  EXPECT_TRUE(load({folder.path() / "empty.laz"}).first.empty());
  PointCloud bare;
  bare.positions = {{1, 2, 3}};
  save_cloud_las(folder.path() / "bare.laz", bare);
  EXPECT_EQ(load({folder.path() / "bare.laz"}).first.positions.size(), 1U);
}

TEST(SaveCloud, EmptyAndBareClouds) {
  const TemporaryFolder folder;
  save_cloud_ply(folder.path() / "empty.ply", {});
  EXPECT_TRUE(load({folder.path() / "empty.ply"}).first.empty());
  PointCloud bare;
  bare.positions = {{1, 2, 3}};
  save_cloud_ply(folder.path() / "bare.ply", bare);
  expect_same(load({folder.path() / "bare.ply"}).first, bare);
}

TEST(LoadCloud, RealStreetFile) {
  const auto file = recording("lille-street-small.ply");
  if (!file) GTEST_SKIP() << kNoRecordings;
  const auto [cloud, report] = load({*file});
  EXPECT_EQ(cloud.size(), 170610U);  // its header says so
  EXPECT_EQ(report.points_read, 170610U);
  EXPECT_TRUE(cloud.classes.empty());
}

LoadOptions all_columns() {
  LoadOptions options;
  options.other_columns = KeptColumns::all;
  return options;
}

const Column& other(const PointCloud& cloud, const std::string& name) {
  for (const Column& column : cloud.others.columns)
    if (column.name == name) return column;
  throw std::logic_error("no column " + name);
}

// Oracle: the values that were written, after a second way through LAS, LAZ and PLY.
TEST(OtherColumns, GoThroughFiles) {
  const TemporaryFolder folder;
  const std::vector<double> x = {500000.5, 500001.25, 500002}, time = {1.5, 2.5, 1e8};
  const std::vector<std::uint16_t> red = {256, 512, 65280}, source = {7, 8, 9};
  const std::vector<std::uint8_t> number = {1, 2, 0}, returns = {2, 2, 0}, user = {3, 0, 255},
                                  overlap = {0, 1, 0};
  const std::vector<std::int16_t> angle = {-1000, 0, 500};
  const std::vector<std::uint64_t> big = {1, 2, std::uint64_t{1} << 40};
  const ColumnView columns[] = {{"x", ColumnType::f64, x.data(), 8},
                                {"y", ColumnType::f64, x.data(), 8},
                                {"z", ColumnType::f64, time.data(), 8},
                                {"gps_time", ColumnType::f64, time.data(), 8},
                                {"red", ColumnType::u16, red.data(), 2},
                                {"green", ColumnType::u16, red.data(), 2},
                                {"blue", ColumnType::u16, red.data(), 2},
                                {"point_source_id", ColumnType::u16, source.data(), 2},
                                {"return_number", ColumnType::u8, number.data(), 1},
                                {"number_of_returns", ColumnType::u8, returns.data(), 1},
                                {"user_data", ColumnType::u8, user.data(), 1},
                                {"overlap", ColumnType::u8, overlap.data(), 1},
                                {"scan_angle", ColumnType::i16, angle.data(), 2},
                                {"echo width", ColumnType::u64, big.data(), 8}};
  const auto first = folder.path() / "a.las";
  LasWriteOptions writing;
  writing.offset_m = {500000, 500000, 0};
  writing.has_adjusted_times = true;
  write_las(first, 2, columns, writing);
  PointCloud cloud = load({first}, all_columns()).first;
  cloud.label_scheme = "asprs";
  cloud.intensities = {0.25F, 0.5F};
  cloud.classes = {2, 300};
  for (const char* const name : {"b.las", "b.laz", "b.ply"}) {
    SCOPED_TRACE(name);
    const auto path = folder.path() / name;
    (path.extension() == ".ply" ? save_cloud_ply : save_cloud_las)(path, cloud, {});
    const PointCloud again = load({path}, all_columns()).first;
    for (const char* const column : {"gps_time", "point_source_id", "return_number",
                                     "number_of_returns", "user_data", "overlap"})
      for (std::size_t i = 0; i < 2; ++i)
        EXPECT_EQ(other(again, column).as_double(i), other(cloud, column).as_double(i)) << column;
    EXPECT_NEAR(other(again, "scan_angle").as_double(0), -6, 1e-4);
    EXPECT_EQ(file_colors(again), file_colors(cloud));
    EXPECT_EQ(file_colors(again)[1], (std::array<std::uint8_t, 3>{2, 2, 2}));
    const bool is_ply = path.extension() == ".ply";
    EXPECT_EQ(other(again, is_ply ? "echo_width" : "echo width").as_double(1), 2);
    EXPECT_EQ(again.others.has_adjusted_times, !is_ply);
    EXPECT_EQ(again.others.columns.size(), cloud.others.columns.size());
    EXPECT_EQ(again.intensities, cloud.intensities);
    if (!is_ply) {
      EXPECT_EQ(read_las_facts(path).labels, "asprs");
    }
    // Only on request.
    EXPECT_TRUE(load({path}).first.others.columns.empty());
  }
}

TEST(OtherColumns, OfSeveralInputs) {
  const TemporaryFolder folder;
  const auto a = folder.write("a.csv", "x,y,z,rgb,echo\n1,2,3,255,5\nnan,1,1,7,6\n4,5,6,65536,7\n");
  const auto b = folder.write("b.csv", "x,y,z,R,G,B\n1,2,9,1,2,3\n");
  RecordedProgress listener;
  const std::vector<std::filesystem::path> both = {a, b};
  LoadOptions options = all_columns();
  options.max_dropped = 1;
  const PointCloud cloud = load_cloud(both, options, Executor(2), listener).first;
  EXPECT_EQ(file_colors(cloud),
            (std::vector<std::array<std::uint8_t, 3>>{{0, 0, 255}, {1, 0, 0}, {1, 2, 3}}));
  EXPECT_EQ(cloud.others.columns.size(), 3U);
  const auto lists_echo = [](const std::string& warning) {
    return warning.ends_with("dropped: echo");
  };
  EXPECT_EQ(std::ranges::count_if(listener.warnings, lists_echo), 1);
  options.other_columns = KeptColumns::colors;
  EXPECT_EQ(load({a}, options).first.others.columns.size(), 3U);
}

TEST(LoadCloud, OneFrameOfKittisObjectBenchmarkFromItsSensor) {
  const TemporaryFolder folder;
  std::vector<float> points;
  for (int k = 0; k < 400; ++k) {
    const float turn = 0.0157F * static_cast<float>(k);
    points.insert(points.end(), {9 * std::cos(turn), 9 * std::sin(turn), -1.7F, 0.5F});
  }
  for (const char* name : {"000000", "000001"}) {
    folder.write("training/velodyne/" + std::string(name) + ".bin", points);
    folder.write("training/calib/" + std::string(name) + ".txt", "P0: 1 0 0 0\n");
  }
  // Frames are independent, so they are no drive.
  const auto frame = folder.path() / "training/velodyne/000000.bin";
  expect_error(ErrorKind::no_input, {"`viewpoint` 0,0,0", frame.string()},
               [&] { load({folder.path() / "training"}); });
  LoadOptions options;
  options.viewpoint = Vec3d{0, 0, 0};
  const auto [cloud, report] = load({frame}, options);
  ASSERT_EQ(cloud.size(), 400U);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_EQ(cloud.origin_kind(i), OriginKind::stated);
    EXPECT_LT(length(cloud.origin + vec_cast<double>(cloud.sensor_positions[i])), 1e-5);
  }
}

// RIEGL's reflectances are in decibels.
TEST(LoadCloud, DecibelsAreNoIntensities) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv", "x,y,z,Reflectance\n1,2,3,-12.5\n4,5,6,0.75\n");
  RecordedProgress listener;
  const PointCloud cloud =
      load_cloud(std::span(&file, 1), all_columns(), Executor(1), listener).first;
  EXPECT_TRUE(cloud.intensities.empty());
  EXPECT_EQ(other(cloud, "reflectance").as_double(0), -12.5);
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_NE(listener.warnings[0].find("'reflectance' has values of -12.5 to 0.75"),
            std::string::npos)
      << listener.warnings[0];
  const auto both =
      folder.write("b.csv", "x,y,z,Reflectance,Amplitude\n1,2,3,-12.5,20\n4,5,6,0.75,30\n");
  const PointCloud amplitudes = load({both}, all_columns()).first;
  EXPECT_EQ(amplitudes.intensities, (std::vector<float>{20, 30}));
  EXPECT_EQ(amplitudes.others.columns.size(), 2U);  // both keep their names
}

// Oracle: table 7 of the LAS specification: intensity is 0 when not included.
TEST(LoadCloud, LasWithoutIntensitiesHasUnknownOnes) {
  const TemporaryFolder folder;
  const std::vector<double> x = {1, 2};
  const auto las = [&](const char* name, std::vector<std::uint16_t> values) {
    const ColumnView columns[] = {{"x", ColumnType::f64, x.data(), 8},
                                  {"y", ColumnType::f64, x.data(), 8},
                                  {"z", ColumnType::f64, x.data(), 8},
                                  {"intensity", ColumnType::u16, values.data(), 2}};
    write_las(folder.path() / name, 2, columns, {});
    return folder.path() / name;
  };
  const std::vector<std::filesystem::path> both = {las("a.las", {0, 0}), las("b.laz", {0, 9})};
  RecordedProgress listener;
  const PointCloud cloud = load_cloud(both, {}, Executor(1), listener).first;
  ASSERT_EQ(cloud.intensities.size(), 4U);
  EXPECT_EQ(std::ranges::count_if(cloud.intensities, [](float v) { return std::isnan(v); }), 2);
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_NE(listener.warnings[0].find("a.las: the intensities of all 2 points are 0"),
            std::string::npos)
      << listener.warnings[0];
  RecordedProgress alone;
  EXPECT_TRUE(
      load_cloud(std::span(both).first(1), {}, Executor(1), alone).first.intensities.empty());
  EXPECT_TRUE(alone.warnings.empty());
}

std::string pcd_header(const char* height, const char* viewpoint) {
  return std::string("VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT ") +
         height + "\nVIEWPOINT " + viewpoint + "\nDATA ascii\n";
}

TEST(LoadCloud, ZerosOfAnOrganisedCloudAreMissingReturns) {
  const TemporaryFolder folder;
  const std::string points = "-0 0 0\n1 2 3\n0 0 0\n4 5 6\n";
  const auto grid = folder.write("a.pcd", pcd_header("2", "0 0 0 1 0 0 0") + points);
  const auto [cloud, report] = load({grid});
  EXPECT_EQ(cloud.size(), 2U);
  EXPECT_EQ(report.no_returns, 2U);
  const auto row = folder.write("b.pcd", pcd_header("1", "0 0 0 1 0 0 0") + "0 0 0\n1 2 3\n");
  EXPECT_EQ(load({row}).first.size(), 2U);
  // Others write the grid as a row.
  std::string many = "x y z\n1 2 3\n";
  for (int k = 0; k < 100; ++k) many += "0 0 0\n";
  EXPECT_EQ(load({folder.write("c.xyz", many)}).second.no_returns, 100U);
}

// CloudCompare writes its shift into VIEWPOINT, other programs the pose of the sensor.
TEST(LoadCloud, ViewpointsOfPcdAreNotIgnored) {
  const TemporaryFolder folder;
  const auto load_one = [&](const char* viewpoint, RecordedProgress& listener) {
    const auto file = folder.write("a.pcd", pcd_header("1", viewpoint) + "1 2 3\n4 5 6\n");
    return load_cloud(std::span(&file, 1), {}, Executor(1), listener).first;
  };
  RecordedProgress shifted, posed, none;
  EXPECT_TRUE(load_one("600000 6.339e+06 -0 1 0 0 0", shifted).world(1) ==
              (Vec3d{600004, 6339005, 6}));
  ASSERT_EQ(shifted.warnings.size(), 1U);
  EXPECT_NE(shifted.warnings[0].find("600000, 6339000, 0 m"), std::string::npos)
      << shifted.warnings[0];
  EXPECT_TRUE(load_one("1.5 2 3 1 0 0 0", posed).world(1) == (Vec3d{4, 5, 6}));
  ASSERT_EQ(posed.warnings.size(), 1U);
  EXPECT_NE(posed.warnings[0].find("VIEWPOINT 1.5 2 3 1 0 0 0"), std::string::npos)
      << posed.warnings[0];
  load_one("0 0 0 1 0 0 0", none);
  EXPECT_TRUE(none.warnings.empty());
}

TEST(LoadCloud, SecondsAndNanosecondsAreOneTime) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("a.csv", "timestamp_nanosec,timestamp_sec,x,y,z\n500000000,17,1,2,3\n");
  ProgressSink quiet;
  EXPECT_EQ(read_file_part(file, {}, quiet).times_s, (std::vector<double>{17.5}));
}

// An EPT has thousands of files.
TEST(LoadCloud, FilesShareAWarning) {
  const TemporaryFolder folder;
  std::vector<std::filesystem::path> files;
  for (const char* const name : {"a.csv", "b.csv", "c.csv"})
    files.push_back(folder.write(name, "x,y,z,intensty\n1,2,3,4\n"));
  RecordedProgress listener;
  load_cloud(files, {}, Executor(1), listener);
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_NE(listener.warnings[0].find("a.csv and 2 more files: column 'intensty'"),
            std::string::npos)
      << listener.warnings[0];
}

// Oracle: the values that were written.
TEST(SaveCloud, ColumnsOfOtherProgramsFillTheFieldsOfLas) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv",
                                 "x,y,z,scalar_ReturnNumber,scalar_NumberOfReturns,scalar_GpsTime,"
                                 "ScanAngleRank,PointSourceId\n1,2,3,2,4,575.25,-12,70\n");
  save_cloud_las(folder.path() / "a.las", load({file}, all_columns()).first);
  const Table table = read_las(folder.path() / "a.las", {.all_fields = true});
  const std::pair<const char*, double> values[] = {{"return_number", 2},
                                                   {"number_of_returns", 4},
                                                   {"gps_time", 575.25},
                                                   {"scan_angle", -12},
                                                   {"point_source_id", 70}};
  for (const auto& [name, value] : values)
    EXPECT_NEAR(table.find(name)->as_double(0), value, 1e-4) << name;
  EXPECT_EQ(table.find("scalar_gpstime"), nullptr);
}

}  // namespace
}  // namespace adasplats
