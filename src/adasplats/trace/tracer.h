// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// A hit of one of several rays.
struct RayHit {
  std::uint32_t ray = 0;
  Hit hit;
};

/// Finds the hits of rays in a scene; one interface for all backends. A tracer keeps views of its
/// scene. Calls are const and thread-safe.
class Tracer {
 public:
  virtual ~Tracer() = default;

  virtual std::string_view name() const = 0;

  /// Nearest hit of every ray: hits[i] of rays[i]. Consecutive rays with similar directions (a
  /// laser row) are faster. A ray with a component that is not finite or beyond 1e18, or without a
  /// direction, hits nothing; a t_min below 0 counts as 0. Ties go to the smaller primitive index.
  /// Throws std::logic_error if the numbers of rays and hits differ.
  virtual void nearest(std::span<const Ray> rays, std::span<Hit> hits,
                       const Executor& executor) const {
    nearest_hits(rays, 1, hits, executor);
  }

  /// The nearest `depth` hits of every ray in ascending order: hits[i * depth + k]; entries after
  /// the last hit are Hit{} (not valid()).
  virtual void nearest_hits(std::span<const Ray> rays, int depth, std::span<Hit> hits,
                            const Executor& executor) const = 0;

  /// Calls body(hits) with all hits of the rays, group by group and in any order, on the caller's
  /// thread.
  using HitsBody = FunctionRef<void(std::span<const RayHit> hits)>;
  virtual void all_hits(std::span<const Ray> rays, HitsBody body) const;
};

/// Tests every primitive for every ray: the oracle of the tests. The scene's data must outlive it.
std::unique_ptr<Tracer> make_brute_force_tracer(const SceneView& scene);

/// Embree 3 or 4 with user geometry and exact disk bounds. Hits equal those of brute force bit by
/// bit for rays up to kExactReach_m. Builds on the executor's threads; the scene's data must
/// outlive it. Errors: data (2^32 - 1 primitives or more), software (Embree does not start or has
/// no memory).
std::unique_ptr<Tracer> make_embree_tracer(const SceneView& scene, const Executor& executor);

/// Our own tree with 16 children per node, for the machine's widest vectors (AVX-512, AVX2 or
/// portable code, with the same bits). Consecutive similar rays traverse the tree together. Hits
/// are those of brute force bit by bit for rays up to kExactReach_m. Builds on the executor's
/// threads; the scene's data must outlive it. Errors: data (2^32 - 1 primitives or more).
std::unique_ptr<Tracer> make_wide_tracer(const SceneView& scene, const Executor& executor);

/// The fastest tracer on this CPU: our tree for disks, Embree with triangles. In a scene with
/// opacities the nearest hit is where the ray most likely ends (trace/soft_hits.h), and several
/// hits are those with all disks. Errors: those of either.
std::unique_ptr<Tracer> make_cpu_tracer(const SceneView& scene, const Executor& executor);

}  // namespace adasplats
