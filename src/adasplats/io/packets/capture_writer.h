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

/// Sender or receiver of a datagram.
struct UdpEndpoint {
  std::array<std::uint8_t, 6> mac{};
  std::array<std::uint8_t, 4> address{};
  std::uint16_t port = 0;
};

/// Writes UDP datagrams as a capture that libpcap reads: classic PCAP (version 2.4, microseconds,
/// little-endian), Ethernet and IPv4 with checksums; a datagram of more than 1472 bytes is split
/// into fragments, as in a network with frames of 1500 bytes. Atomic (AtomicFile).
class CaptureWriter {
 public:
  /// Errors: cannot_create, io.
  explicit CaptureWriter(const std::filesystem::path& path);

  /// Adds a datagram at `time_us` since 1970. Errors: io; data (a time beyond 2106, more than 65507
  /// bytes).
  void add(std::uint64_t time_us, const UdpEndpoint& from, const UdpEndpoint& to,
           std::string_view payload);
  /// Completes the file. Call once, last.
  void finish() { file_.commit(); }

 private:
  void add_frame(std::uint64_t time_us, const UdpEndpoint& from, const UdpEndpoint& to,
                 std::string_view part, std::size_t offset, bool more);

  std::filesystem::path path_;
  AtomicFile file_;
  std::uint16_t datagram_ = 0;  ///< identifies the fragments of a datagram
};

}  // namespace adasplats
