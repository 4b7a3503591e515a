// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/recording_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "adasplats/cloud/load/file_scan.h"
#include "adasplats/cloud/load/frame_evidence.h"
#include "adasplats/cloud/load/recording_poses.h"
#include "adasplats/cloud/load/sensor_drive.h"
#include "adasplats/cloud/origins/track.h"
#include "adasplats/cloud/poses/exact_time.h"
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
    topic.fault = what + " has " + words_of_frame(head.header.frame) + ", earlier ones " +
                  words_of_frame(topic.frame) + "; expected one frame per topic";
  topic.clouds.push_back({seconds_of(head.header.stamp_ns), head.header.stamp_ns, topic.messages,
                          head.points, message.place});
}

void add_packets(const RecordedMessage& message, const std::string& what, TopicSurvey& topic) {
  if (topic.packets.empty())
    topic.frame =
        ros_packets(message.bytes, message.topic.type, message.topic.encoding, what).frame;
  topic.packets.push_back({message.time_ns, message.place});
}

/// Ouster's drivers record the metadata as a text.
void add_metadata(const RecordedMessage& message, const std::string& what, TopicSurvey& topic) {
  if (topic.metadata.empty() && topic.topic.name.ends_with("metadata"))
    topic.metadata = ros_string(message.bytes, message.topic.encoding, what);
}

void add_pose(const RosPose& pose, bool is_static, std::uint64_t logged_ns, const std::string& what,
              TopicSurvey& topic) {
  const auto [found, is_new] = topic.edges.try_emplace({pose.header.frame, pose.child_frame});
  FrameEdge& edge = found->second;
  if (is_new) edge = {pose.header.frame, pose.child_frame, is_static, {}, {}, {}};
  const double norm =
      std::sqrt(pose.qw * pose.qw + pose.qx * pose.qx + pose.qy * pose.qy + pose.qz * pose.qz);
  if (!(std::fabs(norm - 1) <= kUnitTolerance) || !is_finite(pose.position)) {
    if (edge.fault.empty())
      edge.fault = what + ": the pose of '" + pose.child_frame + "' in '" + pose.header.frame +
                   "' is invalid: its quaternion has norm " + std::to_string(norm) +
                   ", expected 1 and a finite position";
    return;
  }
  if (is_static) {  // the last one counts
    edge.parent_from_child.clear();
    edge.stamps_ns.clear();
    edge.logged_ns.clear();
  }
  edge.stamps_ns.push_back(pose.header.stamp_ns);
  edge.logged_ns.push_back(static_cast<std::int64_t>(logged_ns));
  edge.parent_from_child.push_back(
      {seconds_of(pose.header.stamp_ns),
       {rotation_from_quaternion(pose.qw / norm, pose.qx / norm, pose.qy / norm, pose.qz / norm),
        pose.position}});
}

/// Uses the times of the log if no header has one.
void replace_missing_times(FrameEdge& edge) {
  const auto is_zero = [](std::int64_t stamp_ns) { return stamp_ns == 0; };
  if (edge.is_static || edge.stamps_ns.size() < 2 || !std::ranges::all_of(edge.stamps_ns, is_zero))
    return;
  edge.is_timed_by_log = true;
  edge.stamps_ns = edge.logged_ns;
  for (std::size_t k = 0; k < edge.stamps_ns.size(); ++k)
    edge.parent_from_child[k].time_s = seconds_of(edge.stamps_ns[k]);
}

bool are_apart(const RigidTransform& a, const RigidTransform& b) {
  constexpr double kSame_m = 1e-3, kSame_rad = 1e-3;
  return length(a.translation - b.translation) > kSame_m ||
         angle_between(a.rotation, b.rotation) > kSame_rad;
}

/// Sorts by time and removes repeated times: publishers repeat unchanged poses. Doubles cannot
/// distinguish stamps a few nanoseconds apart. Many other poses of the same times are a fault.
void put_in_order(FrameEdge& edge) {
  constexpr std::size_t kMaxShare = 10;  // one in
  replace_missing_times(edge);
  std::vector<std::size_t> order(edge.stamps_ns.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return edge.stamps_ns[k]; });
  Trajectory poses;
  std::optional<std::int64_t> before_ns;
  for (const std::size_t k : order) {
    TimedPose pose = edge.parent_from_child[k];
    if (before_ns == edge.stamps_ns[k]) {
      if (are_apart(poses.back().world_from_sensor, pose.world_from_sensor)) ++edge.repeated;
      continue;
    }
    before_ns = edge.stamps_ns[k];
    if (!poses.empty()) pose.time_s = time_after(poses.back().time_s, pose.time_s);
    poses.push_back(pose);
  }
  if (edge.repeated > order.size() / kMaxShare && edge.fault.empty())
    edge.fault = std::to_string(edge.repeated) + " of " + std::to_string(order.size()) +
                 " poses of '" + edge.child + "' in '" + edge.parent +
                 "' have the time of another pose in their headers; expected distinct times";
  edge.parent_from_child = std::move(poses);
  edge.stamps_ns = edge.logged_ns = {};
}

/// The same for clouds, which are all kept.
void put_in_order(std::vector<CloudMessage>& clouds) {
  std::ranges::stable_sort(clouds, {}, &CloudMessage::stamp_ns);
  for (std::size_t k = 1; k < clouds.size(); ++k)
    clouds[k].stamp_s = clouds[k].stamp_ns == clouds[k - 1].stamp_ns
                            ? clouds[k - 1].stamp_s
                            : time_after(clouds[k - 1].stamp_s, clouds[k].stamp_s);
}

}  // namespace

std::string words_of_frame(const std::string& frame) {
  return frame.empty() ? "no frame (frame_id is empty)" : "frame '" + frame + "'";
}

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
                                       " has messages of two types, " + topic.topic.type + " and " +
                                       message.topic.type);
    topic.first_ns =
        topic.messages == 0 ? message.time_ns : std::min(topic.first_ns, message.time_ns);
    topic.last_ns = std::max(topic.last_ns, message.time_ns);
    ++topic.messages;
    if (topic.topic.encoding == MessageEncoding::other) return;
    const std::string what = name_of_message(*survey.recording, topic);
    if (topic.holds_clouds()) return add_cloud(message, what, topic);
    if (holds_packets(topic.topic.type)) return add_packets(message, what, topic);
    if (topic.topic.type == kRosString) return add_metadata(message, what, topic);
    if (!holds_poses(topic.topic.type)) return;
    const bool is_static = topic.topic.name.ends_with("tf_static");
    for (const RosPose& pose :
         ros_poses(message.bytes, topic.topic.type, topic.topic.encoding, what))
      add_pose(pose, is_static, message.time_ns, what, topic);
  });
  progress.end_step();
  for (auto& [name, topic] : survey.topics) {
    put_in_order(topic.clouds);
    for (auto& [frames, edge] : topic.edges) put_in_order(edge);
  }
  return survey;
}

namespace {

namespace fs = std::filesystem;

/// Reads scans that are messages, by generated names.
class RecordedScans final : public ScanSource {
 public:
  RecordedScans(std::shared_ptr<const Recording> recording, MessageEncoding encoding,
                std::map<fs::path, MessagePosition> places)
      : recording_(std::move(recording)), encoding_(encoding), places_(std::move(places)) {}
  FileScan read(const fs::path& scan) const override {
    return scan_of_table(scan, ros_points(recording_->message(places_.at(scan)), encoding_,
                                          scan.string() + ": the message"));
  }

 private:
  std::shared_ptr<const Recording> recording_;
  MessageEncoding encoding_;
  std::map<fs::path, MessagePosition> places_;
};

/// "drive.mcap/000012": by its number among the clouds of the topic.
fs::path scan_name(const fs::path& recording, std::size_t number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%06zu", number);
  return recording / text.data();
}

/// A sample scan to determine the meaning of point times.
struct TimedScan {
  TimeSpan times;
  double stamp_s = 0;
};

constexpr double kMaxFromStamp_s = 1;  // maximum length of a sweep

/// The meaning of point times, from two scans: offsets from the stamp, or times near it in its
/// clock, in the unit in which a sweep takes 5 ms to a second. Errors: data if they are neither.
PointTimes meaning_by_stamps(const TimedScan& first, const TimedScan& last, double offset_s,
                             const fs::path& recording) {
  constexpr double kShortest_s = 0.005, kLongest_s = 1;
  const double length =
      std::max(first.times.last - first.times.first, last.times.last - last.times.first);
  PointTimes times;
  if (!(length > 0)) return times;  // no times, or one per scan, which adds nothing to the stamp
  for (const double unit_s : {1.0, 1e-3, 1e-6, 1e-9}) {
    if (unit_s * length < kShortest_s || unit_s * length > kLongest_s) continue;
    times.unit_s = unit_s;
    const auto near_to = [&](const auto& target_of) {
      return std::ranges::all_of(std::array{first, last}, [&](const TimedScan& scan) {
        return std::fabs(unit_s * scan.times.first - target_of(scan)) <= kMaxFromStamp_s &&
               std::fabs(unit_s * scan.times.last - target_of(scan)) <= kMaxFromStamp_s;
      });
    };
    if (near_to([](const TimedScan&) { return 0.0; })) {
      times.kind = PointTimes::Kind::offsets;
      return times;
    }
    if (near_to([](const TimedScan& scan) { return scan.stamp_s; })) {
      times.kind = PointTimes::Kind::absolute;
      times.shift_s = offset_s;
      return times;
    }
  }
  std::array<char, 256> text{};
  std::snprintf(
      text.data(), text.size(),
      ": the times of its points (%.9g to %.9g in the cloud at %.3f s) are neither offsets within "
      "a sweep (5 ms to 1 s) nor near the time of the cloud, in s, ms, us or ns",
      first.times.first, first.times.last, first.stamp_s);
  throw Error(ErrorKind::data, recording.string() + text.data());
}

/// The scans with points.
struct RecordedDrive {
  SensorFrames frames;
  std::vector<double> stamps_s;  ///< in the recording's clock
};

/// Whether two messages are the same but for their first four bytes, the number of a message of
/// ROS 1.
bool are_copies(const Recording& recording, const CloudMessage& one, const CloudMessage& other) {
  constexpr std::size_t kNumberBytes = 4;
  return recording.message(one.place).substr(kNumberBytes) ==
         recording.message(other.place).substr(kNumberBytes);
}

Error same_time(const RecordingSurvey& survey, const TopicSurvey& topic, const CloudMessage& one,
                const CloudMessage& other) {
  return {ErrorKind::data,
          survey.recording->path().string() + ": clouds " + std::to_string(one.number) + " and " +
              std::to_string(other.number) + " (from 1) of " + topic.topic.name +
              " have the same time in their headers, " + std::to_string(one.stamp_s) +
              " s, but different points; expected distinct times (record each sensor or return in "
              "a topic of its own)"};
}

RecordedDrive scans_of(const RecordingSurvey& survey, const TopicSurvey& topic,
                       ProgressSink& progress) {
  const Recording& recording = *survey.recording;
  const fs::path& path = recording.path();
  RecordedDrive scans;
  std::map<fs::path, MessagePosition> places;
  const CloudMessage* last = nullptr;
  std::size_t empty = 0, copies = 0;
  for (std::size_t k = 0; k < topic.clouds.size(); ++k) {
    const CloudMessage& cloud = topic.clouds[k];
    if (cloud.points == 0) ++empty;
    if (cloud.points == 0) continue;
    if (last != nullptr && cloud.stamp_ns == last->stamp_ns) {
      if (!are_copies(recording, *last, cloud)) throw same_time(survey, topic, *last, cloud);
      ++copies;
      continue;
    }
    last = &cloud;
    const fs::path name = scan_name(path, k);
    places.emplace(name, cloud.place);
    scans.frames.files.push_back(name);
    scans.stamps_s.push_back(cloud.stamp_s);
  }
  if (scans.stamps_s.empty())
    throw Error(ErrorKind::data,
                path.string() + ": the clouds of " + topic.topic.name + " have no points");
  const auto warn = [&](std::size_t count, const std::string& what) {
    if (count > 0)
      progress.warn(path.string() + ": " + std::to_string(count) + " clouds of " +
                    topic.topic.name + " " + what + " and are skipped");
  };
  warn(empty, "have no points");
  warn(copies, "are copies of the cloud before");
  scans.frames.source =
      std::make_shared<RecordedScans>(survey.recording, topic.topic.encoding, std::move(places));
  return scans;
}

/// Drops the scans that the track does not cover. `within_s`: time span of a scan's points,
/// relative to its stamp.
void drop_uncovered_scans(RecordedDrive& scans, const Track& track, TimeSpan within_s,
                          const fs::path& path, ProgressSink& progress) {
  std::vector<TimeSpan> spans_s;
  for (const double stamp_s : scans.stamps_s)
    spans_s.push_back({stamp_s + within_s.first, stamp_s + within_s.last});
  std::size_t kept = 0;
  for (const std::size_t k : covered_scans(spans_s, track, path, "clouds", progress)) {
    scans.stamps_s[kept] = scans.stamps_s[k];
    scans.frames.files[kept++] = scans.frames.files[k];
  }
  scans.stamps_s.resize(kept);
  scans.frames.files.resize(kept);
}

/// Sets the meaning of point times; returns the time span of a scan's points, relative to its
/// stamp.
TimeSpan understand_times(RecordedDrive& scans, double offset_s, const fs::path& path) {
  const auto look_at = [&](std::size_t k) {
    return TimedScan{scans.frames.source->read(scans.frames.files[k]).time_span(),
                     scans.stamps_s[k]};
  };
  const TimedScan first = look_at(0), last = look_at(scans.stamps_s.size() - 1);
  PointTimes& times = scans.frames.times;
  times = meaning_by_stamps(first, last, offset_s, path);
  if (times.kind == PointTimes::Kind::none) return {0, 0};
  const auto from_stamp = [&](const TimedScan& scan, double time) {
    const bool is_absolute = times.kind == PointTimes::Kind::absolute;
    return times.unit_s * time - (is_absolute ? scan.stamp_s : 0);
  };
  return {std::min(from_stamp(first, first.times.first), from_stamp(last, last.times.first)),
          std::max(from_stamp(first, first.times.last), from_stamp(last, last.times.last))};
}

void require_options_of_recordings(const DriveInput& drive) {
  if (!drive.scan_times.empty())
    throw Error(ErrorKind::usage, drive.folder.string() +
                                      ": the clouds of a recording have times in their headers; "
                                      "`scan_times` applies to folders of files");
  if (drive.points_in == PointsIn::world)
    throw Error(ErrorKind::usage, drive.folder.string() +
                                      ": clouds of a recording are read in the sensor frame; "
                                      "`points_in` world applies to folders of files");
  if (!drive.trajectory.empty() && !drive.poses_topic.empty())
    throw Error(ErrorKind::usage,
                drive.folder.string() +
                    ": `trajectory` and `poses_topic` both give the poses; give only one of them");
}

}  // namespace

KittiSequence open_recording_drive(const DriveInput& given, const RecordingSurvey& survey,
                                   const Executor& executor, ProgressSink& progress) {
  DriveInput drive = given;
  require_options_of_recordings(drive);
  const TopicSurvey& topic = topic_of_clouds(survey, drive.topic);
  RecordedDrive scans = scans_of(survey, topic, progress);
  const RecordedPoses found = poses_of_clouds(drive, survey, topic, scans.stamps_s);
  const double offset_s = drive.time_offset_s.value_or(0);
  const TimeSpan within_s = understand_times(scans, offset_s, drive.folder);
  for (double& stamp_s : scans.stamps_s) stamp_s += offset_s;
  const Track track = track_of(found.poses);
  drop_uncovered_scans(scans, track, within_s, drive.folder, progress);
  SensorFrames& frames = scans.frames;
  frames.poses = {{}, track.poses, found.by, true};
  for (const double stamp_s : scans.stamps_s)
    frames.poses.of_scans.push_back({stamp_s, interpolate(track.poses, stamp_s)});
  if (frames.times.kind == PointTimes::Kind::absolute)
    frames.spans_s = spans_of_scans(frames, executor, progress);
  std::string because = found.because;
  if (drive.points_in == PointsIn::sensor) because = "as stated";
  if (because.empty()) {
    progress.begin_step("frame of the points", 0);
    const FrameVerdict verdict = find_frame(frames, executor);
    progress.end_step();
    because = verdict.because;
    if (verdict.points_in != PointsIn::sensor)
      throw Error(ErrorKind::data, drive.folder.string() + ": the points of " + topic.topic.name +
                                       " (" + words_of_frame(topic.frame) +
                                       (verdict.points_in == PointsIn::world
                                            ? ") are not in the sensor frame"
                                            : ") cannot be shown to be in the sensor frame") +
                                       " (" + because + "); give `points_in` if they are");
  }
  if (drive.trajectory.empty()) drive.trajectory = drive.folder;  // for messages about clocks
  KittiSequence sequence = open_sensor_frames(drive, frames, because, executor, progress);
  return sequence;
}

}  // namespace adasplats
