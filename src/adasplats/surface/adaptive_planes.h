// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/surface/fused_points.h"
#include "adasplats/surface/plane_fit.h"

namespace adasplats {

/// One plane a cell, by PCA with the cells' numbers of points as weights (so that a plane through
/// cells is the plane through their points), at a scale of its own. `index` holds the cells in
/// their order.
std::vector<LocalPlane> adaptive_planes(const FusedPoints& cells, const PointIndex& index,
                                        const AdaptivePlaneOptions& options,
                                        const Executor& executor);

}  // namespace adasplats
