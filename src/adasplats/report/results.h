// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/report/document.h"

// Reads the results of `adasplats compare` and makes the sections of the report. Missing keys and
// other types have no value.
namespace adasplats::page {

using Json = nlohmann::ordered_json;
using KeyPath = std::vector<std::string>;

/// Null if a key of the path is missing.
const Json* find(const Json& json, const KeyPath& path);
/// Only finite numbers.
std::optional<double> number_at(const Json& json, const KeyPath& path);
/// "" if there is no text.
std::string text_at(const Json& json, const KeyPath& path);

struct Competitor {
  std::string name;
  std::string title;      ///< or its name
  std::string badge;      ///< its state unless done; a competitor with a badge is never best
  bool has_model = true;  ///< false: its model was never made
  Key key;
  const Json* json = nullptr;
};

/// Suffix of variants without resampling.
inline constexpr std::string_view kVariantSuffix = "-no-resample";

/// The competitors in order. A variant shares the slot of its base. The results must outlive them.
std::vector<Competitor> competitors_of(const Json& results);

/// The paper's rows that are objects; the results must outlive them.
std::vector<const Json*> paper_rows_of(const Json& results);

/// The report of the results; empty sections are omitted.
Document document_of(const Json& results);

/// The sections of the report.
Section paper_section(const Json& results, const std::vector<Competitor>& competitors);
Section cost_section(const std::vector<Competitor>& competitors);
Section clouds_section(const std::vector<Competitor>& competitors);
Section beams_section(const std::vector<Competitor>& competitors);
Section truth_section(const std::vector<Competitor>& competitors);

}  // namespace adasplats::page
