// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <numbers>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/rigid_transform.h"

// Private to synth/: the course of the road, in plan and height. Positions in a world are (s, d):
// metres along the axis of the road, and metres to its left.

namespace adasplats {

inline constexpr double kFullTurn = 2 * std::numbers::pi;

/// Limits of the curvature and slope of a kind of world.
struct RouteLimits {
  double min_radius_m = 100;
  double max_climb = 0.03;  ///< slope of the road
};

/// World coordinates of a position (s, d), including the height of the land.
using LandPosition = std::function<Vec3d(double s, double d)>;

/// The axis of a road: its heading is the sum of two waves, its height another wave; or it follows
/// a given land.
class WorldRoute {
 public:
  WorldRoute(double length_m, const RouteLimits& limits, Random random);
  WorldRoute(double length_m, LandPosition land);

  double length_m() const { return length_m_; }
  double heading(double s) const;
  /// Height of the land: that of the axis, unless the land is given.
  double land_height(double s, double d) const;
  /// World coordinates without the height.
  Vec3d at(double s, double d) const;

 private:
  struct Wave {
    double amplitude = 0, length_m = 1, phase = 0;
    double at(double s) const;
  };

  double length_m_;
  LandPosition land_;  ///< the given land, else empty
  std::array<Wave, 2> heading_;
  std::array<Wave, 2> height_;
  std::vector<Vec3d> axis_;  ///< every kStep_m from -kBeyond_m on
};

/// The axis extends this far beyond both ends of the road.
inline constexpr double kBeyond_m = 40;

}  // namespace adasplats
