// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/reflectance/reflectance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/splats/reflectance/response_tables.h"

namespace adasplats {
namespace {

float table_value(std::span<const float> nodes, std::span<const float> values, float at) {
  if (values.size() < 2 || nodes.size() != values.size()) return values.empty() ? 1.0F : values[0];
  return gain_of({nodes.data(), values.data(), static_cast<std::uint32_t>(values.size())}, at);
}

}  // namespace

float IntensityResponse::gain(float range_m, float cos_incidence) const {
  return table_value(ranges_m, range_gains, range_m) *
         table_value(cos_incidences, incidence_gains, cos_incidence);
}

void solve_table(std::span<const std::int64_t> diagonal, std::span<const std::int64_t> off_diagonal,
                 std::span<const std::int64_t> right, std::size_t unit, std::span<float> values) {
  const std::size_t nodes = values.size();
  std::vector<double> d(diagonal.begin(), diagonal.end()), x(right.begin(), right.end());
  double sum = 0;
  for (std::size_t k = 0; k < nodes; ++k) sum += d[k];
  std::ranges::fill(values, 1.0F);
  if (!(sum > 0)) return;
  // Chosen: less leaves nodes without rays undetermined, more flattens the table.
  const double pull = 2e-4 * sum;
  const auto link = [&](std::size_t k) { return static_cast<double>(off_diagonal[k]) - pull; };
  for (std::size_t k = 0; k < nodes; ++k) d[k] += (k == 0 || k + 1 == nodes) ? pull : 2 * pull;
  for (std::size_t k = 1; k < nodes; ++k) {
    const double factor = link(k - 1) / d[k - 1];
    d[k] -= factor * link(k - 1);
    x[k] -= factor * x[k - 1];
  }
  x[nodes - 1] /= d[nodes - 1];
  for (std::size_t k = nodes - 1; k-- > 0;) x[k] = (x[k] - link(k) * x[k + 1]) / d[k];
  if (!(x[unit] > 0)) return;
  for (std::size_t k = 0; k < nodes; ++k)
    values[k] = static_cast<float>(std::max(x[k] / x[unit], 0.0));
}

double power_of_two_above(double value) {
  if (!(value > 0)) return 1;
  int exponent = 0;
  std::frexp(value, &exponent);
  return std::ldexp(1.0, exponent);
}

}  // namespace adasplats
