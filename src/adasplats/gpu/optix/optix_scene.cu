// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/optix/optix_pipeline.h"
#include "adasplats/gpu/trace/device_scene.h"
#include "adasplats/scene/soft_disk.h"
#include "adasplats/trace/soft_hits.h"

namespace adasplats::gpu {
namespace {

/// A box for a primitive without one, which no ray hits: a single point.
__device__ optix::Box box_of(Vec3f low, Vec3f high) {
  if (!is_finite(low) || !is_finite(high)) return {{0, 0, 0}, {0, 0, 0}};
  return {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
}

__device__ optix::Box box_of(const Disk& disk) {
  const Vec3f half = disk_half_extent(disk);
  return box_of(disk.center - half, disk.center + half);
}

__device__ optix::Box box_of(const Triangle& triangle) {
  const Vec3f low = min(min(triangle.a, triangle.b), triangle.c);
  const Vec3f high = max(max(triangle.a, triangle.b), triangle.c);
  const Vec3f reach = max(max(low, -low), max(high, -high));
  const float margin = box_margin(fmaxf(reach.x, fmaxf(reach.y, reach.z)));
  return box_of(low - Vec3f{margin, margin, margin}, high + Vec3f{margin, margin, margin});
}

DeviceBuffer<TriangleRecord> triangle_records(const SceneView& scene, cudaStream_t stream) {
  std::vector<TriangleRecord> records(scene.triangle_count());
  for (std::size_t i = 0; i < records.size(); ++i) records[i].triangle = scene.mesh->triangle(i);
  return {std::span<const TriangleRecord>(records), stream};
}

__device__ optix::Box box_of(const DiskRecord& record) { return box_of(record.disk); }
__device__ optix::Box box_of(const TriangleRecord& record) { return box_of(record.triangle); }

template <class Record>
DeviceBuffer<optix::Box> boxes_of(const DeviceBuffer<Record>& records, cudaStream_t stream) {
  DeviceBuffer<optix::Box> boxes(records.size(), stream);
  for_each(records.size(), stream, "make boxes",
           [from = records.data(), to = boxes.data()] __device__(std::uint64_t i) {
             to[i] = box_of(from[i]);
           });
  return boxes;
}

DeviceBuffer<DiskRecord> disk_records(const SceneView& scene, cudaStream_t stream) {
  const DeviceBuffer<Disk> packed(scene.disks, stream);
  const DeviceBuffer<float> opacities(scene.opacities, stream);
  DeviceBuffer<DiskRecord> records(packed.size(), stream);
  for_each(packed.size(), stream, "copy the disks",
           [from = packed.data(), opacities = opacities.data(), soft = opacities.size() > 0,
            to = records.data()] __device__(std::uint64_t i) {
             to[i] = {from[i], soft ? opacities[i] : 1.0F};
           });
  return records;
}

/// The lists of all hits with soft disks, from ray `first` on, and where the most likely ones go.
struct SoftLists {
  RaySource source;
  std::uint64_t first;
  const Hit* lists;
  const DiskRecord* disks;
  std::uint32_t disk_count;
  Hit* hits;

  __device__ float opacity_at(const Ray& ray, Hit hit) const {
    if (hit.primitive >= disk_count) return kMaxOpacity;
    const DiskRecord& record = disks[hit.primitive];
    return opacity_of_hit(ray, hit.t, record.disk, record.opacity);
  }
  __device__ void operator()(std::uint64_t k) const {
    const Ray ray = ray_of(source, first + k);
    const std::uint64_t place = place_of_ray(source, first + k);
    const Hit* const list = lists + (place - first) * SoftHits::kMost;
    SoftHits soft;
    for (int i = 0; i < SoftHits::kMost && list[i].valid(); ++i)
      soft.offer(list[i], opacity_at(ray, list[i]));
    hits[place] = soft.most_likely();
  }
};

optix::DeviceAddress address(const void* memory) {
  return reinterpret_cast<optix::DeviceAddress>(memory);
}

/// Disks and triangles are custom primitives, not OptiX's triangles, so our intersection functions
/// decide and hits are bit-identical to the CPU. A margin of the boxes ensures that a box test in
/// single precision loses no hit. OptiX does not document its box test: our tests allow no
/// difference, but cards with RT cores have not been measured (docs/performance.md).
class OptixScene final : public DeviceScene {
 public:
  explicit OptixScene(const SceneView& scene)
      : pipeline_(stream_.get()),
        disks_(disk_records(scene, stream_.get())),
        triangles_(triangle_records(scene, stream_.get())),
        is_soft_(!scene.opacities.empty()) {
    if (scene.primitive_count() > 0) build();
    stream_.wait("build a scene for OptiX");
  }

  std::string_view name() const override { return "optix"; }

  void cast(const RaySource& source, std::uint64_t count, int depth, Hit* hits,
            cudaStream_t stream) const override {
    if (count == 0) return;
    if (depth == 1 && is_soft_) {
      cast_softly(source, count, hits, stream);
    } else if (depth == 1) {
      cast_to(source, 0, count, 1, hits, 0, stream);
    } else if (is_on_device(hits)) {
      cast_to(source, 0, count, static_cast<std::uint32_t>(depth), hits, 0, stream);
    } else {
      cast_to_host(source, count, static_cast<std::uint32_t>(depth), hits, stream);
    }
  }

 private:
  void build() {
    const auto disks = boxes_of(disks_, stream_.get());
    const auto triangles = boxes_of(triangles_, stream_.get());
    const std::array boxes = {address(disks.data()), address(triangles.data())};
    const std::array counts = {disks.size(), triangles.size()};
    // One set of flags per record: none of our programs is an any-hit program.
    constexpr unsigned kNoAnyHit = 1;
    std::vector<optix::BuildInput> inputs;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (counts[i] == 0) continue;
      optix::BuildInput& input = inputs.emplace_back();
      input.primitives.boxes = &boxes[i];
      input.primitives.count = static_cast<unsigned>(counts[i]);
      input.primitives.flags = &kNoAnyHit;
      input.primitives.first_index = i == 0 ? 0 : static_cast<unsigned>(counts[0]);
    }
    build(inputs);
  }

  void build(std::span<const optix::BuildInput> inputs) {
    const optix::Functions& optix = pipeline_.optix();
    const OptixLibrary& library = pipeline_.library();
    const auto input_count = static_cast<unsigned>(inputs.size());
    const optix::BuildOptions options;
    optix::BuildSizes sizes;
    library.check(
        optix.build_sizes(pipeline_.context(), &options, inputs.data(), input_count, &sizes),
        "plan a scene");
    const DeviceBuffer<std::byte> temporary(sizes.temporary, stream_.get());
    const DeviceBuffer<std::size_t> compacted_size(1, stream_.get());
    tree_ = {sizes.output, stream_.get()};
    const optix::EmittedProperty property = {address(compacted_size.data())};
    library.check(optix.build(pipeline_.context(), stream_.get(), &options, inputs.data(),
                              input_count, address(temporary.data()), temporary.bytes(),
                              address(tree_.data()), tree_.bytes(), &traversable_, &property, 1),
                  "build a scene");
    compact(compacted_size.download()[0]);
  }

  void compact(std::size_t bytes) {
    if (bytes >= tree_.bytes()) return;
    DeviceBuffer<std::byte> smaller(bytes, stream_.get());
    pipeline_.library().check(
        pipeline_.optix().compact(pipeline_.context(), stream_.get(), traversable_,
                                  address(smaller.data()), smaller.bytes(), &traversable_),
        "compact a scene");
    tree_ = std::move(smaller);
  }

  /// Casts rays [first, first + count) of the source. `hits` begins at `first_place`.
  void cast_to(const RaySource& source, std::uint64_t first, std::uint64_t count,
               std::uint32_t depth, Hit* hits, std::uint64_t first_place,
               cudaStream_t stream) const {
    OptixParams parameters;
    parameters.source = source;
    parameters.first_place = first_place;
    parameters.hits = hits;
    parameters.scene = traversable_;
    parameters.disks = disks_.data();
    parameters.triangles = triangles_.data();
    parameters.disk_count = static_cast<std::uint32_t>(disks_.size());
    parameters.depth = depth;
    const OptixQuery query = depth == 1 ? OptixQuery::nearest : OptixQuery::several;
    for (std::uint64_t done = 0; done < count; done += optix::kMaxLaunch) {
      parameters.first_ray = first + done;
      // Allocated in stream order: other casts may still be reading their parameters.
      const DeviceBuffer<OptixParams> there({&parameters, 1}, stream);
      pipeline_.launch(query, !disks_.empty(), there.data(),
                       std::min<std::uint64_t>(count - done, optix::kMaxLaunch), stream);
    }
  }

  static bool is_on_device(const Hit* hits) {
    cudaPointerAttributes attributes{};
    cuda_check(cudaPointerGetAttributes(&attributes, hits), "look at the memory for hits");
    return attributes.type == cudaMemoryTypeDevice;
  }

  /// Lists of hits are read and written often, so they are made in device memory, for a part of the
  /// rays at a time.
  void cast_to_host(const RaySource& source, std::uint64_t count, std::uint32_t depth, Hit* hits,
                    cudaStream_t stream) const {
    const std::uint64_t part = rays_at_once(source, count, depth);
    const DeviceBuffer<Hit> lists(part * depth, stream);
    for (std::uint64_t done = 0; done < count; done += part) {
      const std::uint64_t rays = std::min(part, count - done);
      cast_to(source, done, rays, depth, lists.data(), done, stream);
      cuda_check(cudaMemcpyAsync(hits + done * depth, lists.data(), rays * depth * sizeof(Hit),
                                 cudaMemcpyDefault, stream),
                 "copy hits from the GPU");
    }
  }

  /// The most likely hits (SoftHits).
  void cast_softly(const RaySource& source, std::uint64_t count, Hit* hits,
                   cudaStream_t stream) const {
    constexpr std::uint32_t kDepth = SoftHits::kMost;
    const std::uint64_t part = rays_at_once(source, count, kDepth);
    const DeviceBuffer<Hit> lists(part * kDepth, stream);
    const auto disk_count = static_cast<std::uint32_t>(disks_.size());
    for (std::uint64_t done = 0; done < count; done += part) {
      const std::uint64_t rays = std::min(part, count - done);
      cast_to(source, done, rays, kDepth, lists.data(), done, stream);
      for_each(rays, stream, "find the most likely hits",
               SoftLists{source, done, lists.data(), disks_.data(), disk_count, hits});
    }
  }

  /// Rays whose lists of hits fit into 128 MB. Complete scans: within a scan, the order of hits may
  /// differ from that of rays.
  static std::uint64_t rays_at_once(const RaySource& source, std::uint64_t count,
                                    std::uint32_t depth) {
    constexpr std::uint64_t kMaxHits = std::uint64_t{1} << 24U;
    const std::uint64_t scan = source.order == nullptr ? 1 : source.firing_count;
    return std::min(count, std::max<std::uint64_t>(kMaxHits / depth / scan, 1) * scan);
  }

  Stream stream_;  // of what the scene holds
  OptixPipeline pipeline_;
  DeviceBuffer<DiskRecord> disks_;
  DeviceBuffer<TriangleRecord> triangles_;
  bool is_soft_;
  DeviceBuffer<std::byte> tree_;
  optix::Traversable traversable_ = 0;  ///< 0, an empty scene: every ray misses
};

}  // namespace

std::unique_ptr<DeviceScene> make_optix_scene(const SceneView& scene) {
  if (scene.primitive_count() > optix::kMaxPrimitives) {
    throw Error(ErrorKind::data, "the scene has " + std::to_string(scene.primitive_count()) +
                                     " primitives and OptiX supports at most " +
                                     std::to_string(optix::kMaxPrimitives) + "; use `device` cuda");
  }
  return std::make_unique<OptixScene>(scene);
}

}  // namespace adasplats::gpu
