// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace adasplats {

// For tests: class ids of SemanticKITTI.
inline constexpr std::uint16_t kCar = 10, kRoad = 40, kBuilding = 50, kPole = 80;
inline constexpr std::uint16_t kMovingCar = 252, kMovingPerson = 254;

}  // namespace adasplats
