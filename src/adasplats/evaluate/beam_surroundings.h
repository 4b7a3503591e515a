// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// What a beam and the eight beams of its scan with the nearest directions end on.
enum class Surroundings : std::uint8_t {
  flat,   ///< their points are within 3 cm of a plane, and within 10 cm along the beam (RMS)
  rough,  ///< neither: leaves, grass, small things
  edge,   ///< not flat, and their sorted ranges have a gap of more than 0.5 m
};
inline constexpr std::size_t kSurroundings = 3;

std::string_view name_of(Surroundings surroundings);

/// One per point of a scan, in the sensor's frame. Points at the sensor are rough.
std::vector<Surroundings> surroundings_of(std::span<const Vec3f> points, const Executor& executor);

}  // namespace adasplats
