// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace adasplats {

/// Every file that decides what a ModelScene of `model` is: the model or mesh, and of a world file
/// itself, its place, and the geometries and trajectories of its objects; of glTF the buffers, too,
/// and of trajectories what is read beside them (trajectory_files()).
/// Each once, in the order in which they are named. The scheme of the classes is not among them.
/// Errors: those of read_world_file and of glTF.
std::vector<std::filesystem::path> files_of_scene(const std::filesystem::path& model);

}  // namespace adasplats
