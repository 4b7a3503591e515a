// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/recording_poses.h"

#include <algorithm>
#include <set>
#include <utility>

#include "adasplats/cloud/origins/track.h"
#include "adasplats/core/error.h"
#include "adasplats/io/bags/ros_values.h"

namespace adasplats {

namespace {

std::string count_and_type(const TopicSurvey& topic) {
  return topic.topic.name + " (" + topic.topic.type + ", " + std::to_string(topic.messages) +
         " messages)";
}

/// "/a (TYPE, 3 messages), /b (...)" of the topics for which `chosen` is true.
template <class Chosen>
std::string list_of_topics(const RecordingSurvey& survey, Chosen&& chosen) {
  std::string list;
  for (const auto& [name, topic] : survey.topics)
    if (chosen(topic)) list += (list.empty() ? "" : ", ") + count_and_type(topic);
  return list.empty() ? "none" : list;
}

bool is_pose_topic(const TopicSurvey& topic) {
  return !topic.edges.empty() && !topic.is_transforms();
}

/// All transforms of tf topics. Errors: data if they contradict each other.
FrameTree tree_of(const RecordingSurvey& survey) {
  FrameTree tree;
  for (const auto& [name, topic] : survey.topics) {
    if (!topic.is_transforms()) continue;
    for (const auto& [frames, edge] : topic.edges) {
      try {
        tree.add(edge);
      } catch (const Error& error) {
        throw Error(error.kind(), survey.recording->path().string() + ": " + error.what());
      }
    }
  }
  return tree;
}

/// The pair of frames of a topic of poses.
const FrameEdge& edge_of_topic(const TopicSurvey& topic) {
  if (topic.edges.size() != 1)
    throw Error(ErrorKind::data, topic.topic.name + " has poses of " +
                                     std::to_string(topic.edges.size()) +
                                     " pairs of frames; expected one pair");
  const FrameEdge& edge = topic.edges.begin()->second;
  if (!edge.fault.empty()) throw Error(ErrorKind::data, edge.fault);
  return edge;
}

/// "of 'base_link' in 'odom' by /odometry".
std::string words_of_edge(const FrameEdge& edge, const std::string& topic) {
  return (edge.child.empty() ? "" : "of '" + edge.child + "' ") + "in '" + edge.parent + "' by " +
         topic +
         (edge.is_timed_by_log ? " at the times of the log, since its headers have none" : "") +
         (edge.repeated == 0
              ? ""
              : " without " + std::to_string(edge.repeated) + " other poses of the same times");
}

Error no_frame(const TopicSurvey& clouds) {
  return {ErrorKind::data,
          "messages of " + clouds.topic.name +
              " name no frame (frame_id in their headers is empty), so transforms cannot give "
              "their poses; give the poses of the sensor as `trajectory`, or a `poses_topic` and "
              "`mount`, the position of the sensor in the frame of those poses"};
}

/// The poses of a topic with one pair of frames.
RecordedPoses poses_of_topic(const DriveInput& drive, const FrameTree& tree,
                             const TopicSurvey& topic, const TopicSurvey& clouds) {
  const std::string& name = topic.topic.name;
  const FrameEdge& edge = edge_of_topic(topic);
  RecordedPoses found;
  found.by = words_of_edge(edge, name);
  if (const auto mount = drive.given_mount()) {
    found.poses = mounted(edge.parent_from_child, mount->transform());
  } else if (edge.child.empty()) {
    found.poses = edge.parent_from_child;
  } else {
    if (clouds.frame.empty()) throw no_frame(clouds);
    if (edge.child != clouds.frame && !(tree.has(edge.child) && tree.has(clouds.frame)))
      throw Error(ErrorKind::data,
                  "the clouds of " + clouds.topic.name + " are in frame '" + clouds.frame +
                      "', the poses of " + name + " are those of '" + edge.child +
                      "', and no transforms connect the two (frames: " + tree.frame_names() +
                      "); give `mount`, the position of the sensor in '" + edge.child + "'");
    found.poses = mounted(edge.parent_from_child, tree.fixed_between(edge.child, clouds.frame));
    if (edge.child != clouds.frame) found.by += ", transformed to '" + clouds.frame + "' by tf";
  }
  if (!edge.child.empty())
    found.because =
        words_of_frame(clouds.frame) + " of a vehicle that moves in '" + edge.parent + "'";
  return found;
}

RecordedPoses poses_of_tree(const DriveInput& drive, const FrameTree& tree,
                            const std::string& frame) {
  if (drive.given_mount())
    throw Error(ErrorKind::usage,
                "`mount` needs poses from a `trajectory` or a `poses_topic`; here the transforms "
                "of the recording define the pose of '" +
                    frame + "'");
  const std::string root = tree.root_of(frame);
  return {tree.poses_of(frame), "of '" + frame + "' in '" + root + "' by tf",
          "frame '" + frame + "', which moves in '" + root + "'"};
}

Error no_poses(const RecordingSurvey& survey, const FrameTree& tree, const TopicSurvey& clouds) {
  const auto holds_points = [](const TopicSurvey& topic) { return is_pose_topic(topic); };
  std::string found = "its transforms have the frames " + tree.frame_names();
  if (tree.has(clouds.frame))
    found = "'" + clouds.frame + "' does not move in '" + tree.root_of(clouds.frame) + "' (" +
            found + ")";
  return Error(
      ErrorKind::data,
      "the clouds of " + clouds.topic.name + " are in frame '" + clouds.frame +
          "', whose poses are unknown: " + found +
          "; topics of poses: " + list_of_topics(survey, holds_points) +
          "; record tf from a fixed frame to it, or give `poses_topic` or `trajectory` (of "
          "a sensor that stands still: twice the same pose, before the first cloud and "
          "after the last)");
}

/// The topic with that name. Errors: usage if it has no poses.
const TopicSurvey& stated_topic_of_poses(const RecordingSurvey& survey, const std::string& name) {
  const auto topic = survey.topics.find(name);
  if (topic == survey.topics.end() || topic->second.edges.empty())
    throw Error(ErrorKind::usage, name + " is not a topic with poses; topics with poses: " +
                                      list_of_topics(survey, [](const TopicSurvey& one) {
                                        return !one.edges.empty();
                                      }));
  return topic->second;
}

/// The only topic of odometry or poses; null: none. Errors: usage if there are several.
const TopicSurvey* only_topic_of_poses(const RecordingSurvey& survey) {
  const TopicSurvey* only = nullptr;
  for (const auto& [name, topic] : survey.topics) {
    if (!is_pose_topic(topic)) continue;
    if (only != nullptr)
      throw Error(ErrorKind::usage,
                  "has several topics of poses: " + list_of_topics(survey, &is_pose_topic) +
                      "; choose one with `poses_topic`");
    only = &topic;
  }
  return only;
}

RecordedPoses poses_within(const DriveInput& drive, const RecordingSurvey& survey,
                           const TopicSurvey& clouds) {
  const FrameTree tree = tree_of(survey);
  if (!drive.poses_topic.empty()) {
    const TopicSurvey& topic = stated_topic_of_poses(survey, drive.poses_topic);
    if (topic.is_transforms() && clouds.frame.empty()) throw no_frame(clouds);
    if (topic.is_transforms()) return poses_of_tree(drive, tree, clouds.frame);
    return poses_of_topic(drive, tree, topic, clouds);
  }
  if (tree.moves(clouds.frame)) return poses_of_tree(drive, tree, clouds.frame);
  const TopicSurvey* const only = only_topic_of_poses(survey);
  if (only == nullptr)
    throw clouds.frame.empty() ? no_frame(clouds) : no_poses(survey, tree, clouds);
  return poses_of_topic(drive, tree, *only, clouds);
}

/// The only frame that moves in its parent.
std::string only_moving_frame(const RecordingSurvey& survey) {
  std::set<std::string> moving;
  for (const auto& [name, topic] : survey.topics)
    for (const auto& [frames, edge] : topic.edges)
      if (topic.is_transforms() && !edge.is_static && edge.parent_from_child.size() > 1)
        moving.insert(edge.child);
  if (moving.empty())
    throw Error(ErrorKind::data,
                "has no poses: neither changing transforms nor topics of odometry or poses");
  if (moving.size() == 1) return *moving.begin();
  std::string all;
  for (const std::string& frame : moving) all += (all.empty() ? "'" : ", '") + frame + "'";
  throw Error(ErrorKind::usage, "several frames move by tf (" + all +
                                    "), and without clouds the frame of the sensor is unknown; "
                                    "choose a topic of odometry or poses with `poses_topic`");
}

/// The poses of a recording without clouds.
RecordedPoses poses_without_clouds(const RecordingSurvey& survey, const std::string& poses_topic) {
  const TopicSurvey* const topic = poses_topic.empty()
                                       ? only_topic_of_poses(survey)
                                       : &stated_topic_of_poses(survey, poses_topic);
  if (topic == nullptr || topic->is_transforms())
    return poses_of_tree({}, tree_of(survey), only_moving_frame(survey));
  const FrameEdge& edge = edge_of_topic(*topic);
  return {edge.parent_from_child, words_of_edge(edge, topic->topic.name), ""};
}

/// poses_within(), or those of a vehicle that no transforms connect to the clouds.
RecordedPoses poses_of_clouds_or_vehicle(const RecordingSurvey& survey, const TopicSurvey& clouds,
                                         const std::string& poses_topic) {
  DriveInput drive;
  drive.poses_topic = poses_topic;
  const FrameTree tree = tree_of(survey);
  const bool by_tree = poses_topic.empty()
                           ? tree.moves(clouds.frame)
                           : stated_topic_of_poses(survey, poses_topic).is_transforms();
  const TopicSurvey* topic = nullptr;
  if (!by_tree)
    topic = poses_topic.empty() ? only_topic_of_poses(survey)
                                : &stated_topic_of_poses(survey, poses_topic);
  if (topic == nullptr) return poses_within(drive, survey, clouds);
  const FrameEdge& edge = edge_of_topic(*topic);
  const bool is_joined = edge.child.empty() || edge.child == clouds.frame ||
                         (tree.has(edge.child) && tree.has(clouds.frame));
  if (is_joined) return poses_within(drive, survey, clouds);
  return {edge.parent_from_child,
          words_of_edge(edge, topic->topic.name) + ", which no transforms connect to " +
              words_of_frame(clouds.frame) + " of the clouds",
          ""};
}

/// Calls find() and prefixes its errors with the recording.
template <class Find>
RecordedPoses named_errors(const RecordingSurvey& survey, const Find& find) {
  try {
    return find();
  } catch (const Error& error) {
    const std::string path = survey.recording->path().string();
    const std::string message = error.what();
    if (message.starts_with(path)) throw;
    throw Error(error.kind(), path + ": " + message);
  }
}

}  // namespace

const TopicSurvey& topic_of_clouds(const RecordingSurvey& survey, const std::string& stated) {
  const std::string path = survey.recording->path().string();
  const auto is_one = [](const TopicSurvey& topic) { return topic.holds_clouds(); };
  const TopicSurvey* chosen = nullptr;
  std::size_t count = 0;
  for (const auto& [name, topic] : survey.topics) {
    if (!is_one(topic) || (!stated.empty() && name != stated)) continue;
    chosen = &topic;
    ++count;
  }
  if (count == 0 && stated.empty())
    throw Error(ErrorKind::data,
                path + ": has no topic of points (" + std::string(kRosCloud) +
                    ") or of packets of a sensor; its topics: " +
                    list_of_topics(survey, [](const TopicSurvey&) { return true; }));
  if (count == 0)
    throw Error(ErrorKind::usage, path + ": has no topic of points " + stated +
                                      "; topics of points: " + list_of_topics(survey, is_one));
  if (count > 1)
    throw Error(ErrorKind::usage, path + ": has several topics of points: " +
                                      list_of_topics(survey, is_one) + "; choose one with `topic`");
  if (!chosen->fault.empty()) throw Error(ErrorKind::data, chosen->fault);
  return *chosen;
}

RecordedPoses poses_of_trajectory(const DriveInput& drive, const std::vector<double>& stamps_s,
                                  const std::string& scans, const std::string& when) {
  RecordedPoses found;
  found.poses = read_trajectory(drive.trajectory);
  found.by = "interpolated " + when;
  if (!has_times(drive.trajectory)) {
    if (found.poses.size() != stamps_s.size())
      throw Error(ErrorKind::data,
                  drive.trajectory.string() + ": " + std::to_string(found.poses.size()) +
                      " poses without times for " + std::to_string(stamps_s.size()) + " " + scans +
                      "; expected one pose each, or poses with times");
    for (std::size_t k = 0; k < stamps_s.size(); ++k) found.poses[k].time_s = stamps_s[k];
    found.by = "one each, " + when;
  }
  if (const auto mount = drive.given_mount())
    found.poses = mounted(std::move(found.poses), mount->transform());
  return found;
}

RecordedPoses poses_of_clouds(const DriveInput& drive, const RecordingSurvey& survey,
                              const TopicSurvey& clouds, const std::vector<double>& stamps_s) {
  if (!drive.trajectory.empty())
    return poses_of_trajectory(drive, stamps_s, "clouds", "at the times of the clouds' headers");
  return named_errors(survey, [&] { return poses_within(drive, survey, clouds); });
}

RecordedPoses poses_of_carrier(const RecordingSurvey& survey, const TopicSurvey* clouds,
                               const std::string& poses_topic) {
  return named_errors(survey, [&] {
    return clouds == nullptr ? poses_without_clouds(survey, poses_topic)
                             : poses_of_clouds_or_vehicle(survey, *clouds, poses_topic);
  });
}

namespace {

/// The poses at the times of clouds, if covered.
Trajectory poses_at_clouds(const Trajectory& poses, const TopicSurvey& clouds,
                           const std::string& path, ProgressSink& progress) {
  const Track track = track_of(poses);
  Trajectory at;
  std::size_t left_out = 0;
  for (const CloudMessage& cloud : clouds.clouds) {
    const double time_s = cloud.stamp_s;
    const bool is_new = at.empty() || time_s > at.back().time_s;
    if (track.covers(time_s) && is_new)
      at.push_back({time_s, interpolate(track.poses, time_s)});
    else
      ++left_out;
  }
  const std::string figures = std::to_string(left_out) + " of " +
                              std::to_string(clouds.clouds.size()) + " clouds of " +
                              clouds.topic.name + " have no pose, or repeat a time";
  if (at.size() < left_out)
    throw Error(ErrorKind::data, path + ": " + figures + "; the clocks of clouds and poses differ");
  if (left_out > 0) progress.warn(path + ": " + figures + " and are skipped");
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
