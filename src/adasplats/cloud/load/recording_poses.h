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

/// The topic of the scans: the given one, else the only one with clouds. Errors: usage with a list
/// of the candidates.
const TopicSurvey& topic_of_clouds(const RecordingSurvey& survey, const std::string& stated);

/// Poses of the clouds' frame over time.
struct RecordedPoses {
  Trajectory poses;     ///< of the frame of the clouds
  std::string by;       ///< how they were found, for messages
  std::string because;  ///< evidence that the clouds are in a moving frame; empty: none
};

/// Poses of the given trajectory; without times, one pose for each of the `scans` ("clouds") at
/// their times. `when` describes those times. Errors: data.
RecordedPoses poses_of_trajectory(const DriveInput& drive, const std::vector<double>& stamps_s,
                                  const std::string& scans, const std::string& when);

/// Poses as open_recording_drive() chooses them. `stamps_s`: times of the clouds, for a trajectory
/// without times. Errors: usage, data.
RecordedPoses poses_of_clouds(const DriveInput& drive, const RecordingSurvey& survey,
                              const TopicSurvey& clouds, const std::vector<double>& stamps_s);

/// Poses to drive the same route again: those of the clouds' frame, or those of a vehicle if no
/// transforms connect it to that frame. Without `clouds` (null): those of `poses_topic`, of the
/// only topic of poses, or of the only frame that tf moves. Errors: usage, data.
RecordedPoses poses_of_carrier(const RecordingSurvey& survey, const TopicSurvey* clouds,
                               const std::string& poses_topic);

/// The trajectory of a recording's vehicle.
struct RecordedTrajectory {
  Trajectory poses;   ///< one per cloud, or all without clouds
  Trajectory motion;  ///< all
  std::string by;     ///< how they were found, for messages
};

/// The poses of a recording, to drive along them. They are chosen as in open_recording_drive() for
/// the clouds of `topic` (empty: the only one) and interpolated at the times of their headers;
/// clouds without poses are skipped with a warning. Poses of a vehicle that no transforms connect
/// to the clouds stay its own. Without clouds: those of `poses_topic`, of the only topic of
/// odometry or poses, or of the only frame that moves by tf. Errors: usage (ambiguous topics), data
/// (no poses, different clocks), those of survey_recording().
RecordedTrajectory trajectory_of_recording(const std::filesystem::path& recording,
                                           const std::string& topic, const std::string& poses_topic,
                                           ProgressSink& progress);

}  // namespace adasplats
