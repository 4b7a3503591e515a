// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/recording_survey.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/bags/ros_values.h"

namespace adasplats {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;
constexpr double kUnitTolerance = 1e-3;  // of quaternions, as in files of poses

double seconds_of(std::int64_t time_ns) {
  return static_cast<double>(time_ns) / kNanosecondsPerSecond;
}

std::string name_of_message(const Recording& recording, const TopicSurvey& topic) {
  return recording.path().string() + ": message " + std::to_string(topic.messages) +
         " (from 1) of " + topic.topic.name;
}

void add_cloud(const RecordedMessage& message, const std::string& what, TopicSurvey& topic) {
  const RosCloudHead head = ros_cloud_head(message.bytes, message.topic.encoding, what);
  if (topic.clouds.empty()) topic.frame = head.header.frame;
  if (head.header.frame != topic.frame && topic.fault.empty())
    topic.fault = what + " is in frame '" + head.header.frame + "', those before it in '" +
                  topic.frame + "'; the clouds of a topic are expected in one";
  topic.clouds.push_back({seconds_of(head.header.stamp_ns), head.points, message.place});
}

void add_pose(const RosPose& pose, bool is_static, const std::string& what, TopicSurvey& topic) {
  const auto [found, is_new] = topic.edges.try_emplace({pose.header.frame, pose.child_frame});
  FrameEdge& edge = found->second;
  if (is_new) edge = {pose.header.frame, pose.child_frame, is_static, {}, {}};
  const double norm =
      std::sqrt(pose.qw * pose.qw + pose.qx * pose.qx + pose.qy * pose.qy + pose.qz * pose.qz);
  if (!(std::fabs(norm - 1) <= kUnitTolerance) || !is_finite(pose.position)) {
    if (edge.fault.empty())
      edge.fault = what + ": where '" + pose.child_frame + "' is in '" + pose.header.frame +
                   "' is no pose: its quaternion's norm is " + std::to_string(norm) +
                   ", expected 1, and its position finite";
    return;
  }
  if (is_static) edge.parent_from_child.clear();  // the last one holds
  edge.parent_from_child.push_back(
      {seconds_of(pose.header.stamp_ns),
       {rotation_from_quaternion(pose.qw / norm, pose.qx / norm, pose.qy / norm, pose.qz / norm),
        pose.position}});
}

/// By time, each time once: publishers repeat what did not change.
void put_in_order(FrameEdge& edge) {
  std::ranges::stable_sort(edge.parent_from_child, {}, &TimedPose::time_s);
  const auto same_time = [](const TimedPose& a, const TimedPose& b) {
    return a.time_s == b.time_s;
  };
  Trajectory& poses = edge.parent_from_child;
  poses.erase(std::unique(poses.begin(), poses.end(), same_time), poses.end());
}

}  // namespace

bool TopicSurvey::holds_clouds() const { return topic.type == kRosCloud; }

bool TopicSurvey::is_transforms() const {
  return topic.type == kRosTransforms || topic.type == kOldRosTransforms;
}

RecordingSurvey survey_recording(const std::filesystem::path& path, ProgressSink& progress) {
  RecordingSurvey survey{std::make_shared<const Recording>(path), {}};
  progress.begin_step("read " + path.filename().string(), 0);
  std::uint64_t done = 0;
  survey.recording->for_each_message([&](const RecordedMessage& message) {
    progress.advance(++done);
    TopicSurvey& topic = survey.topics[message.topic.name];
    if (topic.messages == 0) topic.topic = message.topic;
    if (topic.topic.type != message.topic.type || topic.topic.encoding != message.topic.encoding)
      throw Error(ErrorKind::data, path.string() + ": topic " + message.topic.name +
                                       " has messages of types " + topic.topic.type + " and " +
                                       message.topic.type);
    topic.first_ns =
        topic.messages == 0 ? message.time_ns : std::min(topic.first_ns, message.time_ns);
    topic.last_ns = std::max(topic.last_ns, message.time_ns);
    ++topic.messages;
    const bool has_points = topic.holds_clouds(), has_poses = holds_poses(topic.topic.type);
    if ((!has_points && !has_poses) || topic.topic.encoding == MessageEncoding::other) return;
    const std::string what = name_of_message(*survey.recording, topic);
    if (has_points) return add_cloud(message, what, topic);
    const bool is_static = topic.topic.name.ends_with("tf_static");
    for (const RosPose& pose :
         ros_poses(message.bytes, topic.topic.type, topic.topic.encoding, what))
      add_pose(pose, is_static, what, topic);
  });
  progress.end_step();
  for (auto& [name, topic] : survey.topics) {
    std::ranges::stable_sort(topic.clouds, {}, &CloudMessage::stamp_s);
    for (auto& [frames, edge] : topic.edges) put_in_order(edge);
  }
  return survey;
}

}  // namespace adasplats
