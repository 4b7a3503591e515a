// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "adasplats/core/maths/ray.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/sensors/lens.h"

namespace adasplats {

/// The rays of a camera, precomputed for CPU and GPU.
struct CameraRays {
  RigidTransform local_from_camera;
  double center_u = 0, center_v = 0;  ///< middle of the image, pixels
  double focal_px = 1;                ///< pinhole; of a lens: the mean of its axes
  double pixel_m = 0;                 ///< > 0: parallel rays at this distance instead
  bool has_lens = false;
  Lens lens;

  /// Ray through the point (u, v) of the image, in pixels from the top left corner. Pixel (i, j)
  /// has its centre at (i + 0.5, j + 0.5). Without a direction where the lens shows nothing.
  ADASPLATS_HD Ray ray(double u, double v) const {
    return has_lens ? lens_ray(u, v) : plain_ray(u, v);
  }

  /// The same with a lens alone.
  ADASPLATS_HD Ray lens_ray(double u, double v) const {
    const Vec3d optical = lens.direction(u - 0.5, v - 0.5);
    Ray ray;
    ray.origin = vec_cast<float>(local_from_camera.translation);
    ray.direction =
        vec_cast<float>(local_from_camera.rotation * Vec3d{optical.z, -optical.x, -optical.y});
    return ray;
  }

  /// The same without a lens, for kernels that need few registers.
  ADASPLATS_HD Ray plain_ray(double u, double v) const {
    const double right = u - center_u;
    const double down = v - center_v;
    Vec3d eye;
    Vec3d direction = {1, 0, 0};
    if (pixel_m > 0) {
      eye = {0, -right * pixel_m, -down * pixel_m};
    } else {
      direction = {focal_px, -right, -down};
    }
    Ray ray;
    ray.origin = vec_cast<float>(local_from_camera * eye);
    ray.direction = vec_cast<float>(normalized(local_from_camera.rotation * direction));
    return ray;
  }
};

/// Pinhole or orthographic camera, or one with a lens. Camera frame: x forward, y left, z up, as
/// for sensors.
struct Camera {
  RigidTransform world_from_camera;
  int width = 2560;
  int height = 1440;
  double horizontal_fov_rad = 1.2;  ///< pinhole
  double orthographic_width_m = 0;  ///< > 0: parallel rays over that width instead
  std::optional<Lens> lens;         ///< instead, of the same width and height

  /// Rays relative to `origin` (the scene's).
  CameraRays rays(Vec3d origin) const;
  Ray ray(double u, double v, Vec3d origin) const { return rays(origin).ray(u, v); }
};

/// From the axes of a lens, x right, y down, z forward.
inline constexpr Mat3d kCameraFromOptical = {{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}};

/// A camera at `eye` that looks at `target`, z up. Errors: usage if both are the same point.
Camera look_at(Vec3d eye, Vec3d target);

/// Bird's eye view: straight down on the box [low, high], north (+y) up, the box fully visible.
Camera birds_eye(Vec3d low, Vec3d high, int width, int height);

}  // namespace adasplats
