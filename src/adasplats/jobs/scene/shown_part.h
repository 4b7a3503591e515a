// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "adasplats/sensors/camera.h"

namespace adasplats {

/// World box of the middle 98 % of points along each axis, which is robust to far outliers.
/// `positions` (one or more) are relative to `origin`.
std::pair<Vec3d, Vec3d> middle_box(std::span<const Vec3f> positions, Vec3d origin);

/// The dense part of a scene, for pictures. A drive has a street and, around it, points of single
/// beams far away.
struct ShownPart {
  Vec3d low, high;            ///< its box, world, m
  std::vector<Vec3d> points;  ///< some thousands of its points, world, m

  Vec3d middle() const { return 0.5 * (low + high); }
};

/// The points in the fullest columns above the ground that together hold 90 % of all points,
/// without the lowest and the highest percent. `positions` (one or more) are relative to `origin`.
ShownPart shown_part(std::span<const Vec3f> positions, Vec3d origin);

/// A pinhole camera that looks down on the part, from the side from which most of it is visible and
/// large. The picture contains all of it, with a margin.
Camera overview(const ShownPart& part, int width, int height, double horizontal_fov_rad);

/// The same from a given side: `pitch_rad` below the horizon, `azimuth_rad` the direction of the
/// view, counter-clockwise from +x.
Camera overview_from(const ShownPart& part, int width, int height, double horizontal_fov_rad,
                     double pitch_rad, double azimuth_rad);

}  // namespace adasplats
