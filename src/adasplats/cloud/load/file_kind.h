// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace adasplats {

/// What a file is, as far as its name and its first bytes say.
enum class FileKind : std::uint8_t {
  points,       ///< of a format of points, and nothing says otherwise; text with a point in it
  mesh,         ///< OBJ, glTF, a PLY that declares faces
  splat_model,  ///< a PLY with a radius and a normal
  trajectory,   ///< text with columns qw, qx, qy, qz, or whose lines are poses
  other,        ///< none of these, such as prose
};

/// Looks at the name and at most 64 KiB. What cannot be read is what its name says.
FileKind kind_of_file(const std::filesystem::path& file);

/// Whether files with such a name can be anything but FileKind::other.
bool has_extension_of_a_kind(const std::filesystem::path& file);

/// "points", "meshes", ...
std::string_view plural_name_of(FileKind kind);

}  // namespace adasplats
