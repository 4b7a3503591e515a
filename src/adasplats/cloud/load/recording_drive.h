// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/frame_tree.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/core/progress.h"
#include "adasplats/io/bags/recording.h"

namespace adasplats {

/// A message with points.
struct CloudMessage {
  double stamp_s = 0;         ///< of its header; distinct if `stamp_ns` is
  std::int64_t stamp_ns = 0;  ///< as it is
  std::uint64_t number = 0;   ///< among the messages of its topic, from 1
  std::uint64_t points = 0;
  MessagePosition place;
};

/// A message with packets of a sensor.
struct PacketMessage {
  std::uint64_t time_ns = 0;  ///< when it was recorded
  MessagePosition place;
};

/// The contents of one topic of a recording.
struct TopicSurvey {
  RecordedTopic topic;
  std::uint64_t messages = 0;
  std::uint64_t first_ns = 0, last_ns = 0;  ///< time of recording
  std::vector<CloudMessage> clouds;         ///< if the topic has points
  std::vector<PacketMessage> packets;       ///< if the topic has packets of a sensor
  std::string metadata;                     ///< of an Ouster, if the topic has them
  std::string frame;                        ///< of the clouds or packets
  std::string fault;                        ///< why its clouds cannot be used; empty: usable
  /// If the topic has poses, by parent and child; an empty child: not given.
  std::map<std::pair<std::string, std::string>, FrameEdge> edges;
  bool holds_clouds() const;
  bool is_transforms() const;
};

/// The index of a recording: its topics by name, all poses, and the positions of its clouds.
struct RecordingSurvey {
  std::shared_ptr<const Recording> recording;
  std::map<std::string, TopicSurvey> topics;
};

/// "frame 'lidar'", or "no frame (frame_id is empty)".
std::string words_of_frame(const std::string& frame);

/// Reads a recording from front to back. Memory: 120 bytes per pose, 72 per cloud and 40 per
/// message of packets. Errors: those of Recording; data for invalid messages of clouds and poses.
RecordingSurvey survey_recording(const std::filesystem::path& path, ProgressSink& progress);

/// Opens the clouds of one topic of a recording as the scans of a drive, each in the frame of its
/// sensor. The poses at the times of their headers come from the first of these: the given
/// trajectory; the given topic of poses; the transforms (tf) between the clouds' frame and its
/// root; the only topic of odometry or poses, with fixed transforms from its child frame to the
/// clouds' (or the given mount). Scans without poses, clouds without points and exact copies of the
/// cloud before are skipped with a warning; more than half of the scans without poses are an error.
/// Times of points are offsets from the header's time or in its clock, in s, ms, us or ns; else an
/// error. Errors: usage (ambiguous topics, options of folders), data (frames that no transforms
/// connect, different clocks, other clouds of the same time), those of survey_recording() and
/// open_sensor_frames().
KittiSequence open_recording_drive(const DriveInput& drive, const RecordingSurvey& survey,
                                   const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
