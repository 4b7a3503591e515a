// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/trace/gpu_tracer.h"

#include <algorithm>
#include <array>
#include <mutex>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/trace/hit_list.h"

namespace adasplats::gpu {
namespace {

constexpr std::size_t kRaysAtOnce = std::size_t{1} << 19;
constexpr std::size_t kHitsAtOnce = std::size_t{1} << 22;

/// One of two batches in progress.
struct Slot {
  Stream stream;
  PinnedBuffer<Ray> rays;
  PinnedBuffer<Hit> hits;
  DeviceBuffer<Ray> device_rays;
  DeviceBuffer<Hit> device_hits;
  std::size_t first = 0, count = 0;

  void reserve(std::size_t max_rays, std::size_t max_hits) {
    if (rays.size() < max_rays) {
      rays = PinnedBuffer<Ray>(max_rays);
      device_rays = DeviceBuffer<Ray>(max_rays, stream.get());
    }
    if (hits.size() < max_hits) {
      hits = PinnedBuffer<Hit>(max_hits);
      device_hits = DeviceBuffer<Hit>(max_hits, stream.get());
    }
  }
};

class GpuTracer final : public Tracer {
 public:
  GpuTracer(const DeviceScene& scene, int device) : scene_(scene), device_(device) {
    const DeviceGuard guard(device);
    for (auto& slot : slots_) slot = std::make_unique<Slot>();
  }
  ~GpuTracer() override {
    const DeviceGuard guard(device_);
    for (auto& slot : slots_) slot.reset();
  }

  std::string_view name() const override { return scene_.name(); }

  void nearest(std::span<const Ray> rays, std::span<Hit> hits,
               const Executor& executor) const override {
    nearest_hits(rays, 1, hits, executor);
  }

  void nearest_hits(std::span<const Ray> rays, int depth, std::span<Hit> hits,
                    const Executor& executor) const override {
    clear_hits(rays, depth, hits);
    const std::scoped_lock lock(mutex_);
    const DeviceGuard guard(device_);
    const auto slots = static_cast<std::size_t>(depth);
    const std::size_t batch =
        std::min(rays.size(), std::min(kRaysAtOnce, std::max<std::size_t>(1, kHitsAtOnce / slots)));
    for (auto& slot : slots_) {
      slot->count = 0;
      slot->reserve(batch, batch * slots);
    }
    std::size_t turn = 0;
    for (std::size_t first = 0; first < rays.size(); first += batch, turn ^= 1U) {
      Slot& slot = *slots_[turn];
      take(slot, slots, hits, executor);
      launch(slot, rays, first, std::min(batch, rays.size() - first), depth, executor);
    }
    take(*slots_[turn], slots, hits, executor);
    take(*slots_[turn ^ 1U], slots, hits, executor);
  }

 private:
  void launch(Slot& slot, std::span<const Ray> rays, std::size_t first, std::size_t count,
              int depth, const Executor& executor) const {
    slot.first = first;
    slot.count = count;
    executor.for_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
      std::copy(rays.begin() + static_cast<std::ptrdiff_t>(first + begin),
                rays.begin() + static_cast<std::ptrdiff_t>(first + end), slot.rays.data() + begin);
    });
    const std::size_t hit_count = count * static_cast<std::size_t>(depth);
    slot.device_rays.upload(slot.rays.span().first(count));
    RaySource source;
    source.rays = slot.device_rays.data();
    scene_.cast(source, count, depth, slot.device_hits.data(), slot.stream.get());
    cuda_check(cudaMemcpyAsync(slot.hits.data(), slot.device_hits.data(), hit_count * sizeof(Hit),
                               cudaMemcpyDeviceToHost, slot.stream.get()),
               "copy the hits from the GPU");
  }

  /// Waits for the batch of a slot and returns its hits.
  static void take(Slot& slot, std::size_t slots, std::span<Hit> hits, const Executor& executor) {
    if (slot.count == 0) return;
    slot.stream.wait("cast rays on the GPU");
    const auto target = hits.subspan(slot.first * slots, slot.count * slots);
    executor.for_chunks(target.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      std::copy(slot.hits.data() + begin, slot.hits.data() + end,
                target.begin() + static_cast<std::ptrdiff_t>(begin));
    });
    slot.count = 0;
  }

  const DeviceScene& scene_;
  int device_;
  mutable std::mutex mutex_;
  std::array<std::unique_ptr<Slot>, 2> slots_;
};

}  // namespace

std::unique_ptr<Tracer> make_gpu_tracer(const DeviceScene& scene, int device) {
  return std::make_unique<GpuTracer>(scene, device);
}

}  // namespace adasplats::gpu
#endif
