// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "adasplats/sensors/camera.h"

namespace adasplats {

/// World box of the middle 98 % of points along each axis: far outliers must not decide what a
/// picture shows. `positions` (one or more) are relative to `origin`.
std::pair<Vec3d, Vec3d> middle_box(std::span<const Vec3f> positions, Vec3d origin);

/// What a picture should show of a place: the dense part. A drive has a street and, around it, what
/// single beams found far away.
struct ShownPart {
  Vec3d low, high;            ///< its box, world, m
  std::vector<Vec3d> points;  ///< some thousands of its points, world, m

  Vec3d middle() const { return 0.5 * (low + high); }
};

/// The points of the fullest columns of ground that together hold 90 % of all, less the outermost
/// percent of their heights. `positions` (one or more) are relative to `origin`.
ShownPart shown_part(std::span<const Vec3f> positions, Vec3d origin);

/// A pinhole camera that looks down on the part from where most of it is seen and largest, all of
/// it in the picture with a rim around.
Camera overview(const ShownPart& part, int width, int height, double horizontal_fov_rad);

/// The same from a given side: `pitch_rad` below the horizon, `azimuth_rad` the direction of the
/// view, counter-clockwise from +x.
Camera overview_from(const ShownPart& part, int width, int height, double horizontal_fov_rad,
                     double pitch_rad, double azimuth_rad);

}  // namespace adasplats
