// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/json_rows.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace adasplats::json_rows {
namespace {

using Json = nlohmann::ordered_json;

std::vector<Json> rows_of(std::string_view text) {
  std::vector<Json> rows;
  parse_json_rows(text, "rows", [&](const Json& row) { rows.push_back(row); });
  return rows;
}

// Oracle: the whole document in memory.
TEST(JsonRows, AreThoseOfTheDocument) {
  Json whole = {{"a", 1}, {"other", {{{"x", 9}}}}, {"rows", Json::array()}, {"b", {{"rows", 2}}}};
  for (int i = 0; i < 100; ++i)
    whole["rows"].push_back({{"x", i}, {"at", {i, {{"y", 2}}, "}]"}}, {"rows", {{{"x", -1}}}}});
  for (const int indent : {-1, 1}) {
    std::vector<Json> rows;
    const Json rest =
        parse_json_rows(whole.dump(indent), "rows", [&](const Json& row) { rows.push_back(row); });
    EXPECT_EQ(Json(rows), whole["rows"]);
    Json expected = whole;
    expected["rows"] = Json::array();
    EXPECT_EQ(rest, expected);
  }
}

TEST(JsonRows, OfNoneAndOfOne) {
  EXPECT_TRUE(rows_of(R"({"rows": []})").empty());
  EXPECT_EQ(rows_of(R"({"rows": [{}], "z": {"q": {}}})").size(), 1U);
}

TEST(JsonRows, ValuesThatAreNotRowsArePassedOn) {
  const std::vector<Json> rows = rows_of(R"({"rows": [{"x": 1}, 7, [{"x": 2}], null]})");
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[1], 7);
  EXPECT_TRUE(rows[2].is_array());
}

TEST(JsonRows, OtherTextIsAnError) {
  for (const char* text : {"", "{", "[]", "7", R"({"rows": {"a": {"x": 1}}})", R"({"rows": 7})",
                           R"({"row": [{}]})", R"({"rows": [{"x": 1})", R"({"rows": [{}]} 1)"})
    EXPECT_THROW(rows_of(text), Json::exception) << text;
}

TEST(JsonRows, ErrorsOfTheCallbackPass) {
  const auto taken = [](const Json& row) { row.at("y"); };
  EXPECT_THROW(parse_json_rows(R"({"rows": [{"x": 1}]})", "rows", taken), Json::out_of_range);
}

}  // namespace
}  // namespace adasplats::json_rows
