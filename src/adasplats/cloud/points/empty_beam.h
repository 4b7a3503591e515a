// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// A beam that returned nothing: what it passed is free.
struct EmptyBeam {
  Vec3f origin;            ///< where it left the sensor, relative to the cloud's origin, m
  Vec3f direction;         ///< unit, world axes
  std::uint32_t scan = 0;  ///< number of its scan
};

}  // namespace adasplats
