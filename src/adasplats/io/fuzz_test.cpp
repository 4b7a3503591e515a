// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/core/recordings_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/mutator_test.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/base/test_files.h"
#include "adasplats/io/e57/e57_file_test.h"
#include "adasplats/io/laz/laz_samples_test.h"
#include "adasplats/io/ply/ply.h"

// Broken files of every format, the same in each run: nothing but adasplats::Error may escape, no
// columns of unequal length, no memory beyond what the file's size allows. Worth most under the
// sanitizers.
namespace adasplats {
namespace {

using io_test::bytes_of;
using io_test::Mutator;
using io_test::put;
using io_test::TemporaryFolder;

struct Seed {
  std::string name;
  std::string content;
};

std::string las_seed(int minor, int format, std::size_t record_bytes) {
  const std::size_t header_bytes = minor == 4 ? 375 : 227;
  std::string content(header_bytes + 54 + 5 * record_bytes, '\0');
  put(content, 0, std::uint32_t{0x4653414c});
  put(content, 24, std::uint8_t{1});
  put(content, 25, static_cast<std::uint8_t>(minor));
  put(content, 94, static_cast<std::uint16_t>(header_bytes));
  put(content, 96, static_cast<std::uint32_t>(header_bytes + 54));
  put(content, 100, std::uint32_t{1});
  put(content, 104, static_cast<std::uint8_t>(format));
  put(content, 105, static_cast<std::uint16_t>(record_bytes));
  put(content, 107, std::uint32_t{5});
  for (std::size_t axis = 0; axis < 3; ++axis) put(content, 131 + 8 * axis, 0.01);
  return content;
}

/// Scans of floats and of packed integers, with poses.
std::string e57_seed() {
  io_test::E57Composer composer;
  const std::string reals = io_test::stream_of<double>({1, 2, 3});
  composer.add_scan(3, io_test::xyz_fields(), {reals, reals, reals},
                    io_test::pose_element({"1", "0", "0", "0", "1", "2", "3"}), 10);
  const std::string fields = io_test::integer_field("sphericalRange", 1, 1000, "scale=\"0.01\"") +
                             io_test::float_field("sphericalAzimuth", true) +
                             io_test::integer_field("sphericalElevation", 0, 2) +
                             io_test::integer_field("intensity", 5, 5) +
                             io_test::integer_field("sphericalInvalidState", 0, 2);
  composer.add_scan(4, fields, {"abcde", io_test::stream_of<float>({0, 1, 2, 3}), "a", "", "b"},
                    "<name><![CDATA[b]]></name>", 3);
  return composer.file();
}

std::vector<Seed> small_seeds() {
  const std::string mesh =
      "comment c\nelement vertex 3\nproperty float x\nproperty double y\nproperty uchar z\n"
      "element face 2\nproperty list uchar int vertex_indices\nproperty short c\nend_header\n";
  const std::string ascii_mesh = mesh + "1 2 3\n4 5.5 6\n-7 8e3 9\n3 0 1 2 5\n4 2 1 0 1 6\n";
  std::string binary_mesh = mesh;
  for (int k = 0; k < 3; ++k) binary_mesh += bytes_of(1.0F) + bytes_of(2.0) + "3";
  binary_mesh += "\3" + bytes_of(0) + bytes_of(1) + bytes_of(2) + "ab";
  binary_mesh += "\3" + bytes_of(2) + bytes_of(1) + bytes_of(0) + "cd";
  const std::string pcd =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x _ n\nSIZE 4 1 2\nTYPE F U I\n"
      "COUNT 1 3 2\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";
  const std::string lzf = std::string(
                              "\x03"
                              "abcd\x60\x03",
                              7) +
                          std::string("\x20\x00", 2) +
                          std::string(
                              "\x09"
                              "0123456789",
                              11);
  std::vector<Seed> seeds = {
      {"a.ply", "ply\nformat ascii 1.0\n" + ascii_mesh},
      {"a.ply", "ply\nformat binary_little_endian 1.0\n" + binary_mesh},
      {"a.ply", "ply\nformat binary_big_endian 1.0\n" + binary_mesh},
      {"a.pcd", pcd + "DATA ascii\n1.5 1 2 3 4 5\nnan 1 2 3 4 5\n"},
      {"a.pcd", pcd + "DATA binary\n" + std::string(22, 'b')},
      {"a.pcd", pcd + "DATA binary_compressed\n" +
                    bytes_of(static_cast<std::uint32_t>(lzf.size())) + bytes_of(22U) + lzf},
      {"a.las", las_seed(2, 3, 34)},
      {"a.las", las_seed(4, 7, 40)},
      {"a.xyz", "# x y z\n1 2 3\n4 5.5 -6e3\n"},
      {"a.pts", "2\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n"},
      {"a.csv", "x,y,z,\"t\"\n1,2,3,\n4,5,6,7\n"},
      {"a.ptx",
       "1\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n9 9 9 1\n"
       "1 2 3 0.5\n0 0 0 0.5\n"},
      {"a.e57", e57_seed()},
      {"a.bin", std::string(64, '?')}};
  for (const laz_test::LazSample& sample : laz_test::kLazSamples)
    seeds.push_back({"a.laz", laz_file(sample)});
  return seeds;
}

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
      // Its checksums tell all that is broken; what lies behind them must stand it, too.
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
