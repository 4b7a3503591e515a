// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/sensor_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Points of four rings at elevations of -15 to 0 degrees, moved by `shift`.
struct Rings {
  std::vector<Vec3d> positions;
  std::vector<float> ranges;
  std::vector<std::uint16_t> rings;

  explicit Rings(Vec3d shift) {
    for (int i = 0; i < 400; ++i) {
      const double range = 6 + i % 37, azimuth = 0.1 * i, elevation = -0.0873 * (i % 4);
      rings.push_back(static_cast<std::uint16_t>(i % 4));
      ranges.push_back(static_cast<float>(range));
      positions.push_back(shift + Vec3d{range * std::cos(elevation) * std::cos(azimuth),
                                        range * std::cos(elevation) * std::sin(azimuth),
                                        range * std::sin(elevation)});
    }
  }
};

Table table_of(const char* name, Column::Values values) {
  Table table;
  table.rows = 400;
  table.columns.push_back({name, std::move(values)});
  return table;
}

TEST(SensorFrame, RangesAndRingsAroundTheOriginShowAScan) {
  const Rings scan({}), world({30, 20, 1.7});
  for (const bool by_range : {true, false}) {
    const Table table = by_range ? table_of("range", scan.ranges) : table_of("ring", scan.rings);
    EXPECT_TRUE(sensor_frame_of("a.ply", table, scan.positions)) << by_range;
    EXPECT_FALSE(sensor_frame_of("a.ply", table, world.positions)) << by_range;
  }
}

TEST(SensorFrame, PcdStatesItsPose) {
  const Rings scan({});
  Table table = table_of("range", scan.ranges);
  table.comments = {"VIEWPOINT 0 0 0 1 0 0 0"};
  EXPECT_FALSE(sensor_frame_of("a.pcd", table, scan.positions)->has_pose);
  table.comments = {"VIEWPOINT 10 5 1.7 1 0 0 0"};
  EXPECT_TRUE(sensor_frame_of("a.pcd", table, scan.positions)->has_pose);
}

TEST(SensorFrame, BinFilesAreScans) {
  const Rings scan({}), world({300, 20, 1.7});
  EXPECT_TRUE(sensor_frame_of("000000.bin", Table(), scan.positions));
  EXPECT_FALSE(sensor_frame_of("000000.bin", Table(), world.positions));
  EXPECT_FALSE(sensor_frame_of("000000.ply", Table(), scan.positions));
}

/// Where a ray from `from` meets a hall of 60 x 40 x 8 m around the origin, 1.7 m above its floor.
Vec3d hit_of_hall(Vec3d from, Vec3d direction) {
  const Vec3d low{-30, -20, -1.7}, high{30, 20, 6.3};
  double nearest = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const double wall = direction[axis] > 0 ? high[axis] : low[axis];
    nearest = std::min(nearest, (wall - from[axis]) / direction[axis]);
  }
  return from + nearest * direction;
}

/// A scan of 16 rings, 2 degrees apart, with motion compensation: the sensor drives `drive_m` along
/// x and is at `at` in the middle.
std::vector<Vec3d> hall_scan(Vec3d at, double drive_m) {
  constexpr int kColumns = 720, kRings = 16;
  std::vector<Vec3d> points;
  for (int column = 0; column < kColumns; ++column) {
    const double turn = static_cast<double>(column) / kColumns;
    for (int ring = 0; ring < kRings; ++ring) {
      const double azimuth = 360 * kDegree * turn, elevation = (2 * ring - 15) * kDegree;
      const Vec3d direction{std::cos(elevation) * std::cos(azimuth),
                            std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      points.push_back(hit_of_hall(at + Vec3d{(turn - 0.5) * drive_m, 0, 0}, direction));
    }
  }
  return points;
}

TEST(SensorFrame, PointsOnRingsAroundTheOriginAreAScan) {
  const Executor executor(1);
  for (const double drive_m : {0.0, 2.0}) {
    const auto frame = scan_pattern_of(hall_scan({}, drive_m), executor);
    ASSERT_TRUE(frame) << drive_m;
    EXPECT_TRUE(frame->by_points);
  }
}

TEST(SensorFrame, OtherPointsAroundTheOriginAreNoScan) {
  const Executor executor(1);
  EXPECT_FALSE(scan_pattern_of(hall_scan({12, 9, 0}, 0), executor)) << "one scan, in the world";
  std::vector<Vec3d> drive;
  for (int scan = 0; scan < 8; ++scan)
    for (const Vec3d p : hall_scan({1.3 * scan, 0.1 * scan, 0.01 * scan}, 0)) drive.push_back(p);
  EXPECT_FALSE(scan_pattern_of(drive, executor)) << "scans joined";
  std::vector<Vec3d> ball;
  for (int row = -10; row <= 10; ++row)
    for (int column = 0; column < 360; ++column) {
      const double azimuth = column * kDegree, elevation = 5 * row * kDegree;
      ball.push_back(5.0 * Vec3d{std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation)});
    }
  EXPECT_FALSE(scan_pattern_of(ball, executor)) << "a ball, points on circles of latitude";
}

std::string text_of(const std::vector<Vec3d>& points) {
  std::string text = "x y z intensity\n";
  for (const Vec3d p : points) {
    std::array<char, 128> line{};
    std::snprintf(line.data(), line.size(), "%.3f %.3f %.3f 0.5\n", p.x, p.y, p.z);
    text += line.data();
  }
  return text;
}

TEST(SensorFrame, LoadingReportsScansWithoutColumns) {
  class Warnings : public ProgressSink {
   public:
    void warn(std::string_view message) override { text += message; }
    std::string text;
  } warnings;
  const TemporaryFolder folder;
  const Executor executor(1);
  const fs::path scan = folder.write("scan.txt", text_of(hall_scan({}, 0)));
  const fs::path next = folder.write("next.txt", text_of(hall_scan({12, 9, 0}, 0)));
  const auto load = [&](std::vector<fs::path> files, LoadOptions options = {}) {
    warnings.text.clear();
    return load_cloud(files, options, executor, warnings).second.sensor_frames.size();
  };
  EXPECT_EQ(load({scan}), 1U);
  EXPECT_NE(warnings.text.find("is one scan in the sensor frame"), std::string::npos);
  EXPECT_NE(warnings.text.find("'adasplats export"), std::string::npos) << warnings.text;
  expect_error(ErrorKind::data, {"2 of its files are scans in the sensor frame", "`viewpoint`"},
               [&] {
                 load({scan, scan});
               });
  EXPECT_EQ(load({scan, next}), 0U) << "world points may begin near the origin";
  LoadOptions stated;
  stated.viewpoint = Vec3d{};
  EXPECT_EQ(load({scan}, stated), 0U);
}

}  // namespace
}  // namespace adasplats
