// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// The class names of a data set by their ids.
using ClassNames = std::vector<std::pair<std::uint16_t, std::string>>;

/// A data set whose folders contain scans and their poses.
struct DataTree {
  const char* name;  ///< "PandaSet sequence"
  bool (*is_one)(const std::filesystem::path& folder);
  KittiSequence (*open)(const DriveInput& drive, const Executor& executor, ProgressSink& progress);
  /// Empty without labels.
  ClassNames (*class_names)(const std::filesystem::path& folder);
  std::span<const std::string_view> sensors = {};  ///< its LiDARs if `topic` can choose one
  /// Whether each of them has points in a folder, so that it is a rig; null: it is one drive.
  bool (*is_rig)(const std::filesystem::path& folder) = nullptr;
};

/// The data set that a path belongs to; null: none.
const DataTree* data_tree_of(const std::filesystem::path& path);

/// Opens a data set as a drive. Errors: usage for settings of other drives, and those of the data
/// set.
KittiSequence open_data_tree(const DataTree& tree, const DriveInput& drive,
                             const Executor& executor, ProgressSink& progress);

/// The one of known_label_schemes() that has all classes of a data set by id and name; nothing if
/// there is none, or if the path is not a data set with labels.
std::optional<LabelScheme> labels_of_tree(const std::filesystem::path& path);

/// Throws usage if the path is a data set with labels and `scheme` is one of known_label_schemes()
/// with other names for their ids. Schemes of users may rename classes.
void require_labels_of_tree(const std::filesystem::path& path, const LabelScheme& scheme);

}  // namespace adasplats
