// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// A trajectory in a file of OpenSCENARIO.
struct ScenarioPath {
  std::filesystem::path file;
  std::string name;  ///< of the trajectory; empty: the only one
};

/// The parts of "street.xosc" or "street.xosc:overtaking"; nothing for other paths.
std::optional<ScenarioPath> scenario_path(const std::filesystem::path& path);

/// Reads the vertices of a trajectory with the shape Polyline (ASAM OpenSCENARIO XML 1.0 to 1.3,
/// class Polyline): times in s, WorldPosition x, y, z in m and h, p, r in rad, missing ones 0. If
/// no vertex has h, poses look where they go. The storyboard is not evaluated: times are those of
/// the vertices. Errors: data with the line (no well-formed XML; no trajectory of this name, or
/// several; another shape or position; a vertex without time, or times that do not ascend; values
/// that are no finite numbers, such as parameters; a TimeReference that scales or shifts times).
Trajectory read_scenario(const ScenarioPath& path);

}  // namespace adasplats
