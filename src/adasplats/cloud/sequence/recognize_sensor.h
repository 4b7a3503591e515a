// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "adasplats/cloud/sequence/sensor_cones.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Which sensor measured points, and where it was.
struct Recognition {
  SensorCones cones;
  /// Without a turn about the sensor's axis: cones do not show it.
  RigidTransform vehicle_from_sensor;
  double residual_rad;  ///< mean angle from a point to its cone, each at most half a degree
  double chance_rad;    ///< the same of points that know nothing of the cones
  double share;         ///< of points nearer to a cone than an eighth of the gap; 0.25 by chance

  /// 1: all points are on the cones; 0: no nearer than by chance.
  double confidence() const;
};

/// Finds the sensor and its mount from the pattern of elevations alone: seen from the right place,
/// points lie on the cones of the right table and leave the gaps empty. `points`: in the frame of
/// the vehicle (or of the sensor), each as at its own time; z up; a few thousand of a few scans
/// suffice. Mounts up to 2 m off in the plane, from 0.5 m below to 2.5 m above the origin, tilted
/// by up to 1.25 degrees. Points in the sensor's own frame are tried first. Nothing where no sensor
/// fits clearly, or one of another kind fits about as well.
std::optional<Recognition> recognize_sensor(std::span<const Vec3d> points,
                                            std::span<const SensorCones> candidates,
                                            const Executor& executor);

/// The same for points in the sensor's own frame, without a search for the mount.
std::optional<Recognition> recognize_in_place(std::span<const Vec3d> points,
                                              std::span<const SensorCones> candidates,
                                              const Executor& executor);

/// How near points lie to the cones of one sensor about the best of the mounts near a given one,
/// without a search: the mean angle, rad (each at most half a degree). `points` as recognize_sensor
/// takes them; 0 where fewer than a sensor is recognised by.
double residual_near(std::span<const Vec3d> points, const SensorCones& sensor,
                     const RigidTransform& vehicle_from_sensor);

}  // namespace adasplats
