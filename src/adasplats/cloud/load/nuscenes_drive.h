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

struct NuscenesScene {
  std::string name;
  std::vector<NuscenesScan> scans;  ///< by time
  bool has_labels = false;          ///< lidarseg.json is there
};

/// The folders of tables in a root, by name: v1.0-mini, v1.0-trainval, ...
std::vector<std::filesystem::path> nuscenes_tables(const std::filesystem::path& root);

/// Reads of the tables (the devkit's docs/schema_nuscenes.md) what one scene needs, row by row:
/// memory grows with the samples of the scene, not with sample_data.json and ego_pose.json. `name`:
/// empty for the only scene there is; of a name in several folders of tables, the first. Errors:
/// usage (no such scene, several and none is named; the scenes are listed), no_input (a table is
/// missing), data with table and row (tokens that refer to nothing, rotations that are none, two
/// scans of one time, no scans).
NuscenesScene read_nuscenes_scene(const std::filesystem::path& root, const std::string& name);

/// True for a folder with a folder of tables in it: v1.0-*/scene.json or v1.0-*/sample_data.json.
bool is_nuscenes_root(const std::filesystem::path& folder);

/// Opens a scene of a data root of nuScenes (read_nuscenes_scene()) as a drive of
/// open_sensor_frames(): keyframes and sweeps in the order of their times, each in the frame of the
/// LiDAR, in our axes. Points have no times, so scans are taken as if standing still. Points of
/// sweeps are kNuscenesUnlabeled where keyframes have labels. Errors: usage (`mount` and
/// `time_offset`, which the tables say), data that names the file (a frame that is missing, or has
/// other labels than points), those of the two.
KittiSequence open_nuscenes_drive(const FrameDrive& drive, const Executor& executor,
                                  ProgressSink& progress);

/// category.json by the indices, of a root with lidarseg.json; else empty.
ClassNames nuscenes_class_names(const std::filesystem::path& folder);

}  // namespace adasplats
