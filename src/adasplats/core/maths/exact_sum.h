// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// Rounds numbers to multiples of so coarse a unit that double adds them without rounding: their
/// sum has the same bits in every order, on any number of lanes or threads. After Demmel and Nguyen
/// 2013, "Fast reproducible floating-point summation" (one bin). The unit is at most 2^-50 of
/// `count` times the largest number: of 40 numbers, 44 bits of the largest are left.
class ExactAddends {
 public:
  /// Of up to `count` numbers, each at most `largest` in size (finite).
  ADASPLATS_HD ExactAddends(std::uint32_t count, double largest) {
    // 2^k, with their sum below 2^(k+1); 0 for 0. With 6 * 2^k added every number lies between
    // 2^(k+2) and 2^(k+3), where double has steps of 2^(k-50); taking it away again is exact.
    constexpr std::uint64_t kExponent = 0x7ff0000000000000U;
    const auto bits = std::bit_cast<std::uint64_t>(static_cast<double>(count) * largest);
    shift_ = 6.0 * std::bit_cast<double>(bits & kExponent);
  }

  ADASPLATS_HD double operator()(double value) const { return (value + shift_) - shift_; }

 private:
  double shift_;
};

}  // namespace adasplats
