// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "adasplats/io/base/atomic_file.h"

namespace adasplats {

/// One end of a way through a network.
struct UdpEnd {
  std::array<std::uint8_t, 6> mac{};
  std::array<std::uint8_t, 4> address{};
  std::uint16_t port = 0;
};

/// Writes UDP datagrams as a capture that libpcap reads: classic PCAP (version 2.4, microseconds,
/// little-endian), Ethernet and IPv4 with checksums; a datagram of more than 1472 bytes is sent as
/// fragments, as a network with frames of 1500 bytes has it. Atomic (AtomicFile).
class CaptureWriter {
 public:
  /// Errors: cannot_create, io.
  explicit CaptureWriter(const std::filesystem::path& path);

  /// A datagram that was captured `time_us` after 1970. Errors: io; data (a time beyond 2106, more
  /// than 65507 bytes).
  void add(std::uint64_t time_us, const UdpEnd& from, const UdpEnd& to, std::string_view payload);
  /// Makes the file whole. Call once, last.
  void finish() { file_.commit(); }

 private:
  void add_frame(std::uint64_t time_us, const UdpEnd& from, const UdpEnd& to, std::string_view part,
                 std::size_t offset, bool more);

  std::filesystem::path path_;
  AtomicFile file_;
  std::uint16_t datagram_ = 0;  ///< names those whose fragments belong together
};

}  // namespace adasplats
