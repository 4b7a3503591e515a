// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/smooth_path.h"

#include <algorithm>
#include <cmath>

namespace adasplats {
namespace {

/// A value and its rate, with their covariance (vv, vr, rr).
struct State {
  double value = 0, rate = 0;
  double vv = 0, vr = 0, rr = 0;
};

State predicted(const State& s, double step_s, double acceleration) {
  const double q = acceleration * acceleration, t = step_s;
  return {s.value + t * s.rate, s.rate, s.vv + 2 * t * s.vr + t * t * s.rr + q * t * t * t / 3,
          s.vr + t * s.rr + q * t * t / 2, s.rr + q * t};
}

State updated(const State& s, double value, double deviation) {
  const double gain = 1 / (s.vv + deviation * deviation);
  const double on_value = s.vv * gain, on_rate = s.vr * gain, off = value - s.value;
  return {s.value + on_value * off, s.rate + on_rate * off, (1 - on_value) * s.vv,
          (1 - on_value) * s.vr, s.rr - on_rate * s.vr};
}

SmoothPath smoothed(std::span<const double> times_s, std::span<const double> values,
                    std::span<const double> deviations, double acceleration) {
  constexpr double kAnyRate = 30;
  const std::size_t count = values.size();
  std::vector<State> filtered(count), ahead(count);
  for (std::size_t i = 0; i < count; ++i) {
    ahead[i] = i == 0 ? State{values[0], 0, 1e4, 0, kAnyRate * kAnyRate}
                      : predicted(filtered[i - 1], times_s[i] - times_s[i - 1], acceleration);
    filtered[i] = updated(ahead[i], values[i], deviations[i]);
  }
  SmoothPath path{std::vector<double>(count), std::vector<double>(count)};
  path.values[count - 1] = filtered[count - 1].value;
  path.rates[count - 1] = filtered[count - 1].rate;
  for (std::size_t i = count - 1; i-- > 0;) {
    const State& f = filtered[i];
    const State& p = ahead[i + 1];
    const double t = times_s[i + 1] - times_s[i];
    // filtered covariance * transition^T * predicted covariance^-1
    const double a = f.vv + t * f.vr, b = f.vr, c = f.vr + t * f.rr, d = f.rr;
    const double det = p.vv * p.rr - p.vr * p.vr;
    const double g00 = (a * p.rr - b * p.vr) / det, g01 = (b * p.vv - a * p.vr) / det;
    const double g10 = (c * p.rr - d * p.vr) / det, g11 = (d * p.vv - c * p.vr) / det;
    const double off = path.values[i + 1] - p.value, off_rate = path.rates[i + 1] - p.rate;
    path.values[i] = f.value + g00 * off + g01 * off_rate;
    path.rates[i] = f.rate + g10 * off + g11 * off_rate;
  }
  return path;
}

}  // namespace

SmoothPath smooth_path(std::span<const double> times_s, std::span<const double> values,
                       std::span<const double> deviations, double acceleration) {
  if (values.empty()) return {};
  const SmoothPath first = smoothed(times_s, values, deviations, acceleration);
  std::vector<double> robust(deviations.begin(), deviations.end());
  for (std::size_t i = 0; i < robust.size(); ++i)
    robust[i] *= std::max(1.0, std::fabs(values[i] - first.values[i]) / (2 * deviations[i]));
  return smoothed(times_s, values, robust, acceleration);
}

}  // namespace adasplats
