// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
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

struct Box {
  Vec3f low, high;
};

__host__ __device__ inline Box united(const Box& a, const Box& b) {
  return {min(a.low, b.low), max(a.high, b.high)};
}
__host__ __device__ inline float half_area(const Box& box) {
  const Vec3f size = box.high - box.low;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

__device__ inline float largest_coordinate(const Box& box) {
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis)
    largest = fmaxf(largest, fmaxf(fabsf(box.low[axis]), fabsf(box.high[axis])));
  return largest;
}

__device__ inline Box box_of(const Disk& disk) {
  const Vec3f half = disk_half_extent(disk);
  return {disk.center - half, disk.center + half};
}
__device__ inline Box box_of(const Triangle& t) {
  const Box tight = {min(t.a, min(t.b, t.c)), max(t.a, max(t.b, t.c))};
  const float margin = box_margin(largest_coordinate(tight));
  return {tight.low - Vec3f{margin, margin, margin}, tight.high + Vec3f{margin, margin, margin}};
}

/// What has no finite box is never hit: values that are not finite, a normal of zero. One NaN would
/// spread to all boxes above it.
__device__ inline bool is_finite(const Box& box) {
  return adasplats::is_finite(box.low) && adasplats::is_finite(box.high);
}
__device__ inline bool is_there(const Disk& disk) {
  return disk.radius > 0.0F && is_finite(box_of(disk));
}
__device__ inline bool is_there(const Triangle& t) {
  return adasplats::is_finite(t.a) && adasplats::is_finite(t.b) && adasplats::is_finite(t.c) &&
         is_finite(box_of(t));
}

__device__ inline LeafDisk leaf_of(const Disk& disk, std::uint32_t primitive) {
  return {disk.center, disk.radius, disk.normal, primitive};
}
__device__ inline LeafTriangle leaf_of(const Triangle& triangle, std::uint32_t primitive) {
  return {triangle, primitive, {}};
}

/// Spreads the low 21 bits to every third bit.
__device__ inline std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}

/// The ways in which a binary node may be represented, and what they cost (step 2): the area of the
/// boxes of all wide nodes below. Primitives cost the same whatever the tree.
struct alignas(32) Choices {
  static constexpr int kMost = kWidth - 1;
  float cost[kMost];  ///< of standing for the subtree by at most i + 1 nodes and primitives
  /// Three bits each: how many of i = 2 to 8 go to the left child (0: as with one fewer).
  std::uint32_t decisions;

  __device__ int left_share(int nodes) const {
    return static_cast<int>(decisions >> (3 * (nodes - 2)) & 7U);
  }
};
static_assert(sizeof(Choices) == 32);

/// The binary tree: primitives are nodes [0, primitives), inner nodes follow in the order in which
/// they were made, children before parents.
struct BinaryTree {
  Box* boxes;
  Choices* choices;  ///< of inner nodes, by node - primitives
  uint2* children;   ///< of inner nodes, by node - primitives
  std::uint32_t primitives;

  __device__ bool is_primitive(std::uint32_t node) const { return node < primitives; }
};

/// Fills in the costs of a pair whose children are known.
__device__ inline void choose(const BinaryTree& tree, std::uint32_t index, float area) {
  const uint2 pair = tree.children[index];
  const auto cost_of = [&](std::uint32_t node, int nodes) {
    return tree.is_primitive(node) ? 0.0F : tree.choices[node - tree.primitives].cost[nodes - 1];
  };
  Choices choices;
  choices.decisions = 0;
  float best[kWidth + 1];  // by number of nodes that the two children share
  for (int nodes = 2; nodes <= kWidth; ++nodes) {
    best[nodes] = HUGE_VALF;
    std::uint32_t share = 0;
    for (int k = 1; k < nodes; ++k) {
      const float cost = cost_of(pair.x, k) + cost_of(pair.y, nodes - k);
      if (cost < best[nodes]) {
        best[nodes] = cost;
        share = static_cast<std::uint32_t>(k);
      }
    }
    choices.decisions |= share << (3 * (nodes - 2));
  }
  choices.cost[0] = best[kWidth] + area;
  for (int nodes = 2; nodes < kWidth; ++nodes) {
    const float fewer = choices.cost[nodes - 2];
    choices.cost[nodes - 1] = fminf(best[nodes], fewer);
    if (!(best[nodes] < fewer)) choices.decisions &= ~(7U << (3 * (nodes - 2)));
  }
  tree.choices[index] = choices;
}

constexpr int kPairBlock = 256;
constexpr int kMostRadius = 64;

/// The neighbour on the curve with which a cluster has the smallest box, within `radius` places. Of
/// equal ones the one whose place has the fewest high bits in common: that order is the same seen
/// from both, so some pair always agrees, and equal boxes pair up all at once.
__global__ void __launch_bounds__(kPairBlock)
    nearest_cluster_kernel(const std::uint32_t* clusters, std::uint32_t count, const Box* boxes,
                           int radius, bool balanced, std::uint32_t* nearest) {
  __shared__ Box near[kPairBlock + 2 * kMostRadius];
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
    if (2 * tree.depth + 2 > kStackEntries) tree = build_from(true);
    if (2 * tree.depth + 2 > kStackEntries)
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
    const int radius = std::min(std::max(options_.search_radius, 1), kMostRadius);
    std::uint32_t made = 0;
    for (std::uint32_t left = count; left > 1;) {
      nearest_cluster_kernel<<<(left + kPairBlock - 1) / kPairBlock, kPairBlock, 0, stream_>>>(
          clusters.data(), left, boxes_.data(), radius, balanced, nearest.data());
      cuda_check(cudaGetLastError(), kDoing);
      // Both counts in one sum: clusters that stay above, pairs that join below.
      const std::uint32_t* nearest_data = nearest.data();
      std::uint64_t* offsets_data = offsets.data();
      for_each(left + 1, stream_, kDoing, [=] __device__(std::uint64_t i) {
        std::uint64_t flags = 0;
        if (i < left) {
          const std::uint32_t other = nearest_data[i];
          const bool agreed = nearest_data[other] == i;
          const bool first = agreed && i < other;
          flags = std::uint64_t{!agreed || first} << 32 | std::uint64_t{first};
        }
        offsets_data[i] = flags;
      });
      sum_in_place(offsets_data, left + 1, stream_);
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

  WideTree<Leaf> widen();

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

/// The children of one wide node before they have slots.
struct Family {
  std::uint32_t nodes[kWidth];
  int size = 0;
};

/// Follows the decisions of step 2 from a node that becomes a wide one.
__device__ inline Family family_of(const BinaryTree& tree, std::uint32_t root) {
  Family family;
  if (tree.is_primitive(root)) {  // the whole scene is one primitive
    family.nodes[family.size++] = root;
    return family;
  }
  struct Part {
    std::uint32_t node;
    int nodes;  // that may stand for it
  };
  Part parts[kWidth];
  int size = 0;
  const auto open = [&](std::uint32_t node, int nodes) {
    const int left = tree.choices[node - tree.primitives].left_share(nodes);
    const uint2 pair = tree.children[node - tree.primitives];
    parts[size++] = {pair.y, nodes - left};
    parts[size++] = {pair.x, left};
  };
  open(root, kWidth);
  while (size > 0) {
    Part part = parts[--size];
    if (!tree.is_primitive(part.node)) {
      const Choices& choices = tree.choices[part.node - tree.primitives];
      while (part.nodes > 1 && choices.left_share(part.nodes) == 0) --part.nodes;
      if (part.nodes > 1) {
        open(part.node, part.nodes);
        continue;
      }
    }
    family.nodes[family.size++] = part.node;
  }
  return family;
}

/// Slot s holds what a ray meets first that goes along (s & 4 ? -x : +x, ...) as seen from the
/// middle: greedy assignment by how far each child lies in each of the eight directions.
__device__ inline void assign_slots(const Family& family, const Box* boxes, const Box& own,
                                    int (&slot_of)[kWidth]) {
  const Vec3f middle = own.low + own.high;
  float cost[kWidth][kWidth];
  for (int c = 0; c < family.size; ++c) {
    const Box& box = boxes[family.nodes[c]];
    const Vec3f d = box.low + box.high - middle;
    for (int s = 0; s < kWidth; ++s) {
      cost[c][s] =
          ((s & 4) != 0 ? -d.x : d.x) + ((s & 2) != 0 ? -d.y : d.y) + ((s & 1) != 0 ? -d.z : d.z);
    }
    slot_of[c] = -1;
  }
  unsigned used = 0;
  for (int round = 0; round < family.size; ++round) {
    float best = HUGE_VALF;
    int best_child = -1, best_slot = 0;
    for (int c = 0; c < family.size; ++c) {
      if (slot_of[c] >= 0) continue;
      for (int s = 0; s < kWidth; ++s) {
        if ((used >> s & 1U) == 0 && (best_child < 0 || cost[c][s] < best)) {
          best = cost[c][s];
          best_child = c;
          best_slot = s;
        }
      }
    }
    slot_of[best_child] = best_slot;
    used |= 1U << best_slot;
  }
}

/// Exponent of a node's grid along one axis: 255 cells of a power of two metres span its extent.
__device__ inline int grid_exponent(float low, float high) {
  const double extent = static_cast<double>(high) - static_cast<double>(low);
  int exponent = 0;
  frexp(extent / 255.0, &exponent);  // 2^exponent is larger
  return ldexp(255.0, exponent - 1) >= extent ? exponent - 1 : exponent;
}

/// What is to be written: a binary node and the place of its wide node.
struct Task {
  std::uint32_t node, place;
};

/// Numbers given out while a level is written.
struct Cursors {
  std::uint32_t nodes, primitives, tasks;
};

template <class Primitive, class Leaf>
WideTree<Leaf> Builder<Primitive, Leaf>::widen() {
  WideTree<Leaf> tree;
  // Every wide node but the root has at least two children, so there are fewer than primitives.
  const std::size_t most_nodes = count_;
  DeviceBuffer<WideNode> nodes(most_nodes, stream_);
  tree.leaves = DeviceBuffer<Leaf>(count_, stream_);
  DeviceBuffer<Task> tasks(most_nodes, stream_), next_tasks(most_nodes, stream_);
  DeviceBuffer<Cursors> cursors(1, stream_);
  const Task first = {root_, 0};
  tasks.upload({&first, 1});
  Cursors state = {1, 0, 0};

  const BinaryTree binary = tree_;
  const Primitive* primitives = primitives_;
  const std::uint32_t* ids = ids_.data();
  const std::uint32_t first_primitive = first_primitive_;
  WideNode* out = nodes.data();
  Leaf* leaves = tree.leaves.data();
  for (std::uint32_t count = 1; count > 0; ++tree.depth) {
    state.tasks = 0;
    cursors.upload({&state, 1});
    const Task* now = tasks.data();
    Task* next = next_tasks.data();
    Cursors* cursor = cursors.data();
    for_each(count, stream_, kDoing, [=] __device__(std::uint64_t i) {
      const Task task = now[i];
      const Family family = family_of(binary, task.node);
      const Box own = binary.boxes[task.node];
      int slot_of[kWidth];
      assign_slots(family, binary.boxes, own, slot_of);
      int child_in[kWidth];
      for (int& child : child_in) child = -1;
      std::uint32_t inner_count = 0;
      for (int c = 0; c < family.size; ++c) {
        child_in[slot_of[c]] = c;
        if (!binary.is_primitive(family.nodes[c])) ++inner_count;
      }
      const std::uint32_t leaf_count = static_cast<std::uint32_t>(family.size) - inner_count;
      WideNode node{};
      node.first_child = inner_count > 0 ? atomicAdd(&cursor->nodes, inner_count) : 0;
      node.first_primitive = leaf_count > 0 ? atomicAdd(&cursor->primitives, leaf_count) : 0;
      const std::uint32_t first_task = inner_count > 0 ? atomicAdd(&cursor->tasks, inner_count) : 0;
      double cells[3];
      for (int axis = 0; axis < 3; ++axis) {
        node.origin[axis] = own.low[axis];
        const int exponent = grid_exponent(own.low[axis], own.high[axis]);
        cells[axis] = ldexp(1.0, exponent);
        const auto cell = static_cast<float>(cells[axis]);
        node.scale[axis] = static_cast<std::uint16_t>(__float_as_uint(cell) >> 16);
      }
      std::uint32_t inner = 0, written = 0;
      for (int s = 0; s < kWidth; ++s) {
        const int c = child_in[s];
        if (c < 0) continue;
        const Box box = binary.boxes[family.nodes[c]];
        for (int axis = 0; axis < 3; ++axis) {
          // In double, where the differences of floats are all but exact: outward.
          const auto origin = static_cast<double>(own.low[axis]);
          const double low = floor((static_cast<double>(box.low[axis]) - origin) / cells[axis]);
          const double high = ceil((static_cast<double>(box.high[axis]) - origin) / cells[axis]);
          node.bounds[axis][0][s] = static_cast<std::uint8_t>(fmin(fmax(low, 0.0), 255.0));
          node.bounds[axis][1][s] = static_cast<std::uint8_t>(fmin(fmax(high, 0.0), 255.0));
        }
        if (binary.is_primitive(family.nodes[c])) {
          node.primitives = static_cast<std::uint8_t>(node.primitives | 1U << s);
          const std::uint32_t id = ids[family.nodes[c]];
          leaves[node.first_primitive + written] = leaf_of(primitives[id], first_primitive + id);
          ++written;
        } else {
          node.nodes = static_cast<std::uint8_t>(node.nodes | 1U << s);
          next[first_task + inner] = {family.nodes[c], node.first_child + inner};
          ++inner;
        }
      }
      out[task.place] = node;
    });
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
