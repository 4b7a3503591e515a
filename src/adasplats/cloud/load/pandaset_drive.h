// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/cloud/load/data_tree.h"

namespace adasplats {

/// True for a folder `lidar` with poses.json, timestamps.json or 00.pkl.gz in it.
bool is_pandaset_sequence(const std::filesystem::path& folder);

/// Opens a sequence of PandaSet (Xiao et al., "PandaSet: Advanced Sensor Suite Dataset for
/// Autonomous Driving", 2021, and its devkit): lidar/{NN.pkl.gz,poses.json,timestamps.json}, and
/// annotations/semseg/NN.pkl.gz where there are labels. Scans are the points of the LiDAR that
/// turns (d is 0, the Pandar64); those of the PandarGT (d is 1) are left out and counted, since
/// nothing tells where it sits. Points are in world coordinates, each with its time (t), so the
/// drive is one of open_world_frames(): the poses are those of the vehicle, or of the LiDAR, which
/// the cones of its beams tell; where these are not recognised they are taken as the LiDAR's, with
/// the mount that is stated. Errors: data that names the file (a frame that is missing or has no
/// pose, or other labels than points; times of another count; a heading that is none).
KittiSequence open_pandaset_drive(const FrameDrive& drive, const Executor& executor,
                                  ProgressSink& progress);

/// annotations/semseg/classes.json; empty where there are no labels.
ClassNames pandaset_class_names(const std::filesystem::path& folder);

}  // namespace adasplats
