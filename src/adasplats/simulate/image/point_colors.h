// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/simulate/image/point_image.h"

namespace adasplats {

/// Default colouring of a cloud: the colours of its file, otherwise classes if most points have one
/// with a colour in `labels` (may be null), otherwise intensity, otherwise height. An attribute
/// with a single value is skipped.
ImageColor default_color(const PointCloud& cloud, const LabelScheme* labels);
/// The same for classes and intensities; nothing if neither shows anything.
std::optional<ImageColor> default_color(std::span<const std::uint16_t> classes,
                                        std::span<const float> intensities,
                                        const LabelScheme* labels);

/// A colour for each point of a cloud, for draw_points(). Without `color`: default_color().
/// - semantic: the class's colour, grey if it has none or black.
/// - intensity: 2nd to 98th percentile; grey if the cloud has none.
/// `range`: values at the ends of the scale; default: shown_range().
/// - range: distance from `eye` (world), on a logarithmic scale from 1 m to 100 m.
/// - rgb: the colours of the file.
/// - shading: one grey, for the relief of draw_points.
/// Errors: usage (normal: points have none; semantic without labels; rgb without colours).
std::vector<Rgb> point_colors(const PointCloud& cloud, const LabelScheme* labels,
                              std::optional<ImageColor> color, Vec3d eye,
                              std::optional<ValueRange> range = {});

/// Values at the ends of a colour scale, as shown_range() of a scene.
ValueRange shown_range(const PointCloud& cloud, ImageColor color);

}  // namespace adasplats
