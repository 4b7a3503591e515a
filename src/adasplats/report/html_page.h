// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/report/document.h"

namespace adasplats::page {

/// A document as one HTML page without scripts that loads nothing from anywhere: pictures below
/// `folder` are embedded.
std::string html_page(const Document& document, const std::filesystem::path& folder);

}  // namespace adasplats::page
