// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// What `labels` names; for an empty one that of the first input with labels, SemanticKITTI of a
/// sequence folder, labels_of_tree() of a tree of a data set; else nothing. Errors: those of
/// require_labels_of_tree.
std::optional<LabelScheme> label_scheme_for(const std::string& labels,
                                            std::span<const std::filesystem::path> inputs);

/// How a model or a mesh names its scheme, so that it can be loaded again from another folder.
std::string scheme_reference(const std::string& labels, const LabelScheme& scheme);

/// A point cloud input as given, or the sequences of a tree (cloud_inputs, and its errors).
std::vector<std::filesystem::path> resolve_cloud_inputs(const std::filesystem::path& input);

/// Likewise, where one is wanted. Errors: usage (several sequences).
std::filesystem::path resolve_cloud_input(const std::filesystem::path& input);

/// Whether a path is a splat model: a PLY with a radius and a normal, or the folder of a city.
bool is_splat_model(const std::filesystem::path& file);

/// The trajectory of a pose file or of a sequence folder; of a recording all of its poses
/// (trajectory_of_recording()).
Trajectory load_trajectory(const std::filesystem::path& path);

/// Every n-th pose of that trajectory, shifted in world axes. Errors: usage (`every` is 0), data
/// (no poses).
Trajectory poses_along(const std::filesystem::path& path, Vec3d offset_m, std::size_t every);

/// Throws no_input where there is nothing of that name, so that it is said before long work.
void require_input(const std::filesystem::path& path);

}  // namespace adasplats
