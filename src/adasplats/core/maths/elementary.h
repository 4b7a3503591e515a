// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "adasplats/core/host_device.h"

namespace adasplats {

// Elementary functions with the same bits on CPU and GPU (those of the libraries differ in the last
// bit): only sums and products of polynomials. Errors are a few units in the last place; the tests
// measure them against the standard library.

/// 2^k for k of a normal number, -1022 to 1023.
ADASPLATS_HD inline double power_of_two(int k) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

/// (e^x - 1) / x for |x| <= 0.35 (Taylor).
ADASPLATS_HD inline double exp_series(double x) {
  double sum = 1.0 / 1307674368000.0;
  sum = sum * x + 1.0 / 87178291200.0;
  sum = sum * x + 1.0 / 6227020800.0;
  sum = sum * x + 1.0 / 479001600.0;
  sum = sum * x + 1.0 / 39916800.0;
  sum = sum * x + 1.0 / 3628800.0;
  sum = sum * x + 1.0 / 362880.0;
  sum = sum * x + 1.0 / 40320.0;
  sum = sum * x + 1.0 / 5040.0;
  sum = sum * x + 1.0 / 720.0;
  sum = sum * x + 1.0 / 120.0;
  sum = sum * x + 1.0 / 24.0;
  sum = sum * x + 1.0 / 6.0;
  sum = sum * x + 0.5;
  return sum * x + 1.0;
}

/// e^x. Below -708, where results are subnormal: 0; above 709: infinity. NaN stays NaN.
ADASPLATS_HD inline double exp_of(double x) {
  if (!(x >= -708.0)) return x < 0 ? 0.0 : x;
  if (x > 709.0) return std::numeric_limits<double>::infinity();
  constexpr double kLog2E = 1.4426950408889634;
  // fdlibm, e_exp.c (Sun 1993): the high part has few bits, so that its product with k is exact.
  constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
  const double k = std::floor(x * kLog2E + 0.5);
  const double rest = (x - k * kLn2High) - k * kLn2Low;
  return (1.0 + rest * exp_series(rest)) * power_of_two(static_cast<int>(k));
}

/// e^x - 1, without loss for small x.
ADASPLATS_HD inline double expm1_of(double x) {
  return std::fabs(x) < 0.35 ? x * exp_series(x) : exp_of(x) - 1.0;
}

/// Cumulative distribution of the standard normal at x, within 1e-7 (Abramowitz and Stegun 1964,
/// 26.2.17).
ADASPLATS_HD inline double normal_share(double x) {
  const double size = std::fabs(x);
  const double t = 1.0 / (1.0 + 0.2316419 * size);
  double sum = 1.330274429;
  sum = sum * t - 1.821255978;
  sum = sum * t + 1.781477937;
  sum = sum * t - 0.356563782;
  sum = sum * t + 0.319381530;
  const double above = 0.3989422804014327 * exp_of(-0.5 * size * size) * sum * t;
  return x < 0 ? above : 1.0 - above;
}

/// Natural logarithm of a finite, normal, positive number (not checked).
ADASPLATS_HD inline double log_of(double x) {
  auto bits = std::bit_cast<std::uint64_t>(x);
  int exponent = static_cast<int>(bits >> 52) - 1023;
  bits = (bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL;
  double mantissa = std::bit_cast<double>(bits);  // 1 to 2
  if (mantissa > 1.4142135623730951) {
    mantissa *= 0.5;
    ++exponent;
  }
  // fdlibm, e_log.c (Sun 1993): log(1 + f) = 2 s + s R(s^2), s = f / (2 + f).
  const double f = mantissa - 1.0;
  const double s = f / (2.0 + f);
  const double z = s * s;
  double sum = 1.479819860511658591e-01;
  sum = sum * z + 1.531383769920937332e-01;
  sum = sum * z + 1.818357216161805012e-01;
  sum = sum * z + 2.222219843214978396e-01;
  sum = sum * z + 2.857142874366239149e-01;
  sum = sum * z + 3.999999999940941908e-01;
  sum = sum * z + 6.666666666666735130e-01;
  const double half_square = 0.5 * f * f;
  const double k = static_cast<double>(exponent);
  constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
  return k * kLn2High - ((half_square - (s * (half_square + z * sum) + k * kLn2Low)) - f);
}

/// A lower bound of log_of(x) for normal positive x, at most kLogFloorError below it: the exponent,
/// and a straight line for the mantissa.
inline constexpr double kLogFloorError = 0.0597;
ADASPLATS_HD inline double log_floor_of(double x) {
  constexpr double kLn2 = 0.6931471805599453;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const auto exponent = static_cast<double>(static_cast<int>(bits >> 52) - 1024);
  return kLn2 *
         (exponent + std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL));
}

/// Cosine of `turns` full turns, 0 to 1 (Taylor within an eighth of a turn).
ADASPLATS_HD inline double cos_of_turns(double turns) {
  const double quarter = std::floor(4.0 * turns + 0.5);
  const double x = 6.283185307179586 * (turns - 0.25 * quarter);
  const double z = x * x;
  double cosine = 1.0 / 20922789888000.0;
  cosine = cosine * z - 1.0 / 87178291200.0;
  cosine = cosine * z + 1.0 / 479001600.0;
  cosine = cosine * z - 1.0 / 3628800.0;
  cosine = cosine * z + 1.0 / 40320.0;
  cosine = cosine * z - 1.0 / 720.0;
  cosine = cosine * z + 1.0 / 24.0;
  cosine = cosine * z - 0.5;
  cosine = cosine * z + 1.0;
  double sine = 1.0 / 355687428096000.0;
  sine = sine * z - 1.0 / 1307674368000.0;
  sine = sine * z + 1.0 / 6227020800.0;
  sine = sine * z - 1.0 / 39916800.0;
  sine = sine * z + 1.0 / 362880.0;
  sine = sine * z - 1.0 / 5040.0;
  sine = sine * z + 1.0 / 120.0;
  sine = sine * z - 1.0 / 6.0;
  sine = x + x * z * sine;
  const int q = static_cast<int>(quarter) & 3;
  const double value = (q & 1) == 0 ? cosine : sine;
  return q == 1 || q == 2 ? -value : value;
}

/// e^x for x <= 0, within two units in the last place: 2^k times a polynomial of the rest (Cephes,
/// expf; Moshier 1989). Below -87, where results are subnormal: 0. NaN stays NaN.
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
