// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/recorded_trajectory.h"

#include <algorithm>
#include <utility>

#include "adasplats/cloud/load/recording_poses.h"
#include "adasplats/cloud/origins/track.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// The poses at the times of clouds, as far as there are some.
Trajectory poses_at_clouds(const Trajectory& poses, const TopicSurvey& clouds,
                           const std::string& path, ProgressSink& progress) {
  const Track track = track_of(poses);
  const TimeSpan covered = track.covered_s();
  Trajectory at;
  std::size_t left_out = 0;
  for (const CloudMessage& cloud : clouds.clouds) {
    const double time_s = cloud.stamp_s;
    const bool in_gap = std::ranges::any_of(
        track.gaps, [time_s](TimeSpan gap) { return time_s > gap.first && time_s < gap.last; });
    const bool is_known = time_s >= covered.first && time_s <= covered.last && !in_gap;
    const bool is_new = at.empty() || time_s > at.back().time_s;
    if (is_known && is_new)
      at.push_back({time_s, interpolate(track.poses, time_s)});
    else
      ++left_out;
  }
  const std::string figures = std::to_string(left_out) + " of " +
                              std::to_string(clouds.clouds.size()) + " clouds of " +
                              clouds.topic.name + " have no pose at a time of their own";
  if (at.size() < left_out)
    throw Error(ErrorKind::data, path + ": " + figures + ": the clocks of clouds and poses differ");
  if (left_out > 0) progress.warn(path + ": " + figures + ", so they are left out");
  return at;
}

}  // namespace

RecordedTrajectory trajectory_of_recording(const std::filesystem::path& recording,
                                           const std::string& topic, const std::string& poses_topic,
                                           ProgressSink& progress) {
  const RecordingSurvey survey = survey_recording(recording, progress);
  const std::string path = recording.string();
  const bool has_clouds = std::ranges::any_of(
      survey.topics, [](const auto& named) { return named.second.holds_clouds(); });
  const TopicSurvey* const clouds =
      has_clouds || !topic.empty() ? &topic_of_clouds(survey, topic) : nullptr;
  RecordedPoses found = poses_of_carrier(survey, clouds, poses_topic);
  RecordedTrajectory result;
  result.by = found.by;
  if (clouds != nullptr) {
    result.poses = poses_at_clouds(found.poses, *clouds, path, progress);
    result.by += ", at the times of the clouds of " + clouds->topic.name;
  } else {
    result.poses = found.poses;
  }
  result.motion = std::move(found.poses);
  return result;
}

}  // namespace adasplats
