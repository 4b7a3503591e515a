// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "adasplats/cloud/load/recording_drive.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/io/packets/datagram_reader.h"

namespace adasplats {

/// Position of a packet in its file.
struct PacketPlace {
  CapturePosition capture;     ///< in a capture
  std::size_t message = 0;     ///< in a recording: number of the message in its topic
  std::size_t in_message = 0;  ///< number of the packet in its message
};

/// A UDP payload.
struct SensorPacket {
  std::uint64_t time_ns = 0;  ///< when it was captured, since 1970
  std::string_view source;  ///< "192.168.1.201:2368" (address of the sender, destination port), or
                            ///< a topic
  std::string_view bytes;   ///< while the visitor runs
  PacketPlace place;
};

/// A file with packets of sensors: a capture, or a recording.
class PacketFile {
 public:
  virtual ~PacketFile() = default;
  /// All packets; those of one source in their order. Errors: those of DatagramReader or Recording.
  virtual DatagramCounts for_each(FunctionRef<void(const SensorPacket&)> visit) const = 0;
  /// The packets of `source` from one found by for_each() on, until `visit` returns false. Several
  /// threads may call it at once. Errors: io (the file ends before).
  virtual void read_from(const std::string& source, const PacketPlace& place,
                         FunctionRef<bool(const SensorPacket&)> visit) const = 0;
};

std::shared_ptr<const PacketFile> packets_of_capture(const std::filesystem::path& path);
/// The packets in messages of drivers (ros_packets()). `survey` must outlive the file.
std::shared_ptr<const PacketFile> packets_of_recording(
    std::shared_ptr<const RecordingSurvey> survey);

}  // namespace adasplats
