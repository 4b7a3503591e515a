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
  double stamp_s = 0;  ///< of its header
  std::uint64_t points = 0;
  MessagePlace place;
};

/// What one topic of a recording has.
struct TopicSurvey {
  RecordedTopic topic;
  std::uint64_t messages = 0;
  std::uint64_t first_ns = 0, last_ns = 0;  ///< when they were recorded
  std::vector<CloudMessage> clouds;         ///< of topics of points
  std::string frame;                        ///< of these
  std::string fault;                        ///< why its clouds cannot be used; empty: they can
  /// Of topics of poses, by parent and child; an empty child: not said.
  std::map<std::pair<std::string, std::string>, FrameEdge> edges;
  bool holds_clouds() const;
  bool is_transforms() const;
};

/// A recording that was read once: its topics by name, all poses, and where its clouds are.
struct RecordingSurvey {
  std::shared_ptr<const Recording> recording;
  std::map<std::string, TopicSurvey> topics;
};

/// Reads a recording from front to back. Memory: 112 bytes a pose and 56 a cloud. Errors: those of
/// Recording; data for messages of clouds and poses that are none.
RecordingSurvey survey_recording(const std::filesystem::path& path, ProgressSink& progress);

/// Opens the clouds of one topic of a recording as the scans of a drive, each in the frame of its
/// sensor. Poses at the times of their headers are, in this order: those of the stated trajectory;
/// of the stated topic of poses; of the transforms (tf) between the clouds' frame and the one that
/// has no parent; of the one topic of odometry or poses that there is, with fixed transforms from
/// its child frame to the clouds' (or the stated mount). Scans that poses do not cover are left out
/// and counted, more than half of them are an error; so are clouds without points. Times of points
/// are offsets from the header's time, or of its clock, in s, ms, us or ns: where neither, an
/// error. Errors: usage (topics that are not clear, options of folders), data (frames that nothing
/// joins, clocks that differ), those of survey_recording() and open_sensor_frames().
KittiSequence open_recording_drive(const FrameDrive& drive, const RecordingSurvey& survey,
                                   const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
