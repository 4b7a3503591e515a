// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"

namespace adasplats {

/// A box that drives along x at constant speed, for tests.
struct DrivingBox {
  Vec3d middle;  ///< at time 0
  Vec3d size_m;
  double speed_mps = 0;

  Vec3d at(double time_s) const { return middle + Vec3d{speed_mps * time_s, 0, 0}; }
};

/// Scans in memory; their files are their numbers.
class MemoryReader final : public ScanReader {
 public:
  explicit MemoryReader(std::vector<KittiScan> scans) : scans_(std::move(scans)) {}
  KittiScan read(const std::filesystem::path& file) const override {
    return scans_.at(static_cast<std::size_t>(std::stoi(file.string())));
  }

 private:
  std::vector<KittiScan> scans_;
};

inline double way_to_box(Vec3d from, Vec3d direction, Vec3d middle, Vec3d size_m) {
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (middle[axis] - size_m[axis] / 2 - from[axis]) / direction[axis];
    const double b = (middle[axis] + size_m[axis] / 2 - from[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave && enter > 0 ? enter : std::numeric_limits<double>::infinity();
}

/// A sensor 1.8 m above flat ground that drives along x at 5 m/s between two walls, y = 12 m and
/// y = -12 m, with boxes; 10 scans a second of 40 x 600 beams, snapshots.
inline KittiSequence recorded_street(const std::vector<DrivingBox>& boxes, std::size_t scans) {
  constexpr double kEgo_mps = 5, kHeight_m = 1.8, kWall_m = 12, kReach_m = 70;
  KittiSequence drive;
  std::vector<KittiScan> points(scans);
  for (std::size_t k = 0; k < scans; ++k) {
    const double time_s = 0.1 * static_cast<double>(k);
    const Vec3d sensor = {kEgo_mps * time_s, 0, kHeight_m};
    drive.scans.emplace_back(std::to_string(k));
    drive.trajectory.push_back({time_s, {{}, sensor}});
    for (int row = 0; row < 40; ++row) {
      const double elevation = (3.0 - 0.6 * row + 0.01) * std::numbers::pi / 180;
      for (int column = 0; column < 600; ++column) {
        const double azimuth = (0.6 * column + 0.1) * std::numbers::pi / 180;
        const Vec3d direction = {std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
        double range_m = kWall_m / std::fabs(direction.y);
        if (direction.z < 0) range_m = std::min(range_m, -kHeight_m / direction.z);
        for (const DrivingBox& box : boxes)
          range_m = std::min(range_m, way_to_box(sensor, direction, box.at(time_s), box.size_m));
        if (range_m < kReach_m) points[k].positions.push_back(vec_cast<float>(range_m * direction));
      }
    }
  }
  drive.reader = std::make_shared<MemoryReader>(std::move(points));
  return drive;
}

}  // namespace adasplats
