// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "adasplats/scene/scene.h"

namespace adasplats {

/// The part of a mesh where a value given at the vertices, linear in between, is at least `least`:
/// triangles across the bound are cut along it. As PoissonRecon's SurfaceTrimmer does it, except
/// that small holes and small leftovers (0.1 % of the area) are not merged with what is around
/// them. Classes are not kept.
TriangleMesh trimmed(const TriangleMesh& mesh, std::span<const float> values, float least);

}  // namespace adasplats
