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

/// The levels of detail of a city, below its folder: the table of all nodes, and the elements of
/// those that stand above the tiles.
inline constexpr const char* kTopLevelsFile = "levels/top.levels";
/// The levels of detail of a tile.
std::string levels_file_of(TileKey tile);

/// What the levels of all tiles have in common: reads all tiles. Intensities are those of every
/// n-th splat, so that a city of any size is surveyed in bounded memory.
LevelFacts survey_levels(const std::filesystem::path& folder, const CityManifest& city);

/// Writes levels_file_of() tile `k` of the city, which has splats. `facts`: survey_levels().
void write_tile_levels(const std::filesystem::path& folder, const CityManifest& city, std::size_t k,
                       const LevelFacts& facts, const Executor& executor);

/// Writes kTopLevelsFile, of the files of all tiles. `sha256_of`: of such a file. Memory: about 100
/// kB a tile.
void write_top_levels(const std::filesystem::path& folder, const CityManifest& city,
                      const LevelFacts& facts,
                      FunctionRef<std::string(const std::string& file)> sha256_of,
                      const Executor& executor);

/// Whether a city has levels of detail.
bool has_levels(const std::filesystem::path& folder);

/// A city's levels of detail: one tree over all tiles, of which memory holds the table of its nodes
/// alone (about 64 bytes for some thousand splats).
class CityLevels {
 public:
  /// Errors: those of read_levels; data (of other tiles than `city` names).
  CityLevels(const std::filesystem::path& folder, const CityManifest& city);
  /// The same with `table`, which read_levels() read of kTopLevelsFile.
  CityLevels(std::filesystem::path folder, const CityManifest& city, LevelTable table);

  const LevelFacts& facts() const { return table_.facts; }
  std::span<const LevelNode> nodes() const { return table_.nodes; }
  /// The elements of node `n`, read from the disk, as the viewer's page is sent them. Errors: data
  /// (the file of a tile is another one), no_input, io.
  std::string node_bytes(std::size_t n) const;
  /// Places of splats of the tile with most of them, every n-th, `most` or a few more; relative to
  /// the city's origin.
  std::vector<Vec3f> samples(std::size_t most) const;
  /// Errors: data (a file is not the one that was written: its SHA-256 differs).
  void verify() const;

 private:
  struct AnyModel {
    std::uint32_t part;  ///< of the table; their number: in the top file itself
    std::uint64_t offset;
  };

  void check_parts(const CityManifest& city) const;
  void find_places();

  std::filesystem::path folder_;
  LevelTable table_;
  std::uint64_t top_bytes_ = 0;
  std::vector<AnyModel> places_;  ///< of the elements of each node
};

}  // namespace adasplats
