// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/core/recordings_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/mutator_test.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/e57/e57_file_test.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/io/small_files_test.h"

// Broken files of every format, the same in each run: nothing but adasplats::Error may escape, no
// columns of unequal length, no memory beyond what the file's size allows. Worth most under the
// sanitizers.
namespace adasplats {
namespace {

using io_test::Mutator;
using io_test::Seed;
using io_test::small_seeds;

std::vector<Seed> real_seeds(const std::filesystem::path& folder) {
  std::vector<Seed> seeds;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".tsv" || entry.file_size() == 0) continue;
    seeds.push_back({"a" + extension, read_file(entry.path())});
  }
  // The order of a folder is the machine's; the test must not depend on it.
  std::sort(seeds.begin(), seeds.end(),
            [](const Seed& a, const Seed& b) { return a.content < b.content; });
  return seeds;
}

void expect_sound(const Table& table, std::size_t file_bytes) {
  for (const Column& column : table.columns) ASSERT_EQ(column.size(), table.rows);
  // The smallest record of any format has a byte, but where LZF packs 88 into one.
  ASSERT_LE(table.rows, 88 * file_bytes);
}

/// Whether the file was read; anything but an Error ends the test.
bool reads_or_throws_error(const std::filesystem::path& path, const std::string& content) {
  io_test::write_bytes(path, content);
  bool was_read = false;
  try {
    expect_sound(read_points(path, {content.size() % 2 == 0}), content.size());
    was_read = true;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(path.filename().string()), std::string::npos);
  }
  if (path.extension() != ".ply") return was_read;
  try {
    const MeshTable mesh = read_ply_mesh(path);
    expect_sound(mesh.vertices, content.size());
    expect_sound(mesh.faces, content.size());
    EXPECT_EQ(mesh.triangle_vertices.size(), 3 * mesh.faces.rows);
    for (const std::uint32_t index : mesh.triangle_vertices) EXPECT_LT(index, mesh.vertices.rows);
  } catch (const Error&) {
  }
  return was_read;
}

void fuzz(const std::vector<Seed>& seeds, int rounds, std::uint64_t random_seed) {
  const TemporaryFolder folder;
  Mutator mutator(random_seed);
  std::size_t was_read = 0;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < seeds.size(); ++k) {
      const std::string& other =
          seeds[(k + static_cast<std::size_t>(round)) % seeds.size()].content;
      std::string content = mutator.mutate(seeds[k].content, other);
      // Checksums detect all damage; the code after them must survive it, too.
      if (seeds[k].name == "a.e57" && round % 4 != 0) content = io_test::sealed_e57(content);
      ASSERT_NO_THROW(was_read +=
                      reads_or_throws_error(folder.path() / seeds[k].name, content) ? 1 : 0)
          << seeds[k].name << ", seed " << k << ", round " << round;
    }
  }
  // Breaking every file beyond recognition would prove little, breaking none nothing.
  const std::size_t cases = seeds.size() * static_cast<std::size_t>(rounds);
  EXPECT_GT(was_read, cases / 20);
  EXPECT_LT(was_read, cases * 19 / 20);
}

TEST(Fuzz, TheSmallSeedsAreValid) {
  const TemporaryFolder folder;
  for (const Seed& seed : small_seeds())
    EXPECT_TRUE(reads_or_throws_error(folder.path() / seed.name, seed.content)) << seed.content;
}

TEST(Fuzz, SmallFilesOfEveryFormat) { fuzz(small_seeds(), 400, 1); }

TEST(Fuzz, RealFiles) {
  const auto folder = recording("formats");
  if (!folder) GTEST_SKIP() << kNoRecordings;
  const std::vector<Seed> seeds = real_seeds(*folder);
  ASSERT_FALSE(seeds.empty());
  fuzz(seeds, 25, 2);
}

// Every prefix of a file that a reader believes to be longer.
TEST(Fuzz, EveryTruncation) {
  const TemporaryFolder folder;
  for (const Seed& seed : small_seeds()) {
    for (std::size_t size = 0; size < seed.content.size(); ++size)
      reads_or_throws_error(folder.path() / seed.name, seed.content.substr(0, size));
  }
}

}  // namespace
}  // namespace adasplats
