// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/gaussians/spz_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/pickle/gzip.h"

namespace adasplats {
namespace {

using std::string_literals::operator""s;

std::string words(std::initializer_list<std::uint32_t> values, std::size_t bytes = 4) {
  std::string text;
  for (const std::uint32_t value : values)
    for (std::size_t k = 0; k < bytes; ++k) text += static_cast<char>(value >> (8 * k));
  return text;
}

/// x = 1, y = -2, z = 0.5 m with 12 bits after the point; opacity 128/255; scales of 1, e and e^-6
/// m.
const std::string kPlace = words({1 << 12, 0x1000000 - (2 << 12), 1 << 11}, 3);
const std::string kAlpha = "\x80", kColor = "\x00\x80\xff"s, kScale = "\xa0\xb0\x40";
/// A quarter turn about the x axis, in the layouts of version 2 and of the later ones: w is the
/// largest of equal components, so that x is 511 steps.
const std::string kThree = "\xda\x80\x80", kFour = words({3U << 30 | 511 << 20});

std::string head(std::uint32_t version, std::uint32_t count = 1) {
  return "NGSP" + words({version, count, 12U << 8});
}
std::string version_2() { return head(2) + kPlace + kAlpha + kColor + kScale + kThree; }
std::string version_3() { return head(3) + kPlace + kAlpha + kColor + kScale + kFour; }

/// A frame of zstd (RFC 8878): one segment with its size, one raw block.
std::string frame(const std::string& bytes) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  return "\x28\xb5\x2f\xfd\xa0" + words({size}) + words({size << 3 | 1}, 3) + bytes;
}

std::string version_4() {
  std::string table, streams;
  for (const std::string& stream : {kPlace, kAlpha, kColor, kScale, kFour}) {
    table += words({static_cast<std::uint32_t>(frame(stream).size()), 0,
                    static_cast<std::uint32_t>(stream.size()), 0});
    streams += frame(stream);
  }
  return "NGSP" + words({4, 1, 5U << 24 | 12 << 8, 32, 0, 0, 0}) + table + streams;
}

Table read(const std::string& bytes) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.SPZ", std::ios::binary) << bytes;
  EXPECT_TRUE(is_spz(folder.path() / "a.SPZ"));
  return read_spz(folder.path() / "a.SPZ");
}

void expect_error(const std::string& bytes, const std::string& text) {
  try {
    read(bytes);
    ADD_FAILURE() << "no error with " << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data);
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

void expect_the_gaussian(const Table& table, double turn_tolerance) {
  ASSERT_EQ(table.rows, 1U);
  const auto value = [&](const char* name) { return table.find(name)->as_double(0); };
  EXPECT_EQ(value("x"), -0.5);
  EXPECT_EQ(value("y"), -1);
  EXPECT_EQ(value("z"), -2);
  EXPECT_NEAR(value("opacity"), std::log(128.0 / 127), 1e-12);
  EXPECT_NEAR(value("f_dc_0"), -0.5 / 0.15, 1e-12);
  EXPECT_NEAR(value("f_dc_2"), 0.5 / 0.15, 1e-12);
  EXPECT_EQ(value("scale_0"), 0);
  EXPECT_EQ(value("scale_1"), 1);
  EXPECT_EQ(value("scale_2"), -6);
  // The third axis, back and z of SPZ, becomes down (-y of SPZ) by the turn: (0, 0, -1) of ours.
  const double w = value("rot_0"), x = value("rot_1"), y = value("rot_2"), z = value("rot_3");
  EXPECT_NEAR(2 * (x * z + w * y), 0, turn_tolerance);
  EXPECT_NEAR(2 * (y * z - w * x), 0, turn_tolerance);
  EXPECT_NEAR(1 - 2 * (x * x + y * y), -1, turn_tolerance);
}

TEST(ReadSpz, GaussiansOfEveryVersion) {
  expect_the_gaussian(read(gzipped(version_2())), 0.02);
  expect_the_gaussian(read(gzipped(version_3())), 1e-9);
  try {
    expect_the_gaussian(read(version_4()), 1e-9);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::unavailable) throw;
    GTEST_SKIP() << error.what();
  }
}

TEST(ReadSpz, OpaqueAndInvisible) {
  std::string bytes = version_3();
  bytes[25] = '\xff';
  EXPECT_EQ(read(gzipped(bytes)).find("opacity")->as_double(0), INFINITY);
  bytes[25] = 0;
  EXPECT_EQ(read(gzipped(bytes)).find("opacity")->as_double(0), -INFINITY);
}

TEST(ReadSpz, DamagedFilesAreErrors) {
  expect_error("NGSP", "begin with NGSP");
  expect_error(gzipped("PK and more than sixteen bytes"), "begin with NGSP");
  expect_error(gzipped(head(1) + kPlace), "SPZ version 1, expected 2 to 4");
  expect_error(gzipped(head(4) + kPlace), "SPZ version 4");
  expect_error(head(5) + kPlace, "SPZ version 5");
  expect_error(gzipped(head(3, 0)), "no Gaussians");
  expect_error(gzipped(head(3, 0xFFFFFFFF)), "at most");
  expect_error(gzipped(head(3, 2) + version_3().substr(16)), "truncated");
  const std::string packed = gzipped(version_3());
  for (std::size_t size = 2; size < packed.size(); ++size)
    EXPECT_THROW(read(packed.substr(0, size)), Error) << size;
  const std::string four = version_4();
  for (std::size_t size = 4; size < four.size(); ++size)
    EXPECT_THROW(read(four.substr(0, size)), Error) << size;
  std::string wrong = four;
  wrong[16] = '\xf0';  // where the table of streams begins
  expect_error(wrong, "table of streams");
  wrong = four;
  wrong[32 + 8] = 10;  // the size of the positions
  expect_error(wrong, "table of streams");
}

TEST(ReadSpz, OtherFilesAreNotSpz) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.spz") << "ply\n";
  EXPECT_FALSE(is_spz(folder.path() / "a.spz"));
  std::ofstream(folder.path() / "a.ply") << "NGSP";
  EXPECT_FALSE(is_spz(folder.path() / "a.ply"));
}

}  // namespace
}  // namespace adasplats
