// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/gaussians/spz_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/gaussians/spz_samples_test.h"
#include "adasplats/io/pickle/gzip.h"

namespace adasplats {
namespace {

using namespace spz_samples;

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
  expect_error("ply\nformat ascii 1.0\n", "neither with NGSP nor as gzip");
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

}  // namespace
}  // namespace adasplats
