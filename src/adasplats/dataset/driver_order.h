// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// Which ring of a column comes first.
enum class FirstRing : std::uint8_t {
  top,     ///< as channels of Hesai's sensors are numbered
  bottom,  ///< as Velodyne's driver numbers rings, from the lowest beam
};

/// The points of a scan, by their numbers, as drivers give them and PandaSet and nuScenes store
/// them: column by column as the head turns, the rings of each in their order, returns of one
/// firing side by side. Needs columns and rings (std::logic_error without).
std::vector<std::uint32_t> driver_order(const ScanView& scan, FirstRing first);

}  // namespace adasplats
