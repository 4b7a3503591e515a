// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/levels/level_tree.h"

namespace adasplats {

// File of levels of detail (docs/cities.md, "Levels of detail"): a JSON line that describes the
// rest, the table of nodes and the elements of the nodes, both in the layout of the viewer's page,
// little-endian.

/// Header of a file of levels.
struct LevelFacts {
  std::size_t splats = 0;  ///< number of splats in the leaves
  bool has_classes = false;
  bool has_intensities = false;
  ByteRange intensity_range;
};

/// A subtree in another file. Its node 0 is node `root` of the full tree, its node k > 0 is node
/// `first` + k - 1.
struct LevelPart {
  std::string file;  ///< relative to the folder of the city
  std::size_t root = 0;
  std::size_t first = 0;
  std::size_t nodes = 0;
  std::uint64_t bytes = 0;  ///< size of the file
  std::string sha256;       ///< of the file
  std::string made_of;      ///< SHA-256 of the model that it was made from
};

/// Contents of a file of levels without the elements.
struct LevelTable {
  LevelFacts facts;
  std::vector<LevelNode> nodes;
  std::vector<LevelPart> parts;
  std::uint64_t elements_at = 0;  ///< offset of the first element in the file

  /// For each node, whether its elements are in this file.
  std::vector<bool> own_nodes() const;
};

/// The bytes of a file of levels before its elements, which must be those of own_nodes() in order.
std::string level_head(const LevelTable& table);
/// Writes a complete file of levels.
void write_levels(const std::filesystem::path& path, const LevelTable& table,
                  std::span<const LevelElement> elements);
/// Writes a tree.
void write_levels(const std::filesystem::path& path, const LevelTree& tree,
                  const LevelFacts& facts);

/// Reads everything except the elements, and checks that these are complete. Errors: no_input, data
/// (damaged, another version, or not a file of levels).
LevelTable read_levels(const std::filesystem::path& path);

/// Reads `count` elements from an offset of a file of `bytes` bytes. Errors: no_input, data (wrong
/// size), io.
std::string read_level_elements(const std::filesystem::path& path, std::uint64_t bytes,
                                std::uint64_t offset, std::size_t count);

}  // namespace adasplats
