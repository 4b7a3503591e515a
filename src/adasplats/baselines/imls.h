// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "adasplats/baselines/imls_field.h"
#include "adasplats/core/executor.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// The surface of oriented points by Implicit Moving Least Squares as the paper's experiments have
/// it: values in voxels near points (ImlsField) in a sparse grid, zero surface by OpenVDB. The
/// surface ends where the values end: a cell with a corner that has none gives no faces. Faces are
/// oriented as the normals; without classes. Extraction is dual contouring, not marching cubes:
/// half as many vertices in the same cells. The same bytes for every number of threads.
/// Errors: unavailable (built without OpenVDB), usage (options).
TriangleMesh imls_surface(std::span<const Vec3f> points, std::span<const Vec3f> normals,
                          const ImlsOptions& options, const Executor& executor);

}  // namespace adasplats
