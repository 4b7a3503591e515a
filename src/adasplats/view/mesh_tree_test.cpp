// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/mesh_tree.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <vector>

namespace adasplats {
namespace {

/// Squares of two triangles each along x; the class of a triangle is its number, modulo 60,000.
TriangleMesh strip(std::uint32_t squares) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= squares; ++i) {
    mesh.vertices.push_back({static_cast<float>(i), 0, 0});
    mesh.vertices.push_back({static_cast<float>(i), 1, 0});
  }
  for (std::uint32_t i = 0; i < squares; ++i) {
    mesh.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
    mesh.triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    mesh.classes.push_back(static_cast<std::uint16_t>(i % 60'000));
  return mesh;
}

// Oracle: the mesh itself.
TEST(MeshTree, EveryTriangleIsInOneLeafWithinItsBox) {
  const TriangleMesh mesh = strip(20'000);
  const MeshTree tree(mesh, {}, {0, 0, 5});
  std::multiset<std::uint16_t> classes;
  for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
    const LevelNode& node = tree.nodes()[n];
    if (node.child_count > 0) {
      EXPECT_EQ(node.count, 0U);
      EXPECT_GT(node.spacing_m, 0);
      EXPECT_GT(node.first_child, n);
      ASSERT_LE(node.first_child + node.child_count, tree.nodes().size());
      EXPECT_LE(node.child_count, 8U);
      for (std::uint32_t c = 0; c < node.child_count; ++c)
        EXPECT_EQ(tree.nodes()[node.first_child + c].level, node.level + 1);
      continue;
    }
    EXPECT_LE(node.count, MeshTree::kLeafSize);
    for (const MeshElement& element : tree.elements(n)) {
      classes.insert(element.class_id);
      for (const Vec3f& corner : element.corners) {
        EXPECT_EQ(corner.z, 5);
        ASSERT_TRUE(min(corner, node.low) == node.low && max(corner, node.high) == node.high);
      }
    }
  }
  EXPECT_EQ(classes.size(), mesh.triangles.size());
  EXPECT_EQ(classes, std::multiset<std::uint16_t>(mesh.classes.begin(), mesh.classes.end()));
}

TEST(MeshTree, EmptyAndSmallMeshes) {
  const MeshTree none({}, {}, {});
  ASSERT_EQ(none.nodes().size(), 1U);
  EXPECT_EQ(none.nodes()[0].count, 0U);
  const std::vector<float> intensities = {0.5F, 2};
  const MeshTree one(strip(1), intensities, {});
  ASSERT_EQ(one.nodes().size(), 1U);
  ASSERT_EQ(one.elements(0).size(), 2U);
  EXPECT_EQ(one.elements(0)[0].intensity, 128);
  EXPECT_EQ(one.elements(0)[1].intensity, 255);
}

}  // namespace
}  // namespace adasplats
