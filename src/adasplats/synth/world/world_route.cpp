// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/world/world_route.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace adasplats {
namespace {

constexpr double kRouteStep_m = 0.5;

}  // namespace

double WorldRoute::Wave::at(double s) const {
  return amplitude * std::sin(kFullTurn * s / length_m + phase);
}

WorldRoute::WorldRoute(double length_m, const RouteLimits& limits, Random random)
    : length_m_(length_m) {
  for (Wave& wave : heading_) {
    wave.length_m = random.uniform(120, 420);
    wave.phase = random.uniform(0, kFullTurn);
    // The curvature of a wave of the heading is at most amplitude * 2 pi / length.
    const double curvature = 0.5 * random.uniform() / limits.min_radius_m;
    wave.amplitude = curvature * wave.length_m / kFullTurn;
  }
  for (Wave& wave : height_) {
    wave.length_m = random.uniform(90, 360);
    wave.phase = random.uniform(0, kFullTurn);
    wave.amplitude = 0.5 * limits.max_climb * random.uniform() * wave.length_m / kFullTurn;
  }
  Vec3d position;
  const double beyond = length_m + 2 * kBeyond_m;
  for (double s = -kBeyond_m; s <= beyond; s += kRouteStep_m) {
    axis_.push_back(position);
    const double middle = heading(s + 0.5 * kRouteStep_m);
    position = position + kRouteStep_m * Vec3d{std::cos(middle), std::sin(middle), 0};
  }
  const Vec3d start = axis_[static_cast<std::size_t>(kBeyond_m / kRouteStep_m)];
  for (Vec3d& p : axis_) p = p - start;
}

WorldRoute::WorldRoute(double length_m, LandPosition land)
    : length_m_(length_m), land_(std::move(land)) {}

double WorldRoute::heading(double s) const {
  if (!land_) return heading_[0].at(s) + heading_[1].at(s);
  const Vec3d along = land_(s + kRouteStep_m, 0) - land_(s - kRouteStep_m, 0);
  return std::atan2(along.y, along.x);
}

double WorldRoute::land_height(double s, double d) const {
  return land_ ? land_(s, d).z : height_[0].at(s) + height_[1].at(s);
}

Vec3d WorldRoute::at(double s, double d) const {
  if (land_) {
    Vec3d position = land_(s, d);
    position.z = 0;
    return position;
  }
  const double along =
      std::clamp((s + kBeyond_m) / kRouteStep_m, 0.0, static_cast<double>(axis_.size()) - 2);
  const auto before = static_cast<std::size_t>(along);
  const double share = along - static_cast<double>(before);
  const Vec3d on_axis = axis_[before] + share * (axis_[before + 1] - axis_[before]);
  const double yaw = heading(s);
  return on_axis + d * Vec3d{-std::sin(yaw), std::cos(yaw), 0};
}

}  // namespace adasplats
