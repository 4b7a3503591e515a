// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Where the carrier of a recording's sensor went.
struct RecordedTrajectory {
  Trajectory poses;   ///< one a cloud where there are clouds, else all
  Trajectory motion;  ///< all
  std::string by;     ///< how they were found, for messages
};

/// The poses of a recording, for what drives along it. They are chosen as open_recording_drive()
/// chooses them for the clouds of `topic` (empty: of the only one), at the times of whose headers
/// poses are interpolated; clouds when there are no poses are left out with a warning. Poses of a
/// vehicle that no transforms join to the clouds stay its own. Of a recording without clouds: those
/// of `poses_topic`, the only topic of odometry or poses, or the only frame that moves by tf.
/// Errors: usage (topics that are not clear), data (none, clocks that differ), those of
/// survey_recording().
RecordedTrajectory trajectory_of_recording(const std::filesystem::path& recording,
                                           const std::string& topic, const std::string& poses_topic,
                                           ProgressSink& progress);

}  // namespace adasplats
