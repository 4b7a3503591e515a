// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/synth/city/city_grid.h"

// Inside synth/city/: where the vehicle drives.

namespace adasplats {

inline constexpr double kCityDriveSpeed_m_per_s = 8;

/// A drive on the right lanes of the streets of a square of blocks, as large as suits its length:
/// at every crossing it goes on or turns, rather into streets that it knows less, and comes through
/// some of them again. The vehicle's frame has its origin on the road.
class CityDrive {
 public:
  /// `length_m` at least 1.
  CityDrive(const CityGrid& grid, double length_m);

  double length_m() const { return length_m_; }
  /// Where the vehicle is after so many metres, and when; before the beginning and after the end,
  /// there.
  TimedPose at(double travelled_m) const;
  /// The same on the grid's plane: x is u, y is v.
  Vec3d grid_place(double travelled_m) const;

 private:
  struct Sample {
    double u = 0, v = 0;
    double travelled_m = 0;
  };

  Vec3d world_place(double travelled_m) const;
  void append(const CityLand& land, double u, double v);

  CityLand land_;
  double length_m_;
  std::vector<Sample> samples_;
};

}  // namespace adasplats
