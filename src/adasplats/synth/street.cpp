// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/street.h"

#include <algorithm>
#include <cmath>

#include "adasplats/synth/street_parts.h"

namespace adasplats {

double street_length_for(std::size_t points) {
  const double length = 60 * std::pow(static_cast<double>(points) / 300'000, 0.4);
  return std::clamp(length, kShortestStreet_m, kLongestStreet_m);
}

Street make_street(const StreetOptions& options) {
  const StreetPlan plan = make_street_plan(options);
  MeshBuilder builder;
  add_ground(plan, builder);
  add_facades(plan, builder);
  add_houses(plan, builder);
  add_fences(plan, builder);
  add_furniture(plan, builder);
  add_vegetation(plan, builder);
  const std::uint16_t first_moving = add_parked_cars(plan, builder);
  BuiltMesh built = builder.take();

  Street street;
  street.length_m = plan.length;
  street.fixed = std::move(built.mesh);
  street.instances = std::move(built.instances);
  street.reflectances = std::move(built.reflectances);
  street.moving = make_traffic(plan, first_moving);
  street.traffic_period_s = kTrafficPeriod_s;
  return street;
}

}  // namespace adasplats
