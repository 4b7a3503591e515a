// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/nearest_classes.h"

#include <stdexcept>

#include "adasplats/core/progress_meter.h"
#include "adasplats/neighbors/point_index.h"

namespace adasplats {

std::vector<std::uint16_t> nearest_classes(const TriangleMesh& mesh, std::span<const Vec3f> points,
                                           std::span<const std::uint16_t> classes,
                                           const Executor& executor) {
  if (points.size() != classes.size())
    throw std::logic_error("nearest_classes: the numbers of points and classes differ");
  std::vector<std::uint16_t> found;
  if (points.empty()) return found;
  std::vector<Vec3f> centroids(mesh.triangles.size());
  executor.for_chunks(centroids.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle t = mesh.triangle(i);
      centroids[i] = (t.a + t.b + t.c) / 3.0F;
    }
  });
  const PointIndex index = PointIndex::from_sorted(points, executor);
  const ProgressPass pass(executor, 2 * centroids.size());  // sorted, then searched
  found.reserve(centroids.size());
  for (const Neighbor& neighbor : index.nearest(centroids, executor))
    found.push_back(classes[neighbor.index]);
  return found;
}

}  // namespace adasplats
