// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "adasplats/cloud/labels/label_scheme.h"

namespace adasplats {

/// Label schemes give black to what has no class; a black surface would show no shape.
inline constexpr std::array<std::uint8_t, 3> kNoClassColor = {0, 0, 0};

/// A class's colour as pictures show it: nearer to grey, so that light and shadow show on the
/// darkest and the most glaring of a scheme, too.
std::array<std::uint8_t, 3> muted(std::array<std::uint8_t, 3> rgb);

/// Share (0..1) of `classes` that have a colour in the scheme; 0 without a scheme or classes.
double share_with_class_colors(std::span<const std::uint16_t> classes, const LabelScheme* labels);

/// From this share on classes are what a picture shows by itself.
inline constexpr double kMaxHaveClasses = 0.5;

}  // namespace adasplats
