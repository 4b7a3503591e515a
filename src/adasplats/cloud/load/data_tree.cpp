// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/data_tree.h"

#include <algorithm>
#include <array>

#include "adasplats/cloud/load/av2_drive.h"
#include "adasplats/cloud/load/nuscenes_drive.h"
#include "adasplats/cloud/load/pandaset_drive.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr std::array kDataTrees = {
    DataTree{"PandaSet sequence", &is_pandaset_sequence, &open_pandaset_drive,
             &pandaset_class_names, kPandaSetSensors, &is_pandaset_rig},
    DataTree{"nuScenes scene", &is_nuscenes_root, &open_nuscenes_drive, &nuscenes_class_names},
    DataTree{"Argoverse 2 log", &is_av2_log, &open_av2_drive, &av2_class_names, kAv2Sensors}};

/// The first class that a scheme does not have under that name.
const ClassNames::value_type* first_other(const ClassNames& names, const LabelScheme& scheme) {
  for (const auto& entry : names) {
    const SemanticClass* const known = scheme.find(entry.first);
    if (known == nullptr || known->name != entry.second) return &entry;
  }
  return nullptr;
}

ClassNames class_names_in(const std::filesystem::path& path) {
  const DataTree* const tree = data_tree_of(path);
  return tree == nullptr ? ClassNames() : tree->class_names(path);
}

/// Throws usage for a `topic` that is not a sensor of the data set.
void require_sensor(const DataTree& tree, const DriveInput& drive) {
  if (drive.topic.empty() || std::ranges::count(tree.sensors, drive.topic) > 0) return;
  std::string names;
  for (const std::string_view name : tree.sensors) (names += names.empty() ? "" : " or ") += name;
  const std::string of = drive.folder.string() + ": ";
  throw Error(ErrorKind::usage,
              names.empty()
                  ? of + "is a " + tree.name + ", which has one LiDAR; `topic` does not apply"
                  : of + "has no sensor '" + drive.topic + "'; the `topic` of this " + tree.name +
                        " can be " + names);
}

}  // namespace

const DataTree* data_tree_of(const std::filesystem::path& path) {
  std::error_code ignored;  // an unreadable folder is not a data set
  if (!std::filesystem::is_directory(path, ignored)) return nullptr;
  const auto found =
      std::ranges::find_if(kDataTrees, [&path](const DataTree& tree) { return tree.is_one(path); });
  return found == kDataTrees.end() ? nullptr : &*found;
}

KittiSequence open_data_tree(const DataTree& tree, const DriveInput& drive,
                             const Executor& executor, ProgressSink& progress) {
  const bool states_others = !drive.trajectory.empty() || !drive.scan_times.empty() ||
                             !drive.poses_topic.empty() || drive.points_in != PointsIn::found ||
                             drive.sweep_points != SweepPoints::found;
  if (states_others)
    throw Error(ErrorKind::usage,
                drive.folder.string() + ": is a " + tree.name +
                    ", which contains poses, times and frames; `trajectory`, `scan_times`, "
                    "`poses_topic`, `points_in` and `sweep_points` do not apply");
  require_sensor(tree, drive);
  return tree.open(drive, executor, progress);
}

std::optional<LabelScheme> labels_of_tree(const std::filesystem::path& path) {
  const ClassNames names = class_names_in(path);
  if (names.empty()) return std::nullopt;
  for (const LabelScheme* const scheme : known_label_schemes())
    if (first_other(names, *scheme) == nullptr) return *scheme;
  return std::nullopt;
}

void require_labels_of_tree(const std::filesystem::path& path, const LabelScheme& scheme) {
  const bool is_known = std::ranges::any_of(
      known_label_schemes(),
      [&scheme](const LabelScheme* known) { return known->name() == scheme.name(); });
  if (!is_known) return;
  const ClassNames names = class_names_in(path);
  const auto* const other = first_other(names, scheme);
  if (other == nullptr) return;
  const SemanticClass* const stated = scheme.find(other->first);
  throw Error(ErrorKind::usage,
              path.string() + ": its class " + std::to_string(other->first) + " is '" +
                  other->second + "', but in the label scheme " + scheme.name() + " that class " +
                  (stated == nullptr ? "does not exist" : "is '" + stated->name + "'") +
                  "; omit `labels`, or give a file with the class names of the data set");
}

}  // namespace adasplats
