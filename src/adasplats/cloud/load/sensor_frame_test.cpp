// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/sensor_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace adasplats {
namespace {

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

}  // namespace
}  // namespace adasplats
