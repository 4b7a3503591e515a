// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace adasplats {

/// Every file that a ModelScene of `model` depends on: the model or mesh; for a world file also the
/// file itself and the geometries and trajectories of its objects; for glTF also the buffers, and
/// for trajectories also the files read with them (trajectory_files()). Each once, in the order in
/// which they are named, without the scheme of the classes. Errors: those of read_world_file and of
/// glTF.
std::vector<std::filesystem::path> files_of_scene(const std::filesystem::path& model);

}  // namespace adasplats
