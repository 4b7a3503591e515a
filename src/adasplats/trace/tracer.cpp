// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/tracer.h"

#include "adasplats/trace/wide_kernel.h"

namespace adasplats {

std::unique_ptr<Tracer> make_cpu_tracer(const SceneView& scene, const Executor& executor) {
  // Measured by bench_trace: for disks our tree is faster in everything where there are vectors of
  // 8 or 16; with triangles it is no better, and slower with AVX2.
  const bool has_vectors = detail::wide_versions().front().name != "portable";
  if (has_vectors && scene.triangle_count() == 0) return make_wide_tracer(scene, executor);
  return make_embree_tracer(scene, executor);
}

}  // namespace adasplats
