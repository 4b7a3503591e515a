// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace adasplats::page {

/// RFC 4648.
std::string base64(const std::string& bytes);

/// A PNG or JPEG below `folder` as a data URI; empty where there is none: no such file, no such
/// format, or a path that leaves the folder.
std::string picture_data_uri(const std::filesystem::path& folder, const std::string& relative);

}  // namespace adasplats::page
