// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/ray.h"
#include "adasplats/core/rigid_transform.h"

namespace adasplats {

/// Pinhole or orthographic camera. Camera frame: x forward, y left, z up, as sensors have it.
struct Camera {
  RigidTransform world_from_camera;
  int width = 2560;
  int height = 1440;
  double horizontal_fov_rad = 1.2;  ///< pinhole
  double orthographic_width_m = 0;  ///< > 0: parallel rays over that width instead

  /// Ray through the point (u, v) of the image, in pixels from the top left corner; relative to
  /// `origin` (the scene's). Pixel (i, j) has its centre at (i + 0.5, j + 0.5).
  Ray ray(double u, double v, Vec3d origin) const;
};

/// A camera at `eye` that looks at `target`, z up. Errors: usage where both are the same point.
Camera look_at(Vec3d eye, Vec3d target);

/// Bird's eye view: straight down over the box [low, high], north (+y) up, the whole box inside.
Camera birds_eye(Vec3d low, Vec3d high, int width, int height);

}  // namespace adasplats
