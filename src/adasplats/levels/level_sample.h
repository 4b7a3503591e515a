// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/levels/level_tree.h"

namespace adasplats {

/// Private to levels/: one element of a node before it becomes bytes.
struct LevelSample {
  Vec3f position;
  float radius_m = 0;  ///< of a splat
  Vec3f normal{0, 0, 1};
  std::uint16_t class_id = 0;
  float intensity = 0;
  float error_m = 0;  ///< signed, NaN: not known
};

/// Fills box and largest radius of a node that holds `samples`, and gives their bytes. A position
/// is off by at most half a 65535th of the box (and the rounding of a float), a radius likewise of
/// the largest, which is never less than one step.
std::vector<LevelElement> encode(std::span<const LevelSample> samples, ByteRange intensities,
                                 ByteRange errors_m, LevelNode& node);

}  // namespace adasplats
