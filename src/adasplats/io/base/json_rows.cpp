// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/json_rows.h"

#include <nlohmann/json.hpp>
#include <string>

namespace adasplats {

using Json = nlohmann::ordered_json;

Json parse_json_rows(std::string_view text, std::string_view key,
                     FunctionRef<void(const Json& row)> take) {
  using Event = Json::parse_event_t;
  bool is_named = false;  // the current top-level value
  bool is_inside = false;
  const auto keep = [&](int depth, Event event, const Json& parsed) {
    if (event == Event::key && depth == 1) is_named = parsed.get_ref<const std::string&>() == key;
    if (event == Event::array_start && depth == 1) is_inside = is_named;
    if (event == Event::array_end && depth == 1) is_inside = false;
    if (!is_inside || event != Event::object_end || depth != 2) return true;
    take(parsed);
    return false;
  };
  Json rest = Json::parse(text.data(), text.data() + text.size(), keep);
  // Rows that are not objects are still in the array: `take` reports them.
  for (const Json& row : rest.at(std::string(key)).get_ref<const Json::array_t&>()) take(row);
  return rest;
}

}  // namespace adasplats
