// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// Private to evaluate/: the beams beside each beam of firings_of(sensor), by their place there;
/// kNoBeam where there is none. Before and behind it in azimuth on its ring (around the full turn),
/// and of the same column on the rings above and below. A free pattern has no columns: there, only
/// the beams before and behind it on its ring in the pattern's order.
inline constexpr std::uint32_t kNoBeam = 0xffffffffU;
std::vector<std::array<std::uint32_t, 4>> beam_neighbors(const LidarModel& sensor);

}  // namespace adasplats
