// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/simulate/point_hits.h"

namespace adasplats::gpu {

void queue_point_hits(const Hit* hits, const FiringRay* firings, std::uint32_t firing_count,
                      std::uint64_t count, PointHit* points, cudaStream_t stream) {
  for_each(count, stream, "turn hits into points on the GPU", [=] __device__(std::uint64_t i) {
    const Hit hit = hits[i];
    const FiringRay firing = firings[i % firing_count];
    points[i] = {hit.valid() ? firing.origin + hit.t * firing.direction : Vec3f{}, hit.primitive};
  });
}

}  // namespace adasplats::gpu
