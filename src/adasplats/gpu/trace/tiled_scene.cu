// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sparse_device_array.h"
#include "adasplats/gpu/trace/scene_trees.h"
#include "adasplats/gpu/trace/tiled_scene.h"
#include "adasplats/gpu/trace/wide_nodes.cuh"
#include "adasplats/trace/tiled_tracer.h"

namespace adasplats::gpu {
namespace {

/// Maximum depth of the tree over trees: 8^8 tiles.
constexpr int kTopLevels = 8;

/// A node of the tree over trees. Its children are numbers of boxes: first those of the shown
/// tiles, then those of the nodes of this tree.
struct TopNode {
  Family family;
  std::uint32_t place;  ///< assigned by the parent
};

/// Writes the tree over trees, node by node from the root. Children are consecutive in the order of
/// their slots, so the roots of tiles are copied there.
__global__ void write_top_kernel(TopNode* top, std::uint32_t top_count, const Box* boxes,
                                 const std::uint32_t* roots, std::uint32_t tile_count,
                                 WideNode* nodes) {
  std::uint32_t next = 1;
  top[0].place = 0;
  for (std::uint32_t t = 0; t < top_count; ++t) {
    const Family family = top[t].family;
    const Box own = boxes[tile_count + t];
    int slot_of[kWidth];
    assign_slots(family, boxes, own, slot_of);
    int child_in[kWidth];
    for (int& child : child_in) child = -1;
    for (int c = 0; c < family.size; ++c) child_in[slot_of[c]] = c;
    WideNode node{};
    node.first_child = next;
    double cells[3];
    set_grid(node, own, cells);
    for (int slot = 0; slot < kWidth; ++slot) {
      if (child_in[slot] < 0) continue;
      const std::uint32_t child = family.nodes[child_in[slot]];
      set_bounds(node, slot, own, boxes[child], cells);
      node.nodes = static_cast<std::uint8_t>(node.nodes | 1U << slot);
      if (child < tile_count) {
        nodes[next] = nodes[roots[child]];
      } else {
        top[child - tile_count].place = next;
      }
      ++next;
    }
    nodes[top[t].place] = node;
  }
}

/// Copies a tree into the arrays shared by all trees and adjusts its numbers.
void move_tree(const WideTree<LeafDisk>& tree, std::uint32_t first_node, std::uint32_t first_splat,
               WideNode* nodes, LeafDisk* leaves, cudaStream_t stream) {
  constexpr const char* kDoing = "copy the ray tree of a tile on the GPU";
  const WideNode* from_nodes = tree.nodes.data();
  for_each(tree.node_count, stream, kDoing, [=] __device__(std::uint64_t i) {
    WideNode node = from_nodes[i];
    node.first_child += first_node;
    node.first_primitive += first_splat;
    nodes[first_node + i] = node;
  });
  const LeafDisk* from_leaves = tree.leaves.data();
  for_each(tree.leaves.size(), stream, kDoing, [=] __device__(std::uint64_t i) {
    LeafDisk leaf = from_leaves[i];
    leaf.primitive += first_splat;
    leaves[first_splat + i] = leaf;
  });
}

/// The tree of a tile in the shared arrays.
struct TileTree {
  std::size_t first = 0;  ///< first splat of the tile, numbered across all tiles
  std::size_t splats = 0;
  std::size_t nodes = 0, leaves = 0;
  Box box{};
  bool is_built = false;
};

/// Bounding box of the disks that can be hit.
Box box_around(std::span<const Disk> disks) {
  Box box = {{HUGE_VALF, HUGE_VALF, HUGE_VALF}, {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF}};
  for (const Disk& disk : disks) {
    const Vec3f half = disk_half_extent(disk);
    const Vec3f low = disk.center - half, high = disk.center + half;
    if (disk.radius > 0 && adasplats::is_finite(low) && adasplats::is_finite(high))
      box = united(box, {low, high});
  }
  return box;
}

class CudaTiledScene final : public TiledScene {
 public:
  explicit CudaTiledScene(std::span<const std::size_t> splats) : tiles_(splats.size()) {
    std::size_t all = 0;
    for (std::size_t k = 0; k < splats.size(); ++k) {
      tiles_[k].first = all;
      tiles_[k].splats = splats[k];
      all += splats[k];
    }
    // Nodes over trees, and copies of the roots of the trees.
    top_room_ = 2 * splats.size() + 2;
    if (all + top_room_ >= (std::size_t{1} << 31U))
      throw Error(ErrorKind::data, "the city has " + std::to_string(all) +
                                       " splats; a GPU supports at most 2^31 in tiles");
    nodes_.emplace(top_room_ + all);
    leaves_.emplace(all);
    nodes_->hold(0, top_room_);
  }

  std::string_view name() const override { return "cuda"; }

  void build(std::size_t tile, std::span<const Disk> disks) override {
    TileTree& tree = tiles_.at(tile);
    if (tree.is_built || disks.size() != tree.splats)
      throw std::logic_error("TiledScene: this tile cannot be built");
    const DeviceBuffer<Disk> on_device(disks, building_.get());
    TreeOptions options;
    options.levels_above = kTopLevels;
    const WideTree<LeafDisk> made =
        build_tree(on_device.data(), disks.size(), options, building_.get());
    tree.nodes = made.node_count;
    tree.leaves = made.leaves.size();
    tree.box = box_around(disks);
    hold(tree);
    move_tree(made, static_cast<std::uint32_t>(first_node(tree)),
              static_cast<std::uint32_t>(tree.first), nodes_->data(), leaves_->data(),
              building_.get());
    building_.wait("build the ray tree of a tile on the GPU");
    tree.is_built = true;
  }

  void drop(std::size_t tile) override {
    TileTree& tree = tiles_.at(tile);
    if (!tree.is_built) return;
    const std::lock_guard lock(mutex_);
    nodes_->release(first_node(tree), first_node(tree) + tree.nodes);
    leaves_->release(tree.first, tree.first + tree.leaves);
    tree.is_built = false;
  }

  void show(std::span<const std::size_t> tiles) override {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> roots;
    for (const std::size_t tile : tiles) {
      const TileTree& tree = tiles_.at(tile);
      if (!tree.is_built) throw std::logic_error("TiledScene: a tile is shown before it is built");
      if (tree.nodes == 0) continue;
      boxes.push_back(tree.box);
      roots.push_back(static_cast<std::uint32_t>(first_node(tree)));
    }
    shown_ = {};
    if (roots.empty()) return;
    const auto tile_count = static_cast<std::uint32_t>(roots.size());
    std::vector<std::uint32_t> order(roots.size());
    for (std::uint32_t i = 0; i < tile_count; ++i) order[i] = i;
    std::vector<TopNode> top;
    boxes.resize(roots.size());
    add_top(order, boxes, tile_count, top);
    const DeviceBuffer<Box> device_boxes(std::span<const Box>(boxes), showing_.get());
    const DeviceBuffer<std::uint32_t> device_roots(std::span<const std::uint32_t>(roots),
                                                   showing_.get());
    const DeviceBuffer<TopNode> device_top(std::span<const TopNode>(top), showing_.get());
    write_top_kernel<<<1, 1, 0, showing_.get()>>>(
        device_top.data(), static_cast<std::uint32_t>(top.size()), device_boxes.data(),
        device_roots.data(), tile_count, nodes_->data());
    cuda_check(cudaGetLastError(), "show tiles on the GPU");
    showing_.wait("show tiles on the GPU");
    shown_.disks = {nodes_->data(), leaves_->data()};
  }

  void cast(const RaySource& source, std::uint64_t count, int depth, Hit* hits,
            cudaStream_t stream) const override {
    cast_trees(shown_, source, count, depth, hits, stream);
  }

 private:
  std::size_t first_node(const TileTree& tree) const { return top_room_ + tree.first; }

  /// Memory for a tile's tree.
  void hold(const TileTree& tree) {
    const std::lock_guard lock(mutex_);
    nodes_->hold(first_node(tree), first_node(tree) + tree.nodes);
    try {
      leaves_->hold(tree.first, tree.first + tree.leaves);
    } catch (...) {
      nodes_->release(first_node(tree), first_node(tree) + tree.nodes);
      throw;
    }
  }

  /// Makes the node above some boxes by bisection along their longer side; its box follows those of
  /// the tiles. Parents precede their children.
  static std::uint32_t add_top(std::span<std::uint32_t> tiles, std::vector<Box>& boxes,
                               std::uint32_t tile_count, std::vector<TopNode>& top) {
    const auto own = static_cast<std::uint32_t>(top.size());
    top.emplace_back();
    boxes.emplace_back();
    Box box = boxes[tiles.front()];
    Family family;
    const auto center = [&](std::uint32_t tile) { return boxes[tile].low + boxes[tile].high; };
    const auto number = [](std::uint32_t tile) { return tile; };
    for (const std::span<std::uint32_t> group : spatial_groups(tiles, kWidth, center, number)) {
      const std::uint32_t child =
          group.size() == 1 ? group.front() : add_top(group, boxes, tile_count, top);
      family.nodes[family.size++] = child;
      box = united(box, boxes[child]);
    }
    top[own].family = family;
    boxes[tile_count + own] = box;
    return tile_count + own;
  }

  Stream building_, showing_;
  std::vector<TileTree> tiles_;
  std::size_t top_room_ = 0;
  std::optional<SparseDeviceArray<WideNode>> nodes_;  ///< over trees, then tile after tile
  std::optional<SparseDeviceArray<LeafDisk>> leaves_;
  std::mutex mutex_;  ///< guards the pages
  TreesView shown_;
};

}  // namespace

std::unique_ptr<TiledScene> make_tiled_scene(std::span<const std::size_t> splats) {
  return std::make_unique<CudaTiledScene>(splats);
}

}  // namespace adasplats::gpu
