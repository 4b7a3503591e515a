// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/pandaset_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/driver_order.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/dataset/tree_names.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/pickle/data_frame.h"

namespace adasplats {
namespace {

nlohmann::json json_in(const std::filesystem::path& file) {
  return nlohmann::json::parse(read_file(file));
}

double value(const Table& table, std::string_view name, std::size_t row) {
  const Column* const column = table.find(name);
  return column == nullptr ? std::nan("") : column->as_double(row);
}

// Oracle: by hand. Columns ascend, returns of a firing stay side by side.
TEST(DriverOrder, ColumnByColumn) {
  Scan scan = scan_number(0, 5);
  scan.rings = {0, 0, 1, 1, 1};
  scan.columns = {0, 1, 0, 0, 1};
  using Numbers = std::vector<std::uint32_t>;
  EXPECT_EQ(driver_order(scan, FirstRing::top), (Numbers{0, 2, 3, 1, 4}));
  EXPECT_EQ(driver_order(scan, FirstRing::bottom), (Numbers{2, 3, 0, 4, 1}));
  EXPECT_TRUE(driver_order(Scan(), FirstRing::top).empty());
  scan.columns.clear();
  EXPECT_THROW(driver_order(scan, FirstRing::top), std::logic_error);
}

// Oracle: the scan, by the devkit's formulas: a point less the position, turned back by the
// heading, is right, forward, up of the LiDAR.
TEST(PandaSetWriter, PointsAndPoses) {
  const TemporaryFolder folder;
  const Scan scan = scan_number(1, 130);
  ScanWriterOptions options;
  options.labels = &semantickitti_labels();
  options.drive = {2, [](std::size_t) { return 0.0; }};
  const auto writer = make_scan_writer(folder.path(), ScanFormat::pandaset, options);
  writer->write(0, scan);
  writer->write(1, scan_number(2, 0));
  writer->finish();
  const auto sequence = folder.path() / "001";
  const Table points = read_data_frame(sequence / "lidar/00.pkl.gz");
  const Table classes = read_data_frame(sequence / "annotations/semseg/00.pkl.gz");
  const auto pose = json_in(sequence / "lidar/poses.json")[0];
  const auto& q = pose["heading"];
  const Mat3d turn = rotation_from_quaternion(q["w"], q["x"], q["y"], q["z"]).transposed();
  const Vec3d at = {pose["position"]["x"], pose["position"]["y"], pose["position"]["z"]};
  const auto order = driver_order(scan, FirstRing::top);
  ASSERT_EQ(points.rows, 130U);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint32_t i = order[k];
    const Vec3d world = {value(points, "x", k), value(points, "y", k), value(points, "z", k)};
    // Points are as measured, while the sensor moved by a metre along x.
    const double share = std::min(1.0, 10 * double{scan.times_s[i]});
    const Vec3d seen = turn * (world - Vec3d{share - 0.5, 0, 0} - at),
                p = vec_cast<double>(scan.positions[i]);
    EXPECT_LT(length(seen - Vec3d{-p.y, p.x, p.z}), 1e-6) << k;
    EXPECT_EQ(value(points, "i", k), double{scan.intensities[i]});
    EXPECT_EQ(value(points, "t", k), scan.time_s - 0.05 + double{scan.times_s[i]});
    EXPECT_EQ(value(points, "d", k), 0);
    EXPECT_EQ(value(classes, "class", k), scan.classes[i]);
  }
  EXPECT_EQ(json_in(sequence / "annotations/semseg/classes.json")["40"], "road");
  EXPECT_EQ(read_data_frame(sequence / "annotations/semseg/01.pkl.gz").rows, 0U);
  EXPECT_EQ(json_in(sequence / "lidar/timestamps.json")[0], scan.time_s);
  for (const char* list : {"lidar/poses.json", "meta/gps.json", "meta/timestamps.json"})
    EXPECT_EQ(json_in(sequence / list).size(), 2U) << list;
  EXPECT_FALSE(std::filesystem::exists(sequence / "annotations/cuboids"));
}

// Oracle: a box of 4 x 2 x 1.5 m by hand, ahead to the left, driving north: PandaSet's yaw is from
// the world's y.
TEST(PandaSetWriter, Cuboids) {
  const TemporaryFolder folder;
  Scan scan = scan_number(0, 1);
  scan.world_from_sensor = {};
  scan.positions[0] = {10, 5, 0};
  ScanWriterOptions options;
  options.labels = &semantickitti_labels();
  options.boxes = [](std::size_t, double time_s) {
    const Vec3d at = {10, 5 + 2 * (time_s - 1.0 / 3), 0};
    const Mat3d north = rotation_from_yaw_pitch_roll(std::numbers::pi / 2, 0, 0);
    const Mat3d east;
    return std::vector<ObjectBox>{{10, 7, {north, at}, {4, 2, 1.5}},
                                  {10, 8, {east, {50, 0, 0}}, {4, 2, 1.5}}};
  };
  const auto writer = make_scan_writer(folder.path(), ScanFormat::pandaset, options);
  writer->write(0, scan);
  writer->finish();
  const auto path = folder.path() / "001/annotations/cuboids/00.pkl.gz";
  const Table cuboids = read_data_frame(path);
  ASSERT_EQ(cuboids.rows, 1U);  // nothing of the other one is seen
  EXPECT_NEAR(value(cuboids, "yaw", 0), 0, 1e-12);
  EXPECT_EQ(value(cuboids, "position.x", 0), 10);
  EXPECT_EQ(value(cuboids, "dimensions.x", 0), 2);
  EXPECT_EQ(value(cuboids, "dimensions.y", 0), 4);
  EXPECT_EQ(value(cuboids, "stationary", 0), 0);
  EXPECT_EQ(uuid_of("object 7").size(), 36U);
}

// Names must sort: of 101 scans each has three digits.
TEST(PandaSetWriter, NamesSort) {
  const TemporaryFolder folder;
  ScanWriterOptions options;
  options.drive = {101, [](std::size_t) { return 0.0; }};
  const auto writer = make_scan_writer(folder.path(), ScanFormat::pandaset, options);
  EXPECT_EQ(writer->main_file(7), "001/lidar/007.pkl.gz");
  options.drive.times_s.resize(100);
  EXPECT_EQ(make_scan_writer(folder.path(), ScanFormat::pandaset, options)->main_file(7),
            "001/lidar/07.pkl.gz");
}

}  // namespace
}  // namespace adasplats
