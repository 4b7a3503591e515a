// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "adasplats/core/function_ref.h"

namespace adasplats {

/// Parses a JSON object with a long array `key`: each row is passed to `take` and dropped, so that
/// memory holds one row at a time. Returns the object without the rows. Rows are passed on before
/// the text after them has been parsed. Errors: nlohmann::json::exception (not JSON, not an object,
/// no array `key`); those of `take`.
nlohmann::ordered_json parse_json_rows(std::string_view text, std::string_view key,
                                       FunctionRef<void(const nlohmann::ordered_json& row)> take);

}  // namespace adasplats
