// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/elementary.h"

namespace adasplats {

/// Counter-based random numbers: a value depends only on (seed, stream, index, counter), so results
/// do not depend on threads or device. Each draw is a 64-bit mix
/// (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators", finaliser of
/// Stafford's variant 13) of a key built the same way.
class Random {
 public:
  ADASPLATS_HD constexpr Random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index)
      : state_(mix(mix(mix(seed + kGolden) ^ (stream + kGolden)) ^ (index + kGolden))) {}

  ADASPLATS_HD constexpr std::uint64_t next_bits() {
    state_ += kGolden;
    return mix(state_);
  }
  /// Uniform in [0, 1) with 53 bits.
  ADASPLATS_HD constexpr double uniform() {
    return static_cast<double>(next_bits() >> 11) * 0x1.0p-53;
  }
  ADASPLATS_HD constexpr double uniform(double low, double high) {
    return low + (high - low) * uniform();
  }
  /// Standard normal (Box-Muller; two uniforms a draw, the second normal is dropped).
  ADASPLATS_HD double normal() {
    const double u = 1.0 - uniform();  // in (0, 1]: the logarithm is finite
    const double v = uniform();
    return std::sqrt(-2.0 * log_of(u)) * cos_of_turns(v);
  }

  ADASPLATS_HD static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

 private:
  static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
  std::uint64_t state_;
};

}  // namespace adasplats
