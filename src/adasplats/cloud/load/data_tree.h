// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// What a data set calls its classes, by their ids.
using ClassNames = std::vector<std::pair<std::uint16_t, std::string>>;

/// A kind of folder that has scans and their poses as some data set lays them out.
struct DataTree {
  const char* name;  ///< "PandaSet sequence"
  bool (*is_one)(const std::filesystem::path& folder);
  KittiSequence (*open)(const FrameDrive& drive, const Executor& executor, ProgressSink& progress);
  /// Empty where there are no labels.
  ClassNames (*class_names)(const std::filesystem::path& folder);
};

/// Which kind a path is; null: none.
const DataTree* data_tree_of(const std::filesystem::path& path);

/// Opens one as a drive. Errors: usage for settings of other drives, those of its kind.
KittiSequence open_data_tree(const DataTree& tree, const FrameDrive& drive,
                             const Executor& executor, ProgressSink& progress);

/// The one of known_label_schemes() that has all classes of a tree by their ids and names; nothing
/// where none has, or where the path is no tree with labels.
std::optional<LabelScheme> labels_of_tree(const std::filesystem::path& path);

/// Throws usage where the path is a tree with labels and `scheme` is one of known_label_schemes()
/// that has other names for their ids. Those of users may call classes as they like.
void require_labels_of_tree(const std::filesystem::path& path, const LabelScheme& scheme);

}  // namespace adasplats
