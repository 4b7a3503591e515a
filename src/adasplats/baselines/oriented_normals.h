// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/setting.h"

namespace adasplats {

struct NormalOptions {
  std::uint32_t neighbors = 40;  ///< K, the point itself is one of them
  /// Neighbours between which orientation spreads where there are no sensor positions.
  std::uint32_t spread_neighbors = 10;
};

template <class Visit>
void visit_settings(NormalOptions& normals, Visit&& visit) {
  visit(Setting{.name = "neighbors",
                .help = "Number of points that a normal is estimated from, K",
                .min = 3,
                .max = 1000},
        normals.neighbors);
}

struct OrientedNormals {
  std::vector<Vec3f> normals;  ///< unit, one a point
  bool from_sensors = false;   ///< else spread over the graph of neighbours
  std::size_t components = 0;  ///< parts of that graph, each with a sign of its own
};

/// Normals by PCA of the K nearest points, turned to the sensor. Without sensor positions signs
/// spread along the minimum spanning tree of the graph of neighbours with weights 1 - |n_i . n_j|;
/// the highest point of each part looks up (Hoppe et al. 1992, "Surface reconstruction from
/// unorganized points", section 3.3). `points` in canonical order; `sensor_positions` empty or one
/// a point. The same bytes for every number of threads.
OrientedNormals oriented_normals(std::span<const Vec3f> points,
                                 std::span<const Vec3f> sensor_positions,
                                 const NormalOptions& options, const Executor& executor);

}  // namespace adasplats
