// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/report/document.h"

// Reading compare's results without trusting them: what is missing or of another type is nothing.
namespace adasplats::page {

using Json = nlohmann::ordered_json;
using KeyPath = std::vector<std::string>;

/// Null where a key of the path is missing.
const Json* find(const Json& json, const KeyPath& path);
/// Only finite numbers.
std::optional<double> number_at(const Json& json, const KeyPath& path);
/// "" where there is no text.
std::string text_at(const Json& json, const KeyPath& path);

struct Competitor {
  std::string name;
  std::string title;      ///< the name where it has none
  std::string badge;      ///< its state unless it is done: then it is best at nothing
  bool has_model = true;  ///< false: what its figures would be of was never made
  Key key;
  const Json* json = nullptr;
};

/// Ends the name of a competitor that is another one without resampling.
inline constexpr std::string_view kVariantSuffix = "-no-resample";

/// In their order. A variant shares the slot of the competitor it is a variant of. The results
/// have to outlive them.
std::vector<Competitor> competitors_of(const Json& results);

/// The paper's rows that are objects; the results have to outlive them.
std::vector<const Json*> paper_rows_of(const Json& results);

}  // namespace adasplats::page
