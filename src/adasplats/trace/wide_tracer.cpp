// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include "adasplats/core/error.h"
#include "adasplats/trace/hit_list.h"
#include "adasplats/trace/soft_tracer.h"
#include "adasplats/trace/tracer.h"
#include "adasplats/trace/wide_bvh.h"
#include "adasplats/trace/wide_kernel.h"

namespace adasplats {

namespace {

class WideTracer final : public Tracer {
 public:
  WideTracer(const SceneView& scene, const detail::WideVersion& version, const Executor& executor)
      : version_(version) {
    if (scene.primitive_count() >= Hit::kNone)
      throw Error(ErrorKind::data, "a scene of " + std::to_string(scene.primitive_count()) +
                                       " primitives; the maximum is 2^32 - 2");
    bvh_ = build_wide_bvh(scene, executor);
    constexpr std::size_t kMaxNodes = std::size_t{1} << 28;  // see Walk::entries
    if (bvh_.nodes.size() > kMaxNodes)
      throw Error(ErrorKind::data, "the tree of the scene has more than 2^28 nodes");
  }

  std::string_view name() const override { return "wide"; }

  void nearest_hits(std::span<const Ray> rays, int depth, std::span<Hit> hits,
                    const Executor& executor) const override {
    const WideView tree = depth == 1 && !bvh_.soft.empty() ? bvh_.soft_view() : bvh_.view();
    detail::cast_in_chunks(version_.cast, tree, rays, depth, hits, executor);
  }

  void all_hits(std::span<const Ray> rays, HitsBody body) const override {
    if (bvh_.root.kind() != WideRef::Kind::nothing) version_.all_hits(bvh_.view(), rays, body);
  }

 private:
  detail::WideVersion version_;
  WideBvh bvh_;
};

}  // namespace

void detail::cast_in_chunks(WideCast cast, const WideView& tree, std::span<const Ray> rays,
                            int depth, std::span<Hit> hits, const Executor& executor) {
  const auto slots = static_cast<std::size_t>(depth);
  require_slots(rays, depth, hits);
  executor.for_chunks(rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    const auto own = hits.subspan(begin * slots, (end - begin) * slots);
    std::ranges::fill(own, Hit{});  // here: in parallel, and in each core's cache
    if (tree.root.kind() == WideRef::Kind::nothing) return;
    cast(tree, rays.subspan(begin, end - begin), slots, own);
  });
}

std::vector<detail::WideVersion> detail::wide_versions() {
  std::vector<WideVersion> versions;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq"))
    versions.push_back(avx512_wide());
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2"))
    versions.push_back(avx2_wide());
#endif
  versions.push_back(portable_wide());
  // For benchmarks: the fastest version that may be used.
  const char* const fastest = std::getenv("ADASPLATS_VECTORS");
  if (fastest == nullptr) return versions;
  const auto chosen = std::ranges::find(versions, std::string_view(fastest), &WideVersion::name);
  if (chosen == versions.end())
    throw Error(ErrorKind::usage, "ADASPLATS_VECTORS: expected " + std::string(versions[0].name) +
                                      " or slower (avx2, portable), found '" + fastest + "'");
  versions.erase(versions.begin(), chosen);
  return versions;
}

std::unique_ptr<Tracer> detail::make_wide_tracer(const SceneView& scene, const WideVersion& version,
                                                 const Executor& executor) {
  return std::make_unique<WideTracer>(scene, version, executor);
}

std::unique_ptr<Tracer> make_wide_tracer(const SceneView& scene, const Executor& executor) {
  return detail::make_wide_tracer(scene, detail::wide_versions().front(), executor);
}

std::unique_ptr<Tracer> make_cpu_tracer(const SceneView& scene, const Executor& executor) {
  // Measured by bench_trace: for disks our tree is faster with vectors of 8 or 16; with triangles
  // it is not, and slower with AVX2.
  const bool has_vectors = detail::wide_versions().front().name != "portable";
  std::unique_ptr<Tracer> tracer = has_vectors && scene.triangle_count() == 0
                                       ? make_wide_tracer(scene, executor)
                                       : make_embree_tracer(scene, executor);
  if (scene.opacities.empty() || tracer->name() == "wide") return tracer;
  return make_soft_tracer(std::move(tracer), scene);
}

}  // namespace adasplats
