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
#include "adasplats/core/progress.h"

namespace adasplats {

/// The scheme that `labels` names. If it is empty, the scheme of the first input that states one or
/// has labels: in files of this program the one that they state; else labels_of_tree() for the tree
/// of a data set, SemanticKITTI for a sequence folder, ASPRS for LAS and LAZ, if the classes are
/// those of LAS (`label_field` as in LoadOptions). Nothing if there is none. Errors: those of
/// require_labels_of_tree, and of headers.
std::optional<LabelScheme> label_scheme_for(const std::string& labels,
                                            std::span<const std::filesystem::path> inputs,
                                            const std::string& label_field = {});

/// The scheme that a model's file names; nothing if it names none or, with a warning, if that
/// cannot be loaded: geometry and class numbers do not depend on it.
std::optional<LabelScheme> load_labels_of_model(const std::string& scheme, ProgressSink& progress);

/// The name of the scheme in the file of a model or mesh; it can be loaded from any folder.
std::string scheme_reference(const std::string& labels, const LabelScheme& scheme);

/// A point cloud input as given, or the sequences of a tree. Errors: no_input, those of
/// cloud_inputs.
std::vector<std::filesystem::path> resolve_cloud_inputs(const std::filesystem::path& input);

/// The same for exactly one. Errors: also usage (several sequences).
std::filesystem::path resolve_cloud_input(const std::filesystem::path& input);

/// Whether a path is a splat model: a PLY with a radius and a normal, or the folder of a city.
bool is_splat_model(const std::filesystem::path& file);

/// The trajectory of a pose file or a sequence folder, or all poses of a recording
/// (trajectory_of_recording()).
Trajectory load_trajectory(const std::filesystem::path& path);

/// Every n-th pose of that trajectory, shifted in world axes. Errors: usage (`every` is 0), data
/// (no poses).
Trajectory poses_along(const std::filesystem::path& path, Vec3d offset_m, std::size_t every);

/// Throws no_input if the path does not exist. To be called before long work.
void require_input(const std::filesystem::path& path);

}  // namespace adasplats
