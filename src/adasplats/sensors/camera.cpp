// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/camera.h"

#include <algorithm>
#include <cmath>

#include "adasplats/core/error.h"

namespace adasplats {

namespace {

/// Columns of a rotation: the camera's axes in the world.
Mat3d rotation_from_axes(Vec3d forward, Vec3d left, Vec3d up) {
  return Mat3d{{forward, left, up}}.transposed();
}

}  // namespace

CameraRays Camera::rays(Vec3d origin) const {
  CameraRays rays;
  rays.local_from_camera = {world_from_camera.rotation, world_from_camera.translation - origin};
  rays.center_u = 0.5 * width;
  rays.center_v = 0.5 * height;
  if (lens) {
    rays.has_lens = true;
    rays.lens = *lens;
    rays.focal_px = std::sqrt(lens->fx * lens->fy);
  } else if (orthographic_width_m > 0) {
    rays.pixel_m = orthographic_width_m / width;
  } else {
    rays.focal_px = 0.5 * width / std::tan(0.5 * horizontal_fov_rad);
  }
  return rays;
}

Camera look_at(Vec3d eye, Vec3d target) {
  const Vec3d view = target - eye;
  const double distance = length(view);
  if (!(distance > 0) || !std::isfinite(distance))
    throw Error(ErrorKind::usage, "the camera's eye and target are the same point, or not finite");
  const Vec3d forward = view / distance;
  // Left is z x forward. It is undefined for views straight up or down: there +y is up.
  const Vec3d sideways = {-forward.y, forward.x, 0};
  const double flat = length(sideways);
  const Vec3d left = flat > 1e-9 ? sideways / flat : Vec3d{forward.z < 0 ? -1.0 : 1.0, 0, 0};
  Camera camera;
  camera.world_from_camera = {rotation_from_axes(forward, left, cross(forward, left)), eye};
  return camera;
}

Camera birds_eye(Vec3d low, Vec3d high, int width, int height) {
  if (width <= 0 || height <= 0)
    throw Error(ErrorKind::usage, "an image needs a width and a height above 0");
  const Vec3d size = high - low;
  if (!is_finite(size) || !(size.x >= 0 && size.y >= 0 && size.z >= 0))
    throw Error(ErrorKind::usage, "a bird's eye view needs a box with low <= high");
  const Vec3d center = 0.5 * (low + high);
  constexpr double kClearance_m = 1.0;
  constexpr double kBorder = 1.02;  // 1 % on each side
  constexpr double kSmallest_m = 1e-3;
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.orthographic_width_m = kBorder * std::max({size.x, size.y * width / height, kSmallest_m});
  camera.world_from_camera = {rotation_from_axes({0, 0, -1}, {-1, 0, 0}, {0, 1, 0}),
                              {center.x, center.y, high.z + kClearance_m}};
  return camera;
}

}  // namespace adasplats
