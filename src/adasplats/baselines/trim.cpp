// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/trim.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <unordered_map>

namespace adasplats {
namespace {

class Trimmer {
 public:
  Trimmer(const TriangleMesh& mesh, std::span<const float> values, float min)
      : mesh_(mesh), values_(values), min_(min), new_index_(mesh.vertices.size(), kUnused) {}

  TriangleMesh run() {
    for (const auto& triangle : mesh_.triangles) add(triangle);
    return std::move(trimmed_);
  }

 private:
  static constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

  /// Adds a fan over the kept corners and the cuts of the edges, in the triangle's orientation.
  void add(const std::array<std::uint32_t, 3>& triangle) {
    std::array<std::uint32_t, 4> polygon{};
    std::size_t corners = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangle[k], to = triangle[(k + 1) % 3];
      if (is_kept(from)) polygon[corners++] = kept(from);
      if (is_kept(from) != is_kept(to)) polygon[corners++] = cut(from, to);
    }
    for (std::size_t k = 2; k < corners; ++k)
      trimmed_.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
  }

  bool is_kept(std::uint32_t vertex) const { return values_[vertex] >= min_; }

  std::uint32_t added(Vec3f vertex) {
    trimmed_.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(trimmed_.vertices.size() - 1);
  }

  std::uint32_t kept(std::uint32_t vertex) {
    if (new_index_[vertex] == kUnused) new_index_[vertex] = added(mesh_.vertices[vertex]);
    return new_index_[vertex];
  }

  /// The vertex where an edge has the bound's value; shared by both of its triangles.
  std::uint32_t cut(std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [entry, is_new] = cuts_.try_emplace(std::uint64_t{low} << 32 | high, kUnused);
    if (is_new) {
      const float share = (min_ - values_[low]) / (values_[high] - values_[low]);
      entry->second =
          added(mesh_.vertices[low] + share * (mesh_.vertices[high] - mesh_.vertices[low]));
    }
    return entry->second;
  }

  const TriangleMesh& mesh_;
  std::span<const float> values_;
  float min_;
  std::vector<std::uint32_t> new_index_;
  std::unordered_map<std::uint64_t, std::uint32_t> cuts_;
  TriangleMesh trimmed_;
};

}  // namespace

TriangleMesh trimmed(const TriangleMesh& mesh, std::span<const float> values, float min) {
  if (values.size() != mesh.vertices.size())
    throw std::logic_error("trimmed: the numbers of vertices and values differ");
  return Trimmer(mesh, values, min).run();
}

}  // namespace adasplats
