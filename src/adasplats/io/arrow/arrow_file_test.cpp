// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/arrow/arrow_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "adasplats/io/arrow/arrow_writer_test.h"
#include "adasplats/io/bags/recording_files_test.h"

namespace adasplats {
namespace {

using arrow_test::arrow_file;
using arrow_test::ArrowColumn;
using arrow_test::halves;
using arrow_test::numbers;
using arrow_test::texts;
using io_test::values_of;

ArrowTable table_of(const std::string& bytes) { return arrow_table_of("a.feather", bytes); }

TEST(ArrowFile, EveryValueOfEveryType) {
  ArrowColumn flags = {"flag", 6, 0, false, 3, {std::string(1, '\x05')}};
  constexpr std::int64_t kStamp = 315'966'265'259'836'001;
  const std::vector<ArrowColumn> columns = {halves("half", {0x3c00, 0xc400, 0x0001}),
                                            numbers<float>("f", {1.5F, -2, 0}),
                                            numbers<double>("d", {0.1, 2, 3}),
                                            numbers<std::uint8_t>("u8", {0, 200, 255}),
                                            numbers<std::int8_t>("i8", {-128, 0, 127}),
                                            numbers<std::uint16_t>("u16", {0, 1, 65535}),
                                            numbers<std::int32_t>("i32", {-5, 0, 2654000}),
                                            numbers<std::int64_t>("i64", {kStamp, kStamp + 1, -1}),
                                            texts("name", {"up_lidar", "", "down"}),
                                            flags};
  const ArrowTable table = table_of(arrow_file({columns}));
  ASSERT_EQ(table.numbers.rows, 3U);
  EXPECT_EQ(values_of(table.numbers, "half"), (std::vector<double>{1, -4, 0x1p-24}));
  EXPECT_EQ(values_of(table.numbers, "f"), (std::vector<double>{1.5, -2, 0}));
  EXPECT_EQ(values_of(table.numbers, "d"), (std::vector<double>{0.1, 2, 3}));
  EXPECT_EQ(values_of(table.numbers, "u8"), (std::vector<double>{0, 200, 255}));
  EXPECT_EQ(values_of(table.numbers, "i8"), (std::vector<double>{-128, 0, 127}));
  EXPECT_EQ(values_of(table.numbers, "u16"), (std::vector<double>{0, 1, 65535}));
  EXPECT_EQ(values_of(table.numbers, "i32"), (std::vector<double>{-5, 0, 2654000}));
  EXPECT_EQ(std::get<std::vector<std::int64_t>>(table.numbers.find("i64")->values),
            (std::vector<std::int64_t>{kStamp, kStamp + 1, -1}));
  EXPECT_EQ(values_of(table.numbers, "flag"), (std::vector<double>{1, 0, 1}));
  EXPECT_EQ(table.texts.at("name"), (std::vector<std::string>{"up_lidar", "", "down"}));
}

TEST(ArrowFile, HalvesAtTheirLimits) {
  const ArrowTable table = table_of(
      arrow_file({{halves("h", {0x7bff, 0x0400, 0x83ff, 0x8000, 0x7c00, 0xfc00, 0x7e00})}}));
  const std::vector<double> values = values_of(table.numbers, "h");
  EXPECT_EQ(values[0], 65504);
  EXPECT_EQ(values[1], 0x1p-14);
  EXPECT_EQ(values[2], -1023 * 0x1p-24);
  EXPECT_TRUE(values[3] == 0 && std::signbit(values[3]));
  EXPECT_EQ(values[4], std::numeric_limits<double>::infinity());
  EXPECT_EQ(values[5], -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(values[6]));
}

TEST(ArrowFile, BatchesFollowEachOther) {
  const ArrowTable table =
      table_of(arrow_file({{numbers<float>("x", {1, 2}), texts("t", {"a", "bc"})},
                           {numbers<float>("x", {3}), texts("t", {"d"})},
                           {numbers<float>("x", {}), texts("t", {})}}));
  EXPECT_EQ(values_of(table.numbers, "x"), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(table.texts.at("t"), (std::vector<std::string>{"a", "bc", "d"}));
}

TEST(ArrowFile, CompressedBuffers) {
  const std::vector<std::uint8_t> plain = {7};
  for (const auto& packed : bags_test::kPackedZeros) {
    const std::string_view packing = packed.packing;
    if (packing != "lz4" && packing != "zstd") continue;
    const int codec = packing == "lz4" ? 0 : 1;
    ArrowColumn zeros = numbers("zero", std::vector<std::uint8_t>(1000));
    zeros.buffers = {arrow_test::raw_bytes(std::vector<std::int64_t>{1000}) +
                     std::string(packed.bytes)};
    ArrowColumn as_it_is = numbers("one", std::vector<std::uint8_t>(1000, 1));
    as_it_is.buffers[0] =
        arrow_test::raw_bytes(std::vector<std::int64_t>{-1}) + as_it_is.buffers[0];
    try {
      const ArrowTable table = table_of(arrow_file({{zeros, as_it_is}}, codec));
      EXPECT_EQ(values_of(table.numbers, "zero"), std::vector<double>(1000));
      EXPECT_EQ(values_of(table.numbers, "one"), std::vector<double>(1000, 1));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::unavailable) << error.what();
    }
  }
  expect_error(ErrorKind::data, {"compression 2", "LZ4"},
               [&] { table_of(arrow_file({{numbers("x", plain)}}, 2)); });
}

TEST(ArrowFile, WhatIsNotReadIsAnError) {
  const auto reject = [](const std::vector<std::string>& parts, ArrowColumn column) {
    expect_error(ErrorKind::data, parts, [&] { table_of(arrow_file({{std::move(column)}})); });
  };
  ArrowColumn column = numbers<float>("x", {1, 2});
  column.nulls = 1;
  reject({"a.feather", "column 'x'", "1 null values"}, column);
  column = numbers<std::int8_t>("kind", {0, 1});
  column.is_dictionary = true;
  reject({"column 'kind'", "dictionary"}, column);
  column = numbers<std::int64_t>("when", {0, 1});
  column.kind = 10;  // Timestamp
  reject({"column 'when'", "type number 10"}, column);
  column = numbers<std::int64_t>("x", {0, 1});
  column.bits = 24;
  reject({"column 'x'", "no known type"}, column);
  expect_error(ErrorKind::data, {"exists twice"}, [] {
    table_of(arrow_file({{numbers<float>("x", {1}), numbers<float>("x", {1})}}));
  });
  expect_error(ErrorKind::data, {"Feather version 1", "pyarrow"}, [] { table_of("FEA1....FEA1"); });
  expect_error(ErrorKind::data, {"ARROW1"}, [] { table_of("ply\n"); });
}

TEST(ArrowFile, DamageIsAnError) {
  ArrowColumn shorter = numbers<float>("x", {1, 2});
  shorter.buffers[0].resize(4);
  expect_error(ErrorKind::data, {"record batch 0", "column 'x'", "4 bytes", "expected 8"},
               [&] { table_of(arrow_file({{shorter}})); });
  ArrowColumn longer = numbers<float>("y", {1, 2, 3});
  expect_error(ErrorKind::data, {"column 'y'", "3 values", "expected 2"}, [&] {
    table_of(arrow_file({{numbers<float>("x", {1, 2}), longer}}));
  });
  ArrowColumn name = texts("t", {"abc"});
  name.buffers[1] = "ab";
  expect_error(ErrorKind::data, {"column 't'", "damaged"}, [&] { table_of(arrow_file({{name}})); });
  // Every file that ends too early, and every changed byte, is an error or other values.
  const std::string good = arrow_file({{numbers<float>("x", {1, 2}), texts("t", {"a", "b"})}});
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_THROW(table_of(good.substr(0, size)), Error) << size;
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const unsigned mask : {1U, 0x80U, 0xffU}) {
      std::string changed = good;
      changed[at] = static_cast<char>(static_cast<unsigned char>(changed[at]) ^ mask);
      try {
        EXPECT_LE(table_of(changed).numbers.rows, 2U) << at;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::data) << at << ": " << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace adasplats
