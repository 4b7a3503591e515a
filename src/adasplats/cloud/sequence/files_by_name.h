// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace adasplats {

/// Files of a folder with an extension, by name; none where there is no such folder. Errors:
/// no_input (it cannot be listed).
std::vector<std::filesystem::path> files_by_name(const std::filesystem::path& folder,
                                                 const std::string& extension);

/// The number that a name such as 000123 is; nothing for other names.
std::optional<std::size_t> number_in_name(const std::filesystem::path& file);

}  // namespace adasplats
