// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace adasplats {

/// Octaves of a field of correlated numbers, and how long the correlation of each is.
inline constexpr std::size_t kFieldOctaves = 4;
/// Shares of a field's variance, an octave each; what they leave of 1 is white. Fine to coarse.
using FieldShares = std::array<double, kFieldOctaves>;

/// For how many values of the texture field an intensity is told (texture_node()).
inline constexpr std::size_t kTextureNodes = 15;

/// What one unit reports as intensity where a model of the place expects another one: its lasers'
/// gains, beams that return with intensity zero, the texture of surfaces that is finer than a
/// model, and the steps of its converter. fit_unit() finds it. All in the unit of the intensities.
struct UnitIntensity {
  double step = 0;     ///< values are multiples of it; 0: any
  double highest = 0;  ///< none is reported above

  /// Expected by the model -> level, ring by ring (topmost 0): `ring_nodes` values of each, linear
  /// between them, ascending.
  std::size_t ring_nodes = 0;
  std::vector<float> ring_expected, ring_level;

  std::vector<float> levels;      ///< ascending, for the two tables below
  std::vector<float> zero_share;  ///< of beams with such a level: that report zero
  std::vector<float> reported;    ///< of the others, kTextureNodes of each level, by texture field

  FieldShares zero_field = {};     ///< decides which beams report zero
  FieldShares texture_field = {};  ///< decides what the others report
  /// How unevenly the white part of the texture is spread: standard deviation of the logarithm of
  /// its amplitude. 0: everywhere the same.
  double texture_unevenness = 0;
  /// Amplitude of the white part of each ring, topmost first; empty: 1.
  std::vector<float> ring_texture;
};

}  // namespace adasplats
