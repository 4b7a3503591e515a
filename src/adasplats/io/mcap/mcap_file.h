// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/io/base/atomic_file.h"

namespace adasplats {

/// A topic and the type of its messages.
struct McapChannel {
  std::string topic;
  std::string message_encoding;  ///< of the registry: "cdr", "json", ...
  std::string schema_name;       ///< e.g. "sensor_msgs/msg/PointCloud2"
  std::string schema_encoding;   ///< e.g. "ros2msg"
  std::string schema;
};

/// A message with its checksum, most of the work, which can be computed in advance.
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint64_t time_ns = 0;  ///< nanoseconds since an epoch of the user's choice
  std::string bytes;
  std::uint32_t crc = 0;  ///< of `bytes`, as of zlib
};

/// Several threads may call it at once.
McapMessage mcap_message(std::uint16_t channel, std::uint64_t time_ns, std::string bytes);

/// Writes an MCAP file (Foxglove, "MCAP Format Specification", version 0), message by message:
/// chunks without compression, an index of every chunk and its messages, statistics, summary
/// offsets, and the checksums of chunks, data and summary. Atomic (see AtomicFile).
/// Memory: a chunk of 4 MiB or, if larger, one message; and 80 bytes a chunk.
class McapFile {
 public:
  /// `profile` is a word of the registry, e.g. "ros2". Errors: cannot_create, io.
  McapFile(const std::filesystem::path& path, std::string_view profile);

  /// Adds a record of metadata with one entry. Call before the first message. Errors: io.
  void add_metadata(std::string_view name, std::string_view key, std::string_view value);

  /// Returns the number of the channel for add_message(); at most 65535 channels.
  std::uint16_t add_channel(const McapChannel& channel);
  /// A message of mcap_message(). Errors: io.
  void add_message(const McapMessage& message);
  void add_message(std::uint16_t channel, std::uint64_t time_ns, std::string_view message) {
    add_message(mcap_message(channel, time_ns, std::string(message)));
  }
  /// Completes the file and makes it visible. Call once, last. Errors: io, cannot_create.
  void finish();

 private:
  struct Times {
    std::uint64_t first = ~std::uint64_t{0};
    std::uint64_t last = 0;
    void add(std::uint64_t time_ns);
    std::uint64_t begin() const { return first <= last ? first : 0; }
  };
  /// Time and offset in the chunk of each message of one channel.
  using MessageIndex = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  struct ChannelState {
    std::string schema_record, channel_record;
    std::uint32_t messages = 0;
    MessageIndex in_chunk;
  };

  void put(std::string_view bytes);
  void put_chunk();
  /// Returns the content of the chunk's index record.
  std::string put_message_indexes(std::uint64_t chunk_start, std::uint64_t chunk_length);
  std::string statistics() const;
  void put_summary();

  AtomicFile file_;
  std::uint64_t offset_ = 0;  ///< bytes written
  unsigned long crc_ = 0;     ///< of the bytes of this section, as of zlib
  std::string chunk_;         ///< the records of the open chunk
  unsigned long chunk_crc_ = 0;
  Times chunk_times_, times_;
  std::vector<ChannelState> channels_;
  std::vector<std::string> chunk_indexes_;
  std::vector<std::string> metadata_indexes_;  ///< their records
};

/// Our metadata record, and its entry with the label scheme of the classes.
inline constexpr std::string_view kMcapMetadataName = "adasplats", kMcapLabelsKey = "labels";

/// The value of a record of add_metadata() before the first message; empty without one, or if the
/// file is no MCAP. Errors: no_input, io.
std::string read_mcap_metadata(const std::filesystem::path& path, std::string_view name,
                               std::string_view key);

}  // namespace adasplats
