// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/tracer.h"

namespace adasplats {

std::unique_ptr<Tracer> make_cpu_tracer(const SceneView& scene, const Executor& executor) {
  return make_embree_tracer(scene, executor);
}

}  // namespace adasplats
