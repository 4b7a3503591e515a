// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "adasplats/io/packets/capture_reader.h"

namespace adasplats {

/// A UDP datagram over IPv4.
struct Datagram {
  std::uint64_t time_ns = 0;       ///< capture time of its last fragment, since 1970
  std::uint32_t from = 0, to = 0;  ///< addresses, the first number in the highest byte
  std::uint16_t from_port = 0, to_port = 0;
  std::string_view payload;  ///< valid until the next datagram
  CapturePosition place;     ///< of its first fragment
};

/// Counts of frames and datagrams.
struct DatagramCounts {
  std::uint64_t frames = 0, datagrams = 0;
  std::uint64_t others = 0;    ///< frames of other protocols
  std::uint64_t cut = 0;       ///< frames captured in part, or with wrong lengths
  std::uint64_t timeless = 0;  ///< frames without a time
  std::uint64_t torn = 0;      ///< datagrams with missing fragments
};

/// Reads the UDP datagrams of a capture: Ethernet (also with VLAN tags), Linux' cooked captures,
/// loopback and raw IP; joins fragments in any order. Checksums are not checked: they are often not
/// yet computed in frames captured at the sender. Memory: that of CaptureReader, and of 32
/// incomplete datagrams.
class DatagramReader {
 public:
  explicit DatagramReader(const std::filesystem::path& path) : capture_(path) {}
  DatagramReader(const std::filesystem::path& path, const CapturePosition& place)
      : capture_(path, place) {}

  /// The next datagram; nothing at the end. Errors: those of CaptureReader.
  std::optional<Datagram> next();
  /// Counts so far; `torn` is complete at the end.
  const DatagramCounts& counts() const { return counts_; }
  const std::filesystem::path& path() const { return capture_.path(); }

 private:
  /// Source, destination and the sender's identification.
  using PartsKey = std::tuple<std::uint32_t, std::uint32_t, std::uint16_t>;
  struct Parts {
    std::string bytes;
    std::vector<bool> is_there;  ///< of each 8 bytes
    std::size_t missing = 0;     ///< of is_there
    bool has_end = false;
    std::uint64_t began = 0;  ///< number of its first frame
    CapturePosition place;
  };
  struct Packet;  ///< of IPv4

  std::optional<Datagram> datagram_of(const CapturedFrame& frame);
  std::optional<Datagram> joined(const Packet& packet, const CapturedFrame& frame);
  void drop_oldest();

  CaptureReader capture_;
  DatagramCounts counts_;
  std::map<PartsKey, Parts> parts_;
  std::string whole_;  ///< the last joined datagram
};

/// "192.168.1.201".
std::string address_text(std::uint32_t address);

}  // namespace adasplats
