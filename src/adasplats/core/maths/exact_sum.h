// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// Rounds numbers to multiples of a unit coarse enough that double adds them without rounding, so
/// that their sum has the same bits in every order, on any number of lanes or threads. After Demmel
/// and Nguyen 2013, "Fast reproducible floating-point summation" (one bin). The unit is at most
/// 2^-50 of `count` times the largest number: of 40 numbers, the largest keeps 44 bits.
class ExactAddends {
 public:
  /// For up to `count` numbers, each of at most `largest` in magnitude (finite).
  ADASPLATS_HD ExactAddends(std::uint32_t count, double largest) {
    // 2^k, with the sum below 2^(k+1); 0 for 0. After adding 6 * 2^k every number is between
    // 2^(k+2) and 2^(k+3), where double has steps of 2^(k-50); subtracting it again is exact.
    constexpr std::uint64_t kExponent = 0x7ff0000000000000U;
    const auto bits = std::bit_cast<std::uint64_t>(static_cast<double>(count) * largest);
    shift_ = 6.0 * std::bit_cast<double>(bits & kExponent);
  }

  ADASPLATS_HD double operator()(double value) const { return (value + shift_) - shift_; }
  /// What rounds a number when it is added and subtracted again.
  ADASPLATS_HD double shift() const { return shift_; }

 private:
  double shift_;
};

}  // namespace adasplats
