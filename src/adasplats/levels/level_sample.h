// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/levels/level_tree.h"

namespace adasplats {

/// Private to levels/. One element of a node before it is encoded.
struct LevelSample {
  Vec3f position;
  float radius_m = 0;  ///< of a splat
  Vec3f normal{0, 0, 1};
  std::uint16_t class_id = 0;
  float intensity = 0;
  float error_m = 0;  ///< signed; NaN: unknown
  Vec3f color;        ///< RGB, 0 to 255
};

/// Encodes the samples of a node, and sets its box and largest radius. Positions are rounded to
/// 1/65535 of the box, radii to 1/65535 of the largest; a radius is at least one step.
std::vector<LevelElement> encode(std::span<const LevelSample> samples, ByteRange intensities,
                                 ByteRange errors_m, LevelNode& node);

/// The colours of samples, rounded.
std::vector<LevelColor> encode_colors(std::span<const LevelSample> samples);

}  // namespace adasplats
