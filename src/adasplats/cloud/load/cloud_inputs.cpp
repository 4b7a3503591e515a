// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/cloud_inputs.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>

#include "adasplats/cloud/load/file_kind.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {

namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& path) { return path.filename().string().front() == '.'; }

/// What a folder holds, by name.
std::vector<fs::directory_entry> entries_of(const fs::path& folder) {
  std::vector<fs::directory_entry> entries;
  std::error_code problem;
  fs::directory_iterator entry(folder, problem);
  for (; !problem && entry != fs::directory_iterator(); entry.increment(problem))
    if (!is_hidden(entry->path())) entries.push_back(*entry);
  if (problem) throw system_error(ErrorKind::no_input, folder, "cannot be listed", problem.value());
  std::ranges::sort(entries, {}, [](const fs::directory_entry& e) { return e.path(); });
  return entries;
}

/// What is in a folder that is no sequence.
struct Folder {
  fs::path path;
  std::vector<fs::path> sequences;
  std::map<FileKind, std::vector<fs::path>> files;
  bool has_poses = false;  ///< poses.csv, as `simulate` writes it beside scans

  std::size_t count(FileKind kind) const {
    const auto found = files.find(kind);
    return found == files.end() ? 0 : found->second.size();
  }
};

Folder look_into(const fs::path& path) {
  Folder folder{path, sequences_of_tree(path), {}, false};
  for (const fs::directory_entry& entry : entries_of(path)) {
    std::error_code ignored;  // a broken link is no file
    if (!entry.is_regular_file(ignored)) continue;
    if (entry.path().filename() == "poses.csv") folder.has_poses = true;
    if (const FileKind kind = kind_of_file(entry.path()); kind != FileKind::other)
      folder.files[kind].push_back(entry.path());
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

/// The folder holds several things; it says which and that one of them is to be named.
Error unclear(const Folder& folder) {
  const auto points = folder.files.find(FileKind::points);
  std::string one;
  if (points != folder.files.end()) one = points->second.front().string();
  if (!folder.sequences.empty())
    one = folder.sequences.front().string() + (one.empty() ? "" : " or " + one);
  return Error(ErrorKind::usage, folder.path.string() + ": holds " + list_of(folder) +
                                     "; name what is meant, " + one + " say");
}

bool same_extension(const std::vector<fs::path>& files) {
  const auto extension = [](const fs::path& file) { return lower_case(file.extension().string()); };
  return std::ranges::all_of(
      files, [&](const fs::path& file) { return extension(file) == extension(files.front()); });
}

/// Whether all there is are files of points in one format and trajectories.
bool holds_scans_alone(const Folder& folder) {
  const auto points = folder.files.find(FileKind::points);
  return points != folder.files.end() && same_extension(points->second) &&
         folder.count(FileKind::mesh) == 0 && folder.count(FileKind::splat_model) == 0;
}

std::vector<CloudInput> files_of(const Folder& folder, SensorScans scans) {
  if (folder.has_poses && folder.count(FileKind::points) == 0)
    throw Error(ErrorKind::data,
                folder.path.string() +
                    ": holds scans in the sensor frame (poses.csv is beside them) in no format of "
                    "points; simulate with `format` semantickitti to use them as points");
  if (folder.has_poses && (scans == SensorScans::refused || !holds_scans_alone(folder)))
    throw Error(ErrorKind::data,
                folder.path.string() +
                    ": holds scans in the sensor frame (poses.csv is beside them); give that as "
                    "`trajectory` or simulate with `format` semantickitti to use them as points");
  const std::size_t others = folder.count(FileKind::mesh) + folder.count(FileKind::splat_model) +
                             folder.count(FileKind::trajectory);
  if (folder.count(FileKind::points) == 0) {
    throw Error(ErrorKind::no_input, folder.path.string() +
                                         ": holds neither a folder 'velodyne' nor files of points" +
                                         (others == 0 ? "" : ", but " + list_of(folder)));
  }
  const std::vector<fs::path>& files = folder.files.at(FileKind::points);
  const std::size_t poses =
      scans == SensorScans::taken ? folder.count(FileKind::trajectory) : std::size_t{0};
  if (others != poses || !same_extension(files)) throw unclear(folder);
  if (scans == SensorScans::refused && files.size() > 1 &&
      lower_case(files.front().extension().string()) == ".bin")
    throw Error(ErrorKind::data,
                folder.path.string() + ": holds " + std::to_string(files.size()) +
                    " .bin files, scans in the frame of a sensor that moves; give their poses "
                    "as `trajectory`, or name the sequence folder, which has poses.txt and them in "
                    "a folder 'velodyne'");
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
    for (const fs::directory_entry& entry : entries_of(place))
      if (is_kitti_sequence(entry.path())) sequences.push_back(entry.path());
  }
  return sequences;
}

std::vector<CloudInput> cloud_inputs(const fs::path& path, SensorScans scans) {
  std::error_code ignored;  // what cannot be looked into fails when it is opened as a file
  if (!fs::is_directory(path, ignored) || is_drive_by_itself(path)) return {{path, false}};
  if (is_kitti_sequence(path)) return {{path, true}};
  const Folder folder = look_into(path);
  if (folder.sequences.empty()) return files_of(folder, scans);
  if (folder.count(FileKind::points) != 0) throw unclear(folder);
  std::vector<CloudInput> inputs;
  for (const fs::path& sequence : folder.sequences) inputs.push_back({sequence, true});
  return inputs;
}

void require_one_world(std::span<const CloudInput> sequences) {
  constexpr double kSame_m = 1e-3;  // two drives do not begin at one place to a millimetre
  std::vector<Vec3d> begins;
  for (const CloudInput& sequence : sequences) {
    const Trajectory poses = open_kitti_sequence(sequence.path).trajectory;
    begins.push_back(poses.front().world_from_sensor.translation);
    for (std::size_t k = 0; k + 1 < begins.size(); ++k) {
      if (!(length(begins[k] - begins.back()) < kSame_m)) continue;
      throw Error(ErrorKind::usage,
                  sequences[k].path.string() + " and " + sequence.path.string() +
                      ": begin at the very same pose, so that they are either one drive or each in "
                      "a frame of its own; name one of them");
    }
  }
}

void require_points(const fs::path& file) {
  const auto refuse = [&file](const std::string& what) {
    throw Error(ErrorKind::data, file.string() + ": " + what);
  };
  switch (kind_of_file(file)) {
    case FileKind::mesh:
      return refuse(
          "is a triangle mesh (its header declares faces), not points; simulate, render and "
          "evaluate truth take meshes");
    case FileKind::splat_model:
      return refuse(
          "is a splat model (it has normals and radii), not points; simulate, render, view and "
          "evaluate take models");
    case FileKind::trajectory:
      return refuse(
          "is a trajectory (a line is a pose), not points; `trajectory` takes it where a line "
          "before "
          "the poses names the columns (time,x,y,z,qw,qx,qy,qz or # timestamp tx ty tz qx qy qz "
          "qw) "
          "or where it has KITTI's 12 numbers a line");
    case FileKind::points:
    case FileKind::other: return;
  }
}

void require_one_crs(std::initializer_list<std::pair<std::filesystem::path, Crs>> inputs,
                     ProgressSink& progress) {
  SharedCrs shared;
  for (const auto& [file, crs] : inputs) shared.add(file, crs);
  if (const std::string warning = shared.warning(); !warning.empty()) progress.warn(warning);
}

}  // namespace adasplats
