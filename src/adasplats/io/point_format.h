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

/// What a file holds as far as its extension says.
enum class ExtensionMeans : std::uint8_t {
  points,
  geometry,  ///< points or a surface: the header says
  text,      ///< points, poses or prose: the lines say
};

/// A format of point files. All of them stand in one list (point_format.cpp): reading, the kinds of
/// files in a folder, messages and help are made from it. A new format is its reader and an entry.
struct PointFormat {
  std::string_view name;                         ///< "LAS or LAZ", as help has it
  std::span<const std::string_view> extensions;  ///< ".las", ".laz"
  std::span<const std::string_view> beginnings;  ///< first bytes, any of them; none: not known
  ExtensionMeans means = ExtensionMeans::points;
  std::string_view remark;  ///< behind the last extension in messages
  Table (*read)(const std::filesystem::path& path, const LasReadOptions& options);
  Crs (*read_crs)(const std::filesystem::path& path) = nullptr;  ///< null: the format says none
  /// As records_at_random(); null: none can be read so. Then `read` takes PointSelection::records.
  std::optional<std::uint64_t> (*records)(const std::filesystem::path& path,
                                          bool salvage) = nullptr;
};

std::span<const PointFormat> point_formats();

/// By the extension, in any case; null: none of them.
const PointFormat* format_of_extension(const std::filesystem::path& path);

/// By the extension and the first bytes, which must not contradict each other. Errors: data (they
/// do; an unknown format, with those that are understood), those of opening the file.
const PointFormat& format_of_file(const std::filesystem::path& path);

/// "PLY, PCD, LAS or LAZ, E57, KITTI bin, text, PTX", for help.
std::string point_format_names();

}  // namespace adasplats
