// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "adasplats/core/maths/vec3.h"

// Private to synth/city/: the curved, hilly land of a city. Positions on the grid's plane are (u,
// v) in m: u along east streets, v along north streets.

namespace adasplats {

/// Bends the straight lines of the grid gently and gives them heights. Smooth and unbounded, so
/// that streets, blocks and sections join without seams.
class CityLand {
 public:
  explicit CityLand(std::uint64_t seed);

  /// World coordinates of a grid position; z is the height of the land.
  Vec3d at(double u, double v) const;

 private:
  struct Wave {
    double amplitude = 0, length_m = 1, phase = 0;
    double at(double t) const;
  };
  struct Hill {
    Wave wave;
    double east = 1, north = 0;  ///< direction of the slope
  };

  std::array<Wave, 2> shift_east_,
      shift_north_;  ///< offset of u as a function of v, and of v as a function of u
  std::array<Hill, 3> hills_;
};

/// Maximum shift of the grid's lines, m.
inline constexpr double kMaxBend_m = 16;

}  // namespace adasplats
