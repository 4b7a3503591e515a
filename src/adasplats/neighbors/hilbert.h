// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/vec3.h"

namespace adasplats {

/// Position of a cell along the Hilbert curve of 2^21 cells a side (63 bits). Skilling 2004,
/// "Programming the Hilbert curve": transpose form, then the bits of the axes interleaved.
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, std::uint32_t z);

/// The order of points along a Hilbert curve over their bounding cube: `order[i]` is the index of
/// the i-th point. Points in the same cell of the curve (2^-21 of the cube's side) are ordered by
/// x, y, z and then by index. Consecutive points are near each other, and runs of them fill
/// compact boxes, which Morton order does not give.
std::vector<std::uint32_t> hilbert_order(std::span<const Vec3f> points, const Executor& executor);

}  // namespace adasplats
