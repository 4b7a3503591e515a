// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "adasplats/io/base/point_files.h"

namespace adasplats {

/// What the extension of a file implies about its content.
enum class ExtensionMeaning : std::uint8_t {
  points,
  geometry,  ///< points or a surface, depending on the header
  text,      ///< points, poses or prose, depending on the lines
};

/// A format of point files. The list in point_format.cpp drives reading, the detection of files in
/// a folder, messages and help. A new format is a reader and an entry.
struct PointFormat {
  std::string_view name;                         ///< "LAS or LAZ", as in help
  std::span<const std::string_view> extensions;  ///< ".las", ".laz"
  std::span<const std::string_view> beginnings;  ///< alternative first bytes; empty: none defined
  ExtensionMeaning means = ExtensionMeaning::points;
  std::string_view remark;  ///< after the last extension in messages
  Table (*read)(const std::filesystem::path& path, const LasReadOptions& options);
  Crs (*read_crs)(const std::filesystem::path& path) = nullptr;  ///< null: the format has none
  /// As random_access_records(), if `read` supports PointSelection::records; null: no random
  /// access.
  std::optional<std::uint64_t> (*records)(const std::filesystem::path& path,
                                          bool salvage) = nullptr;
};

std::span<const PointFormat> point_formats();

/// Whether a file is a tile of an Entwine folder or the points of a Potree octree, which are known
/// by the files around them; a .bin of these is no scan.
bool is_octree_part(const std::filesystem::path& path);

/// By the extension, in any case; null if unknown.
const PointFormat* format_of_extension(const std::filesystem::path& path);

/// By the extension and the first bytes. Errors: data (they contradict each other; an unknown
/// format, with the supported ones), those of opening the file.
const PointFormat& format_of_file(const std::filesystem::path& path);

/// "PLY, PCD, LAS or LAZ, E57, KITTI bin, text, PTX", for help.
std::string point_format_names();

}  // namespace adasplats
