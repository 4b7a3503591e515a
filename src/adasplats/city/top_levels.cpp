// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "adasplats/city/city_levels.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// A tile, or a node above several tiles.
struct Branch {
  TileKey square;                     ///< in the grid of its level, counted from the lowest tile
  std::optional<std::size_t> part;    ///< index of a tile
  LevelPiece piece;                   ///< of a node above tiles
  std::vector<std::size_t> children;  ///< of a node above tiles
};

/// Builds the tree above the tiles bottom-up: four squares of a level form one of the next.
class TopTree {
 public:
  TopTree(const fs::path& folder, const CityManifest& city, const LevelFacts& facts,
          FunctionRef<std::string(const std::string& file)> sha256_of, const Executor& executor)
      : folder_(folder), executor_(executor) {
    table_.facts = facts;
    for (const CityTile& tile : city.tiles)
      if (tile.splats > 0) add_tile(tile, sha256_of);
    join();
    number();
  }

  void write() const {
    std::vector<LevelElement> elements;
    for (const std::size_t b : order_)
      if (!branches_[b].part)
        elements.insert(elements.end(), branches_[b].piece.elements.begin(),
                        branches_[b].piece.elements.end());
    write_levels(folder_ / kTopLevelsFile, table_, elements);
  }

 private:
  void add_tile(const CityTile& tile, FunctionRef<std::string(const std::string& file)> sha256_of) {
    LevelPart part;
    part.file = levels_file_of(tile.key);
    LevelTable own = read_levels(folder_ / part.file);
    part.nodes = own.nodes.size();
    part.bytes = fs::file_size(folder_ / part.file);
    part.sha256 = sha256_of(part.file);
    part.made_of = tile.sha256;
    branches_.push_back({tile.key, table_.parts.size(), {}, {}});
    table_.parts.push_back(std::move(part));
    tiles_.push_back(std::move(own));
  }

  void join() {
    std::vector<std::size_t> level(branches_.size());
    for (std::size_t b = 0; b < level.size(); ++b) level[b] = b;
    TileKey lowest = branches_.front().square;
    for (const Branch& branch : branches_)
      lowest = {std::min(lowest.x, branch.square.x), std::min(lowest.y, branch.square.y)};
    for (Branch& branch : branches_)
      branch.square = {branch.square.x - lowest.x, branch.square.y - lowest.y};
    while (level.size() > 1) {
      std::map<TileKey, std::vector<std::size_t>> squares;
      for (const std::size_t b : level) {
        TileKey& square = branches_[b].square;
        square = {square.x / 2, square.y / 2};
        squares[square].push_back(b);
      }
      level.clear();
      for (auto& [square, children] : squares)
        level.push_back(children.size() == 1 ? children.front() : joined(square, children));
    }
    root_ = level.front();
  }

  std::size_t joined(TileKey square, const std::vector<std::size_t>& children) {
    LevelSplats splats;
    for (const std::size_t child : children) add_root(branches_[child], splats);
    const LevelInput input{.disks = splats.disks,
                           .positions = {},
                           .classes = splats.classes,
                           .intensities = splats.intensities,
                           .errors_m = {}};
    branches_.push_back(
        {square, std::nullopt,
         merged_node(input, {.intensity_range = table_.facts.intensity_range}, executor_),
         children});
    return branches_.size() - 1;
  }

  void add_root(const Branch& branch, LevelSplats& splats) const {
    const ByteRange range = table_.facts.intensity_range;
    if (!branch.part) {
      add_splats(branch.piece.node, branch.piece.elements, range, splats);
      return;
    }
    const LevelTable& tile = tiles_[*branch.part];
    const LevelPart& part = table_.parts[*branch.part];
    const LevelNode& root = tile.nodes.front();
    const std::string bytes =
        read_level_elements(folder_ / part.file, part.bytes, tile.elements_at, root.count);
    std::vector<LevelElement> elements(root.count);
    std::memcpy(elements.data(), bytes.data(), bytes.size());
    add_splats(root, elements, range, splats);
  }

  /// Numbers the nodes: first the branches, breadth first, then the nodes below each tile's root,
  /// tile by tile in the order of the tree, so that near nodes are close in the table, which the
  /// page requests in parts.
  void number() {
    order_ = {root_};
    table_.nodes.resize(1);
    for (std::size_t n = 0; n < order_.size(); ++n) {
      const Branch& branch = branches_[order_[n]];
      if (branch.part) {
        table_.parts[*branch.part].root = n;
        continue;
      }
      LevelNode node = branch.piece.node;
      node.level = table_.nodes[n].level;
      node.first_child = static_cast<std::uint32_t>(order_.size());
      node.child_count = static_cast<std::uint32_t>(branch.children.size());
      order_.insert(order_.end(), branch.children.begin(), branch.children.end());
      table_.nodes.resize(order_.size(), LevelNode{.level = node.level + 1});
      table_.nodes[n] = node;
    }
    for (const std::size_t b : order_)
      if (branches_[b].part) number_below(*branches_[b].part);
  }

  void number_below(std::size_t p) {
    LevelPart& part = table_.parts[p];
    const std::vector<LevelNode>& own = tiles_[p].nodes;
    part.first = table_.nodes.size();
    const std::uint32_t depth = table_.nodes[part.root].level;
    for (std::size_t k = 0; k < own.size(); ++k) {
      LevelNode node = own[k];
      node.level += depth;
      if (node.child_count > 0)
        node.first_child = static_cast<std::uint32_t>(part.first + node.first_child - 1);
      if (k == 0)
        table_.nodes[part.root] = node;
      else
        table_.nodes.push_back(node);
    }
  }

  const fs::path& folder_;
  const Executor& executor_;
  LevelTable table_;
  std::vector<LevelTable> tiles_;  ///< one per part
  std::vector<Branch> branches_;
  std::size_t root_ = 0;
  std::vector<std::size_t> order_;  ///< of the branches, breadth first
};

}  // namespace

void write_top_levels(const fs::path& folder, const CityManifest& city, const LevelFacts& facts,
                      FunctionRef<std::string(const std::string& file)> sha256_of,
                      const Executor& executor) {
  TopTree(folder, city, facts, sha256_of, executor).write();
}

}  // namespace adasplats
