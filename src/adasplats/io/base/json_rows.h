// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "adasplats/core/function_ref.h"

namespace adasplats {

/// Parses a JSON object whose array `key` has many rows: each goes to `take` when it has been read,
/// and none is kept, so that memory holds one of them. Gives the object without the rows. They may
/// come before what stands behind them is known to be there, or to be JSON. Errors:
/// nlohmann::json::exception (no JSON, no object, no array `key`); those of `take`.
nlohmann::ordered_json parse_json_rows(std::string_view text, std::string_view key,
                                       FunctionRef<void(const nlohmann::ordered_json& row)> take);

}  // namespace adasplats
