// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string_view>
#include <vector>

#include "adasplats/cloud/load/data_tree.h"

namespace adasplats {

/// The LiDARs of PandaSet in the order of their numbers (column d): the spinning Pandar64 and the
/// forward PandarGT.
inline constexpr std::array<std::string_view, 2> kPandaSetSensors = {"pandar64", "pandargt"};

/// True for a folder that contains lidar/poses.json, lidar/timestamps.json or lidar/00.pkl.gz.
bool is_pandaset_sequence(const std::filesystem::path& folder);

/// Opens a sequence of PandaSet (Xiao et al., "PandaSet: Advanced Sensor Suite Dataset for
/// Autonomous Driving", 2021, and its devkit): lidar/{NN.pkl.gz,poses.json,timestamps.json}, and
/// annotations/semseg/NN.pkl.gz if it has labels. Scans are the points of one LiDAR, that of
/// `topic` (kPandaSetSensors) or the Pandar64; those of the other one are skipped, and counted
/// without a topic. Points are in world coordinates with times (t), so open_world_frames() opens
/// the drive: the cones of the Pandar64's beams show whether the poses are those of the vehicle or
/// of the Pandar64. If they are not recognised, the poses are assumed to be the Pandar64's. The
/// PandarGT is mounted on it as PandaSet's devkit publishes. A stated mount is that of the sensor
/// that is read. Errors: data with the file (a frame that is missing, has no pose, or has fewer or
/// more labels than points; a wrong number of times; an invalid heading).
KittiSequence open_pandaset_drive(const DriveInput& drive, const Executor& executor,
                                  ProgressSink& progress);

/// Whether both LiDARs have at least 1000 points in each of three frames (the first, the middle and
/// the last); false without frames. Errors: data (a damaged frame).
bool is_pandaset_rig(const std::filesystem::path& folder);

/// The frames of a folder by their numbers: NN.pkl.gz, or NN.pkl. Errors: data for two files of one
/// number.
std::map<std::size_t, std::filesystem::path> pandaset_frames(const std::filesystem::path& folder);

/// The times in a timestamps.json. Errors: no_input, data (times that do not ascend).
std::vector<double> pandaset_times(const std::filesystem::path& file);

/// annotations/semseg/classes.json; empty without labels.
ClassNames pandaset_class_names(const std::filesystem::path& folder);

}  // namespace adasplats
