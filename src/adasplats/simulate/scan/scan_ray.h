// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/maths/ray.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Pose from which a scan is cast, in the frame of the scene.
struct ScanPose {
  Vec3f rows[3];  ///< of the rotation, scene from sensor; orthonormal to a float's precision
  Vec3f origin;   ///< relative to the scene's local origin, m
};
static_assert(sizeof(ScanPose) == 48);

/// The pose of a sensor in a scene with local origin `scene_origin`. The rotation is
/// orthonormalised in double precision: rotations from files are orthonormal only to 1e-3.
ADASPLATS_HD inline ScanPose scan_pose(const RigidTransform& world_from_sensor,
                                       Vec3d scene_origin) {
  const Vec3d* rows = world_from_sensor.rotation.rows;
  const Vec3d x = normalized(rows[0]);
  const Vec3d y = normalized(rows[1] - dot(rows[1], x) * x);
  const Vec3d z = normalized(rows[2] - dot(rows[2], x) * x - dot(rows[2], y) * y);
  return {{vec_cast<float>(x), vec_cast<float>(y), vec_cast<float>(z)},
          vec_cast<float>(world_from_sensor.translation - scene_origin)};
}

/// A firing in the form from which rays are made.
struct FiringRay {
  Vec3f direction;   ///< sensor frame, unit length
  float share = 0;   ///< elapsed share of the revolution at the firing, 0..1
  Vec3f origin;      ///< sensor frame, m
  float unused = 0;  ///< 16-byte loads
};
static_assert(sizeof(FiringRay) == 32);

inline ADASPLATS_HD Vec3f turned(const ScanPose& pose, Vec3f v) {
  return {dot(pose.rows[0], v), dot(pose.rows[1], v), dot(pose.rows[2], v)};
}

/// The ray of a firing of a sensor at rest, the same on every backend. Its direction has unit
/// length to 2e-7, 0.02 mm at 100 m.
ADASPLATS_HD inline Ray still_scan_ray(const ScanPose& pose, const FiringRay& firing, float t_min,
                                       float t_max) {
  return {pose.origin + turned(pose, firing.origin), t_min, turned(pose, firing.direction), t_max};
}

/// The same for a moving sensor. `knots`: its poses at `knot_count` equal time steps from the
/// beginning of the revolution to its end; one: at rest. Between knots, origins and directions are
/// interpolated linearly; for knots at most half a degree apart (moving_scans), the error is below
/// 1e-7 rad.
ADASPLATS_HD inline Ray scan_ray(const ScanPose* knots, std::uint32_t knot_count,
                                 const FiringRay& firing, float t_min, float t_max) {
  if (knot_count < 2) return still_scan_ray(knots[0], firing, t_min, t_max);
  const float place = firing.share * static_cast<float>(knot_count - 1);
  std::uint32_t segment = place > 0.0F ? static_cast<std::uint32_t>(place) : 0;
  if (segment > knot_count - 2) segment = knot_count - 2;
  const float late = place - static_cast<float>(segment);
  const ScanPose& from = knots[segment];
  const ScanPose& to = knots[segment + 1];
  return {(1.0F - late) * (from.origin + turned(from, firing.origin)) +
              late * (to.origin + turned(to, firing.origin)),
          t_min,
          normalized((1.0F - late) * turned(from, firing.direction) +
                     late * turned(to, firing.direction)),
          t_max};
}

}  // namespace adasplats
