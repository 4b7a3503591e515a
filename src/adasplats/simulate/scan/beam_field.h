// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/core/maths/random.h"
#include "adasplats/sensors/unit_intensity.h"

namespace adasplats {

// Numbers of one scan's beams that are alike in neighbouring beams, for CPU and GPU: near enough to
// normal, mean 0, variance 1, a function of (seed, scan, ring, column) alone. Each octave is value
// noise: random numbers at every so many columns of each group of so many rings, linear in between
// and made of variance 1 again. What drops out and what shines comes in patches of all sizes; which
// of them matter is fitted (FieldShares).

inline constexpr int kOctaves = static_cast<int>(kFieldOctaves);

/// Columns from one random number of an octave to the next: 3, 12, 48, 192.
ADASPLATS_HD constexpr std::uint32_t octave_columns(int octave) { return 3U << (2 * octave); }
/// Rings that have them in common: 1, 2, 4, 8.
ADASPLATS_HD constexpr std::uint32_t octave_rings(int octave) { return 1U << octave; }

/// What a field is for; fields of one beam do not depend on each other.
enum class BeamField : int { drop = 0, zero = 1, texture = 2, unevenness = 3 };
inline constexpr int kBeamFields = 4;

/// All parts of all fields of one beam; the last of each field is the white one.
struct BeamFieldParts {
  double of[kBeamFields][kOctaves + 1];
};

/// Square roots of FieldShares and of what they leave.
struct FieldWeights {
  double of[kOctaves + 1] = {};
};

inline FieldWeights field_weights(const FieldShares& shares) {
  FieldWeights weights;
  double left = 1;
  for (std::size_t k = 0; k < kFieldOctaves; ++k) {
    weights.of[k] = std::sqrt(shares[k]);
    left -= shares[k];
  }
  weights.of[kOctaves] = std::sqrt(left > 0 ? left : 0.0);
  return weights;
}

/// One of four numbers in 64 bits: the sum of two uniforms, variance 1.
ADASPLATS_HD inline double field_number(std::uint64_t bits, int which) {
  constexpr double kPerStep = 2.449489742783178 / 256.0;  // a sum of two has variance 1 / 6
  const auto pair = static_cast<std::uint32_t>(bits >> (16 * which)) & 0xffffU;
  return (static_cast<double>((pair & 0xffU) + (pair >> 8)) - 255.0) * kPerStep;
}

ADASPLATS_HD inline BeamFieldParts beam_field_parts(std::uint64_t seed, std::uint64_t scan_index,
                                                    std::uint32_t ring, std::uint32_t column) {
  const std::uint64_t base =
      Random::mix(Random::mix(seed ^ 0x6669656c64733a29ULL) + scan_index * 0x9e3779b97f4a7c15ULL);
  const auto bits_at = [&](int octave, std::uint32_t row, std::uint32_t node) {
    const std::uint64_t key =
        static_cast<std::uint64_t>(octave) << 60 | static_cast<std::uint64_t>(row) << 32 | node;
    return Random::mix(base ^ key * 0xd1342543de82ef95ULL);
  };
  BeamFieldParts parts;  // NOLINT: filled below
  for (int k = 0; k < kOctaves; ++k) {
    // Groups begin at another ring in each scan.
    const std::uint32_t shift = static_cast<std::uint32_t>(base >> (8 * k)) % octave_rings(k);
    const std::uint32_t row = (ring + shift) / octave_rings(k);
    const std::uint32_t node = column / octave_columns(k);
    const double share = static_cast<double>(column % octave_columns(k)) / octave_columns(k);
    const double scale = 1 / std::sqrt(share * share + (1 - share) * (1 - share));
    const std::uint64_t here = bits_at(k, row, node), next = bits_at(k, row, node + 1);
    for (int field = 0; field < kBeamFields; ++field)
      parts.of[field][k] =
          scale * ((1 - share) * field_number(here, field) + share * field_number(next, field));
  }
  const std::uint64_t white = bits_at(kOctaves, ring, column);
  for (int field = 0; field < kBeamFields; ++field)
    parts.of[field][kOctaves] = field_number(white, field);
  return parts;
}

ADASPLATS_HD inline double field_value(const BeamFieldParts& parts, BeamField field,
                                       const FieldWeights& weights) {
  const double* const of = parts.of[static_cast<int>(field)];
  double sum = 0;
  for (int k = 0; k <= kOctaves; ++k) sum += weights.of[k] * of[k];
  return sum;
}

/// The texture field: its white part has an amplitude of its own in each patch of 12 to 48 columns,
/// log-normal, mean square 1, and `amplitude` everywhere.
ADASPLATS_HD inline double texture_value(const BeamFieldParts& parts, const FieldWeights& weights,
                                         double unevenness, double amplitude) {
  const double* const of = parts.of[static_cast<int>(BeamField::texture)];
  double sum = 0;
  for (int k = 0; k < kOctaves; ++k) sum += weights.of[k] * of[k];
  const double* const spread = parts.of[static_cast<int>(BeamField::unevenness)];
  const double log_amplitude = 0.7071067811865476 * (spread[1] + spread[2]);
  return sum + amplitude * weights.of[kOctaves] * of[kOctaves] *
                   exp_of(unevenness * log_amplitude - unevenness * unevenness);
}

}  // namespace adasplats
