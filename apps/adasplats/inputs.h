// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "adasplats/cloud/label_scheme.h"
#include "adasplats/cloud/trajectory.h"

namespace adasplats::app {

/// What `labels` names; for an empty one SemanticKITTI where an input is a sequence folder with
/// labels, else nothing.
std::optional<LabelScheme> label_scheme_for(const std::string& labels,
                                            std::span<const std::filesystem::path> inputs);

/// A point cloud input as given, or the one sequence in a folder that `simulate` wrote.
/// Errors: data for a folder of scans in the sensor frame.
std::filesystem::path resolve_cloud_input(const std::filesystem::path& input);

/// The trajectory of a pose file or of a sequence folder.
Trajectory load_trajectory(const std::filesystem::path& path);

/// Throws no_input where there is nothing of that name, so that it is said before long work.
void require_input(const std::filesystem::path& path);

}  // namespace adasplats::app
