// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// The ring of a column that comes first.
enum class FirstRing : std::uint8_t {
  top,     ///< channel numbers of Hesai's sensors
  bottom,  ///< ring numbers of Velodyne's driver, from the lowest beam
};

/// The indices of the points of a scan in the order of drivers, PandaSet and nuScenes: column by
/// column as the head turns, then by ring, with the returns of a firing adjacent. Needs columns and
/// rings (otherwise std::logic_error).
std::vector<std::uint32_t> driver_order(const ScanView& scan, FirstRing first);

}  // namespace adasplats
