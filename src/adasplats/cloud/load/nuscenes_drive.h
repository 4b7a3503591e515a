// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/cloud/load/data_tree.h"

namespace adasplats {

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
