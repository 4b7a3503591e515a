// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/simulate/image/image.h"
#include "adasplats/simulate/image/point_image.h"

namespace adasplats {

/// The colours of a picture by class and what they stand for, the commonest first, at most 14, each
/// of at least one in a thousand; where the scene has no classes, its groups.
using ClassLegend = std::vector<std::pair<Rgb, std::string>>;
ClassLegend legend_of(const ImageScene& scene);
ClassLegend legend_of(std::span<const std::uint16_t> classes, const LabelScheme* labels);

}  // namespace adasplats
