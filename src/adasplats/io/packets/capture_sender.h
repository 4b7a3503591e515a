// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "adasplats/core/function_ref.h"
#include "adasplats/io/packets/datagram_reader.h"

namespace adasplats {

/// What to do while the buffer of a socket is full.
enum class WhenFull : std::uint8_t { wait, fail };

/// Sends UDP datagrams to a host.
class DatagramSender {
 public:
  /// `host`: a name or an IPv4 address. Errors: no_input (unknown host), io.
  explicit DatagramSender(std::string host);
  ~DatagramSender();
  DatagramSender(const DatagramSender&) = delete;
  DatagramSender& operator=(const DatagramSender&) = delete;

  /// Errors: io.
  void send(std::string_view bytes, std::uint16_t port, WhenFull full = WhenFull::wait);

 private:
  std::string host_;
  std::uint32_t address_ = 0;  ///< in network order
  int descriptor_ = -1;
};

/// Destination and speed of sending.
struct SendOptions {
  std::string host = "127.0.0.1";  ///< a name or an IPv4 address
  std::uint16_t port = 0;          ///< 0: the port of each datagram
  std::uint16_t only_port = 0;     ///< only datagrams to this port; 0: all
  double speed = 1;                ///< captured seconds per second; 0: as fast as possible
};

struct SendResult {
  std::uint64_t datagrams = 0, bytes = 0;
  double seconds = 0;
  double latest_s = 0;  ///< maximum delay of a datagram
  DatagramCounts counts;
};

/// Parses "HOST[:PORT]" into the options. Errors: usage.
void set_destination(const std::string& text, SendOptions& options);

/// Sends the UDP datagrams of a capture at their captured intervals. Calls `waited` between them,
/// at least ten times a second, with the number sent so far; it may throw to stop. Errors: those of
/// DatagramReader; no_input (unknown host); io (sending); data (no datagram).
SendResult send_capture(const std::filesystem::path& path, const SendOptions& options,
                        FunctionRef<void(std::uint64_t)> waited);

}  // namespace adasplats
