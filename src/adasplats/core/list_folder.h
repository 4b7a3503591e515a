// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace adasplats {

/// The paths of the entries of a folder, sorted. Without memory it throws std::bad_alloc, where
/// libstdc++'s directory_iterator ends the program. Errors: no_input (cannot be opened), io (a read
/// fails).
std::vector<std::filesystem::path> list_folder(const std::filesystem::path& folder);

/// The same; empty if it is not a folder, does not exist or must not be read.
std::vector<std::filesystem::path> list_folder_if_any(const std::filesystem::path& folder);

/// The regular files in a folder and in its subfolders, sorted; links to folders are not followed.
/// Errors: as list_folder().
std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder);

}  // namespace adasplats
