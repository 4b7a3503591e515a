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
  std::uint32_t neighbors = 40;  ///< K, including the point itself
  /// Number of neighbours for propagating orientations without sensor positions.
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
  std::vector<Vec3f> normals;  ///< unit, one per point
  bool from_sensors = false;   ///< else propagated over the graph of neighbours
  std::size_t components = 0;  ///< connected components of that graph, each with its own sign
};

/// Normals by PCA of the K nearest points, oriented towards the sensor. Without sensor positions,
/// signs propagate along the minimum spanning tree of the graph of neighbours with weights
/// 1 - |n_i . n_j|, and the normal of the highest point of each component points up (Hoppe et al.
/// 1992, "Surface reconstruction from unorganized points", section 3.3). `points` in canonical
/// order; `sensor_positions` empty or one per point. The same bytes for every number of threads.
OrientedNormals oriented_normals(std::span<const Vec3f> points,
                                 std::span<const Vec3f> sensor_positions,
                                 const NormalOptions& options, const Executor& executor);

}  // namespace adasplats
