// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/trace/cuda_scene.h"
#include "adasplats/gpu/trace/scene_trees.h"
#include "adasplats/gpu/trace/wide_traversal.cuh"
#include "adasplats/scene/soft_disk.h"
#include "adasplats/trace/soft_hits.h"

namespace adasplats::gpu {
namespace {

/// Small blocks: a slow ray delays few others.
constexpr unsigned kCastBlock = 64;
/// Blocks on an SM, which bounds the registers of a ray.
constexpr unsigned kMinBlocks = 18;
/// Percentage of a warp's rays that must have primitives to test; below it, these wait. On an H100,
/// 10 traces 1.3 times as many scans as 0.
constexpr int kPostpone = 10;
constexpr int kMaxHits = 64;

/// The same for launches of fewer rays than kSmallLaunch: more registers and a slightly higher
/// percentage make each ray faster.
constexpr unsigned kMinBlocksOfSmall = 12;
constexpr int kPostponeInSmall = 20;

/// As many blocks as fit: an SM of Turing runs 1024 threads.
constexpr unsigned fitting(unsigned blocks) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ < 800
  return blocks < 1024 / kCastBlock ? blocks : 1024 / kCastBlock;
#else
  return blocks;
#endif
}

template <int kWait, unsigned kBlocks, Sensors kSensors>
__global__ void __launch_bounds__(kCastBlock, fitting(kBlocks))
    cast_nearest_kernel(TreesView trees, RaySource source, std::uint64_t count, Hit* hits) {
  const std::uint64_t i = std::uint64_t{blockIdx.x} * kCastBlock + threadIdx.x;
  if (i >= count) return;
  NearestHit best;
  cast_one<kWait>(trees, ray_of<kSensors>(source, i), best);
  best.store(hits + place_of_ray(source, i), 1);
}

template <class Best>
__global__ void __launch_bounds__(kCastBlock)
    cast_hits_kernel(TreesView trees, RaySource source, std::uint64_t count, int depth, Hit* hits) {
  const std::uint64_t i = std::uint64_t{blockIdx.x} * kCastBlock + threadIdx.x;
  if (i >= count) return;
  Best best(depth);
  cast_one<kPostpone>(trees, ray_of(source, i), best);
  best.store(hits + place_of_ray(source, i) * static_cast<std::uint64_t>(depth), depth);
}

/// Keeps the hits that decide where a ray most likely ends.
class LikelyHit {
 public:
  __device__ LikelyHit(const float* opacities, const Ray& ray) : opacities_(opacities), ray_(ray) {}

  __device__ float reach(float t_max) const { return hits_.reach(t_max); }
  __device__ void offer(float t, std::uint32_t primitive, const LeafDisk* leaves,
                        std::uint32_t place) {
    const float4 at = __ldg(reinterpret_cast<const float4*>(leaves + place));
    const Disk disk = {{at.x, at.y, at.z}, at.w, {}};
    hits_.offer({t, primitive}, opacity_of_hit(ray_, t, disk, __ldg(opacities_ + place)));
  }
  __device__ void offer(float t, std::uint32_t primitive, const LeafTriangle*, std::uint32_t) {
    hits_.offer({t, primitive}, kMaxOpacity);
  }
  __device__ Hit most_likely() const { return hits_.most_likely(); }

 private:
  const float* opacities_;
  Ray ray_;
  SoftHits hits_;
};

/// The opacities of the leaves of a tree of disks, in their order.
DeviceBuffer<float> opacities_of_leaves(const WideTree<LeafDisk>& tree,
                                        std::span<const float> opacities, cudaStream_t stream) {
  const DeviceBuffer<float> by_disk(opacities, stream);
  DeviceBuffer<float> of_leaves(tree.leaves.size(), stream);
  for_each(tree.leaves.size(), stream, "order opacities",
           [leaves = tree.leaves.data(), from = by_disk.data(), count = by_disk.size(),
            to = of_leaves.data()] __device__(std::uint64_t i) {
             to[i] = leaves[i].primitive < count ? from[leaves[i].primitive] : 0.0F;
           });
  return of_leaves;
}

__global__ void __launch_bounds__(kCastBlock)
    cast_likely_kernel(TreesView trees, RaySource source, std::uint64_t count, Hit* hits) {
  const std::uint64_t i = std::uint64_t{blockIdx.x} * kCastBlock + threadIdx.x;
  if (i >= count) return;
  const Ray ray = ray_of(source, i);
  LikelyHit best(trees.opacities, ray);
  cast_one<kPostpone>(trees, ray, best);
  hits[place_of_ray(source, i)] = best.most_likely();
}

template <Sensors kSensors>
void launch_nearest(unsigned blocks, const TreesView& trees, const RaySource& source,
                    std::uint64_t count, Hit* hits, cudaStream_t stream) {
  if (count < kSmallLaunch) {
    cast_nearest_kernel<kPostponeInSmall, kMinBlocksOfSmall, kSensors>
        <<<blocks, kCastBlock, 0, stream>>>(trees, source, count, hits);
  } else {
    cast_nearest_kernel<kPostpone, kMinBlocks, kSensors>
        <<<blocks, kCastBlock, 0, stream>>>(trees, source, count, hits);
  }
}

void launch_few(int depth, unsigned blocks, const TreesView& trees, const RaySource& source,
                std::uint64_t count, Hit* hits, cudaStream_t stream) {
  switch (depth) {
    case 2:
      cast_hits_kernel<FewNearestHits<2>>
          <<<blocks, kCastBlock, 0, stream>>>(trees, source, count, depth, hits);
      break;
    case 3:
      cast_hits_kernel<FewNearestHits<3>>
          <<<blocks, kCastBlock, 0, stream>>>(trees, source, count, depth, hits);
      break;
    case 4:
      cast_hits_kernel<FewNearestHits<4>>
          <<<blocks, kCastBlock, 0, stream>>>(trees, source, count, depth, hits);
      break;
    default:
      cast_hits_kernel<FewNearestHits<5>>
          <<<blocks, kCastBlock, 0, stream>>>(trees, source, count, depth, hits);
  }
}

class CudaScene final : public DeviceScene {
 public:
  CudaScene(const SceneView& scene, const TreeOptions& options)
      : stream_(std::in_place), trees_(build_scene_trees(scene, options, stream_->get())) {}
  CudaScene(const Disk* disks, std::size_t count, cudaStream_t stream)
      : trees_{build_tree(disks, count, TreeOptions{}, stream), {}, {}} {}

  std::string_view name() const override { return "cuda"; }

  void cast(const RaySource& source, std::uint64_t count, int depth, Hit* hits,
            cudaStream_t stream) const override {
    cast_trees(trees_.view(), source, count, depth, hits, stream);
  }

 private:
  std::optional<Stream> stream_;  ///< of the memory of the trees, if the scene owns it
  SceneTrees trees_;
};

}  // namespace

void cast_trees(const TreesView& trees, const RaySource& source, std::uint64_t count, int depth,
                Hit* hits, cudaStream_t stream) {
  // One grid holds 2^31 - 1 blocks.
  constexpr std::uint64_t kMaxBlocks = 0x7fffffffU;
  if (count > kMaxBlocks * kCastBlock) throw Error(ErrorKind::data, "the launch has too many rays");
  if (count == 0) return;
  const auto blocks = static_cast<unsigned>((count + kCastBlock - 1) / kCastBlock);
  const bool still = source.first_poses == nullptr;
  if (depth == 1 && trees.opacities != nullptr) {
    cast_likely_kernel<<<blocks, kCastBlock, 0, stream>>>(trees, source, count, hits);
  } else if (depth == 1 && still) {
    launch_nearest<Sensors::still>(blocks, trees, source, count, hits, stream);
  } else if (depth == 1) {
    launch_nearest<Sensors::may_move>(blocks, trees, source, count, hits, stream);
  } else if (depth <= 5) {
    launch_few(depth, blocks, trees, source, count, hits, stream);
  } else if (depth <= kMaxHits) {
    cast_hits_kernel<NearestHits<kMaxHits>>
        <<<blocks, kCastBlock, 0, stream>>>(trees, source, count, depth, hits);
  } else {
    throw Error(ErrorKind::usage, std::to_string(depth) +
                                      " hits per ray exceed the limit of a GPU (" +
                                      std::to_string(kMaxHits) + ")");
  }
  cuda_check(cudaGetLastError(), "cast rays on the GPU");
}

SceneTrees build_scene_trees(const SceneView& scene, const TreeOptions& options,
                             cudaStream_t stream) {
  if (scene.primitive_count() >= Hit::kNone)
    throw Error(ErrorKind::data, "the scene has " + std::to_string(scene.primitive_count()) +
                                     " primitives; a GPU supports at most 2^32 - 2");
  SceneTrees trees;
  if (!scene.disks.empty()) {
    const DeviceBuffer<Disk> disks(scene.disks, stream);
    trees.disks = build_tree(disks.data(), disks.size(), options, stream);
    if (!scene.opacities.empty())
      trees.opacities = opacities_of_leaves(trees.disks, scene.opacities, stream);
  }
  if (scene.triangle_count() > 0) {
    std::vector<Triangle> corners(scene.triangle_count());
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = scene.mesh->triangle(i);
    const DeviceBuffer<Triangle> triangles(std::span<const Triangle>(corners), stream);
    trees.triangles = build_tree(triangles.data(), triangles.size(),
                                 static_cast<std::uint32_t>(scene.disk_count()), options, stream);
  }
  cuda_check(cudaStreamSynchronize(stream), "build the ray tree on the GPU");
  return trees;
}

std::unique_ptr<DeviceScene> make_cuda_scene(const SceneView& scene) {
  return make_cuda_scene(scene, TreeOptions{});
}

std::unique_ptr<DeviceScene> make_cuda_scene(const SceneView& scene, const TreeOptions& options) {
  return std::make_unique<CudaScene>(scene, options);
}

std::unique_ptr<DeviceScene> make_cuda_scene_of_device_disks(const Disk* disks, std::size_t count,
                                                             cudaStream_t stream) {
  return std::make_unique<CudaScene>(disks, count, stream);
}

}  // namespace adasplats::gpu
