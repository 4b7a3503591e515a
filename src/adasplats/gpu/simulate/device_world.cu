// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <unordered_map>

#include "adasplats/core/error.h"
#include "adasplats/gpu/simulate/device_world.h"
#include "adasplats/gpu/trace/wide_traversal.cuh"

namespace adasplats::gpu {
namespace {

constexpr unsigned kObjectBlock = 64;
constexpr int kMaxObjectHits = 64;

/// Loops over the objects one by one: neighbouring rays hit the same ones.
template <class Best>
__global__ void __launch_bounds__(kObjectBlock)
    add_object_hits_kernel(LaunchWorld world, RaySource source, std::uint64_t count, int depth,
                           Hit* hits) {
  const std::uint64_t i = std::uint64_t{blockIdx.x} * kObjectBlock + threadIdx.x;
  if (i >= count) return;
  const Quotient at = divide(i, source.firing_count);  // the scan, the firing
  const std::uint32_t first = world.first_objects[at.whole];
  const std::uint32_t behind = world.first_objects[at.whole + 1];
  if (first == behind) return;
  const Ray ray = ray_of(source, i);
  const float share = source.firings[at.rest].share;
  Hit* const of_ray = hits + place_of_ray(source, i) * static_cast<std::uint64_t>(depth);
  Best all(depth);
  for (int k = 0; k < depth; ++k)
    if (of_ray[k].valid()) all.offer(of_ray[k].t, of_ray[k].primitive);
  bool any = false;
  for (std::uint32_t k = first; k < behind; ++k) {
    const ObjectSighting& object = world.objects[k];
    ObjectRay local;
    if (!object_ray(object, world.knots, ray, share, local)) continue;
    const float reach =
        object_reach(static_cast<double>(all.reach(ray.t_max)), local.begin_m, object.scale);
    if (reach < local.ray.t_max) local.ray.t_max = reach;
    Best found(depth);
    cast_one<0>(world.trees[object.geometry], local.ray, found);
    found.for_each([&](Hit hit) {
      const Hit kept = scan_hit(hit, object, local.begin_m, ray);
      if (!kept.valid()) return;
      all.offer(kept.t, kept.primitive);
      any = true;
    });
  }
  if (any) all.store(of_ray, depth);
}

}  // namespace

DeviceWorld::DeviceWorld(const World& world)
    : world_(&world),
      identity_(world.identity()),
      stream_(std::make_shared<Stream>()),
      kept_(world.geometry_count()),
      held_(world.geometry_count()) {}

std::shared_ptr<const SceneTrees> DeviceWorld::trees(std::size_t geometry) {
  if (kept_[geometry]) return kept_[geometry];
  if (auto held = held_[geometry].lock()) return held;
  struct Owned {
    std::shared_ptr<Stream> stream;  // outlives the memory
    SceneTrees trees;
  };
  auto owned = std::make_shared<Owned>();
  owned->stream = stream_;
  owned->trees = build_scene_trees(world_->geometry_view(geometry), TreeOptions{}, stream_->get());
  const std::shared_ptr<const SceneTrees> built(owned, &owned->trees);
  if (world_->is_in_all_scans(geometry)) kept_[geometry] = built;
  held_[geometry] = built;
  return built;
}

template <class T>
void WorldObjects::Copied<T>::upload(std::span<const T> values, cudaStream_t stream) {
  if (host.size() < values.size()) {
    host = PinnedBuffer<T>(2 * values.size());
    device = DeviceBuffer<T>(2 * values.size(), stream);
  }
  std::copy(values.begin(), values.end(), host.data());
  device.upload(host.span().first(values.size()));
}

void WorldObjects::upload(const World& world, DeviceWorld& on_device,
                          std::span<const ScanMotion> motions, std::uint64_t first_number,
                          double scan_duration_s, cudaStream_t stream) {
  seen_.clear();
  std::vector<std::uint32_t> first_objects = {0};
  for (std::size_t i = 0; i < motions.size(); ++i) {
    world.sight(first_number + i, motions[i], scan_duration_s, seen_);
    first_objects.push_back(static_cast<std::uint32_t>(seen_.objects.size()));
  }
  std::vector<std::shared_ptr<const SceneTrees>> held;
  std::vector<TreesView> views;
  std::unordered_map<std::uint32_t, std::uint32_t> places;  // by geometry
  for (ObjectSighting& object : seen_.objects) {
    const auto [place, is_new] =
        places.emplace(object.geometry, static_cast<std::uint32_t>(views.size()));
    if (is_new) {
      held.push_back(on_device.trees(object.geometry));
      views.push_back(held.back()->view());
    }
    object.geometry = place->second;
  }
  held_ = std::move(held);
  if (seen_.objects.empty()) return;
  trees_.upload(std::span<const TreesView>(views), stream);
  objects_.upload(std::span<const ObjectSighting>(seen_.objects), stream);
  knots_.upload(std::span<const ObjectPose>(seen_.knots), stream);
  first_objects_.upload(std::span<const std::uint32_t>(first_objects), stream);
}

void WorldObjects::add_hits(const RaySource& source, std::uint64_t rays, int depth, Hit* hits,
                            cudaStream_t stream) const {
  if (seen_.objects.empty() || rays == 0) return;
  const LaunchWorld world = {trees_.device.data(), objects_.device.data(), knots_.device.data(),
                             first_objects_.device.data()};
  const auto blocks = static_cast<unsigned>((rays + kObjectBlock - 1) / kObjectBlock);
  if (depth == 1) {
    add_object_hits_kernel<NearestHit>
        <<<blocks, kObjectBlock, 0, stream>>>(world, source, rays, depth, hits);
  } else if (depth == 5) {
    add_object_hits_kernel<FewNearestHits<5>>
        <<<blocks, kObjectBlock, 0, stream>>>(world, source, rays, depth, hits);
  } else {
    add_object_hits_kernel<NearestHits<kMaxObjectHits>>
        <<<blocks, kObjectBlock, 0, stream>>>(world, source, rays, depth, hits);
  }
  cuda_check(cudaGetLastError(), "cast objects on the GPU");
}

}  // namespace adasplats::gpu
