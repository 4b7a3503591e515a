// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/dataset/tree_boxes.h"

namespace adasplats {

/// The folder of the tables, and of the labels.
inline constexpr const char* kNuscenesVersion = "v1.0-mini";
/// The map file that the devkit requires.
inline constexpr const char* kNuscenesMap = "maps/none.png";

/// A scan of the scene.
struct NuscenesFrame {
  TimedPose pose;              ///< world_from_sensor, our axes
  std::string points_file;     ///< relative to the folder of the data set
  std::string classes_file;    ///< likewise, for a key frame with classes; otherwise empty
  bool is_key = false;         ///< a sample; the first frame is one
  std::vector<TreeBox> boxes;  ///< of key frames
};

/// Writes the tables of nuScenes v1.0 (its devkit's docs/schema_nuscenes.md and
/// schema_nuscenes_lidarseg) into FOLDER/v1.0-mini: one log, one scene, `scene-0001`, one sensor,
/// LIDAR_TOP, and a category for each of nuscenes_categories(). The LiDAR has its position in
/// nuScenes, 0.943713 m in front of and 1.84023 m above the origin of the ego frame (x forward),
/// with x to the right. A frame that is not a sample belongs to the nearest sample. The visibility
/// of objects is unknown: all have the highest level. Errors: cannot_create, io, data (times that
/// are not dates).
void write_nuscenes_tables(const std::filesystem::path& folder,
                           std::span<const NuscenesFrame> frames, const LabelScheme* labels);

}  // namespace adasplats
