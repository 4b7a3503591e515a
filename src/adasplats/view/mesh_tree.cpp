// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace adasplats {
namespace {

/// A node is halved this often, each time along its longest side.
constexpr int kHalvings = 3;

Vec3f center_of(const MeshElement& t) {
  return (1.0F / 3) * (t.corners[0] + t.corners[1] + t.corners[2]);
}

std::uint8_t intensity_byte(float intensity) {
  if (!(intensity > 0)) return 0;  // also NaN
  return static_cast<std::uint8_t>(std::lround(255 * std::min(intensity, 1.0F)));
}

}  // namespace

/// A run of triangles.
struct MeshTree::Part {
  std::size_t begin = 0, end = 0;
  std::uint32_t level = 0;
};

MeshTree::MeshTree(const TriangleMesh& mesh, std::span<const float> intensities, Vec3d shift) {
  elements_.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    MeshElement element;
    for (std::size_t corner = 0; corner < 3; ++corner)
      element.corners[corner] =
          vec_cast<float>(vec_cast<double>(mesh.vertices[mesh.triangles[i][corner]]) + shift);
    if (!mesh.classes.empty()) element.class_id = mesh.classes[i];
    if (!intensities.empty()) element.intensity = intensity_byte(intensities[i]);
    elements_.push_back(element);
  }
  std::vector<Part> parts = {{0, elements_.size(), 0}};
  for (std::size_t n = 0; n < parts.size(); ++n) {
    const Part part = parts[n];
    const bool is_leaf = part.end - part.begin <= kLeafSize;
    const std::vector<Part> children = is_leaf ? std::vector<Part>() : split(part);
    LevelNode node = node_of(part);
    node.level = part.level;
    if (is_leaf) {
      node.count = static_cast<std::uint32_t>(part.end - part.begin);
    } else {
      node.spacing_m = length(node.high - node.low);
      node.first_child = static_cast<std::uint32_t>(parts.size());
      node.child_count = static_cast<std::uint32_t>(children.size());
    }
    nodes_.push_back(node);
    firsts_.push_back(part.begin);
    parts.insert(parts.end(), children.begin(), children.end());
  }
}

std::span<const MeshElement> MeshTree::elements(std::size_t n) const {
  return std::span(elements_).subspan(firsts_[n], nodes_[n].count);
}

LevelNode MeshTree::node_of(const Part& part) const {
  LevelNode node{};
  if (part.begin == part.end) return node;
  node.low = node.high = elements_[part.begin].corners[0];
  for (std::size_t i = part.begin; i < part.end; ++i) {
    for (const Vec3f& corner : elements_[i].corners) {
      node.low = min(node.low, corner);
      node.high = max(node.high, corner);
    }
  }
  return node;
}

std::vector<MeshTree::Part> MeshTree::split(const Part& part) {
  std::vector<Part> parts = {part};
  for (int halving = 0; halving < kHalvings; ++halving) {
    std::vector<Part> halves;
    for (const Part& half : parts) {
      if (half.end - half.begin < 2) {
        halves.push_back(half);
        continue;
      }
      const LevelNode box = node_of(half);
      const Vec3f size = box.high - box.low;
      const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
      const std::size_t middle = half.begin + (half.end - half.begin) / 2;
      const auto at = [&](std::size_t i) {
        return elements_.begin() + static_cast<std::ptrdiff_t>(i);
      };
      std::nth_element(at(half.begin), at(middle), at(half.end),
                       [axis](const MeshElement& a, const MeshElement& b) {
                         return center_of(a)[axis] < center_of(b)[axis];
                       });
      halves.push_back({half.begin, middle, part.level + 1});
      halves.push_back({middle, half.end, part.level + 1});
    }
    parts = std::move(halves);
  }
  for (Part& each : parts) each.level = part.level + 1;
  return parts;
}

}  // namespace adasplats
