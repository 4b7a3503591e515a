// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/mount.h"

#include <numbers>

namespace adasplats {

RigidTransform MountSettings::transform() const {
  const Vec3d turn_rad = (std::numbers::pi / 180) * rotation_deg;
  return {rotation_from_yaw_pitch_roll(turn_rad.x, turn_rad.y, turn_rad.z), translation_m};
}

}  // namespace adasplats
