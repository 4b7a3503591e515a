// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/simulate/image/point_image.h"

namespace adasplats {

/// Default colouring of a cloud: classes if most points have one with a colour in `labels` (may be
/// null), otherwise intensity, otherwise height.
ImageColor default_color(const PointCloud& cloud, const LabelScheme* labels);

/// A colour for each point of a cloud, for draw_points(). Without `color`: default_color().
/// - semantic: the class's colour, grey if it has none or black.
/// - intensity: 2nd to 98th percentile; grey if the cloud has none.
/// `range`: values at the ends of the scale; default: shown_range().
/// - range: distance from `eye` (world), on a logarithmic scale from 1 m to 100 m.
/// - shading: one grey, for the relief of draw_points.
/// Errors: usage (normal: points have none; semantic without labels).
std::vector<Rgb> point_colors(const PointCloud& cloud, const LabelScheme* labels,
                              std::optional<ImageColor> color, Vec3d eye,
                              std::optional<ValueRange> range = {});

/// Values at the ends of a colour scale, as shown_range() of a scene.
ValueRange shown_range(const PointCloud& cloud, ImageColor color);

}  // namespace adasplats
