// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace adasplats {

/// The results of `adasplats compare` as one HTML page without scripts that loads nothing from
/// anywhere: pictures, named by paths relative to `folder`, are embedded. Whatever is missing, null
/// or of another type in the results is left out; never throws for that. UTF-8.
std::string report_html(const nlohmann::ordered_json& results, const std::filesystem::path& folder);

/// The same tables and texts in GitHub's Markdown, pictures as links relative to the report.
std::string report_markdown(const nlohmann::ordered_json& results);

}  // namespace adasplats
