// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/synth/city/city_grid.h"

// Private to synth/city/: the path of the vehicle.

namespace adasplats {

inline constexpr double kCityDriveSpeed_m_per_s = 8;

/// A drive in the right lanes of a square of blocks with a size that suits the drive's length. At
/// every crossing it goes straight on or turns, preferring streets with fewer visits, and it drives
/// some streets again. The origin of the vehicle's frame is on the road.
class CityDrive {
 public:
  /// `length_m`: at least 1.
  CityDrive(const CityGrid& grid, double length_m);

  double length_m() const { return length_m_; }
  /// Pose and time after a driven distance; clamped to the ends of the drive.
  TimedPose at(double travelled_m) const;
  /// The same position on the grid's plane: x is u, y is v.
  Vec3d grid_position(double travelled_m) const;

 private:
  struct Sample {
    double u = 0, v = 0;
    double travelled_m = 0;
  };

  Vec3d world_position(double travelled_m) const;
  void append(const CityLand& land, double u, double v);

  CityLand land_;
  double length_m_;
  std::vector<Sample> samples_;
};

}  // namespace adasplats
