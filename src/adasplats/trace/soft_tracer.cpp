// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/soft_tracer.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "adasplats/scene/soft_disk.h"
#include "adasplats/trace/hit_list.h"
#include "adasplats/trace/soft_hits.h"

namespace adasplats {
namespace {

constexpr std::size_t kSoftRaysAtOnce = std::size_t{1} << 15;

Hit most_likely_hit(const SceneView& scene, const Ray& ray, std::span<const Hit> hits) {
  SoftHits soft;
  for (const Hit& hit : hits) {
    if (!hit.valid()) break;
    const std::uint32_t disk = hit.primitive;
    const float opacity = disk < scene.disk_count()
                              ? opacity_of_hit(ray, hit.t, scene.disks[disk], scene.opacities[disk])
                              : kMaxOpacity;
    if (!soft.append(hit, opacity)) break;
  }
  return soft.most_likely();
}

class SoftTracer final : public Tracer {
 public:
  SoftTracer(std::unique_ptr<Tracer> all_hits, const SceneView& scene)
      : all_hits_(std::move(all_hits)), scene_(scene) {}

  std::string_view name() const override { return all_hits_->name(); }

  void nearest_hits(std::span<const Ray> rays, int depth, std::span<Hit> hits,
                    const Executor& executor) const override {
    if (depth != 1) return all_hits_->nearest_hits(rays, depth, hits, executor);
    require_slots(rays, depth, hits);
    constexpr auto kSlots = static_cast<std::size_t>(SoftHits::kMost);
    std::vector<Hit> found(std::min(rays.size(), kSoftRaysAtOnce) * kSlots);
    for (std::size_t done = 0; done < rays.size(); done += kSoftRaysAtOnce) {
      const auto batch = rays.subspan(done, std::min(kSoftRaysAtOnce, rays.size() - done));
      const auto of_batch = std::span(found).first(batch.size() * kSlots);
      all_hits_->nearest_hits(batch, SoftHits::kMost, of_batch, executor);
      executor.for_chunks(batch.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          hits[done + i] = most_likely_hit(scene_, batch[i], of_batch.subspan(i * kSlots, kSlots));
      });
    }
  }

 private:
  std::unique_ptr<Tracer> all_hits_;
  SceneView scene_;
};

}  // namespace

std::unique_ptr<Tracer> make_soft_tracer(std::unique_ptr<Tracer> all_hits, const SceneView& scene) {
  return std::make_unique<SoftTracer>(std::move(all_hits), scene);
}

}  // namespace adasplats
