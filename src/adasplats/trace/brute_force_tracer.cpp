// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/castable.h"
#include "adasplats/trace/hit_list.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

namespace {

class BruteForceTracer final : public Tracer {
 public:
  explicit BruteForceTracer(const SceneView& scene) : scene_(scene) {}

  std::string_view name() const override { return "brute force"; }

  void nearest_hits(std::span<const Ray> rays, int depth, std::span<Hit> hits,
                    const Executor& executor) const override {
    clear_hits(rays, depth, hits);
    const auto slots = static_cast<std::size_t>(depth);
    constexpr std::size_t kRaysPerChunk = 64;
    executor.for_chunks(rays.size(), kRaysPerChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) cast(rays[i], hits.subspan(i * slots, slots));
    });
  }

 private:
  void cast(Ray ray, std::span<Hit> slots) const {
    if (!castable(ray)) return;
    ray.t_min = first_t(ray);
    HitList list(slots);
    std::uint32_t primitive = 0;
    for (const Disk& disk : scene_.disks) {
      const float t = intersect_disk(ray, disk);
      if (t < HUGE_VALF) list.insert({t, primitive});
      ++primitive;
    }
    for (std::size_t i = 0; i < scene_.triangle_count(); ++i) {
      const float t = intersect_triangle(ray, scene_.mesh->triangle(i));
      if (t < HUGE_VALF) list.insert({t, primitive});
      ++primitive;
    }
  }

  SceneView scene_;
};

}  // namespace

std::unique_ptr<Tracer> make_brute_force_tracer(const SceneView& scene) {
  return std::make_unique<BruteForceTracer>(scene);
}

}  // namespace adasplats
