// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/tiled_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/memory.h"
#include "adasplats/trace/wide_bvh.h"
#include "adasplats/trace/wide_kernel.h"

namespace adasplats {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// A tile's tree within the shared arrays.
struct TileTree {
  std::size_t first = 0;  ///< index of the tile's first splat, block and node
  std::size_t splats = 0;
  std::size_t nodes = 0, blocks = 0;
  WideChild root{{}, {}, {}};  ///< `nothing` if no ray can hit its splats
  float margin_m = 0;
  bool has_unit_normals = true;
  bool is_built = false;
};

/// Sets the box of a child to that of a tree.
void set_box(const WideBvh& bvh, WideChild& child) {
  child.low = {kFar, kFar, kFar};
  child.high = -child.low;
  if (bvh.root.kind() == WideRef::Kind::node) {
    const WideNode& node = bvh.nodes[bvh.root.index()];
    for (int axis = 0; axis < 3; ++axis) {
      child.low[axis] = *std::ranges::min_element(node.bounds[0][axis]);
      child.high[axis] = *std::ranges::max_element(node.bounds[1][axis]);
    }
    return;
  }
  const DiskBlock& block = bvh.disks[bvh.root.index()];
  for (unsigned lane = 0; lane < kWide; ++lane) {
    if (block.radius2[lane] < 0) continue;
    const float reach = std::sqrt(block.radius2[lane]) + bvh.margin_m;
    for (int axis = 0; axis < 3; ++axis) {
      child.low[axis] = std::min(child.low[axis], block.center[axis][lane] - reach);
      child.high[axis] = std::max(child.high[axis], block.center[axis][lane] + reach);
    }
  }
}

class WideTiledTracer final : public TiledTracer {
 public:
  explicit WideTiledTracer(std::span<const std::size_t> splats)
      : cast_(detail::wide_versions().front().cast), tiles_(splats.size()) {
    std::size_t all = 0;
    for (std::size_t k = 0; k < splats.size(); ++k) {
      tiles_[k].first = all;
      tiles_[k].splats = splats[k];
      all += splats[k];
    }
    // Indices of nodes and blocks have 30 bits. A tree has at most as many blocks as splats, and
    // fewer nodes than blocks.
    top_ = all;
    if (top_ + splats.size() >= (std::size_t{1} << 30U))
      throw Error(ErrorKind::data,
                  "a city of " + std::to_string(all) + " splats; the maximum is 2^30");
    nodes_ = SparseArray<WideNode>(top_ + splats.size() + 1);
    blocks_ = SparseArray<DiskBlock>(all);
  }

  std::string_view name() const override { return "tiles"; }

  void build(std::size_t tile, std::span<const Disk> disks, const Executor& executor) override {
    TileTree& tree = tiles_.at(tile);
    if (tree.is_built || disks.size() != tree.splats)
      throw std::logic_error(
          "TiledTracer: the tile is built already or has another number of splats");
    tree.is_built = true;
    const WideBvh bvh = build_wide_bvh({disks, nullptr}, executor);
    tree.nodes = bvh.nodes.size();
    tree.blocks = bvh.disks.size();
    tree.margin_m = bvh.margin_m;
    tree.has_unit_normals = bvh.has_unit_normals;
    tree.root.ref = moved(bvh.root, tree.first);
    if (bvh.root.kind() == WideRef::Kind::nothing) return;
    set_box(bvh, tree.root);
    executor.for_chunks(tree.nodes, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        WideNode node = bvh.nodes[i];
        for (WideRef& child : node.children) child = moved(child, tree.first);
        nodes_[tree.first + i] = node;
      }
    });
    executor.for_chunks(tree.blocks, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        DiskBlock block = bvh.disks[i];
        for (std::uint32_t& primitive : block.primitive)
          if (primitive != Hit::kNone) primitive += static_cast<std::uint32_t>(tree.first);
        blocks_[tree.first + i] = block;
      }
    });
  }

  void drop(std::size_t tile) override {
    TileTree& tree = tiles_.at(tile);
    nodes_.release(tree.first, tree.first + tree.nodes);
    blocks_.release(tree.first, tree.first + tree.blocks);
    tree.is_built = false;
  }

  void show(std::span<const std::size_t> tiles) override {
    shown_ = {nodes_.data(), blocks_.data(), nullptr, {}, 0, true};
    std::vector<WideChild> roots;
    for (const std::size_t tile : tiles) {
      const TileTree& tree = tiles_.at(tile);
      if (!tree.is_built) throw std::logic_error("TiledTracer: a shown tile is not built");
      shown_.margin_m = std::max(shown_.margin_m, tree.margin_m);
      shown_.has_unit_normals = shown_.has_unit_normals && tree.has_unit_normals;
      if (tree.root.ref.kind() != WideRef::Kind::nothing) roots.push_back(tree.root);
    }
    std::size_t next = top_;
    if (!roots.empty()) shown_.root = add_top(roots, next).ref;
  }

  void nearest_hits(std::span<const Ray> rays, int depth, std::span<Hit> hits,
                    const Executor& executor) const override {
    detail::cast_in_chunks(cast_, shown_, rays, depth, hits, executor);
  }

 private:
  static WideRef moved(WideRef ref, std::size_t by) {
    return ref.kind() == WideRef::Kind::nothing ? ref : WideRef::to(ref.kind(), ref.index() + by);
  }

  /// Makes the node above some trees; for a single tree, returns its root.
  WideChild add_top(std::span<WideChild> roots, std::size_t& next) {
    if (roots.size() == 1) return roots.front();
    const std::size_t at = next++;
    std::vector<WideChild> children;
    WideChild node{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}, {}};
    const auto center = [](const WideChild& child) { return child.low + child.high; };
    const auto number = [](const WideChild& child) { return child.ref.bits; };
    for (const std::span<WideChild> group : spatial_groups(roots, kWide, center, number)) {
      children.push_back(add_top(group, next));
      node.low = min(node.low, children.back().low);
      node.high = max(node.high, children.back().high);
    }
    nodes_[at] = wide_node(children);
    node.ref = WideRef::to(WideRef::Kind::node, at);
    return node;
  }

  detail::WideCast cast_;
  std::vector<TileTree> tiles_;
  std::size_t top_ = 0;  ///< first node of the tree over the tiles
  SparseArray<WideNode> nodes_;
  SparseArray<DiskBlock> blocks_;
  WideView shown_;
};

}  // namespace

std::unique_ptr<TiledTracer> make_tiled_tracer(std::span<const std::size_t> splats) {
  return std::make_unique<WideTiledTracer>(splats);
}

}  // namespace adasplats
