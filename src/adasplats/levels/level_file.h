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

// Levels of detail as a file (docs/cities.md, "Levels of detail"): a line of JSON that says what
// follows, the table of the nodes and the elements of the nodes, both as the viewer's page reads
// them, little-endian.

/// What a file of levels says of itself.
struct LevelFacts {
  std::size_t splats = 0;  ///< that the leaves of its nodes hold
  bool has_classes = false;
  bool has_intensities = false;
  ByteRange intensity_range;
};

/// A tree whose lower part is in other files: what stands in one of them. Its node 0 is node `root`
/// of the whole, node k > 0 is node `first` + k - 1.
struct LevelPart {
  std::string file;  ///< relative to the folder of the city
  std::size_t root = 0;
  std::size_t first = 0;
  std::size_t nodes = 0;
  std::uint64_t bytes = 0;  ///< size of the file
  std::string sha256;       ///< of the file
  std::string made_of;      ///< SHA-256 of the model that it was made of
};

/// All of a file of levels but the elements.
struct LevelTable {
  LevelFacts facts;
  std::vector<LevelNode> nodes;
  std::vector<LevelPart> parts;
  std::uint64_t elements_at = 0;  ///< offset of the first element in the file

  /// Whether the elements of each node are in the file itself.
  std::vector<bool> own_nodes() const;
};

/// The bytes of a file of levels in front of its elements, which must be those of own_nodes() in
/// their order.
std::string level_head(const LevelTable& table);
/// A whole file of levels.
void write_levels(const std::filesystem::path& path, const LevelTable& table,
                  std::span<const LevelElement> elements);
/// The same for a tree.
void write_levels(const std::filesystem::path& path, const LevelTree& tree,
                  const LevelFacts& facts);

/// Reads all but the elements, and checks that they are where they should be. Errors: no_input,
/// data (damaged, of another version, or no levels).
LevelTable read_levels(const std::filesystem::path& path);

/// `count` elements of a file that is `bytes` long, from an offset on. Errors: no_input, data
/// (of another size), io.
std::string read_level_elements(const std::filesystem::path& path, std::uint64_t bytes,
                                std::uint64_t offset, std::size_t count);

}  // namespace adasplats
