// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <clocale>
#include <locale>
#include <string>

#include "adasplats/io/arrays/npy.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

using io_test::values_of;

const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
    "y\nproperty float z\nend_header\n1.5 2 3\n";
const std::string kPcd = "# .PCD v0.7\nFIELDS x\nSIZE 4\nTYPE F\nPOINTS 1\nDATA ascii\n1.5\n";

TEST(ReadPoints, ByExtensionInAnyCase) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_points(folder.write("a.PLY", kPly)).rows, 1U);
  EXPECT_EQ(read_points(folder.write("a.Pcd", kPcd)).rows, 1U);
  EXPECT_EQ(read_points(folder.write("a.BIN", std::string(32, '\0'))).rows, 2U);
  for (const char* name : {"a.xyz", "a.TXT", "a.asc", "a.csv", "a.pts"})
    EXPECT_EQ(read_points(folder.write(name, "1 2 3\n")).rows, 1U);
}

TEST(ReadPoints, WithheldPointsAreLeftOutInEveryFormat) {
  const TemporaryFolder folder;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty float scalar_Withheld\nend_header\n1 2 3 1\n4 5 6 0\n";
  const std::string pcd =
      "# .PCD v0.7\nFIELDS x y z withheld\nSIZE 4 4 4 1\nTYPE F F F U\nPOINTS 2\nDATA ascii\n"
      "1 2 3 1\n4 5 6 0\n";
  for (const auto& [name, content] : {std::pair("a.ply", ply), std::pair("a.pcd", pcd),
                                      std::pair("a.csv", std::string("x,y,z,Withheld\n1,2,3,1\n"
                                                                     "4,5,6,0\n"))}) {
    const Table table = read_points(folder.write(name, content));
    EXPECT_EQ(values_of(table, "x"), std::vector<double>{4}) << name;
    EXPECT_EQ(table.columns.size(), 3U) << name;
    ASSERT_EQ(table.notes.size(), 1U) << name;
    EXPECT_EQ(table.notes[0], (ReaderNote{NoteKind::withheld, "1 of 2 points"})) << name;
  }
}

TEST(ReadPoints, ByFirstBytesWithoutAKnownExtension) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_points(folder.write("a.model", kPly)).rows, 1U);
  EXPECT_EQ(read_points(folder.write("cloud", kPcd)).rows, 1U);
  expect_error(ErrorKind::data, {"unknown format '.obj'", ".ply, .pcd, .las"},
               [&] { read_points(folder.write("a.obj", "v 1 2 3\n")); });
  expect_error(ErrorKind::data, {"unknown format '.osf'", "ouster-cli source a.osf save a.pcap"},
               [&] { read_points(folder.write("a.osf", "OSF")); });
}

TEST(ReadPoints, ExtensionAndFirstBytesMustAgree) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::data, {"begins like PLY", "extension of LAS"},
               [&] { read_points(folder.write("a.las", kPly)); });
  expect_error(ErrorKind::data, {"begins like LAS", "extension of KITTI"},
               [&] { read_points(folder.write("a.bin", "LASF" + std::string(28, 'x'))); });
  expect_error(ErrorKind::data, {"'1 2 3'", "'ply'"},
               [&] { read_points(folder.write("a.ply", "1 2 3\n")); });
  expect_error(ErrorKind::data, {"begins like E57", "extension of PLY"},
               [&] { read_points(folder.write("a.ply", "ASTM-E57")); });
}

TEST(ReadPoints, MissingAndEmptyFiles) {
  const TemporaryFolder folder;
  for (const std::string name :
       {"a.ply", "a.pcd", "a.las", "a.laz", "a.e57", "a.bin", "a.xyz", "a.ptx", "a"}) {
    expect_error(ErrorKind::no_input, {name}, [&] { read_points(folder.path() / name); });
    expect_error(ErrorKind::data, {"empty"}, [&] { read_points(folder.write(name, "")); });
    std::filesystem::remove(folder.path() / name);
    std::filesystem::create_directory(folder.path() / name);
    expect_error(ErrorKind::no_input, {"folder"}, [&] { read_points(folder.path() / name); });
    std::filesystem::remove(folder.path() / name);
    ASSERT_EQ(::mkfifo((folder.path() / name).c_str(), 0600), 0);
    expect_error(ErrorKind::no_input, {"FIFO"}, [&] { read_points(folder.path() / name); });
  }
}

/// Decimal comma and thousands points, as in German.
class CommaNumbers : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

// Fault 8. The C++ locale is always set, C's where the machine has one with a comma.
TEST(ReadPoints, LocaleWithADecimalComma) {
  const TemporaryFolder folder;
  const std::string c_locale = std::setlocale(LC_ALL, nullptr);
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaNumbers));
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_AT.UTF-8"})
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  const float value = 1.5F;
  const std::vector<ColumnView> columns = {{"x", ColumnType::f32, &value, 0}};
  write_ply(folder.path() / "written.ply", 1234567, columns);
  const std::size_t written = read_points(folder.path() / "written.ply").rows;
  const double ply = values_of(read_points(folder.write("a.ply", kPly)), "x")[0];
  const double pcd = values_of(read_points(folder.write("a.pcd", kPcd)), "x")[0];
  const double xyz = values_of(read_points(folder.write("a.xyz", "1.5 2 3\n")), "x")[0];
  write_npy(folder.path() / "a.npy", std::vector<float>(1234), 1234, 1);
  const std::size_t npy = std::filesystem::file_size(folder.path() / "a.npy");
  std::locale::global(before);
  std::setlocale(LC_ALL, c_locale.c_str());
  EXPECT_EQ(written, 1234567U);
  EXPECT_EQ(ply, 1.5);
  EXPECT_EQ(pcd, 1.5);
  EXPECT_EQ(xyz, 1.5);
  EXPECT_EQ(npy, 128U + 4 * 1234);
}

}  // namespace
}  // namespace adasplats
