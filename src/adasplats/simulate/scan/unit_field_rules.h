// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/sensors/calibrated_sensor.h"

namespace adasplats {

/// SensorFields for CPU and GPU: plain values and a pointer, of the host or of a device.
struct UnitFieldRules {
  const std::uint8_t* bytes = nullptr;  ///< null: there are none
  std::uint32_t turns = 0, rings = 0, columns = 0;
};

/// The numbers of one beam: shares from 0 to 1, and m.
struct BeamFields {
  double drop = 0, intensity = 0, noise_m = 0, zero = 0;
};

/// A whole number below `count` of 32 random bits.
ADASPLATS_HD inline std::uint32_t below(std::uint32_t bits, std::uint32_t count) {
  return static_cast<std::uint32_t>(std::uint64_t{bits} * count >> 32);
}

/// Of return `return_index` of a beam. Every scan has a turn of its own, turned by its own number
/// of columns; later returns have other beams' numbers.
ADASPLATS_HD inline BeamFields beam_fields(const UnitFieldRules& rules, std::uint64_t seed,
                                           std::uint64_t scan_index, std::uint32_t ring,
                                           std::uint32_t column, std::uint32_t return_index) {
  constexpr std::uint32_t kToNextReturn = 977;  // farther than fields are alike
  const std::uint64_t bits =
      Random::mix((seed ^ 0x6669656c64733a29ULL) + scan_index * 0x9e3779b97f4a7c15ULL);
  const std::uint32_t turn = below(static_cast<std::uint32_t>(bits >> 32), rules.turns);
  const std::uint32_t shift = below(static_cast<std::uint32_t>(bits), rules.columns);
  // As `%` does, which takes long and is rarely needed.
  const auto within = [](std::uint32_t value, std::uint32_t count) {
    const std::uint32_t once = value < count ? value : value - count;
    return once < count ? once : once % count;
  };
  const std::uint32_t place = within(column + shift + kToNextReturn * return_index, rules.columns);
  const std::size_t beam =
      (std::size_t{turn} * rules.rings + within(ring, rules.rings)) * rules.columns + place;
  const std::uint8_t* const b = rules.bytes + beam * kSensorFields;
  const auto drop = static_cast<double>(b[0]) + 0.5;
  const auto noise = static_cast<double>(b[2]) - 128;
  const auto zero = static_cast<double>(b[3]) + 0.5;
  constexpr double kPerSquare_m = kMaxFieldNoise_m / (127.0 * 127.0);
  return {drop * drop / 65536.0, (static_cast<double>(b[1]) + 0.5) / 256.0,
          kPerSquare_m * noise * (noise < 0 ? -noise : noise), zero * zero / 65536.0};
}

}  // namespace adasplats
