// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "adasplats/core/maths/ray.h"
#include "adasplats/trace/tracer.h"
#include "adasplats/trace/wide_bvh.h"

namespace adasplats::detail {

/// Private to trace/. The nearest `slots` hits of every ray, hits[i * slots + k]; `hits` is clear.
using WideCast = void (*)(const WideView& tree, std::span<const Ray> rays, std::size_t slots,
                          std::span<Hit> hits);

WideCast portable_wide_cast();
#if defined(__x86_64__)
WideCast avx2_wide_cast();
WideCast avx512_wide_cast();
#endif

/// A traversal compiled for one vector instruction set.
struct WideVersion {
  std::string_view name;
  WideCast cast;
};

/// The versions that this machine can run, the fastest first. All give the same bits.
std::vector<WideVersion> wide_versions();

/// Tracer::nearest_hits() for a tree.
void cast_in_chunks(WideCast cast, const WideView& tree, std::span<const Ray> rays, int depth,
                    std::span<Hit> hits, const Executor& executor);

/// make_wide_tracer with the given version.
std::unique_ptr<Tracer> make_wide_tracer(const SceneView& scene, const WideVersion& version,
                                         const Executor& executor);

}  // namespace adasplats::detail
