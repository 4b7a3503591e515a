// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/core/progress.h"
#include "adasplats/io/base/crs.h"

namespace adasplats {

/// One thing that load_cloud reads.
struct CloudInput {
  std::filesystem::path path;
  bool is_sequence = false;  ///< a sequence folder; else a file of points
};

/// Whether files of scans in the sensor frame are accepted: by callers that read them with a
/// trajectory, or that read no points.
enum class SensorScans : std::uint8_t { refused, taken };

/// The inputs that a path stands for, for every part of the program that reads points:
/// - anything that is not a folder, and what is_self_contained_drive(): one file of points;
/// - a sequence folder (with `velodyne`): that sequence;
/// - a tree of sequences (FOLDER/sequences/NAME or FOLDER/NAME, each with `velodyne`): all of them
///   by name;
/// - a folder of Entwine point tiles (ept.json): its LAZ tiles;
/// - a folder with point files of one extension, such as LAS tiles: these by name. Files of other
///   extensions (.md, .json, .prj, ...) and text without points (readme.txt, a CSV index of the
///   tiles) are ignored. Errors: no_input (a folder without points, or that cannot be listed); data
///   (scans in the sensor frame, as `simulate` writes them with a poses.csv, or several .bin);
///   usage for every other folder, with a list of its contents: sequences and point files, point
///   files of several extensions, or meshes, models or trajectories among them. If `scans` are
///   accepted, scans in the sensor frame and trajectories among point files are not errors.
std::vector<CloudInput> cloud_inputs(const std::filesystem::path& path,
                                     SensorScans scans = SensorScans::refused);

/// The sequences of a tree by name, as cloud_inputs finds them, regardless of other files; the
/// folder itself if it is a sequence. Errors: no_input (a folder that cannot be listed).
std::vector<std::filesystem::path> sequences_of_tree(const std::filesystem::path& folder);

/// Throws usage if two sequences start at the same pose: then each is in a frame of its own, as in
/// SemanticKITTI, and joining them makes no sense; or it is the same sequence twice.
void require_distinct_starts(std::span<const CloudInput> sequences);

/// Throws data if a file with the extension of a point format is something else: a triangle mesh (a
/// PLY that declares faces), a splat model (a PLY with a radius and a normal), a trajectory (text
/// with columns qw, qx, qy, qz, or with poses as lines).
void require_points(const std::filesystem::path& file);

/// Throws data if two of the inputs declare different coordinate systems, and warns if one declares
/// less than another (SharedCrs).
void require_same_crs(std::initializer_list<std::pair<std::filesystem::path, Crs>> inputs,
                      ProgressSink& progress);

}  // namespace adasplats
