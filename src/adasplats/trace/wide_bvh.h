// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// Private to trace/: a tree with up to 16 children per node and up to 16 primitives per leaf, so
/// that one vector instruction (two with AVX2) tests all. Nodes of 8 were slower, with AVX-512 by a
/// fifth: most of the time of a visit is spent on choosing the next one.

inline constexpr unsigned kWide = 16;

/// A reference in the tree: to an inner node, or to up to 16 primitives of one kind.
struct WideRef {
  enum class Kind : std::uint32_t { node = 0, disks = 1, triangles = 2, nothing = 3 };
  std::uint32_t bits = 0xffffffffU;  ///< kind in the 2 highest bits, index below

  static WideRef to(Kind kind, std::size_t index) {
    return {static_cast<std::uint32_t>(kind) << 30 | static_cast<std::uint32_t>(index)};
  }
  Kind kind() const { return static_cast<Kind>(bits >> 30); }
  std::uint32_t index() const { return bits & 0x3fffffffU; }
};

/// Boxes of up to 16 children; missing ones have an inverted box. bounds[0] are the low ends,
/// bounds[1] the high ends: [end][axis][child].
struct alignas(64) WideNode {
  float bounds[2][3][kWide];
  WideRef children[kWide];
  /// Children from far to near for rays of each octant.
  std::uint8_t far_first[8][kWide];
};

/// Up to 16 disks in lanes; unused lanes have a negative squared radius and are never hit.
struct alignas(64) DiskBlock {
  float center[3][kWide];
  float normal[3][kWide];
  float radius2[kWide];  ///< rounded as in intersect_disk
  std::uint32_t primitive[kWide];
};

/// What a DiskBlock of soft disks has in addition.
struct alignas(64) SoftBlock {
  float radii_per_m[kWide];  ///< see radii_of_hit()
  float opacity[kWide];      ///< at the centre
};

/// Up to 16 triangles in lanes; unused lanes hold NaN and are never hit.
struct alignas(64) TriangleBlock {
  float corners[3][3][kWide];  ///< [corner][axis][lane]
  std::uint32_t primitive[kWide];
};

/// A view of a tree for traversal.
struct WideView {
  const WideNode* nodes = nullptr;
  const DiskBlock* disks = nullptr;
  const TriangleBlock* triangles = nullptr;
  WideRef root;
  float margin_m = 0.0F;
  bool has_unit_normals = true;
  const SoftBlock* soft = nullptr;  ///< of `disks`; null: disks are opaque
};

struct WideBvh {
  std::vector<WideNode> nodes;
  std::vector<DiskBlock> disks;
  std::vector<TriangleBlock> triangles;
  WideRef root;                  ///< `nothing` in an empty scene
  float margin_m = 0.0F;         ///< box_margin of the largest coordinate
  bool has_unit_normals = true;  ///< to 1e-5; else a disk is culled as a sphere
  std::vector<SoftBlock> soft;   ///< of `disks`, if the scene has opacities

  WideView view() const {
    return {nodes.data(), disks.data(),     triangles.data(), root,
            margin_m,     has_unit_normals, nullptr};
  }
  WideView soft_view() const {
    WideView view = this->view();
    view.soft = soft.data();
    return view;
  }
};

/// A child of a node with its box.
struct WideChild {
  Vec3f low, high;
  WideRef ref;
};

/// Makes the node of up to 16 children.
WideNode wide_node(std::span<const WideChild> children);

/// Builds the tree over the disks' exact boxes and the triangles' boxes, both with box_margin.
/// Primitives with NaN in their box can never be hit and are omitted. Splits use the surface area
/// heuristic with 16 bins; the tree is equal for any number of threads.
WideBvh build_wide_bvh(const SceneView& scene, const Executor& executor);

}  // namespace adasplats
