// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "adasplats/cloud/load/rig.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// The name of the sensor of a topic: "lidar_top" of "/lidar/top/points".
std::string sensor_of_topic(const std::string& topic);

/// The LiDARs of a recording (MCAP, ROS bag): its topics of points, or of packets if it has no
/// points, by name, each read with `settings`. Nothing unless there are several, each in a frame of
/// its own: two topics in one frame can be the same points twice. Errors: those of
/// survey_recording().
std::optional<Rig> rig_of_recording(const std::filesystem::path& path,
                                    const DriveSettings& settings, ProgressSink& progress);

}  // namespace adasplats
