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

/// Tracer::all_hits() for a tree.
using WideAllHits = void (*)(const WideView& tree, std::span<const Ray> rays,
                             Tracer::HitsBody body);

/// A traversal compiled for one vector instruction set.
struct WideVersion {
  std::string_view name;
  WideCast cast;
  WideAllHits all_hits;
};

WideVersion portable_wide();
#if defined(__x86_64__)
WideVersion avx2_wide();
WideVersion avx512_wide();
#endif

/// The versions that this machine can run, the fastest first. All give the same bits.
std::vector<WideVersion> wide_versions();

/// Tracer::nearest_hits() for a tree.
void cast_in_chunks(WideCast cast, const WideView& tree, std::span<const Ray> rays, int depth,
                    std::span<Hit> hits, const Executor& executor);

/// make_wide_tracer with the given version.
std::unique_ptr<Tracer> make_wide_tracer(const SceneView& scene, const WideVersion& version,
                                         const Executor& executor);

}  // namespace adasplats::detail
