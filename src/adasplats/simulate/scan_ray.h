// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/ray.h"
#include "adasplats/core/rigid_transform.h"

namespace adasplats {

/// Where a scan is cast from, in the frame of the scene.
struct ScanPose {
  Vec3f rows[3];  ///< of the rotation, scene from sensor; orthonormal to a float's precision
  Vec3f origin;   ///< relative to the scene's local origin, m
};
static_assert(sizeof(ScanPose) == 48);

/// The pose of a sensor in a scene whose local origin is `scene_origin`. The rotation is made
/// orthonormal in double: from a file it is so to 1e-3 only.
ADASPLATS_HD inline ScanPose scan_pose(const RigidTransform& world_from_sensor,
                                       Vec3d scene_origin) {
  const Vec3d* rows = world_from_sensor.rotation.rows;
  const Vec3d x = normalized(rows[0]);
  const Vec3d y = normalized(rows[1] - dot(rows[1], x) * x);
  const Vec3d z = normalized(rows[2] - dot(rows[2], x) * x - dot(rows[2], y) * y);
  return {{vec_cast<float>(x), vec_cast<float>(y), vec_cast<float>(z)},
          vec_cast<float>(world_from_sensor.translation - scene_origin)};
}

/// THE ray of a firing, for every backend. Its direction has unit length to 2e-7, 0.02 mm at 100 m.
ADASPLATS_HD inline Ray scan_ray(const ScanPose& pose, Vec3f firing_direction, float t_min,
                                 float t_max) {
  return {pose.origin,
          t_min,
          {dot(pose.rows[0], firing_direction), dot(pose.rows[1], firing_direction),
           dot(pose.rows[2], firing_direction)},
          t_max};
}

}  // namespace adasplats
