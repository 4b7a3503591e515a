// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/load/recording_drive.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// The topic whose clouds are the scans: the stated one, else the only one. Errors: usage with a
/// list of those that there are.
const TopicSurvey& topic_of_clouds(const RecordingSurvey& survey, const std::string& stated);

/// Poses over time of what carries the clouds' frame.
struct RecordedPoses {
  Trajectory poses;     ///< of the frame of the clouds
  std::string by;       ///< how they were found, for messages
  std::string because;  ///< what says that the clouds are in a frame that moves; empty: nothing
};

/// Those of the stated trajectory; where it has no times, one pose each of the `scans` ("clouds")
/// at their times. `when` says which those are. Errors: data.
RecordedPoses poses_of_trajectory(const FrameDrive& drive, const std::vector<double>& stamps_s,
                                  const std::string& scans, const std::string& when);

/// As open_recording_drive() chooses them; `stamps_s` are the times of the clouds, which poses of a
/// trajectory without times get. Errors: usage, data.
RecordedPoses poses_of_clouds(const FrameDrive& drive, const RecordingSurvey& survey,
                              const TopicSurvey& clouds, const std::vector<double>& stamps_s);

/// The poses of what carried the sensor, for who drives that way again: those of the clouds' frame,
/// or of a vehicle that nothing joins to it; without `clouds` (null) those of `poses_topic`, of the
/// only topic of poses, or of the only frame that moves by tf. Errors: usage, data.
RecordedPoses poses_of_carrier(const RecordingSurvey& survey, const TopicSurvey* clouds,
                               const std::string& poses_topic);

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
