// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/arrow/arrow_writer.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace adasplats {
namespace {

template <class T>
Column limits_of(const std::string& name) {
  return {name, std::vector<T>{std::numeric_limits<T>::lowest(), T(1), T(0),
                               std::numeric_limits<T>::max(), T(7)}};
}

// Oracle: the reader, which is tested with files put together by the letter of the specification
// (tests/exports reads such files with another program's library).
TEST(ArrowWriter, EveryTypeIsReadBack) {
  ArrowTable table;
  table.texts["name"] = {"up_lidar", "", "a\nb", "\xc3\xa4", "end"};
  table.texts["empty"] = std::vector<std::string>(5);
  table.numbers.rows = 5;
  table.numbers.columns = {limits_of<std::int8_t>("i8"),   limits_of<std::uint8_t>("u8"),
                           limits_of<std::int16_t>("i16"), limits_of<std::uint16_t>("u16"),
                           limits_of<std::int32_t>("i32"), limits_of<std::uint32_t>("u32"),
                           limits_of<std::int64_t>("i64"), limits_of<std::uint64_t>("u64"),
                           limits_of<float>("f32"),        limits_of<double>("f64")};
  const ArrowTable again = arrow_table_of("a.feather", arrow_file_bytes(table));
  EXPECT_EQ(again.texts, table.texts);
  ASSERT_EQ(again.numbers.rows, 5U);
  ASSERT_EQ(again.numbers.columns.size(), table.numbers.columns.size());
  for (std::size_t k = 0; k < table.numbers.columns.size(); ++k) {
    EXPECT_EQ(again.numbers.columns[k].name, table.numbers.columns[k].name);
    EXPECT_EQ(again.numbers.columns[k].values, table.numbers.columns[k].values) << k;
  }
}

TEST(ArrowWriter, TablesWithoutRowsKeepTheirColumns) {
  ArrowTable table;
  table.texts["category"] = {};
  table.numbers.columns = {{"x", std::vector<float>()}};
  const ArrowTable again = arrow_table_of("a.feather", arrow_file_bytes(table));
  EXPECT_EQ(again.numbers.rows, 0U);
  EXPECT_TRUE(again.texts.contains("category"));
  EXPECT_NE(again.numbers.find("x"), nullptr);
}

TEST(ArrowWriter, ColumnsOfUnequalLength) {
  ArrowTable table;
  table.numbers.rows = 2;
  table.numbers.columns = {{"x", std::vector<float>{1, 2}}, {"y", std::vector<float>{1}}};
  EXPECT_THROW(arrow_file_bytes(table), std::logic_error);
  table.numbers.columns.pop_back();
  table.texts["t"] = {"a"};
  EXPECT_THROW(arrow_file_bytes(table), std::logic_error);
}

}  // namespace
}  // namespace adasplats
