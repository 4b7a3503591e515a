// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/cloud/load/data_tree.h"

namespace adasplats {

/// True for a folder that contains lidar/poses.json, lidar/timestamps.json or lidar/00.pkl.gz.
bool is_pandaset_sequence(const std::filesystem::path& folder);

/// Opens a sequence of PandaSet (Xiao et al., "PandaSet: Advanced Sensor Suite Dataset for
/// Autonomous Driving", 2021, and its devkit): lidar/{NN.pkl.gz,poses.json,timestamps.json}, and
/// annotations/semseg/NN.pkl.gz if it has labels. Scans are the points of the spinning LiDAR (d =
/// 0, the Pandar64). Points of the PandarGT (d = 1) are skipped and counted, since its mount is
/// unknown. Points are in world coordinates with times (t), so open_world_frames() opens the drive:
/// the cones of the beams show whether the poses are those of the vehicle or of the LiDAR. If they
/// are not recognised, the poses are assumed to be the LiDAR's, with the stated mount. Errors: data
/// with the file (a frame that is missing, has no pose, or has fewer or more labels than points; a
/// wrong number of times; an invalid heading).
KittiSequence open_pandaset_drive(const DriveInput& drive, const Executor& executor,
                                  ProgressSink& progress);

/// annotations/semseg/classes.json; empty without labels.
ClassNames pandaset_class_names(const std::filesystem::path& folder);

}  // namespace adasplats
