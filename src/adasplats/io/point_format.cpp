// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/point_format.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "adasplats/io/base/column_names.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/ept/ept_tile.h"
#include "adasplats/io/ept/potree_octree.h"
#include "adasplats/io/las/las.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

using Text = std::string_view;

constexpr Text kPly[] = {".ply"};
constexpr Text kPlyStarts[] = {"ply\n", "ply\r"};
constexpr Text kPcd[] = {".pcd"};
constexpr Text kPcdStarts[] = {"# .PCD"};
constexpr Text kLas[] = {".las", ".laz"};
constexpr Text kLasStarts[] = {"LASF"};
constexpr Text kE57[] = {".e57"};
constexpr Text kE57Starts[] = {"ASTM-E57"};
constexpr Text kBin[] = {".bin"};
constexpr Text kText[] = {".xyz", ".txt", ".asc", ".csv", ".pts"};
constexpr Text kPtx[] = {".ptx"};

using Path = std::filesystem::path;
using Options = LasReadOptions;

Crs crs_of_leading_comments(const Path& path) {
  return crs_of_comments(path, leading_comments(path));
}

constexpr PointFormat kFormats[] = {
    {.name = "PLY",
     .extensions = kPly,
     .beginnings = kPlyStarts,
     .means = ExtensionMeaning::geometry,
     .read = [](const Path& path,
                const Options& options) { return read_ply(path, options.selection.records); },
     .read_crs = &read_ply_crs,
     .records = [](const Path& path, bool) { return ply_records_at_random(path); }},
    {.name = "PCD",
     .extensions = kPcd,
     .beginnings = kPcdStarts,
     .read = [](const Path& path, const Options&) { return read_pcd(path); },
     .read_crs = &crs_of_leading_comments},
    {.name = "LAS or LAZ",
     .extensions = kLas,
     .beginnings = kLasStarts,
     .read = &read_las,
     .read_crs = [](const Path& path) { return read_las_facts(path).crs; },
     .records = &las_records_at_random},
    {.name = "E57",
     .extensions = kE57,
     .beginnings = kE57Starts,
     .read = [](const Path& path, const Options&) { return read_e57(path); },
     .read_crs = &read_e57_crs},
    {.name = "KITTI bin",
     .extensions = kBin,
     .remark = " (KITTI; *.pcd.bin: nuScenes)",
     .read = [](const Path& path, const Options&) { return read_bin(path); }},
    {.name = "text",
     .extensions = kText,
     .means = ExtensionMeaning::text,
     .read = [](const Path& path, const Options&) { return read_text_points(path); },
     .read_crs = &crs_of_leading_comments},
    {.name = "PTX",
     .extensions = kPtx,
     .read = [](const Path& path, const Options&) { return read_ptx(path); }},
};

/// Known by the folder, not by the extension.
constexpr PointFormat kEptTile = {
    .name = "EPT tile",
    .extensions = {},
    .read = [](const Path& path, const Options&) { return read_ept_tile(path); },
    .read_crs = &read_ept_crs};

constexpr PointFormat kPotreeOctree = {
    .name = "Potree octree",
    .extensions = {},
    .read = [](const Path& path, const Options&) { return read_potree_octree(path); },
    .read_crs = &read_potree_crs};

const PointFormat* format_of_first_bytes(const Path& path) {
  InputFile file(path);
  const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(8, file.size_bytes()));
  const std::string_view start(reinterpret_cast<const char*>(file.peek(count).data()), count);
  for (const PointFormat& format : kFormats)
    for (const std::string_view beginning : format.beginnings)
      if (start.starts_with(beginning)) return &format;
  return nullptr;
}

/// ".ply, .pcd and .ptx".
std::string supported_extensions() {
  std::vector<std::string> words;
  for (const PointFormat& format : kFormats) {
    for (const std::string_view extension : format.extensions) words.emplace_back(extension);
    words.back() += format.remark;
  }
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return text;
}

/// Finds the columns of coordinates in any case.
void keep_rows_within(const Extent& extent, const Path& path, Table& table) {
  std::array<const Column*, 3> axes{};
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    for (const Column& column : table.columns)
      if (lower_case(column.name) == std::string_view("xyz").substr(axis, 1)) axes[axis] = &column;
    if (axes[axis] == nullptr)
      throw data_error({path, {}, {}}, "has no columns x, y and z for `extent`");
  }
  std::vector<bool> kept(table.rows);
  for (std::size_t row = 0; row < table.rows; ++row)
    kept[row] = extent.contains(
        {axes[0]->as_double(row), axes[1]->as_double(row), axes[2]->as_double(row)});
  keep_rows(kept, table);
}

/// What converts a file of another program; empty: unknown.
std::string conversion_of(const Path& path) {
  if (lower_case(path.extension().string()) != ".osf") return "";
  const std::string stem = path.stem().string();
  return "; an Ouster recording: convert it to packets, ouster-cli source " + stem + ".osf save " +
         stem + ".pcap";
}

}  // namespace

std::span<const PointFormat> point_formats() { return kFormats; }

bool is_octree_part(const Path& path) { return is_ept_tile(path) || is_potree_octree(path); }

const PointFormat* format_of_extension(const Path& path) {
  const std::string extension = lower_case(path.extension().string());
  for (const PointFormat& format : kFormats)
    for (const std::string_view known : format.extensions)
      if (known == extension) return &format;
  return nullptr;
}

const PointFormat& format_of_file(const Path& path) {
  if (is_ept_tile(path)) return kEptTile;
  if (is_potree_octree(path)) return kPotreeOctree;
  const PointFormat* const by_bytes = format_of_first_bytes(path);
  const PointFormat* const by_extension = format_of_extension(path);
  if (by_bytes != nullptr && by_extension != nullptr && by_bytes != by_extension)
    throw data_error({path, 0, {}}, "begins like " + std::string(by_bytes->name) +
                                        ", but has the extension of " +
                                        std::string(by_extension->name));
  if (by_extension != nullptr) return *by_extension;
  if (by_bytes != nullptr) return *by_bytes;
  throw data_error({path, {}, {}}, "unknown format " + shown(path.extension().string()) +
                                       ", supported are " + supported_extensions() +
                                       conversion_of(path));
}

std::string point_format_names() {
  std::string text;
  for (const PointFormat& format : kFormats) {
    text += (text.empty() ? "" : ", ") + std::string(format.name);
  }
  return text;
}

bool is_las(const Path& path) { return format_of_file(path).read == &read_las; }

Crs read_crs(const Path& path) {
  const PointFormat& format = format_of_file(path);
  return format.read_crs == nullptr ? Crs() : format.read_crs(path);
}

std::optional<std::uint64_t> random_access_records(const Path& path, bool salvage) {
  const PointFormat& format = format_of_file(path);
  return format.records == nullptr ? std::nullopt : format.records(path, salvage);
}

void require_no_levels(const Path& path, const PointSelection& selection) {
  if (!selection.has_levels()) return;
  throw Error(ErrorKind::usage,
              path.string() + ": `" + (selection.level ? "level" : "resolution") +
                  "` needs a file with levels of detail (COPC), this one has none");
}

namespace {

/// Leaves out the points that a column flags as deleted, and the column, as the reader of LAS does.
void drop_withheld(Table& table) {
  const Column* const column = find_column(table, PointColumn::withheld);
  if (column == nullptr) return;
  std::vector<bool> kept(table.rows);
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = !(column->as_double(i) > 0);
  const auto withheld = static_cast<std::size_t>(std::ranges::count(kept, false));
  if (withheld > 0)
    table.notes.push_back({NoteKind::withheld, std::to_string(withheld) + " of " +
                                                   std::to_string(table.rows) + " points"});
  table.columns.erase(table.columns.begin() + (column - table.columns.data()));
  if (withheld > 0) keep_rows(kept, table);
}

}  // namespace

Table read_points(const Path& path, const LasReadOptions& options) {
  const PointFormat& format = format_of_file(path);
  if (options.selection.records && format.records == nullptr)
    throw std::logic_error("read_points: records of a format without random access");
  if (format.read == &read_las) return read_las(path, options);
  require_no_levels(path, options.selection);
  Table table = format.read(path, options);
  drop_withheld(table);
  if (options.selection.extent) keep_rows_within(*options.selection.extent, path, table);
  return table;
}

}  // namespace adasplats
