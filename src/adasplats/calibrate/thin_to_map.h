// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/cloud/points/point_cloud.h"

namespace adasplats {

/// Thins points to the density of a map: in a cube of 0.4 m at most as many as there are points of
/// the map, or 4. Planes through both would otherwise follow a sensor that is much denser than the
/// map, and hide its errors.
PointCloud thinned_to_map(const PointCloud& points, const PointCloud& map);

}  // namespace adasplats
