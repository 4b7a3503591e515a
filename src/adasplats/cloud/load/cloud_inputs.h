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
  bool is_sequence = false;  ///< a sequence folder, else a file of points
};

/// Whether scans in the frame of their sensor are files like others: for who reads them with a
/// trajectory, or reads no points.
enum class SensorScans : std::uint8_t { refused, taken };

/// What a path means as points, for every part of the program that takes some:
/// - what is no folder: that, as a file of points; likewise what is_drive_by_itself();
/// - a sequence folder (with `velodyne`): that;
/// - a tree of sequences (FOLDER/sequences/NAME or FOLDER/NAME, each with `velodyne`): all of them
///   by name;
/// - a folder whose files of points have one extension, such as tiles of LAS: those by name. Files
///   of other extensions that points do not come in (.md, .json, .prj, ...) do not count, nor does
///   text without points (readme.txt, an index of the tiles as CSV).
/// Errors: no_input (a folder without points; one that cannot be listed), data (scans in the
/// sensor's frame, as `simulate` writes them beside poses.csv, or several .bin), usage for every
/// other folder, with a list of what is in it: sequences beside files of points, points of several
/// extensions, meshes, models or trajectories among them. Where `scans` are taken, scans in the
/// sensor's frame and trajectories beside files of points are no errors.
std::vector<CloudInput> cloud_inputs(const std::filesystem::path& path,
                                     SensorScans scans = SensorScans::refused);

/// The sequences of a tree by name, as cloud_inputs finds them, whatever else is there; the folder
/// itself where it is one. Errors: no_input (a folder that cannot be listed).
std::vector<std::filesystem::path> sequences_of_tree(const std::filesystem::path& folder);

/// Throws usage where two sequences, of a tree or named one by one, begin at the very same pose:
/// each is in a frame of its own then, as those of SemanticKITTI are, and together they are no
/// place; or it is one sequence, named twice.
void require_one_world(std::span<const CloudInput> sequences);

/// Throws data where a file that a format of points may hold is something else: a triangle mesh (a
/// PLY that declares faces), a splat model (a PLY with a radius and a normal), a trajectory (text
/// with columns qw, qx, qy, qz, or whose lines are poses).
void require_points(const std::filesystem::path& file);

/// Throws data where two of the inputs say different coordinate systems, and warns where one says
/// less than another (SharedCrs).
void require_one_crs(std::initializer_list<std::pair<std::filesystem::path, Crs>> inputs,
                     ProgressSink& progress);

}  // namespace adasplats
