// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// A pose as the page has it: x, y, z relative to `origin`, qx, qy, qz, qw.
inline std::array<double, 7> pose_json(const RigidTransform& world_from_sensor, Vec3d origin) {
  const Vec3d at = world_from_sensor.translation - origin;
  const Quaternion q = quaternion_from_rotation(world_from_sensor.rotation);
  return {at.x, at.y, at.z, q.x, q.y, q.z, q.w};
}

}  // namespace adasplats
