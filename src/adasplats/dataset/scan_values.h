// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/simulate/scan.h"

namespace adasplats {

/// x, y, z (sensor frame, m) and intensity of each point; intensity 0 where the scan has none.
std::vector<float> points_with_intensity(const Scan& scan);

/// instance << 16 | class of each point, 0 for what the scan does not have.
std::vector<std::uint32_t> packed_labels(const Scan& scan);

}  // namespace adasplats
