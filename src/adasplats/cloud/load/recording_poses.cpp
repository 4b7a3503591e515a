// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/recording_poses.h"

#include <algorithm>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/bags/ros_values.h"

namespace adasplats {
namespace {

std::string count_and_type(const TopicSurvey& topic) {
  return topic.topic.name + " (" + topic.topic.type + ", " + std::to_string(topic.messages) +
         " messages)";
}

/// "/a (TYPE, 3 messages), /b (...)" of the topics that `chosen` takes.
template <class Chosen>
std::string list_of_topics(const RecordingSurvey& survey, Chosen&& chosen) {
  std::string list;
  for (const auto& [name, topic] : survey.topics)
    if (chosen(topic)) list += (list.empty() ? "" : ", ") + count_and_type(topic);
  return list.empty() ? "none" : list;
}

bool tells_one_pose(const TopicSurvey& topic) {
  return !topic.edges.empty() && !topic.is_transforms();
}

/// All transforms of topics of tf. Errors: data where they contradict each other.
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

RecordedPoses poses_of_file(const FrameDrive& drive, const std::vector<double>& stamps_s) {
  RecordedPoses found;
  found.poses = read_trajectory(drive.trajectory);
  found.by = "interpolated at the times of the clouds' headers";
  if (!has_times(drive.trajectory)) {
    if (found.poses.size() != stamps_s.size())
      throw Error(ErrorKind::data, drive.trajectory.string() + ": " +
                                       std::to_string(found.poses.size()) +
                                       " poses without times, " + std::to_string(stamps_s.size()) +
                                       " clouds; expected one pose a cloud, or poses with times");
    for (std::size_t k = 0; k < stamps_s.size(); ++k) found.poses[k].time_s = stamps_s[k];
    found.by = "one a cloud, at the times of their headers";
  }
  if (drive.mount) found.poses = mounted(std::move(found.poses), drive.mount->transform());
  return found;
}

/// The poses of a topic that says where one frame is in another.
RecordedPoses poses_of_topic(const FrameDrive& drive, const FrameTree& tree,
                             const TopicSurvey& topic, const TopicSurvey& clouds) {
  const std::string& name = topic.topic.name;
  if (topic.edges.size() != 1)
    throw Error(ErrorKind::data, name + " has poses of " + std::to_string(topic.edges.size()) +
                                     " pairs of frames, expected one");
  const FrameEdge& edge = topic.edges.begin()->second;
  if (!edge.fault.empty()) throw Error(ErrorKind::data, edge.fault);
  RecordedPoses found;
  found.by = "of '" + edge.child + "' in '" + edge.parent + "' by " + name;
  if (edge.child.empty()) found.by = "in '" + edge.parent + "' by " + name;
  if (drive.mount) {
    found.poses = mounted(edge.parent_from_child, drive.mount->transform());
  } else if (edge.child.empty()) {
    found.poses = edge.parent_from_child;
  } else {
    if (edge.child != clouds.frame && !(tree.has(edge.child) && tree.has(clouds.frame)))
      throw Error(ErrorKind::data,
                  "the clouds of " + clouds.topic.name + " are in frame '" + clouds.frame +
                      "', the poses of " + name + " are those of '" + edge.child +
                      "', and no transforms join them (frames: " + tree.frame_names() +
                      "); `mount` states where the sensor sits");
    found.poses = mounted(edge.parent_from_child, tree.fixed_between(edge.child, clouds.frame));
    if (edge.child != clouds.frame) found.by += ", brought to '" + clouds.frame + "' by tf";
  }
  if (!edge.child.empty())
    found.because = "frame '" + clouds.frame + "' of a vehicle that moves in '" + edge.parent + "'";
  return found;
}

RecordedPoses poses_of_tree(const FrameDrive& drive, const FrameTree& tree,
                            const std::string& frame) {
  if (drive.mount)
    throw Error(ErrorKind::usage,
                "`mount` is for poses of a trajectory or of a topic of them; the transforms of the "
                "recording say where '" +
                    frame + "' sits");
  const std::string root = tree.root_of(frame);
  return {tree.poses_of(frame), "of '" + frame + "' in '" + root + "' by tf",
          "frame '" + frame + "', which moves in '" + root + "'"};
}

Error no_poses(const RecordingSurvey& survey, const FrameTree& tree, const TopicSurvey& clouds) {
  const auto holds_points = [](const TopicSurvey& topic) { return tells_one_pose(topic); };
  std::string found = "its transforms know frames " + tree.frame_names();
  if (tree.has(clouds.frame))
    found = "'" + clouds.frame + "' does not move in '" + tree.root_of(clouds.frame) + "' (" +
            found + ")";
  return Error(ErrorKind::data,
               "the clouds of " + clouds.topic.name + " are in frame '" + clouds.frame +
                   "', and where that was is not said: " + found +
                   "; topics of poses: " + list_of_topics(survey, holds_points) +
                   "; expected tf from a fixed frame to it, `poses_topic` or a `trajectory`");
}

RecordedPoses poses_within(const FrameDrive& drive, const RecordingSurvey& survey,
                           const TopicSurvey& clouds) {
  const FrameTree tree = tree_of(survey);
  if (!drive.poses_topic.empty()) {
    const auto topic = survey.topics.find(drive.poses_topic);
    if (topic == survey.topics.end() || topic->second.edges.empty())
      throw Error(ErrorKind::usage, drive.poses_topic + " is no topic with poses; there are " +
                                        list_of_topics(survey, [](const TopicSurvey& one) {
                                          return !one.edges.empty();
                                        }));
    if (topic->second.is_transforms()) return poses_of_tree(drive, tree, clouds.frame);
    return poses_of_topic(drive, tree, topic->second, clouds);
  }
  if (tree.moves(clouds.frame)) return poses_of_tree(drive, tree, clouds.frame);
  std::vector<const TopicSurvey*> candidates;
  for (const auto& [name, topic] : survey.topics)
    if (tells_one_pose(topic)) candidates.push_back(&topic);
  if (candidates.size() > 1)
    throw Error(ErrorKind::usage,
                "has several topics of poses: " + list_of_topics(survey, &tells_one_pose) +
                    "; `poses_topic` states which");
  if (candidates.empty()) throw no_poses(survey, tree, clouds);
  return poses_of_topic(drive, tree, *candidates.front(), clouds);
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
                path + ": has no topic of points (" + std::string(kRosCloud) + "), but " +
                    list_of_topics(survey, [](const TopicSurvey&) { return true; }));
  if (count == 0)
    throw Error(ErrorKind::usage, path + ": has no topic of points " + stated + "; there are " +
                                      list_of_topics(survey, is_one));
  if (count > 1)
    throw Error(ErrorKind::usage, path + ": has several topics of points: " +
                                      list_of_topics(survey, is_one) + "; `topic` states which");
  if (!chosen->fault.empty()) throw Error(ErrorKind::data, chosen->fault);
  return *chosen;
}

RecordedPoses poses_of_clouds(const FrameDrive& drive, const RecordingSurvey& survey,
                              const TopicSurvey& clouds, const std::vector<double>& stamps_s) {
  if (!drive.trajectory.empty()) return poses_of_file(drive, stamps_s);
  try {
    return poses_within(drive, survey, clouds);
  } catch (const Error& error) {
    const std::string path = survey.recording->path().string();
    const std::string message = error.what();
    if (message.starts_with(path)) throw;
    throw Error(error.kind(), path + ": " + message);
  }
}

}  // namespace adasplats
