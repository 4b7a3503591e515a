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

}  // namespace adasplats
