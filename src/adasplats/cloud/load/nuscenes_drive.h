// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// A scan of LIDAR_TOP.
struct NuscenesScan {
  std::filesystem::path file;    ///< samples/... or sweeps/..., with the root
  std::filesystem::path labels;  ///< lidarseg/..., with the root; empty: none
  bool is_key = false;           ///< of a sample
  TimedPose pose;                ///< ego_pose * calibrated_sensor, in the axes of the tables
};

/// A row of scene.json.
struct NuscenesSceneRow {
  std::filesystem::path tables;  ///< folder
  std::string token, name;
};

struct NuscenesScene {
  std::string name;
  std::vector<NuscenesScan> scans;  ///< by time
  bool has_labels = false;          ///< the tables include lidarseg.json
};

/// The table folders of a data root, by name: v1.0-mini, v1.0-trainval, ...
std::vector<std::filesystem::path> nuscenes_tables(const std::filesystem::path& root);

/// The scene of a name in table folders, the first if several have it; an empty name: the only one.
/// `root` is for messages. Errors: usage (with a list), no_input, data.
NuscenesSceneRow find_nuscenes_scene(const std::filesystem::path& root,
                                     const std::vector<std::filesystem::path>& tables,
                                     const std::string& name);

/// Reads one scene from the tables (the devkit's docs/schema_nuscenes.md), row by row: memory grows
/// with the samples of the scene, not with sample_data.json and ego_pose.json. `name`: empty for
/// the only scene; if several table folders have the name, the first is used. Errors: usage
/// (unknown scene, or several and no name; with a list), no_input (a missing table), data with
/// table and row (dangling tokens, invalid rotations, two scans with the same time, no scans).
NuscenesScene read_nuscenes_scene(const std::filesystem::path& root, const std::string& name);

/// True for a folder that contains v1.0-*/scene.json or v1.0-*/sample_data.json.
bool is_nuscenes_root(const std::filesystem::path& folder);

/// Opens a scene of a nuScenes data root (read_nuscenes_scene()) as a drive (open_sensor_frames()):
/// keyframes and sweeps by time, each in the frame of the LiDAR, in our axes. Points have no times,
/// so the sensor is assumed to be at rest during a scan. If keyframes have labels, points of sweeps
/// are kNuscenesUnlabeled. Errors: usage (`mount` and `time_offset`, which the tables define), data
/// with the file (a missing frame, or a wrong number of labels), and those of the two functions.
KittiSequence open_nuscenes_drive(const DriveInput& drive, const Executor& executor,
                                  ProgressSink& progress);

/// category.json by index, for a root with lidarseg.json; else empty.
ClassNames nuscenes_class_names(const std::filesystem::path& folder);

}  // namespace adasplats
