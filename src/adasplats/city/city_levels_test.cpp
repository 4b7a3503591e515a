// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/city/city_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/city/small_city_test.h"
#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats::city_levels {
namespace {

namespace fs = std::filesystem;
using small_city::write_city_with_levels;

TEST(CityLevels, LeavesHoldAllSplats) {
  const TemporaryFolder folder;
  const CityManifest city = write_city_with_levels(folder.path());
  const CityLevels levels(folder.path(), city);
  EXPECT_TRUE(has_levels(folder.path()));
  EXPECT_TRUE(levels.facts().has_classes);
  EXPECT_TRUE(levels.facts().has_intensities);
  std::size_t in_leaves = 0, inner = 0;
  for (std::size_t n = 0; n < levels.nodes().size(); ++n) {
    const LevelNode& node = levels.nodes()[n];
    EXPECT_EQ(levels.node_bytes(n).size(), node.count * sizeof(LevelElement)) << n;
    if (node.child_count == 0) in_leaves += node.count;
    inner += node.child_count > 0 ? 1 : 0;
  }
  EXPECT_EQ(in_leaves, city.splats());
  EXPECT_GE(inner, 4U) << "a root, and one for each four tiles";
}

// Oracle: the tree of the tile in memory.
TEST(CityLevels, NodesOfATileEqualItsTreeInMemory) {
  const TemporaryFolder folder;
  const CityManifest city = write_city_with_levels(folder.path());
  const CityLevels levels(folder.path(), city);
  std::vector<std::string> all;
  for (std::size_t n = 0; n < levels.nodes().size(); ++n) all.push_back(levels.node_bytes(n));
  for (std::size_t k = 0; k < city.tiles.size(); ++k) {
    if (city.tiles[k].splats == 0) continue;
    const SplatModel tile = load_city_tile(folder.path(), city, k);
    const LevelInput input{.disks = tile.disks,
                           .positions = {},
                           .classes = tile.classes,
                           .intensities = tile.intensities,
                           .errors_m = {}};
    const LevelTree tree(input, {.intensity_range = levels.facts().intensity_range}, Executor(1));
    for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
      const auto bytes = std::as_bytes(tree.elements(n));
      const std::string wanted(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      EXPECT_TRUE(std::ranges::find(all, wanted) != all.end()) << k << " " << n;
    }
  }
}

/// The splats of node `n`.
LevelSplats splats_of(const CityLevels& levels, std::size_t n) {
  const LevelNode& node = levels.nodes()[n];
  const std::string bytes = levels.node_bytes(n);
  std::vector<LevelElement> elements(node.count);
  std::memcpy(elements.data(), bytes.data(), bytes.size());
  LevelSplats splats;
  add_splats(node, elements, levels.facts().intensity_range, splats);
  return splats;
}

// Oracle: splats are inside their tiles, so the root's splats cover the center of each tile.
TEST(CityLevels, RootCoversAllTiles) {
  const TemporaryFolder folder;
  const CityManifest city = write_city_with_levels(folder.path());
  const CityLevels levels(folder.path(), city);
  const LevelSplats root = splats_of(levels, 0);
  for (const CityTile& tile : city.tiles) {
    if (tile.splats == 0) continue;
    const Vec3f middle = vec_cast<float>(0.5 * (tile.low + tile.high) - city.origin);
    const bool covered = std::ranges::any_of(root.disks, [&](const Disk& disk) {
      return std::hypot(disk.center.x - middle.x, disk.center.y - middle.y) <
             1.5F * disk.radius + levels.nodes()[0].spacing_m;
    });
    EXPECT_TRUE(covered) << name_of(tile.key);
  }
  // The gap in the middle remains.
  for (const Disk& disk : root.disks)
    EXPECT_FALSE(std::fabs(disk.center.x - 5) < 3 && std::fabs(disk.center.y - 5) < 3);
}

TEST(CityLevels, BoxesOfNodesContainTheirSubtrees) {
  const TemporaryFolder folder;
  const CityManifest city = write_city_with_levels(folder.path());
  const CityLevels levels(folder.path(), city);
  // The page's box of a node and its subtree (viewer/src/picture/lod.ts).
  const auto margin_m = [](const LevelNode& node) {
    return node.largest_radius_m + 2 * node.spacing_m;
  };
  for (const LevelNode& node : levels.nodes()) {
    for (std::size_t c = 0; c < node.child_count; ++c) {
      const LevelNode& child = levels.nodes()[node.first_child + c];
      EXPECT_EQ(child.level, node.level + 1);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(child.low[axis], node.low[axis] - margin_m(node));
        EXPECT_LE(child.high[axis], node.high[axis] + margin_m(node));
      }
    }
  }
}

TEST(CityLevels, CityOfOneTileEqualsItsTree) {
  const TemporaryFolder folder;
  CityManifest city = small_city::write_city(folder.path());
  city.tiles.resize(1);
  fs::create_directories(folder.path() / "levels");
  const LevelFacts facts = survey_levels(folder.path(), city);
  write_tile_levels(folder.path(), city, 0, facts, Executor(1));
  write_top_levels(
      folder.path(), city, facts, [](const std::string&) { return "hash"; }, Executor(1));
  const CityLevels levels(folder.path(), city);
  EXPECT_EQ(levels.nodes().size(), 1U);
  EXPECT_EQ(splats_of(levels, 0).disks.size(), city.tiles[0].splats);
}

TEST(CityLevels, RejectsLevelsOfOtherTiles) {
  const TemporaryFolder folder;
  const CityManifest city = write_city_with_levels(folder.path());
  CityManifest other = city;
  other.tiles.front().sha256 = "another";
  EXPECT_THROW(CityLevels(folder.path(), other), Error);
  other = city;
  other.tiles.pop_back();
  other.tiles.pop_back();
  EXPECT_THROW(CityLevels(folder.path(), other), Error);
}

TEST(CityLevels, RejectsAChangedTile) {
  const TemporaryFolder folder;
  const CityManifest city = write_city_with_levels(folder.path());
  const CityLevels levels(folder.path(), city);
  levels.verify();
  const fs::path file = folder.path() / levels_file_of(city.tiles.front().key);
  std::string bytes = read_file(file);
  bytes.back() = static_cast<char>(bytes.back() + 1);
  write_file(file, bytes);
  EXPECT_THROW(levels.verify(), Error);
  write_file(file, bytes + "x");
  std::size_t errors = 0;
  for (std::size_t n = 0; n < levels.nodes().size(); ++n) {
    try {
      levels.node_bytes(n);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::data);
      ++errors;
    }
  }
  EXPECT_EQ(errors, 1U) << "the tile's one node";
}

TEST(CityLevels, SamplesAreFromTheFullestTile) {
  const TemporaryFolder folder;
  const CityManifest city = write_city_with_levels(folder.path());
  const CityLevels levels(folder.path(), city);
  const std::vector<Vec3f> samples = levels.samples(100);
  EXPECT_GE(samples.size(), 90U);
  EXPECT_LE(samples.size(), 110U);
}

// Oracle: one thread.
TEST(CityLevels, AreTheSameBytesOnAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const CityManifest city = write_city_with_levels(folder.path());
  const std::string top = read_file(folder.path() / kTopLevelsFile);
  const LevelFacts facts = survey_levels(folder.path(), city);
  for (std::size_t k = 0; k < city.tiles.size(); ++k)
    if (city.tiles[k].splats > 0) write_tile_levels(folder.path(), city, k, facts, Executor(1));
  write_top_levels(
      folder.path(), city, facts,
      [&](const std::string& file) { return sha256_of_file(folder.path() / file); }, Executor(1));
  EXPECT_EQ(read_file(folder.path() / kTopLevelsFile), top);
}

}  // namespace
}  // namespace adasplats::city_levels
