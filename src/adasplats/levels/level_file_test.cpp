// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/levels/level_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats::level_files {
namespace {

namespace fs = std::filesystem;

struct Splats {
  std::vector<Disk> disks;
  std::vector<std::uint16_t> classes;
  std::vector<float> intensities;

  LevelInput input() const {
    return {.disks = disks,
            .positions = {},
            .classes = classes,
            .intensities = intensities,
            .errors_m = {}};
  }
};

/// A floor with random heights.
Splats floor_of(int side) {
  Splats splats;
  for (int i = 0; i < side * side; ++i) {
    Random random(4, 0, static_cast<std::uint64_t>(i));
    const Vec3d center = {0.1 * (i % side), 0.1 * static_cast<double>(i / side),
                          random.uniform(0, 0.2)};
    splats.disks.push_back({vec_cast<float>(center), 0.08F, {0, 0, 1}});
    splats.classes.push_back(static_cast<std::uint16_t>(40 + i % 3));
    splats.intensities.push_back(static_cast<float>(random.uniform()));
  }
  return splats;
}

constexpr LevelFacts kFacts = {.splats = 2500,
                               .has_classes = true,
                               .has_intensities = true,
                               .intensity_range = {0.25F, 0.75F}};

LevelTree small_tree() {
  const Splats splats = floor_of(50);
  return {
      splats.input(), {.leaf_size = 200, .intensity_range = kFacts.intensity_range}, Executor(1)};
}

/// The error of reading the file, or empty.
std::string error_of_reading(const fs::path& file) {
  try {
    read_levels(file);
    return {};
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data);
    EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
    return error.what();
  }
}

// Oracle: the tree in memory.
TEST(LevelFile, RoundTrip) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.levels";
  const LevelTree tree = small_tree();
  ASSERT_GT(tree.nodes().size(), 10U);
  write_levels(file, tree, kFacts);
  const LevelTable table = read_levels(file);
  EXPECT_EQ(table.facts.splats, kFacts.splats);
  EXPECT_TRUE(table.facts.has_classes);
  EXPECT_TRUE(table.facts.has_intensities);
  EXPECT_EQ(table.facts.intensity_range, kFacts.intensity_range);
  ASSERT_EQ(table.nodes.size(), tree.nodes().size());
  EXPECT_EQ(std::memcmp(table.nodes.data(), tree.nodes().data(), tree.nodes().size_bytes()), 0);
  std::uint64_t offset = table.elements_at;
  for (std::size_t n = 0; n < table.nodes.size(); ++n) {
    const auto expected = std::as_bytes(tree.elements(n));
    const std::string found =
        read_level_elements(file, fs::file_size(file), offset, table.nodes[n].count);
    ASSERT_EQ(found.size(), expected.size()) << n;
    EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size()), 0) << n;
    offset += found.size();
  }
  EXPECT_EQ(offset, fs::file_size(file));
}

TEST(LevelFile, AnEmptyTreeIsOneNode) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.levels";
  LevelFacts facts = kFacts;
  facts.splats = 0;
  write_levels(file, LevelTree({}, {}, Executor(1)), facts);
  EXPECT_EQ(read_levels(file).nodes.size(), 1U);
}

TEST(LevelFile, DamageIsAnError) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.levels";
  write_levels(file, small_tree(), kFacts);
  const std::string good = read_file(file);
  const std::size_t line = good.find('\n') + 1;
  const auto error_of = [&](const std::string& bytes) {
    write_file(file, bytes);
    return error_of_reading(file);
  };
  const auto with_word = [&](std::size_t node, std::size_t word, std::uint32_t value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + line + node * sizeof(LevelNode) + 4 * word, &value, sizeof(value));
    return error_of(bytes);
  };
  EXPECT_EQ(error_of(good), "");
  for (const std::size_t size : {std::size_t{1}, line - 1, line, line + 47, good.size() - 1})
    EXPECT_NE(error_of(good.substr(0, size)), "") << size;
  EXPECT_NE(error_of(good + "x"), "") << "longer than declared";
  EXPECT_NE(error_of(std::string(1000, 'x')).find("not a file of levels"), std::string::npos);
  EXPECT_NE(with_word(0, 8, 0), "") << "a node that is its own child";
  EXPECT_NE(with_word(0, 8, 2), "") << "a node without a parent";
  EXPECT_NE(with_word(0, 9, 9), "") << "more than eight children";
  EXPECT_NE(with_word(0, 9, 0), "") << "a leaf that loses its children";
  EXPECT_NE(with_word(1, 10, 1U << 31), "") << "too many elements";
  EXPECT_NE(with_word(0, 0, 0x7fc00000U), "") << "a box that is NaN";
  EXPECT_NE(with_word(0, 6, 0xbf800000U), "") << "a negative spacing";
}

TEST(LevelFile, OtherVersionsAreNamedInTheError) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.levels";
  write_levels(file, small_tree(), kFacts);
  std::string bytes = read_file(file);
  const std::string version = "\"version\":1";
  bytes.replace(bytes.find(version), version.size(), "\"version\":2");
  write_file(file, bytes);
  EXPECT_NE(error_of_reading(file).find("version 2; this program reads version 1"),
            std::string::npos);
}

TEST(LevelFile, AChangedFileSizeIsAnError) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.levels";
  write_file(file, std::string(64, 'x'));
  EXPECT_EQ(read_level_elements(file, 64, 16, 3).size(), 48U);
  EXPECT_THROW(read_level_elements(file, 80, 16, 3), Error);
  EXPECT_THROW(read_level_elements(folder.path() / "b", 64, 16, 3), Error);
}

// Oracle: the sum of the areas, which merging preserves if disks do not overlap.
TEST(LevelFile, MergingPreservesTheArea) {
  Splats splats = floor_of(40);
  for (Disk& disk : splats.disks) disk.radius = 0.03F;
  const LevelOptions options = {.intensity_range = kFacts.intensity_range};
  const LevelPiece piece = merged_node(splats.input(), options, Executor(1));
  EXPECT_EQ(piece.node.count, piece.elements.size());
  EXPECT_LE(piece.elements.size(), splats.disks.size() / 2);
  EXPECT_GT(piece.node.spacing_m, 0);
  LevelSplats merged;
  add_splats(piece.node, piece.elements, kFacts.intensity_range, merged);
  const auto area = [](const std::vector<Disk>& disks) {
    double sum = 0;
    for (const Disk& disk : disks)
      sum += static_cast<double>(disk.radius) * static_cast<double>(disk.radius);
    return sum;
  };
  EXPECT_NEAR(area(merged.disks), area(splats.disks), 0.02 * area(splats.disks));
}

}  // namespace
}  // namespace adasplats::level_files
