// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

/// Chunks of ASCII with ranges of positions and scales, and of colours if wanted.
struct PackedFile {
  bool has_color_ranges = true;
  std::size_t chunks = 1;
  std::string word = "uint", position = "packed_position";
  std::vector<std::string> vertices;

  std::string text() const {
    std::ostringstream out;
    out << "ply\nformat ascii 1.0\ncomment adasplats.labels kept\nelement chunk " << chunks << "\n";
    std::string values;
    for (const char* side : {"min_", "max_"}) {
      for (const char* name : {"x", "y", "z", "scale_x", "scale_y", "scale_z", "r", "g", "b"}) {
        if (std::string(name).size() == 1 && std::string("rgb").find(name) != std::string::npos &&
            !has_color_ranges)
          continue;
        out << "property float " << side << name << "\n";
        values += side == std::string("min_") ? "-2 " : "6 ";
      }
    }
    out << "element vertex " << vertices.size() << "\nproperty " << word << " " << position
        << "\nproperty uint packed_rotation\nproperty uint packed_scale\nproperty uint "
           "packed_color\nend_header\n";
    for (std::size_t k = 0; k < chunks; ++k) out << values << "\n";
    for (const std::string& vertex : vertices) out << vertex << "\n";
    return out.str();
  }
};

Table read(const PackedFile& file) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.ply") << file.text();
  return read_ply(folder.path() / "a.ply");
}

std::string packed(std::uint32_t position, std::uint32_t rotation, std::uint32_t scale,
                   std::uint32_t color) {
  std::ostringstream line;
  line << position << " " << rotation << " " << scale << " " << color;
  return line.str();
}

/// The lowest x, the highest y, z three quarters up; the turn (0, 1, 0, 0), which 512 of 1023 steps
/// round; opaque red.
const std::string kOne =
    packed(1023U << 11 | 1535, 1U << 30 | 512 << 20 | 512 << 10 | 512, 0, 0xFF0000FF);

double value(const Table& table, const char* name, std::size_t row = 0) {
  return table.find(name)->as_double(row);
}

TEST(PackedPly, GaussiansAreUnpacked) {
  for (const bool has_color_ranges : {true, false}) {
    const Table table = read({.has_color_ranges = has_color_ranges, .vertices = {kOne}});
    ASSERT_EQ(table.rows, 1U);
    EXPECT_EQ(table.comments, std::vector<std::string>{"adasplats.labels kept"});
    EXPECT_EQ(value(table, "x"), -2);
    EXPECT_EQ(value(table, "y"), 6);
    EXPECT_NEAR(value(table, "z"), -2 + 8 * 1535.0 / 2047, 1e-12);
    EXPECT_EQ(value(table, "scale_1"), -2);
    EXPECT_EQ(value(table, "opacity"), INFINITY);
    EXPECT_NEAR(value(table, "rot_1"), 1, 1e-5);
    EXPECT_NEAR(value(table, "rot_0"), 0, 1e-3);
    constexpr double kHarmonic = 0.28209479177387814;
    EXPECT_NEAR(value(table, "f_dc_0"), ((has_color_ranges ? 6 : 1) - 0.5) / kHarmonic, 1e-9);
    EXPECT_NEAR(value(table, "f_dc_2"), ((has_color_ranges ? -2 : 0) - 0.5) / kHarmonic, 1e-9);
  }
}

TEST(PackedPly, EveryChunkHas256Gaussians) {
  PackedFile file{.chunks = 2, .vertices = std::vector<std::string>(257, kOne)};
  EXPECT_EQ(read(file).rows, 257U);
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.ply") << file.text();
  EXPECT_FALSE(ply_records_at_random(folder.path() / "a.ply"));
  for (const std::size_t chunks : {1U, 3U}) {
    file.chunks = chunks;
    EXPECT_THROW(read(file), Error);
  }
}

TEST(PackedPly, DamagedFilesAreErrors) {
  EXPECT_THROW(read({.word = "float", .vertices = {kOne}}), Error);
  std::string text = PackedFile{.vertices = {kOne}}.text();
  for (const char* missing : {"property float max_y\n", "property uint packed_color\n"}) {
    std::string damaged = text;
    damaged.erase(damaged.find(missing), std::string(missing).size());
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "a.ply") << damaged;
    EXPECT_THROW(read_ply(folder.path() / "a.ply"), Error) << missing;
  }
}

}  // namespace
}  // namespace adasplats
