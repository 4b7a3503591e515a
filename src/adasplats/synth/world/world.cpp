// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/world/world.h"

#include <cmath>

#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

constexpr double kDriveSpeed_m_per_s = 8;
constexpr double kDriveStep_m = 0.5;

/// The vehicle drives in the outermost lane of the right side, or nearer to the axis of a road
/// without a center line. No roll.
Trajectory drive_along(const WorldPlan& plan) {
  Trajectory drive;
  const double lane = plan.driven_line();
  const auto position = [&](double s) {
    Vec3d p = plan.route.at(s, -lane);
    p.z = plan.height(s, -lane);
    return p;
  };
  for (double s = 0; s < plan.options.length_m; s += kDriveStep_m) {
    const Vec3d here = position(s);
    const Vec3d ahead = position(s + 1) - here;
    const double pitch = -std::atan2(ahead.z, std::hypot(ahead.x, ahead.y));
    drive.push_back({s / kDriveSpeed_m_per_s,
                     {rotation_from_yaw_pitch_roll(std::atan2(ahead.y, ahead.x), pitch, 0), here}});
  }
  return drive;
}

}  // namespace

SynthWorld make_world(const WorldOptions& options) {
  check_settings(options);
  const WorldPlan plan(options);
  MeshBuilder builder;
  add_world_ground(plan, builder);
  add_world_buildings(plan, builder);
  add_world_edges(plan, builder);
  add_world_plants(plan, builder);
  add_world_furniture(plan, builder);
  const std::uint16_t first_moving = add_world_objects(plan, builder);
  BuiltMesh built = builder.take();

  SynthWorld world;
  world.street.length_m = options.length_m;
  world.street.fixed = std::move(built.mesh);
  world.street.instances = std::move(built.instances);
  world.street.reflectances = std::move(built.reflectances);
  world.street.moving = make_world_traffic(plan, first_moving);
  world.drive = drive_along(plan);
  return world;
}

}  // namespace adasplats
