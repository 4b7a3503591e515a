// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/cloud_inputs.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "adasplats/cloud/load/file_kind.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/load/sensor_frame.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/ept/ept_tile.h"
#include "adasplats/io/ept/potree_octree.h"
#include "adasplats/io/packets/capture_reader.h"

namespace adasplats {

namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& path) { return path.filename().string().front() == '.'; }

/// The entries of a folder that are not hidden, by name.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries = list_folder(folder);
  std::erase_if(entries, is_hidden);
  return entries;
}

/// The contents of a folder that is not a sequence.
struct Folder {
  fs::path path;
  std::vector<fs::path> sequences;
  std::map<FileKind, std::vector<fs::path>> files;
  bool has_poses = false;  ///< has a poses.csv, as `simulate` writes it with scans

  std::size_t count(FileKind kind) const {
    const auto found = files.find(kind);
    return found == files.end() ? 0 : found->second.size();
  }
};

Folder read_folder(const fs::path& path) {
  Folder folder{path, sequences_of_tree(path), {}, false};
  for (const fs::path& entry : entries_of(path)) {
    std::error_code ignored;  // a broken link is not a file
    if (!fs::is_regular_file(entry, ignored)) continue;
    if (entry.filename() == "poses.csv") folder.has_poses = true;
    if (const FileKind kind = kind_of_file(entry); kind != FileKind::other)
      folder.files[kind].push_back(entry);
  }
  return folder;
}

/// "a.ply, b.ply and 7 more": names relative to the folder.
std::string names_of(const Folder& folder, const std::vector<fs::path>& paths) {
  constexpr std::size_t kMaxNames = 3;
  std::string names;
  for (std::size_t i = 0; i < std::min(kMaxNames, paths.size()); ++i)
    names += (i == 0 ? "" : ", ") + paths[i].lexically_relative(folder.path).string();
  if (paths.size() > kMaxNames)
    names += " and " + std::to_string(paths.size() - kMaxNames) + " more";
  return names;
}

/// "points (a.ply), a mesh (b.ply)".
std::string list_of(const Folder& folder) {
  std::string list;
  const auto add = [&](std::string_view what, const std::vector<fs::path>& paths) {
    if (paths.empty()) return;
    list += (list.empty() ? "" : ", ") + std::string(what) + " (" + names_of(folder, paths) + ")";
  };
  add("sequences", folder.sequences);
  for (const auto& [kind, paths] : folder.files) add(plural_name_of(kind), paths);
  return list;
}

/// The point files without the extension of most; empty if no extension is that of more than half.
std::vector<fs::path> odd_files(const std::vector<fs::path>& files) {
  std::map<std::string, std::size_t> counts;
  for (const fs::path& file : files) ++counts[lower_case(file.extension().string())];
  const auto most =
      std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; });
  std::vector<fs::path> odd;
  if (most == counts.end() || 2 * most->second <= files.size()) return odd;
  for (const fs::path& file : files)
    if (lower_case(file.extension().string()) != most->first) odd.push_back(file);
  return odd;
}

/// The folder holds several kinds of input.
Error ambiguous_folder(const Folder& folder) {
  const auto points = folder.files.find(FileKind::points);
  const bool only_points = folder.files.size() == 1 && folder.sequences.empty();
  if (points != folder.files.end() && only_points) {
    std::vector<fs::path> usual = points->second;
    const std::vector<fs::path> odd = odd_files(usual);
    std::erase_if(usual,
                  [&](const fs::path& file) { return std::ranges::find(odd, file) != odd.end(); });
    if (!odd.empty())
      return Error(ErrorKind::usage,
                   folder.path.string() + ": contains point files of several formats: " +
                       names_of(folder, odd) + " beside " + names_of(folder, usual) + "; move " +
                       (odd.size() == 1 ? "it" : "them") +
                       " out of the folder, or give single files");
  }
  std::string one;
  if (points != folder.files.end()) one = points->second.front().string();
  if (!folder.sequences.empty())
    one = folder.sequences.front().string() + (one.empty() ? "" : " or " + one);
  return Error(ErrorKind::usage,
               folder.path.string() + ": contains several kinds of input: " + list_of(folder) +
                   "; give one of them instead of the folder, for example " + one);
}

bool same_extension(const std::vector<fs::path>& files) {
  const auto extension = [](const fs::path& file) { return lower_case(file.extension().string()); };
  return std::ranges::all_of(
      files, [&](const fs::path& file) { return extension(file) == extension(files.front()); });
}

/// Whether the folder holds only point files of one format, and trajectories.
bool is_folder_of_scans(const Folder& folder) {
  const auto points = folder.files.find(FileKind::points);
  return points != folder.files.end() && same_extension(points->second) &&
         folder.count(FileKind::mesh) == 0 && folder.count(FileKind::splat_model) == 0;
}

/// The drive in a folder of simulated scans that are not files of points; empty: none.
fs::path drive_in(const fs::path& folder) {
  const auto is_drive = [](const fs::path& path) {
    return is_self_contained_drive(path) || is_kitti_raw_drive(path);
  };
  for (const fs::path& path : list_folder_if_any(folder)) {
    if (is_drive(path)) return path;
    for (const fs::path& deeper : list_folder_if_any(path))  // KITTI's raw data: DATE/DRIVE
      if (is_drive(deeper)) return deeper;
  }
  return {};
}

std::string advice_without_points(const fs::path& folder) {
  const fs::path drive = drive_in(folder);
  if (is_capture(drive))
    return "; give its capture, " + drive.string() +
           ", to a command with `packet_sensor` and `trajectory`";
  if (!drive.empty()) return "; give the drive in it, " + drive.string();
  return ", but not in a point format; simulate with `format` semantickitti to use them as points";
}

/// The text after `"key":` in the JSON of a file, without quotes; empty: none.
std::string json_word(const std::string& text, const std::string& key) {
  std::size_t begin = text.find("\"" + key + "\"");
  if (begin == std::string::npos) return {};
  begin = text.find_first_not_of(" \t\r\n\":", begin + key.size() + 2);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_first_of(" \t\r\n\",}", begin) - begin);
}

/// The tiles of an Entwine point tile folder: each point is in one of them. Errors: data (tiles
/// of an unknown type, or fewer points in them than ept.json states).
std::vector<CloudInput> ept_tiles(const fs::path& folder) {
  const std::string facts = read_file(folder / "ept.json");
  const std::string type = json_word(facts, "dataType");
  const std::string name = folder.string() + ": is an Entwine point tile (EPT) folder ";
  const bool is_laz = type == "laszip";
  if (!is_laz && type != "binary" && type != "zstandard")
    throw Error(ErrorKind::data, name + "with tiles of type '" + type +
                                     "', read are laszip, binary and zstandard; convert it: 'pdal "
                                     "translate " +
                                     (folder / "ept.json").string() + " points.laz'");
  const char* const extension = is_laz ? ".laz" : type == "binary" ? ".bin" : ".zst";
  std::vector<CloudInput> tiles;
  std::uint64_t points = 0;
  for (const fs::path& tile : files_by_name(folder / "ept-data", extension)) {
    tiles.push_back({tile, false});
    points += is_laz ? read_las_facts(tile).points : ept_tile_points(tile);
  }
  const std::optional<std::uint64_t> stated = ept_stated_points(folder);
  if (tiles.empty() || (stated && *stated != points))
    throw Error(ErrorKind::data, name + "whose " + std::to_string(tiles.size()) + " tiles hold " +
                                     std::to_string(points) + " points, expected " +
                                     std::to_string(stated.value_or(0)) +
                                     "; copy the complete ept-data");
  return tiles;
}

/// Throws data for folders of other programs that are not read, with what to do.
void reject_foreign(const fs::path& folder) {
  const auto has = [&folder](const char* name) {
    std::error_code ignored;
    return fs::exists(folder / name, ignored);
  };
  const auto reject = [&folder](const std::string& what) {
    throw Error(ErrorKind::data, folder.string() + ": is " + what);
  };
  if (has("cloud.js"))
    reject(
        "a Potree 1 octree, which is not read; give the LAS or LAZ files that it was made from, "
        "or convert it to LAS or LAZ");
}

std::vector<CloudInput> files_of(const Folder& folder, SensorScans scans) {
  if (folder.has_poses && folder.count(FileKind::points) == 0)
    throw Error(ErrorKind::data, folder.path.string() +
                                     ": contains scans in the sensor frame (it has a poses.csv)" +
                                     advice_without_points(folder.path));
  if (folder.has_poses && (scans == SensorScans::refused || !is_folder_of_scans(folder)))
    throw Error(ErrorKind::data, folder.path.string() +
                                     ": contains scans in the sensor frame (it has a poses.csv); " +
                                     advice_for_scans(folder.path, folder.path / "poses.csv"));
  const std::size_t others = folder.count(FileKind::mesh) + folder.count(FileKind::splat_model) +
                             folder.count(FileKind::trajectory);
  if (folder.count(FileKind::points) == 0) {
    const fs::path drive = drive_in(folder.path);
    throw Error(ErrorKind::no_input,
                folder.path.string() + ": contains neither a folder 'velodyne' nor point files" +
                    (others == 0 ? "" : ", only " + list_of(folder)) +
                    (drive.empty() ? "; give the folder that contains the scans"
                                   : "; give a drive in it, for example " + drive.string()));
  }
  const std::vector<fs::path>& files = folder.files.at(FileKind::points);
  const std::size_t poses =
      scans == SensorScans::taken ? folder.count(FileKind::trajectory) : std::size_t{0};
  if (others != poses || !same_extension(files)) throw ambiguous_folder(folder);
  if (scans == SensorScans::refused && files.size() > 1 &&
      lower_case(files.front().extension().string()) == ".bin")
    throw Error(ErrorKind::data,
                folder.path.string() + ": contains " + std::to_string(files.size()) +
                    " .bin files, which are scans in the frame of a moving sensor; give the "
                    "sequence folder that contains poses.txt and the folder 'velodyne'; or, " +
                    advice_for_scans(folder.path, "POSES"));
  std::vector<CloudInput> inputs;
  inputs.reserve(files.size());
  for (const fs::path& file : files) inputs.push_back({file, false});
  return inputs;
}

}  // namespace

std::vector<fs::path> sequences_of_tree(const fs::path& folder) {
  if (is_kitti_sequence(folder)) return {folder};
  std::vector<fs::path> sequences;
  std::error_code ignored;
  for (const fs::path& place : {folder, folder / "sequences"}) {
    if (!fs::is_directory(place, ignored)) continue;
    for (const fs::path& entry : entries_of(place))
      if (is_kitti_sequence(entry)) sequences.push_back(entry);
  }
  return sequences;
}

std::vector<CloudInput> cloud_inputs(const fs::path& path, SensorScans scans) {
  std::error_code ignored;  // an unreadable path fails when it is opened as a file
  if (!fs::is_directory(path, ignored) || is_self_contained_drive(path)) return {{path, false}};
  if (is_kitti_sequence(path)) return {{path, true}};
  if (fs::exists(path / "ept.json", ignored)) return ept_tiles(path);
  if (is_potree_octree(path / "octree.bin")) return {{path / "octree.bin", false}};
  reject_foreign(path);
  const Folder folder = read_folder(path);
  if (folder.sequences.empty()) return files_of(folder, scans);
  if (folder.count(FileKind::points) != 0) throw ambiguous_folder(folder);
  std::vector<CloudInput> inputs;
  for (const fs::path& sequence : folder.sequences) inputs.push_back({sequence, true});
  return inputs;
}

void require_distinct_starts(std::span<const CloudInput> sequences) {
  constexpr double kSame_m = 1e-3;  // two drives do not start within a millimetre
  std::vector<Vec3d> begins;
  for (const CloudInput& sequence : sequences) {
    const Trajectory poses = open_kitti_sequence(sequence.path).trajectory;
    begins.push_back(poses.front().world_from_sensor.translation);
    for (std::size_t k = 0; k + 1 < begins.size(); ++k) {
      if (!(length(begins[k] - begins.back()) < kSame_m)) continue;
      throw Error(ErrorKind::usage,
                  sequences[k].path.string() + " and " + sequence.path.string() +
                      ": start at the same pose, so they are either the same drive or each in its "
                      "own frame and cannot be joined; give only one of them");
    }
  }
}

void require_points(const fs::path& file) {
  const auto reject = [&file](const std::string& what) {
    throw Error(ErrorKind::data, file.string() + ": " + what);
  };
  switch (kind_of_file(file)) {
    case FileKind::mesh:
      return reject(lower_case(file.extension().string()) == ".ply"
                        ? "is a triangle mesh (its header declares faces), not a point cloud; "
                          "simulate, render and evaluate truth read meshes"
                        : "is of a format of meshes, of which points are not read; simulate, "
                          "render and evaluate truth read meshes; export points as PLY, LAS, PCD "
                          "or CSV");
    case FileKind::splat_model:
      return reject(
          "is a splat model (it has normals and radii), not a point cloud; simulate, render, view "
          "and evaluate read models");
    case FileKind::trajectory:
      return reject(
          "is a trajectory (each line is a pose), not a point cloud; give it as `trajectory`, with "
          "a line before the poses that names the columns (time,x,y,z,qw,qx,qy,qz or # timestamp "
          "tx ty tz qx qy qz qw) or with KITTI's 12 numbers per line");
    case FileKind::points:
    case FileKind::other: return;
  }
}

void require_same_crs(std::initializer_list<std::pair<std::filesystem::path, Crs>> inputs,
                      ProgressSink& progress) {
  SharedCrs shared;
  for (const auto& [file, crs] : inputs) shared.add(file, crs);
  if (const std::string warning = shared.warning(); !warning.empty()) progress.warn(warning);
}

}  // namespace adasplats
