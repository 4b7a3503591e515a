// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {

/// Shapes of neighbourhoods in lanes of SIMD, with the bits of local_shape() of their exact
/// Moments. One per thread: it reuses its memory.
class ShapeLanes {
 public:
  /// Sets shapes[i] to that of lists[i], the neighbours of point first_rank + i.
  void find(std::span<const Vec3f> points, std::uint32_t first_rank,
            std::span<const NeighborList> lists, std::span<LocalShape> shapes);

 private:
  std::vector<float> offsets_;  ///< of the neighbours of one point
};

}  // namespace adasplats
