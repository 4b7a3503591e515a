// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/simulate/image/point_image.h"

namespace adasplats {

/// What the colours of a cloud show where nothing else is said: classes where most points have one
/// with a colour in `labels` (may be null), else intensity, else height.
ImageColor default_color(const PointCloud& cloud, const LabelScheme* labels);

/// A colour for each point of a cloud, to be drawn by draw_points. Without `color`:
/// default_color().
/// - semantic: the class's colour, grey where it has none or black.
/// - intensity: 2nd to 98th percentile; grey where the cloud has none.
/// `range`: what the ends of the scale stand for, else shown_range().
/// - range: distance from `eye` (world), on a logarithmic scale from 1 m to 100 m.
/// - shading: one grey, for the relief of draw_points.
/// Errors: usage (normal: points have none; semantic without labels).
std::vector<Rgb> point_colors(const PointCloud& cloud, const LabelScheme* labels,
                              std::optional<ImageColor> color, Vec3d eye,
                              std::optional<ValueRange> range = {});

/// What the ends of the scale of a colour stand for: as shown_range() of a scene.
ValueRange shown_range(const PointCloud& cloud, ImageColor color);

}  // namespace adasplats
