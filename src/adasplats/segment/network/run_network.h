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

/// How much a point of a kernel (in cells) takes of a neighbour that lies `way` off (KPConv,
/// equation 3); not positive: nothing.
ADASPLATS_HD inline float kernel_influence(Vec3f way, Vec3f kernel_point, float cell_m,
                                           float sigma_m) {
  const Vec3f off = way - cell_m * kernel_point;
  return 1 - std::sqrt(dot(off, off)) / sigma_m;
}

/// Leaky rectification: negative values are multiplied.
ADASPLATS_HD inline float activated(float value, float slope) {
  return value < 0 ? slope * value : value;
}

/// The logits of every point of the finest level, point by point, a number a class. `features`:
/// likewise, a number a feature of the network. The same bits on any number of threads. Errors:
/// unavailable (built without OpenBLAS).
std::vector<float> run_network(const Network& network, std::span<const PyramidLevel> levels,
                               std::vector<float> features, const Executor& executor);

/// c = a * b, row by row: (rows, inner) by (inner, columns). May be called from several threads;
/// each product is made by the thread that asks. Errors: unavailable (built without OpenBLAS).
void multiply(const float* a, const float* b, float* c, std::size_t rows, std::size_t inner,
              std::size_t columns);

/// Errors: unavailable, saying what is missing and how to get it, where products cannot be made.
void require_products();

}  // namespace adasplats
