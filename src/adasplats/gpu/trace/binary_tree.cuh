// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/gpu/trace/wide_tree.h"
#include "adasplats/scene/intersect.h"

namespace adasplats::gpu {

// Private to gpu/trace: boxes, and the binary tree from which the wide tree is made.

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

/// A primitive without a finite box (non-finite values, zero normal) is never hit. A NaN would
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

/// The possible representations of a binary node and their costs (step 2): the area of the boxes of
/// all wide nodes below. The cost of primitives does not depend on the tree.
struct alignas(32) Choices {
  static constexpr int kMost = kWidth - 1;
  float cost[kMost];  ///< of representing the subtree by at most i + 1 nodes and primitives
  /// Three bits each, for i = 2 to 8: number for the left child (0: as for i - 1).
  std::uint32_t decisions;

  __device__ int left_share(int nodes) const {
    return static_cast<int>(decisions >> (3 * (nodes - 2)) & 7U);
  }
};
static_assert(sizeof(Choices) == 32);

/// The binary tree: primitives are nodes [0, primitives), inner nodes follow in order of creation,
/// children before parents.
struct BinaryTree {
  Box* boxes;
  Choices* choices;  ///< of inner nodes, by node - primitives
  uint2* children;   ///< of inner nodes, by node - primitives
  std::uint32_t primitives;

  __device__ bool is_primitive(std::uint32_t node) const { return node < primitives; }
};

/// Computes the costs of a pair from those of its children.
__device__ inline void choose(const BinaryTree& tree, std::uint32_t index, float area) {
  const uint2 pair = tree.children[index];
  const auto cost_of = [&](std::uint32_t node, int nodes) {
    return tree.is_primitive(node) ? 0.0F : tree.choices[node - tree.primitives].cost[nodes - 1];
  };
  Choices choices;
  choices.decisions = 0;
  float best[kWidth + 1];  // by the number of nodes that the two children share
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

}  // namespace adasplats::gpu
