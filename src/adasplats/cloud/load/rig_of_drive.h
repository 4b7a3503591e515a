// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "adasplats/cloud/load/rig.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// The name of the sensor of a topic: "lidar_top" of "/lidar/top/points"; "pandar64" of itself.
std::string sensor_of_topic(const std::string& topic);

/// The LiDARs of a drive that is a rig without a rig file, each read with `settings`:
/// - a recording (MCAP, ROS bag): its topics of points, or of packets if it has no points, by name,
///   if there are several, each in a frame of its own: two topics in one frame can be the same
///   points twice;
/// - a data set that is a rig (DataTree::is_rig), unless a mount is stated: that is of one sensor.
/// Nothing for other paths. Errors: those of survey_recording() and DataTree::is_rig.
std::optional<Rig> rig_of_drive(const std::filesystem::path& path, const DriveSettings& settings,
                                ProgressSink& progress);

}  // namespace adasplats
