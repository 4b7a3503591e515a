// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/box_files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "adasplats/cloud/load/nuscenes_drive.h"
#include "adasplats/cloud/load/pandaset_drive.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/input_file.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAv2Boxes = "annotations.feather";
constexpr const char* kTracklets = "tracklet_labels.xml";
constexpr const char* kNuscenesBoxes = "sample_annotation.json";

enum class BoxFormat : std::uint8_t { csv, av2, kitti_tracklets, json, pandaset_frame };

BoxFormat format_of_file(const fs::path& path) {
  std::array<char, 6> bytes{};
  const InputDescriptor file(path);
  const auto size =
      static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), file.size_bytes()));
  file.read_at(0, std::as_writable_bytes(std::span(bytes)).first(size));
  std::string_view start(bytes.data(), size);
  if (start == "ARROW1") return BoxFormat::av2;
  if (start.starts_with("\x1f\x8b") || start.starts_with('\x80')) return BoxFormat::pandaset_frame;
  if (start.starts_with("\xef\xbb\xbf")) start.remove_prefix(3);  // byte order mark
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return BoxFormat::csv;
  if (start[first] == '<') return BoxFormat::kitti_tracklets;
  return start[first] == '[' || start[first] == '{' ? BoxFormat::json : BoxFormat::csv;
}

/// The folder of a sequence's cuboids, from this or the folders around it.
std::optional<fs::path> cuboids_in(const fs::path& folder) {
  for (const fs::path& cuboids : {folder / "annotations" / "cuboids", folder / "cuboids", folder})
    if (!pandaset_frames(cuboids).empty()) return cuboids;
  return std::nullopt;
}

bool is_box_file(const fs::path& path) {
  std::error_code ignored;  // an unreadable file is none
  return fs::is_regular_file(path, ignored);
}

BoxContent read_box_folder(const fs::path& folder, const BoxDrive& drive) {
  if (is_box_file(folder / kAv2Boxes)) return read_av2_boxes(folder / kAv2Boxes);
  if (is_box_file(folder / kTracklets)) return read_kitti_tracklets(folder / kTracklets, drive);
  if (is_box_file(folder / kNuscenesBoxes)) return read_nuscenes_boxes(folder, drive.scene);
  if (const std::vector<fs::path> tables = nuscenes_tables(folder); !tables.empty())
    return read_nuscenes_boxes(find_nuscenes_scene(folder, tables, drive.scene).tables,
                               drive.scene);
  if (const auto cuboids = cuboids_in(folder)) return read_pandaset_boxes(*cuboids, drive.lidar);
  throw Error(ErrorKind::no_input, folder.string() + ": contains no boxes (" + kAv2Boxes + ", " +
                                       kTracklets + ", annotations/cuboids or v1.0-*/" +
                                       kNuscenesBoxes + ")");
}

}  // namespace

BoxContent read_box_file(const fs::path& path, const BoxDrive& drive) {
  std::error_code ignored;  // the reader reports it
  if (fs::is_directory(path, ignored)) return read_box_folder(path, drive);
  switch (format_of_file(path)) {
    case BoxFormat::av2: return read_av2_boxes(path);
    case BoxFormat::kitti_tracklets: return read_kitti_tracklets(path, drive);
    case BoxFormat::json:
      if (path.filename() == kNuscenesBoxes)
        return read_nuscenes_boxes(path.parent_path(), drive.scene);
      throw Error(ErrorKind::data, path.string() + ": is JSON, expected " + kNuscenesBoxes +
                                       " of nuScenes or another format of boxes");
    case BoxFormat::pandaset_frame:
      throw Error(ErrorKind::data, path.string() +
                                       ": is one frame of PandaSet's cuboids; give the folder "
                                       "annotations/cuboids or the sequence");
    case BoxFormat::csv: break;
  }
  return read_csv_boxes(path);
}

bool is_of_numbered_scans(const fs::path& boxes) {
  std::error_code ignored;
  if (fs::is_directory(boxes, ignored))
    return !is_box_file(boxes / kAv2Boxes) && is_box_file(boxes / kTracklets);
  return format_of_file(boxes) == BoxFormat::kitti_tracklets;
}

}  // namespace adasplats
