// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/rigid_transform.h"

// Inside synth/world/: where the road goes, in the plane and up and down. A place of a world is
// (s, d): metres along the axis of the road, and metres to the left of it.

namespace adasplats {

/// How far a kind of place bends and climbs.
struct RouteLimits {
  double min_radius_m = 100;
  double max_climb = 0.03;  ///< slope of the road
};

/// Where the place (s, d) of a road is, with the height of the land there.
using LandPlace = std::function<Vec3d(double s, double d)>;

/// The axis of a road: its heading is a sum of two waves, its height another; or it lies in a land
/// that is given.
class WorldRoute {
 public:
  WorldRoute(double length_m, const RouteLimits& limits, Random random);
  WorldRoute(double length_m, LandPlace place_of);

  double length_m() const { return length_m_; }
  double heading(double s) const;
  /// Of the land at a place: that of the axis there, unless the land is given.
  double land_height(double s, double d) const;
  /// A place without its height.
  Vec3d at(double s, double d) const;

 private:
  struct Wave {
    double amplitude = 0, length_m = 1, phase = 0;
    double at(double s) const;
  };

  double length_m_;
  LandPlace place_of_;  ///< where the land is given, else empty
  std::array<Wave, 2> heading_;
  std::array<Wave, 2> height_;
  std::vector<Vec3d> axis_;  ///< every kStep_m from -kBeyond_m on
};

/// The axis goes on for so long before its beginning and after its end.
inline constexpr double kBeyond_m = 40;

}  // namespace adasplats
