// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "adasplats/core/executor.h"
#include "adasplats/sensors/camera.h"
#include "adasplats/simulate/image/image.h"

namespace adasplats {

/// 8-bit red, green, blue.
using Rgb = std::array<std::uint8_t, 3>;

struct PointImageOptions {
  double point_size_m = 0.06;  ///< side of the square that stands for a point
  int min_px = 2;              ///< the square's bounds in the picture
  int max_px = 8;
  Rgb background = ImageOptions{}.background;
  bool sky = true;  ///< as ImageOptions has them
  bool relief = true;
};

/// Draws points as squares that face the camera; the nearest to the camera wins, of equally near
/// ones the first. `positions` are relative to `origin`, one colour each. Points that are not
/// finite or behind the camera are not drawn. The same bytes for any number of threads.
/// Errors: usage (a size outside 1 to 32768 pixels); std::logic_error (another number of colours,
/// 2^32 points or more).
Image draw_points(std::span<const Vec3f> positions, Vec3d origin, std::span<const Rgb> colors,
                  const Camera& camera, const PointImageOptions& options, const Executor& executor);

}  // namespace adasplats
