// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/trace/binary_tree.cuh"
#include "adasplats/gpu/trace/wide_nodes.cuh"
#include "adasplats/gpu/trace/wide_tree.h"

// Three steps, all on the device.
// 1. Clusters along a Morton curve join with the neighbour with which they have the smallest box,
//    pair by pair, until one is left (Meister and Bittner 2018, "Parallel locally-ordered
//    clustering for bounding volume hierarchy construction"). That is a binary tree.
// 2. While pairs join, the cheapest way to stand for a subtree by up to 7 nodes is kept for each
//    (Ylitie et al. 2017, section 3.1). That decides which binary nodes become wide ones.
// 3. From the root down, level by level, wide nodes are written.

namespace adasplats::gpu {
namespace {

/// Spreads the low 21 bits to every third bit.
__device__ inline std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}

constexpr int kPairBlock = 256;
constexpr int kMaxRadius = 64;

/// The neighbour on the curve with which a cluster has the smallest box, within `radius` places. Of
/// equal ones the one whose place has the fewest high bits in common: that order is the same seen
/// from both, so some pair always agrees, and equal boxes pair up all at once.
__global__ void __launch_bounds__(kPairBlock)
    nearest_cluster_kernel(const std::uint32_t* clusters, std::uint32_t count, const Box* boxes,
                           int radius, bool balanced, std::uint32_t* nearest) {
  __shared__ Box near[kPairBlock + 2 * kMaxRadius];
  const int block_first = static_cast<int>(blockIdx.x) * kPairBlock;
  const int first = block_first - radius;
  for (int k = static_cast<int>(threadIdx.x); k < kPairBlock + 2 * radius; k += kPairBlock) {
    const int place = first + k;
    if (place >= 0 && place < static_cast<int>(count)) near[k] = boxes[clusters[place]];
  }
  __syncthreads();
  const int place = block_first + static_cast<int>(threadIdx.x);
  if (place >= static_cast<int>(count)) return;
  const Box own = near[place - first];
  float best_area = HUGE_VALF;
  std::uint32_t best_mix = 0xffffffffU;
  std::uint32_t best = 0xffffffffU;
  const int begin = ::max(place - radius, 0);
  const int end = ::min(place + radius, static_cast<int>(count) - 1);
  for (int other = begin; other <= end; ++other) {
    if (other == place) continue;
    float area = balanced ? 0.0F : half_area(united(own, near[other - first]));
    if (!(area < HUGE_VALF)) area = HUGE_VALF;  // so far away that areas overflow: any will do
    const std::uint32_t mix = static_cast<std::uint32_t>(place) ^ static_cast<std::uint32_t>(other);
    if (area < best_area || (area == best_area && mix < best_mix)) {
      best_area = area;
      best_mix = mix;
      best = static_cast<std::uint32_t>(other);
    }
  }
  nearest[place] = best;
}

constexpr const char* kDoing = "build the ray tree on the GPU";

/// The box around `count` boxes, at least one. Which of them meet first changes nothing.
DeviceBuffer<Box> box_of_all(const Box* boxes, std::size_t count, cudaStream_t stream) {
  DeviceBuffer<Box> parts;
  for (const std::size_t threads : {std::size_t{65536}, std::size_t{256}, std::size_t{1}}) {
    DeviceBuffer<Box> fewer(threads, stream);
    for_each(threads, stream, kDoing, [=, to = fewer.data()] __device__(std::uint64_t i) {
      Box box = boxes[::min(std::size_t{i}, count - 1)];
      for (std::size_t k = i + threads; k < count; k += threads) box = united(box, boxes[k]);
      to[i] = box;
    });
    parts = std::move(fewer);
    boxes = parts.data();
    count = threads;
  }
  return parts;
}

/// Builds one tree. Everything is public because nvcc wants that where a function holds a lambda
/// for the device.
template <class Primitive, class Leaf>
struct Builder {
  Builder(const Primitive* primitives, std::size_t count, std::uint32_t first_primitive,
          const TreeOptions& options, cudaStream_t stream)
      : primitives_(primitives),
        given_(static_cast<std::uint32_t>(count)),
        first_primitive_(first_primitive),
        options_(options),
        stream_(stream) {
    if (count >= (std::size_t{1} << 31))
      throw Error(ErrorKind::data, "a scene of " + std::to_string(count) +
                                       " primitives; a GPU's tree takes 2^31 - 1 at most");
  }

  WideTree<Leaf> build() {
    sort_along_curve();
    if (count_ == 0) return {};
    WideTree<Leaf> tree = build_from(false);
    // A ray's stack takes two entries a level.
    const int most = (kStackEntries - 2) / 2 - options_.levels_above;
    if (tree.depth > most) tree = build_from(true);
    if (tree.depth > most)
      throw Error(ErrorKind::software, "a ray tree of " + std::to_string(tree.depth) + " levels");
    return tree;
  }

  /// Indices of the primitives that are there, along a Morton curve.
  void sort_along_curve() {
    const Primitive* primitives = primitives_;
    {
      DeviceBuffer<std::uint8_t> there(given_, stream_);
      for_each(given_, stream_, kDoing, [=, to = there.data()] __device__(std::uint64_t i) {
        to[i] = is_there(primitives[i]) ? 1 : 0;
      });
      ids_ = flagged(there.data(), given_, stream_);
    }
    count_ = static_cast<std::uint32_t>(ids_.size());
    if (count_ == 0) return;

    DeviceBuffer<Box> boxes(count_, stream_);
    const std::uint32_t* ids = ids_.data();
    Box* boxes_data = boxes.data();
    for_each(count_, stream_, kDoing,
             [=] __device__(std::uint64_t i) { boxes_data[i] = box_of(primitives[ids[i]]); });
    const DeviceBuffer<Box> whole = box_of_all(boxes_data, count_, stream_);
    DeviceBuffer<std::uint64_t> keys(count_, stream_);
    std::uint64_t* keys_data = keys.data();
    const Box* whole_data = whole.data();
    for_each(count_, stream_, kDoing, [=] __device__(std::uint64_t i) {
      const Vec3f size = whole_data->high - whole_data->low;
      const float side = fmaxf(fmaxf(size.x, size.y), fmaxf(size.z, 1e-30F));
      const Vec3f middle = 0.5F * (boxes_data[i].low + boxes_data[i].high) - whole_data->low;
      std::uint64_t key = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const float cell = fminf(fmaxf(middle[axis] / side * 2097151.0F, 0.0F), 2097151.0F);
        key |= spread(static_cast<std::uint64_t>(cell)) << (2 - axis);
      }
      keys_data[i] = key;
    });
    sort_pairs(keys, ids_, stream_, 0, 63);
  }

  WideTree<Leaf> build_from(bool balanced) {
    join(balanced);
    return widen();
  }

  /// Before every place, both counts in one sum: clusters that stay above, pairs that join below.
  void count_pairs(std::uint32_t clusters, const std::uint32_t* nearest, std::uint64_t* offsets) {
    for_each(clusters + 1, stream_, kDoing, [=] __device__(std::uint64_t i) {
      std::uint64_t flags = 0;
      if (i < clusters) {
        const std::uint32_t other = nearest[i];
        const bool agreed = nearest[other] == i;
        const bool first = agreed && i < other;
        flags = std::uint64_t{!agreed || first} << 32 | std::uint64_t{first};
      }
      offsets[i] = flags;
    });
    sum_in_place(offsets, clusters + 1, stream_);
  }

  /// Step 1 and 2.
  void join(bool balanced) {
    const std::uint32_t count = count_;
    boxes_ = DeviceBuffer<Box>(2 * std::size_t{count}, stream_);
    choices_ = DeviceBuffer<Choices>(count, stream_);
    children_ = DeviceBuffer<uint2>(count, stream_);
    tree_ = {boxes_.data(), choices_.data(), children_.data(), count};
    DeviceBuffer<std::uint32_t> clusters(count, stream_), next_clusters(count, stream_);
    DeviceBuffer<std::uint32_t> nearest(count, stream_);
    DeviceBuffer<std::uint64_t> offsets(count + 1, stream_);

    const BinaryTree tree = tree_;
    const Primitive* primitives = primitives_;
    const std::uint32_t* ids = ids_.data();
    std::uint32_t* clusters_data = clusters.data();
    for_each(count, stream_, kDoing, [=] __device__(std::uint64_t i) {
      tree.boxes[i] = box_of(primitives[ids[i]]);
      clusters_data[i] = static_cast<std::uint32_t>(i);
    });
    const int radius = std::min(std::max(options_.search_radius, 1), kMaxRadius);
    std::uint32_t made = 0;
    for (std::uint32_t left = count; left > 1;) {
      nearest_cluster_kernel<<<(left + kPairBlock - 1) / kPairBlock, kPairBlock, 0, stream_>>>(
          clusters.data(), left, boxes_.data(), radius, balanced, nearest.data());
      cuda_check(cudaGetLastError(), kDoing);
      count_pairs(left, nearest.data(), offsets.data());
      const std::uint32_t* nearest_data = nearest.data();
      const std::uint64_t* offsets_data = offsets.data();
      const std::uint32_t* from = clusters.data();
      std::uint32_t* to = next_clusters.data();
      for_each(left, stream_, kDoing, [=] __device__(std::uint64_t i) {
        const std::uint32_t other = nearest_data[i];
        const bool agreed = nearest_data[other] == i;
        if (agreed && other < i) return;  // the other one does it
        const auto place = static_cast<std::uint32_t>(offsets_data[i] >> 32);
        if (!agreed) {
          to[place] = from[i];
          return;
        }
        const std::uint32_t index = made + static_cast<std::uint32_t>(offsets_data[i]);
        const std::uint32_t node = tree.primitives + index;
        const uint2 pair = {from[i], from[other]};
        const Box box = united(tree.boxes[pair.x], tree.boxes[pair.y]);
        tree.children[index] = pair;
        tree.boxes[node] = box;
        choose(tree, index, half_area(box));
        to[place] = node;
      });
      const std::uint64_t sums = read_value(offsets.data() + left, stream_);
      left = static_cast<std::uint32_t>(sums >> 32);
      made += static_cast<std::uint32_t>(sums);
      std::swap(clusters, next_clusters);
    }
    root_ = count > 1 ? count + made - 1 : 0;
  }

  /// Step 3.
  WideTree<Leaf> widen() {
    WideTree<Leaf> tree;
    // Every wide node but the root has at least two children, so there are fewer than primitives.
    const std::size_t max_nodes = count_;
    DeviceBuffer<WideNode> nodes(max_nodes, stream_);
    tree.leaves = DeviceBuffer<Leaf>(count_, stream_);
    DeviceBuffer<Task> tasks(max_nodes, stream_), next_tasks(max_nodes, stream_);
    DeviceBuffer<Cursors> cursors(1, stream_);
    const Task first = {root_, 0};
    tasks.upload({&first, 1});
    Cursors state = {1, 0, 0};
    for (std::uint32_t count = 1; count > 0; ++tree.depth) {
      state.tasks = 0;
      cursors.upload({&state, 1});
      for_each(count, stream_, kDoing,
               WriteNode<Primitive, Leaf>{tree_, primitives_, ids_.data(), first_primitive_,
                                          tasks.data(), next_tasks.data(), cursors.data(),
                                          nodes.data(), tree.leaves.data()});
      state = read_value(cursors.data(), stream_);
      count = state.tasks;
      std::swap(tasks, next_tasks);
    }
    tree.node_count = state.nodes;
    tree.nodes = DeviceBuffer<WideNode>(tree.node_count, stream_);
    cuda_check(cudaMemcpyAsync(tree.nodes.data(), nodes.data(), tree.nodes.bytes(),
                               cudaMemcpyDeviceToDevice, stream_),
               kDoing);
    return tree;
  }

  const Primitive* primitives_;
  std::uint32_t given_;
  std::uint32_t first_primitive_;
  TreeOptions options_;
  cudaStream_t stream_;
  std::uint32_t count_ = 0;          ///< primitives that are there
  DeviceBuffer<std::uint32_t> ids_;  ///< of those, along the curve
  DeviceBuffer<Box> boxes_;
  DeviceBuffer<Choices> choices_;
  DeviceBuffer<uint2> children_;
  BinaryTree tree_{};
  std::uint32_t root_ = 0;
};

}  // namespace

WideTree<LeafDisk> build_tree(const Disk* disks, std::size_t count, const TreeOptions& options,
                              cudaStream_t stream) {
  return Builder<Disk, LeafDisk>(disks, count, 0, options, stream).build();
}

WideTree<LeafTriangle> build_tree(const Triangle* triangles, std::size_t count,
                                  std::uint32_t first_primitive, const TreeOptions& options,
                                  cudaStream_t stream) {
  return Builder<Triangle, LeafTriangle>(triangles, count, first_primitive, options, stream)
      .build();
}

}  // namespace adasplats::gpu
