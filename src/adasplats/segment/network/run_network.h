// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/segment/network/network.h"
#include "adasplats/segment/pyramid/pyramid.h"

namespace adasplats {

/// Weight of a neighbour at `offset` for a kernel point (in cells; KPConv, equation 3); no
/// influence unless it is positive.
ADASPLATS_HD inline float kernel_influence(Vec3f offset, Vec3f kernel_point, float cell_m,
                                           float sigma_m) {
  const Vec3f off = offset - cell_m * kernel_point;
  return 1 - std::sqrt(dot(off, off)) / sigma_m;
}

/// Leaky rectifier: scales negative values.
ADASPLATS_HD inline float activated(float value, float slope) {
  return value < 0 ? slope * value : value;
}

/// Computes the logits of every point of the finest level, point by point, one per class.
/// `features`: point by point, one per feature of the network. The same bits on any number of
/// threads. Errors: unavailable (built without OpenBLAS).
std::vector<float> run_network(const Network& network, std::span<const PyramidLevel> levels,
                               std::vector<float> features, const Executor& executor);

/// c = a * b, row by row: (rows, inner) by (inner, columns). Thread-safe; the calling thread
/// computes the product. Errors: unavailable (built without OpenBLAS).
void multiply(const float* a, const float* b, float* c, std::size_t rows, std::size_t inner,
              std::size_t columns);

/// Throws unavailable if the library was built without OpenBLAS.
void require_products();

}  // namespace adasplats
