// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace adasplats {

/// For how many shares of the beams an intensity is told (texture_node()).
inline constexpr std::size_t kTextureNodes = 15;

/// What one unit reports as intensity where a model of the place expects another one: its lasers'
/// gains, beams that return with intensity zero, how intensities scatter on surfaces of one level,
/// and the steps of its converter. Which beams report much and which little, UnitFields say.
/// fit_unit() finds it. All in the unit of the intensities.
struct UnitIntensity {
  double step = 0;     ///< values are multiples of it; 0: any
  double highest = 0;  ///< none is reported above

  /// Expected by the model -> level, ring by ring (topmost 0): `ring_nodes` values of each, linear
  /// between them, ascending.
  std::size_t ring_nodes = 0;
  std::vector<float> ring_expected, ring_level;

  std::vector<float> levels;      ///< ascending, for the two tables below
  std::vector<float> zero_share;  ///< of beams with such a level: that report zero
  /// Of the others, kTextureNodes of each level: what the shares of them that texture_node() has
  /// report at most.
  std::vector<float> reported;
};

}  // namespace adasplats
