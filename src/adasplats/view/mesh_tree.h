// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/levels/level_tree.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// One triangle in the layout of the page (docs/viewer_protocol.md, "A layer's tree").
struct MeshElement {
  Vec3f corners[3];
  std::uint16_t class_id = 0;
  std::uint8_t intensity = 0;
  std::uint8_t error = 0;
};
static_assert(sizeof(MeshElement) == 40);

/// The triangles of a mesh in a tree like a LevelTree. Leaves have at most `kLeafSize` neighbouring
/// triangles. Inner nodes have none; their spacing is so large that the page always replaces them
/// by their children. Memory: 40 bytes per triangle.
class MeshTree {
 public:
  static constexpr std::size_t kLeafSize = 16'384;

  /// `shift` is added to the vertices to get the page's coordinates. `intensities`: one per
  /// triangle (0..1), or empty.
  MeshTree(const TriangleMesh& mesh, std::span<const float> intensities, Vec3d shift);

  std::span<const LevelNode> nodes() const { return nodes_; }
  /// Elements of node `n` (< nodes().size()).
  std::span<const MeshElement> elements(std::size_t n) const;
  std::size_t input_size() const { return elements_.size(); }

 private:
  struct Part;
  LevelNode node_of(const Part& part) const;
  std::vector<Part> split(const Part& part);

  std::vector<LevelNode> nodes_;
  std::vector<std::size_t> firsts_;  ///< first element of each node
  std::vector<MeshElement> elements_;
};

}  // namespace adasplats
