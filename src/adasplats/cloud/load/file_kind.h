// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace adasplats {

/// The kind of a file, from its name and first bytes.
enum class FileKind : std::uint8_t {
  points,       ///< has a point format and is none of those below; text with a point in it
  mesh,         ///< OBJ, glTF, a PLY that declares faces
  splat_model,  ///< SPZ, a PLY with a radius and a normal or with Gaussians
  trajectory,   ///< text with columns qw, qx, qy, qz, or with poses as lines
  other,        ///< none of these, such as prose
};

/// Reads at most 64 KiB. An absent or empty file is classified by its name. Errors: io; no_input (a
/// file with the extension of a format cannot be opened).
FileKind kind_of_file(const std::filesystem::path& file);

/// Whether a file with this extension can be of another kind than FileKind::other.
bool has_extension_of_a_kind(const std::filesystem::path& file);

/// "points", "meshes", ...
std::string_view plural_name_of(FileKind kind);

}  // namespace adasplats
