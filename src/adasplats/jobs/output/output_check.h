// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace adasplats {

/// Throws usage unless the name of a file ends with one of `endings` (".ply", in lower case; the
/// name's case does not matter): what a file holds is not another format than its name says.
void require_ending(const std::filesystem::path& file, std::span<const std::string> endings);
void require_ending(const std::filesystem::path& file, const std::string& ending);

/// Throws usage where writing `file` would replace one of `inputs`, by whatever name (links), or
/// put it among the files that an input folder is read for, as points or as anything else that is
/// looked for there (FileKind).
void require_no_input(const std::filesystem::path& file,
                      std::span<const std::filesystem::path> inputs);

/// Throws usage where a folder that is to be made is one of `inputs`, holds one or lies in one.
void require_folder_apart(const std::filesystem::path& folder,
                          std::span<const std::filesystem::path> inputs);

}  // namespace adasplats
