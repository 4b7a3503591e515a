// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace adasplats {

/// What the numbers of a beam in UnitFields are of.
enum class UnitField : std::uint8_t { drop = 0, intensity = 1, noise = 2, zero = 3 };
inline constexpr std::size_t kUnitFields = 4;

/// Some turns of one unit, as it measured them: of each beam where its echo, its intensity and its
/// range lay among all that the model of the place would have allowed. What is alike in
/// neighbouring beams, whatever the reason, is so here, too: patches that are lost, the grain of
/// surfaces, lasers that are noisier than others. fit_unit() finds them; a simulated scan takes one
/// of the turns, turned by some columns (unit_field_rules.h), so it has the texture of measured
/// scans but none of their places.
struct UnitFields {
  std::uint32_t turns = 0, rings = 0, columns = 0;
  /// Of turn t, ring r (topmost 0) and column c: kUnitFields from ((t * rings + r) * columns + c) *
  /// kUnitFields on.
  /// - drop: (b + 0.5)^2 / 2^16 of all echoes as likely to be lost are lost earlier than this
  /// - intensity: (b + 0.5) / 256 of all intensities of such surfaces that are not zero are lower
  /// - noise: (b - 128) |b - 128| / 127^2 of kMaxFieldNoise_m, on the range
  /// - zero: (b + 0.5)^2 / 2^16 of all returns as likely to report zero report it earlier
  std::vector<std::uint8_t> bytes;
};

inline constexpr double kMaxFieldNoise_m = 0.3;

}  // namespace adasplats
