// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "adasplats/scene/scene.h"

namespace adasplats {

/// The part of a mesh where a value, linear between the vertices, is at least `min`; triangles
/// across the bound are cut along it. Like PoissonRecon's SurfaceTrimmer, except that small holes
/// and islands (0.1 % of the area) are not merged with their surroundings. Classes are dropped.
TriangleMesh trimmed(const TriangleMesh& mesh, std::span<const float> values, float min);

}  // namespace adasplats
