// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "adasplats/core/function_ref.h"
#include "adasplats/io/packets/datagram_reader.h"

namespace adasplats {

/// Where the datagrams of a capture are sent, and how fast.
struct SendOptions {
  std::string host = "127.0.0.1";  ///< a name or an IPv4 address
  std::uint16_t port = 0;          ///< 0: that of each datagram
  std::uint16_t only_port = 0;     ///< of all, those that went to that port; 0: all
  double speed = 1;                ///< captured seconds a second; 0: as fast as they can be read
};

struct SendResult {
  std::uint64_t datagrams = 0, bytes = 0;
  double seconds = 0;
  double latest_s = 0;  ///< most that a datagram was sent after its time
  DatagramCounts counts;
};

/// "HOST[:PORT]" put into the options. Errors: usage.
void set_destination(const std::string& text, SendOptions& options);

/// Sends the UDP datagrams of a capture again, as far apart as they were captured. `waited` is
/// called between them at least ten times a second, with how many were sent, and may throw to end
/// it. Errors: those of DatagramReader; no_input (a host that is not known); io (sending); data (no
/// datagram).
SendResult send_capture(const std::filesystem::path& path, const SendOptions& options,
                        FunctionRef<void(std::uint64_t)> waited);

}  // namespace adasplats
