// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <numbers>

namespace adasplats {

inline constexpr double kDegree = std::numbers::pi / 180;  ///< in radians
inline constexpr double kBytesPerGiB = 1024.0 * 1024 * 1024;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace adasplats
