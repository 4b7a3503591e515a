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

/// Contains the rays of a warp.
struct RayCone {
  Vec3f apex, axis;
  float radius_m = 0;  ///< distance of the origins from the apex
  float cosine = 1, sine = 0;
  float reach_m = 0;
};

/// Around one of the warp's rays, as neighbouring rays have similar directions. `reach_m`: beyond
/// it, hits of this ray do not count.
__device__ RayCone cone_of_warp(const Ray& ray, float reach_m) {
  constexpr int kMiddle = 8;
  const auto of_middle = [](Vec3f v) {
    return Vec3f{__shfl_sync(~0U, v.x, kMiddle), __shfl_sync(~0U, v.y, kMiddle),
                 __shfl_sync(~0U, v.z, kMiddle)};
  };
  RayCone cone;
  cone.apex = of_middle(ray.origin);
  cone.axis = of_middle(ray.direction);
  const Vec3f away = ray.origin - cone.apex;
  cone.radius_m = sqrtf(dot(away, away));
  cone.cosine = dot(cone.axis, ray.direction);
  cone.reach_m = reach_m;
  for (int step = 16; step > 0; step /= 2) {
    cone.radius_m = fmaxf(cone.radius_m, __shfl_xor_sync(~0U, cone.radius_m, step));
    cone.cosine = fminf(cone.cosine, __shfl_xor_sync(~0U, cone.cosine, step));
    cone.reach_m = fmaxf(cone.reach_m, __shfl_xor_sync(~0U, cone.reach_m, step));
  }
  cone.sine = sqrtf(fmaxf(0.0F, 1 - cone.cosine * cone.cosine));
  return cone;
}

/// Whether a ray of the cone may meet the sphere; true if unsure.
__device__ bool may_meet(const RayCone& cone, Vec3f center, float radius_m) {
  const Vec3f to_center = center - cone.apex;
  const float distance_m = sqrtf(dot(to_center, to_center));
  constexpr float kRounding = 1e-3F;
  const float near_m = radius_m + cone.radius_m + kRounding * (1 + distance_m);
  if (distance_m - near_m > cone.reach_m) return false;
  if (!(cone.cosine > 0)) return true;
  const float along_m = dot(to_center, cone.axis);
  const Vec3f beside = to_center - along_m * cone.axis;
  return !(sqrtf(dot(beside, beside)) * cone.cosine - along_m * cone.sine > near_m);
}

/// One scan in a row of blocks. The lanes of a warp find the objects that one of its rays may meet;
/// then each ray meets these one by one, as neighbouring rays hit the same ones.
template <class Best>
__global__ void __launch_bounds__(kObjectBlock)
    add_object_hits_kernel(LaunchWorld world, RaySource source, int depth, Hit* hits) {
  const std::uint32_t first = world.first_objects[blockIdx.y];
  const std::uint32_t behind = world.first_objects[blockIdx.y + 1];
  if (first == behind) return;
  const std::uint32_t thread = blockIdx.x * kObjectBlock + threadIdx.x;
  const bool is_used = thread < source.firing_count;
  const std::uint32_t firing = is_used ? thread : source.firing_count - 1;
  const std::uint64_t i = std::uint64_t{blockIdx.y} * source.firing_count + firing;
  const Ray ray = ray_of(source, i);
  const float share = source.firings[firing].share;
  Hit* const of_ray = hits + place_of_ray(source, i) * static_cast<std::uint64_t>(depth);
  Best all(depth);
  for (int k = 0; k < depth; ++k)
    if (of_ray[k].valid()) all.offer(of_ray[k].t, of_ray[k].primitive);
  const RayCone cone = cone_of_warp(ray, all.reach(ray.t_max));
  bool any = false;
  const auto meet = [&](const ObjectSighting& object) {
    const auto reach_m = static_cast<double>(all.reach(ray.t_max));
    ObjectRay local;
    if (!object_ray(object, world.knots, ray, share, reach_m, local)) return;
    Best found(depth);
    cast_one<0>(world.trees[object.geometry], local.ray, found);
    found.for_each([&](Hit hit) {
      const Hit kept = scan_hit(hit, object, local.begin_m, ray);
      if (!kept.valid()) return;
      all.offer(kept.t, kept.primitive);
      any = true;
    });
  };
  const std::uint32_t lane = threadIdx.x % 32;
  for (std::uint32_t group = first; group < behind; group += 32) {
    bool may = false;
    if (group + lane < behind) {
      const ObjectSighting& object = world.objects[group + lane];
      may = may_meet(cone, vec_cast<float>(object.center), static_cast<float>(object.radius_m));
    }
    for (unsigned left = __ballot_sync(~0U, may); left != 0; left &= left - 1)
      if (is_used)
        meet(world.objects[group + static_cast<std::uint32_t>(__ffs(static_cast<int>(left))) - 1]);
    __syncwarp();
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
void WorldObjects::Copied<T>::resize(std::size_t values, cudaStream_t stream) {
  size = values;
  if (host.size() >= size) return;
  host = PinnedBuffer<T>(2 * size);
  device = DeviceBuffer<T>(2 * size, stream);
}

/// Changes the geometry of each object to its index among those of the launch.
void WorldObjects::find_trees(DeviceWorld& on_device, cudaStream_t stream) {
  std::vector<std::shared_ptr<const SceneTrees>> held;
  std::unordered_map<std::uint32_t, std::uint32_t> places;  // by geometry
  for (ObjectSightings& scan : seen_) {
    for (ObjectSighting& object : scan.objects) {
      const auto [place, is_new] =
          places.emplace(object.geometry, static_cast<std::uint32_t>(held.size()));
      if (is_new) held.push_back(on_device.trees(object.geometry));
      object.geometry = place->second;
    }
  }
  held_ = std::move(held);
  trees_.resize(held_.size(), stream);
  for (std::size_t i = 0; i < held_.size(); ++i) trees_.host.data()[i] = held_[i]->view();
}

void WorldObjects::upload(const World& world, DeviceWorld& on_device,
                          std::span<const ScanMotion> motions, std::uint64_t first_number,
                          double scan_duration_s, const Executor& executor, cudaStream_t stream) {
  seen_.resize(motions.size());
  executor.for_chunks(motions.size(), 1, [&](std::size_t i, std::size_t) {
    world.sight(first_number + i, motions[i], scan_duration_s, seen_[i]);
  });
  first_objects_.resize(motions.size() + 1, stream);
  std::vector<std::uint32_t> first_knots = {0};
  std::uint32_t objects = 0;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    first_objects_.host.data()[i] = objects;
    objects += static_cast<std::uint32_t>(seen_[i].objects.size());
    first_knots.push_back(first_knots.back() + static_cast<std::uint32_t>(seen_[i].knots.size()));
  }
  first_objects_.host.data()[motions.size()] = objects;
  objects_.resize(objects, stream);
  knots_.resize(first_knots.back(), stream);
  find_trees(on_device, stream);
  if (objects == 0) return;
  executor.for_chunks(motions.size(), 1, [&](std::size_t i, std::size_t) {
    std::ranges::copy(seen_[i].knots, knots_.host.data() + first_knots[i]);
    ObjectSighting* to = objects_.host.data() + first_objects_.host.data()[i];
    for (ObjectSighting object : seen_[i].objects) {
      object.first_knot += first_knots[i];
      *to++ = object;
    }
  });
  trees_.upload();
  objects_.upload();
  knots_.upload();
  first_objects_.upload();
}

void WorldObjects::add_hits(const RaySource& source, int depth, Hit* hits,
                            cudaStream_t stream) const {
  if (objects_.size == 0 || source.firing_count == 0) return;
  const LaunchWorld world = {trees_.device.data(), objects_.device.data(), knots_.device.data(),
                             first_objects_.device.data()};
  const dim3 blocks((source.firing_count + kObjectBlock - 1) / kObjectBlock,
                    static_cast<unsigned>(seen_.size()));
  if (depth == 1) {
    add_object_hits_kernel<NearestHit>
        <<<blocks, kObjectBlock, 0, stream>>>(world, source, depth, hits);
  } else if (depth == 5) {
    add_object_hits_kernel<FewNearestHits<5>>
        <<<blocks, kObjectBlock, 0, stream>>>(world, source, depth, hits);
  } else {
    add_object_hits_kernel<NearestHits<kMaxObjectHits>>
        <<<blocks, kObjectBlock, 0, stream>>>(world, source, depth, hits);
  }
  cuda_check(cudaGetLastError(), "cast objects on the GPU");
}

}  // namespace adasplats::gpu
