// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace adasplats {

// Reports as pages. Anything missing, null or of another type in the JSON is left out and never an
// error. HTML pages have no scripts and load nothing. UTF-8.

/// The results of `adasplats compare` as an HTML page. Pictures, named by paths relative to
/// `folder`, are embedded.
std::string report_html(const nlohmann::ordered_json& results, const std::filesystem::path& folder);

/// The same tables and texts in GitHub's Markdown, with links to pictures, relative to the report.
std::string report_markdown(const nlohmann::ordered_json& results);

/// The report of `adasplats calibrate` (docs/formats.md) as an HTML page.
std::string calibration_html(const nlohmann::ordered_json& report);

}  // namespace adasplats
