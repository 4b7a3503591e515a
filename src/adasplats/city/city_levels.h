// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/levels/level_file.h"

namespace adasplats {

/// Levels of detail of a city, relative to its folder: the table of all nodes, and the elements of
/// the nodes above the tiles.
inline constexpr const char* kTopLevelsFile = "levels/top.levels";
/// Levels of detail of a tile.
std::string levels_file_of(TileKey tile);

/// Common facts for the levels of all tiles; reads all tiles. Uses the intensities of every n-th
/// splat, so memory does not grow with the city.
LevelFacts survey_levels(const std::filesystem::path& folder, const CityManifest& city);

/// Writes levels_file_of() for tile `k`, which must have splats. `facts`: from survey_levels().
void write_tile_levels(const std::filesystem::path& folder, const CityManifest& city, std::size_t k,
                       const LevelFacts& facts, const Executor& executor);

/// Writes kTopLevelsFile from the files of all tiles. `sha256_of` returns the hash of such a file.
/// Memory: about 100 kB per tile.
void write_top_levels(const std::filesystem::path& folder, const CityManifest& city,
                      const LevelFacts& facts,
                      FunctionRef<std::string(const std::string& file)> sha256_of,
                      const Executor& executor);

/// Whether a city has levels of detail.
bool has_levels(const std::filesystem::path& folder);

/// A city's levels of detail: one tree over all tiles. Only the table of nodes is in memory (about
/// 64 bytes per several thousand splats).
class CityLevels {
 public:
  /// Errors: those of read_levels; data (the levels belong to other tiles than `city`).
  CityLevels(const std::filesystem::path& folder, const CityManifest& city);
  /// The same with a `table` that read_levels() read from kTopLevelsFile.
  CityLevels(std::filesystem::path folder, const CityManifest& city, LevelTable table);

  const LevelFacts& facts() const { return table_.facts; }
  std::span<const LevelNode> nodes() const { return table_.nodes; }
  /// The elements of node `n` as sent to the viewer's page, read from disk. Errors: data (the file
  /// of a tile has changed), no_input, io.
  std::string node_bytes(std::size_t n) const;
  /// Positions of every n-th splat of the tile with the most splats, about `count`; relative to the
  /// city's origin.
  std::vector<Vec3f> samples(std::size_t count) const;
  /// Errors: data (a file has changed: its SHA-256 differs).
  void verify() const;

 private:
  struct ElementsAt {
    std::uint32_t part;  ///< index of the table's part; the number of parts: the top file
    std::uint64_t offset;
  };

  void check_parts(const CityManifest& city) const;
  void find_elements();

  std::filesystem::path folder_;
  LevelTable table_;
  std::uint64_t top_bytes_ = 0;
  std::vector<ElementsAt> elements_;  ///< file positions of each node's elements
};

}  // namespace adasplats
