// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/setting.h"

namespace adasplats {

/// Where a sensor sits in the frame of the poses, as users give it.
struct MountSettings {
  Vec3d translation_m;
  Vec3d rotation_deg;  ///< yaw, pitch, roll

  /// vehicle_from_sensor
  RigidTransform transform() const {
    const Vec3d turn_rad = (std::numbers::pi / 180) * rotation_deg;
    return {rotation_from_yaw_pitch_roll(turn_rad.x, turn_rad.y, turn_rad.z), translation_m};
  }
};

template <class Visit>
void visit_settings(MountSettings& mount, Visit&& visit) {
  constexpr const char* kGroup = "Trajectory";
  visit(
      Setting{
          .name = "mount", .help = "Sensor position in the frame of the poses, m", .group = kGroup},
      mount.translation_m);
  visit(Setting{.name = "mount_rotation",
                .help = "Yaw, pitch and roll of the sensor in the frame of the poses, degrees; a "
                        "positive pitch looks down",
                .group = kGroup},
        mount.rotation_deg);
}

}  // namespace adasplats
