// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace adasplats {

/// Throws usage unless the name of a file ends with one of `endings` (".ply", in lower case; the
/// name's case does not matter): the name must match the format.
void require_ending(const std::filesystem::path& file, std::span<const std::string> endings);
void require_ending(const std::filesystem::path& file, const std::string& ending);

/// Throws usage if writing `file` would replace one of `inputs`, also through links, or would add
/// it to the files that are read in an input folder (FileKind).
void require_no_input(const std::filesystem::path& file,
                      std::span<const std::filesystem::path> inputs);

/// Throws usage if an output folder is one of `inputs`, contains one or is inside one.
void require_folder_apart(const std::filesystem::path& folder,
                          std::span<const std::filesystem::path> inputs);

}  // namespace adasplats
