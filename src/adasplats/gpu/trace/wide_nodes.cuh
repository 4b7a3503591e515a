// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/gpu/trace/binary_tree.cuh"

namespace adasplats::gpu {

// Private to gpu/trace: writes wide nodes (the last step of wide_tree_build.cu).

/// The children of one wide node before the assignment of slots.
struct Family {
  std::uint32_t nodes[kWidth];
  int size = 0;
};

/// Follows the decisions of step 2 from a node that becomes a wide node.
__device__ inline Family family_of(const BinaryTree& tree, std::uint32_t root) {
  Family family;
  if (tree.is_primitive(root)) {  // the whole scene is one primitive
    family.nodes[family.size++] = root;
    return family;
  }
  struct Part {
    std::uint32_t node;
    int nodes;  // maximum number that may represent it
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

/// Slot s holds the child that a ray along (s & 4 ? -x : +x, ...) meets first: greedy assignment by
/// the distance of each child from the centre in each of the eight directions.
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

/// A node to write: a binary node and the position of its wide node.
struct Task {
  std::uint32_t node, place;
};

/// Counters for the numbers assigned while a level is written.
struct Cursors {
  std::uint32_t nodes, primitives, tasks;
};

/// The node's grid: its origin, and cells of a power of two metres.
__device__ inline void set_grid(WideNode& node, const Box& own, double (&cells)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    node.origin[axis] = own.low[axis];
    cells[axis] = ldexp(1.0, grid_exponent(own.low[axis], own.high[axis]));
    const auto cell = static_cast<float>(cells[axis]);
    node.scale[axis] = static_cast<std::uint16_t>(__float_as_uint(cell) >> 16);
  }
}

/// The box of a child in cells of the node's grid, rounded outward.
__device__ inline void set_bounds(WideNode& node, int slot, const Box& own, const Box& box,
                                  const double (&cells)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    // In double, in which differences of floats are nearly exact.
    const auto origin = static_cast<double>(own.low[axis]);
    const double low = floor((static_cast<double>(box.low[axis]) - origin) / cells[axis]);
    const double high = ceil((static_cast<double>(box.high[axis]) - origin) / cells[axis]);
    node.bounds[axis][0][slot] = static_cast<std::uint8_t>(fmin(fmax(low, 0.0), 255.0));
    node.bounds[axis][1][slot] = static_cast<std::uint8_t>(fmin(fmax(high, 0.0), 255.0));
  }
}

/// Writes the wide node of one task of a level, its primitives, and the tasks of its children.
template <class Primitive, class Leaf>
struct WriteNode {
  BinaryTree binary;
  const Primitive* primitives;
  const std::uint32_t* ids;  ///< of the valid primitives
  std::uint32_t first_primitive;
  const Task* tasks;
  Task* next_tasks;
  Cursors* cursors;
  WideNode* nodes;
  Leaf* leaves;

  __device__ void operator()(std::uint64_t i) const {
    const Task task = tasks[i];
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
    node.first_child = inner_count > 0 ? atomicAdd(&cursors->nodes, inner_count) : 0;
    node.first_primitive = leaf_count > 0 ? atomicAdd(&cursors->primitives, leaf_count) : 0;
    const std::uint32_t first_task = inner_count > 0 ? atomicAdd(&cursors->tasks, inner_count) : 0;
    double cells[3];
    set_grid(node, own, cells);
    std::uint32_t inner = 0, written = 0;
    for (int slot = 0; slot < kWidth; ++slot) {
      if (child_in[slot] < 0) continue;
      const std::uint32_t child = family.nodes[child_in[slot]];
      set_bounds(node, slot, own, binary.boxes[child], cells);
      if (binary.is_primitive(child)) {
        node.primitives = static_cast<std::uint8_t>(node.primitives | 1U << slot);
        const std::uint32_t id = ids[child];
        leaves[node.first_primitive + written] = leaf_of(primitives[id], first_primitive + id);
        ++written;
      } else {
        node.nodes = static_cast<std::uint8_t>(node.nodes | 1U << slot);
        next_tasks[first_task + inner] = {child, node.first_child + inner};
        ++inner;
      }
    }
    nodes[task.place] = node;
  }
};

}  // namespace adasplats::gpu
