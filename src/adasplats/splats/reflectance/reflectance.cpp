// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/reflectance/reflectance.h"

#include <cstdint>
#include <span>

#include "adasplats/splats/reflectance/response_gain.h"

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

}  // namespace adasplats
