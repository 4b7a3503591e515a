// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/scene/intersect.h"

namespace adasplats::gpu {

/// Private to gpu/: an 8-wide tree of boxes with 80 bytes a node. After Ylitie, Karras and Laine
/// 2017, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs": boxes of
/// children are bytes in a grid of the node; children are in the order in which a ray of a given
/// octant meets them. Unlike in the paper, a child is a node or a single primitive: disks are small
/// and do not fill a common box, and a box test costs a quarter of a disk test.
struct alignas(16) WideNode {
  float origin[3];                ///< low corner of the grid, m
  std::uint32_t first_child;      ///< nodes among the children are consecutive from here...
  std::uint32_t first_primitive;  ///< ...and primitives from here, both in the order of slots
  /// Upper halves of floats: cell sizes of the grid along the axes, m.
  std::uint16_t scale[3];
  std::uint8_t nodes;       ///< bit s: the child in slot s is a node
  std::uint8_t primitives;  ///< bit s: it is a primitive
  std::uint32_t unused;
  /// Of the children in cells of the grid, by axis: lower bounds, upper bounds.
  std::uint8_t bounds[3][2][8];
};
static_assert(sizeof(WideNode) == 80);
inline constexpr int kWidth = 8;

/// A disk in a leaf: two 16-byte loads.
struct alignas(16) LeafDisk {
  Vec3f center;
  float radius;
  Vec3f normal;
  std::uint32_t primitive;  ///< index in the scene
};
static_assert(sizeof(LeafDisk) == 32);

/// A triangle in a leaf: three 16-byte loads.
struct alignas(16) LeafTriangle {
  Triangle triangle;
  std::uint32_t primitive;
  float unused[2];
};
static_assert(sizeof(LeafTriangle) == 48);

/// Kernel view of a tree; empty without nodes.
template <class Leaf>
struct TreeView {
  const WideNode* nodes = nullptr;
  const Leaf* leaves = nullptr;
};

/// Options of the tree construction.
struct TreeOptions {
  int search_radius = 12;  ///< neighbours along the curve that a cluster may join with, up to 64
  int levels_above = 0;    ///< of another tree that its root is to stand in
};

template <class Leaf>
struct WideTree {
  DeviceBuffer<WideNode> nodes;
  DeviceBuffer<Leaf> leaves;
  std::size_t node_count = 0;
  int depth = 0;

  TreeView<Leaf> view() const { return {node_count == 0 ? nullptr : nodes.data(), leaves.data()}; }
};

/// Builds the tree of some disks on the device that `disks` is on. Those with no radius are left
/// out. Primitive i is disk i.
WideTree<LeafDisk> build_tree(const Disk* disks, std::size_t count, const TreeOptions& options,
                              cudaStream_t stream);

/// The same for triangles; primitive numbers begin with `first_primitive`.
WideTree<LeafTriangle> build_tree(const Triangle* triangles, std::size_t count,
                                  std::uint32_t first_primitive, const TreeOptions& options,
                                  cudaStream_t stream);

/// Entries of a ray's stack; deeper trees are built anew, balanced.
inline constexpr int kStackEntries = 64;

}  // namespace adasplats::gpu
