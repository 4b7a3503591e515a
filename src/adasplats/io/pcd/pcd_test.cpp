// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <string>
#include <vector>

#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/pcd/lzf.h"

namespace adasplats {
namespace {

using io_test::bytes_of;
using io_test::values_of;
using Doubles = std::vector<double>;

Table read_pcd_bytes(const std::string& content) {
  const TemporaryFolder folder;
  return read_pcd(folder.write("file.pcd", content));
}

void expect_pcd_error(const std::string& content, const std::vector<std::string>& parts) {
  expect_error(ErrorKind::data, parts, [&] { read_pcd_bytes(content); });
}

/// A header of two points: x and y of 4 bytes, two counts of 2 bytes, 3 bytes of padding.
const std::string kFields =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x _ n y\nSIZE 4 1 2 8\nTYPE F U I F\nCOUNT 1 3 2 1\n";
const std::string kTwoPoints = kFields + "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";

void expect_two_points(const Table& table) {
  ASSERT_EQ(table.rows, 2U);
  ASSERT_EQ(table.columns.size(), 4U);
  EXPECT_EQ(values_of(table, "x"), (Doubles{1.5, -2}));
  EXPECT_EQ(values_of(table, "n_0"), (Doubles{-3, 4}));
  EXPECT_EQ(values_of(table, "n_1"), (Doubles{300, 5}));
  EXPECT_EQ(values_of(table, "y"), (Doubles{1e9, 0.25}));
  EXPECT_EQ(table.comments[1], "VIEWPOINT 0 0 0 1 0 0 0");
}

std::string binary_body() {
  const auto i16 = [](int v) { return bytes_of(static_cast<std::int16_t>(v)); };
  return bytes_of(1.5F) + "pad" + i16(-3) + i16(300) + bytes_of(1e9) +  // point 0
         bytes_of(-2.0F) + "pad" + i16(4) + i16(5) + bytes_of(0.25);    // point 1
}

/// LZF without any compression: runs of literals.
std::string stored_lzf(const std::string& bytes) {
  std::string packed;
  for (std::size_t k = 0; k < bytes.size(); k += 32) {
    const std::string run = bytes.substr(k, 32);
    packed += static_cast<char>(run.size() - 1);
    packed += run;
  }
  return packed;
}

std::string compressed_body(const std::string& packed, std::uint32_t unpacked_bytes) {
  return bytes_of(static_cast<std::uint32_t>(packed.size())) + bytes_of(unpacked_bytes) + packed;
}

TEST(Pcd, TheSameTwoPointsInEachEncoding) {
  expect_two_points(
      read_pcd_bytes(kTwoPoints + "DATA ascii\n1.5 1 2 3 -3 300 1e9\n-2 nan x 0 4 5 0.25\n"));
  expect_two_points(read_pcd_bytes(kTwoPoints + "DATA binary\n" + binary_body()));
  const auto i16 = [](int v) { return bytes_of(static_cast<std::int16_t>(v)); };
  const std::string fields_apart = bytes_of(1.5F) + bytes_of(-2.0F) + "padpad" + i16(-3) +
                                   i16(300) + i16(4) + i16(5) + bytes_of(1e9) + bytes_of(0.25);
  expect_two_points(read_pcd_bytes(kTwoPoints + "DATA binary_compressed\n" +
                                   compressed_body(stored_lzf(fields_apart), 38)));
}

TEST(Pcd, OldHeadersAndBodiesThatBeginWithANewline) {
  const Table table = read_pcd_bytes(
      "VERSION .5\r\nFIELDS x\r\nSIZE 4\r\nTYPE U\r\nWIDTH 1\r\nHEIGHT 1\r\n"
      "DATA binary\r\n\n\r\n\r");
  EXPECT_EQ(values_of(table, "x"), Doubles{static_cast<double>(0x0d0a0d0a)});
}

TEST(Pcd, NoPoints) {
  const std::string header = kFields + "WIDTH 0\nHEIGHT 1\nPOINTS 0\n";
  for (const char* encoding : {"ascii", "binary", "binary_compressed"})
    for (const char* body : {"", "x"}) {
      const Table table = read_pcd_bytes(header + "DATA " + encoding + "\n" + body);
      EXPECT_EQ(table.rows, 0U);
      ASSERT_EQ(table.columns.size(), 4U);
      for (const Column& column : table.columns) EXPECT_EQ(column.size(), 0U);
    }
}

TEST(Pcd, NaNPointsAreKept) {
  const Table table = read_pcd_bytes("FIELDS x\nSIZE 4\nTYPE F\nPOINTS 2\nDATA ascii\nnan\n1\n");
  EXPECT_TRUE(std::isnan(values_of(table, "x")[0]));
  EXPECT_EQ(values_of(table, "x")[1], 1.0);
}

// Fault 10.
TEST(Pcd, WidthTimesHeight) {
  const auto with = [](const std::string& counts) {
    return kFields + counts + "DATA binary\n" + binary_body();
  };
  expect_pcd_error(with("WIDTH 4294967296\nHEIGHT 4294967296\nPOINTS 0\n"), {"2^64"});
  expect_pcd_error(with("WIDTH 2\nHEIGHT 1\nPOINTS 3\n"), {"POINTS is 3", "is 2"});
  expect_pcd_error(with("WIDTH -1\nHEIGHT 1\n"), {"WIDTH", "'-1'"});
  expect_pcd_error(with("HEIGHT 1\n"), {"neither WIDTH nor POINTS"});
  expect_pcd_error(with("WIDTH 18446744073709551616\n"), {"WIDTH"});
}

// Fault 11.
TEST(Pcd, SizeTypeAndCount) {
  const auto with = [](const char* size, const char* type, const char* count) {
    return "FIELDS x y\nSIZE " + std::string(size) + "\nTYPE " + type + "\nCOUNT " + count +
           "\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary\n" + std::string(64, '\1');
  };
  EXPECT_EQ(read_pcd_bytes(with("4 8", "F F", "1 1")).rows, 1U);
  for (const char* size : {"0 4", "-4 4", "16 4", "4 3", "4", "4 4 4", "x 4"})
    expect_pcd_error(with(size, "F F", "1 1"), {"SIZE"});
  for (const char* type : {"F", "F X", "F FF"})
    expect_pcd_error(with("4 4", type, "1 1"), {"TYPE"});
  expect_pcd_error(with("2 4", "F F", "1 1"), {"TYPE F with SIZE 2"});
  for (const char* count : {"0 0", "-1 1", "4294967296 1", "1", "1 1 1"})
    expect_pcd_error(with("4 4", "F F", count), {"COUNT"});
  expect_pcd_error(with("4 4", "F F", "65536 65536"), {"more than 65536"});
  expect_pcd_error(with("4 4", "F F", "65000 1"), {"room for 0"});
}

// PCL skips fields of which a point has no values.
TEST(Pcd, FieldsWithoutValues) {
  const Table table = read_pcd_bytes(
      "FIELDS _ x n _ y\nSIZE 1 4 8 1 4\nTYPE U F F U F\nCOUNT 0 1 0 2 1\nWIDTH 1\nHEIGHT 1\n"
      "POINTS 1\nDATA binary\n" +
      bytes_of(1.5F) + std::string(2, '\1') + bytes_of(-2.0F));
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(values_of(table, "x"), Doubles{1.5});
  EXPECT_EQ(values_of(table, "y"), Doubles{-2});
}

// Fault 12.
TEST(Pcd, CompressedSizes) {
  const std::string header =
      "FIELDS x\nSIZE 4\nTYPE U\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary_compressed\n";
  const std::string body = stored_lzf(bytes_of(1) + bytes_of(2));
  EXPECT_EQ(values_of(read_pcd_bytes(header + compressed_body(body, 8)), "x"), (Doubles{1, 2}));
  expect_pcd_error(header + compressed_body(body, 9), {"found 9", "2 points"});
  expect_pcd_error(header + bytes_of(0xffffffffU) + bytes_of(8U) + body, {"4294967295"});
  expect_pcd_error(header + compressed_body(body.substr(0, 5), 8), {"damaged"});
  expect_pcd_error(header + compressed_body(body + std::string(1, '\0') + "x", 8), {"damaged"});
  expect_pcd_error(header + "1234", {"ends here"});
  const std::string many = "FIELDS x\nSIZE 4\nTYPE U\nPOINTS 1000000000\nDATA binary_compressed\n";
  expect_pcd_error(many + compressed_body(body, 4000000000U), {"cannot hold 4000000000"});
}

// Faults 13, 14: counts that the file cannot hold, checked before any allocation.
TEST(Pcd, FewerPointsThanTheHeaderStates) {
  for (const char* points : {"3", "2147483648", "4294967297", "18446744073709551615"}) {
    const std::string header = kFields + "WIDTH " + points + "\nHEIGHT 1\nPOINTS " + points + "\n";
    expect_pcd_error(header + "DATA binary\n" + binary_body(), {"room for 2", points});
    expect_pcd_error(header + "DATA ascii\n1 1 1 1 1 1 1\n1 1 1 1 1 1 1\n", {points});
    expect_pcd_error(header + "DATA binary_compressed\n" + compressed_body(stored_lzf("x"), 38),
                     {"found 38", points});
  }
  expect_pcd_error(kTwoPoints + "DATA ascii\n1 1 1 1 1 1 1               \n", {"after 1 points"});
  expect_pcd_error(kTwoPoints + "DATA ascii\n1 1 1 1 1 1 1\n1 1 1 1 1 100\n",
                   {"file.pcd:13", "'y'", "end of the line"});
  expect_pcd_error(kTwoPoints + "DATA ascii\n1 1 1 1 1 1 1\n1 1 1 1 1 99999 1\n",
                   {"file.pcd:13", "'n_1'", "'99999'"});
}

// Fault 13: a file that is cut while it is read is an error, not a SIGBUS.
TEST(Pcd, FileThatShrinksWhileItIsRead) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.write("file", std::string(1000000, 'x'));
  InputFile file(path);
  file.peek(1);
  ASSERT_EQ(::truncate(path.c_str(), 500000), 0);
  expect_error(ErrorKind::io, {"byte 500000", "shorter"}, [&] { file.peek(1000000); });
}

TEST(Pcd, BrokenHeaders) {
  expect_pcd_error("289814.15 4320978.61 170.76\n", {"file.pcd:1", "'289814.15'"});
  expect_pcd_error("VERSION 0.7\n", {"no DATA"});
  expect_pcd_error(kTwoPoints + "DATA text\n", {"'text'"});
  expect_pcd_error("POINTS 1\nDATA ascii\n1\n", {"no FIELDS"});
}

TEST(Lzf, BackReferencesThatOverlapAndAreLong) {
  const auto unpack = [](const std::string& packed, std::size_t size) {
    return unpack_lzf(std::as_bytes(std::span(packed)), size);
  };
  const auto text = [](const std::vector<std::byte>& bytes) {
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  // "ab", then 5 bytes from 2 back; then 7 + 200 + 2 bytes from 1 back.
  const std::string packed =
      std::string("\1ab", 3) + std::string("\x60\1", 2) + std::string("\xe0\xc8\0", 3);
  const auto unpacked = unpack(packed, 2 + 5 + 209);
  ASSERT_TRUE(unpacked);
  EXPECT_EQ(text(*unpacked), "abababa" + std::string(209, 'a'));
  EXPECT_FALSE(unpack(packed, 2 + 5 + 208));
  EXPECT_FALSE(unpack(packed, 2 + 5 + 210));
  EXPECT_FALSE(unpack(packed.substr(0, 7), 216));
  EXPECT_FALSE(unpack(std::string("\1ab\x60\2", 5), 7)) << "reaches before the start";
  EXPECT_FALSE(
      unpack("\x05"
             "ab",
             6))
      << "fewer literals than said";
  EXPECT_TRUE(unpack("", 0));
}

}  // namespace
}  // namespace adasplats
