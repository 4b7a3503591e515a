// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "adasplats/core/maths/vec3.h"

// Inside synth/city/: the plane of a city's grid, bent and with hills. A place of it is (u, v): u
// along the streets to the east, v along those to the north, in metres.

namespace adasplats {

/// Bends the straight lines of the grid gently and gives them heights: smooth and without end, so
/// that streets, blocks and pieces meet without seams.
class CityLand {
 public:
  explicit CityLand(std::uint64_t seed);

  /// World coordinates of the land, z its height.
  Vec3d at(double u, double v) const;

 private:
  struct Wave {
    double amplitude = 0, length_m = 1, phase = 0;
    double at(double t) const;
  };
  struct Hill {
    Wave wave;
    double east = 1, north = 0;  ///< the direction in which it rises and falls
  };

  std::array<Wave, 2> shift_east_, shift_north_;  ///< of u by v, of v by u
  std::array<Hill, 3> hills_;
};

/// The grid's lines are bent by no more than this, m.
inline constexpr double kMaxBend_m = 16;

}  // namespace adasplats
