// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// e to the power of x, for x <= 0, to two units in the last place, with the same bits on CPU and
/// GPU (libraries' differ): 2^k times a polynomial of what is left (Cephes, expf; Moshier 1989).
/// Below -87, where results are no normal floats: 0. NaN stays NaN.
ADASPLATS_HD inline float exp_of_negative(float x) {
  if (!(x >= -87.0F)) return x < 0 ? 0.0F : x;
  constexpr float kLog2E = 1.44269504F;
  constexpr float kLn2High = 0.693359375F, kLn2Low = -2.12194440e-4F;  // high: few bits, exact
  const float k = std::floor(x * kLog2E + 0.5F);
  const float r = (x - k * kLn2High) - k * kLn2Low;
  float sum = 1.9875691500e-4F;
  sum = sum * r + 1.3981999507e-3F;
  sum = sum * r + 8.3334519073e-3F;
  sum = sum * r + 4.1665795894e-2F;
  sum = sum * r + 1.6666665459e-1F;
  sum = sum * r + 5.0000001201e-1F;
  sum = sum * (r * r) + r + 1;
  const auto exponent = static_cast<std::uint32_t>(static_cast<int>(k) + 127);
  return sum * std::bit_cast<float>(exponent << 23);
}

}  // namespace adasplats
