// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/function_ref.h"

namespace adasplats {

/// How the messages of a topic are serialized.
enum class MessageEncoding : std::uint8_t { ros1, cdr, other };

/// A topic and the type of its messages.
struct RecordedTopic {
  std::string name;
  std::string type;  ///< in the form of ROS 1: "sensor_msgs/PointCloud2", without "msg/"
  MessageEncoding encoding = MessageEncoding::other;
};

/// Position of a message in a recording.
struct MessagePosition {
  static constexpr std::uint64_t kNoChunk = ~std::uint64_t{0};
  std::uint32_t file = 0;
  std::uint64_t chunk = kNoChunk;  ///< byte of the file where the chunk's record begins
  std::uint64_t offset = 0;        ///< in the decompressed chunk, else in the file; of db3 the row
  std::uint64_t size = 0;
};

struct RecordedMessage {
  const RecordedTopic& topic;
  std::uint64_t time_ns;  ///< when it was recorded
  MessagePosition place;
  std::string_view bytes;  ///< while the visitor runs
};

using MessageVisitor = FunctionRef<void(const RecordedMessage&)>;

/// One file of a recording.
class RecordingFile {
 public:
  virtual ~RecordingFile() = default;
  /// All messages in the order of the file. Errors: data (damaged, not closed), io, unavailable.
  virtual void for_each_message(MessageVisitor visit) const = 0;
  /// Reads one message. Several threads may call it at once. Errors: as above.
  virtual std::string message(const MessagePosition& place) const = 0;
};

/// A recording of messages by topic: MCAP (Foxglove's specification, version 0), ROS 1 bags (format
/// 2.0), and ROS 2 bags: a folder with metadata.yaml and MCAP or SQLite files, or one such file,
/// optionally compressed (packed_recording.h). Read sequentially; memory holds one chunk, and for
/// message() the last four (at most kMaxChunkBytes each).
class Recording {
 public:
  /// Errors: no_input, data (none of these formats; missing files of a folder).
  explicit Recording(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  void for_each_message(MessageVisitor visit) const;
  std::string message(const MessagePosition& place) const;

 private:
  std::filesystem::path path_;
  std::vector<std::unique_ptr<RecordingFile>> files_;
};

/// Whether a path is a recording by its name: .mcap, .bag, .db3, optionally followed by .zstd or
/// .zst, or a folder with the metadata.yaml of a ROS 2 bag.
bool is_recording(const std::filesystem::path& path);

/// ".mcap", ".bag", ".db3".
std::vector<std::string> recording_extensions();

/// "MCAP, ROS 1 bag, ROS 2 bag", for help.
std::string recording_format_names();

/// "sensor_msgs/PointCloud2" for "sensor_msgs/msg/PointCloud2".
std::string short_type_name(std::string_view type);

// One for each format (recording.cpp chooses).
std::unique_ptr<RecordingFile> open_mcap(const std::filesystem::path& path);
std::unique_ptr<RecordingFile> open_rosbag(const std::filesystem::path& path);
std::unique_ptr<RecordingFile> open_sqlite(const std::filesystem::path& path);

/// The parts of a ROS 2 bag by its metadata.yaml.
struct Ros2Bag {
  std::vector<std::filesystem::path> files;  ///< in order
  std::string message_packing;  ///< compression of single messages, "zstd"; empty: none
};
/// Errors: data (no list of files, a compression mode other than file or message).
Ros2Bag ros2_bag_in(const std::filesystem::path& folder);

}  // namespace adasplats
