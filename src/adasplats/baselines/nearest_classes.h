// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// For each triangle, the class of the point nearest to its centroid. `points` in canonical order,
/// `classes` one per point; without points the result is empty.
std::vector<std::uint16_t> nearest_classes(const TriangleMesh& mesh, std::span<const Vec3f> points,
                                           std::span<const std::uint16_t> classes,
                                           const Executor& executor);

}  // namespace adasplats
