// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/packets/capture_writer.h"

#include <span>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/io/packets/network_bytes.h"

namespace adasplats {
namespace {

constexpr std::uint32_t kPcapMicroseconds = 0xA1B2C3D4, kSnapLength = 65535, kLinkEthernet = 1;
constexpr std::size_t kMaxIpPayload = 1480;  // of frames of 1500 bytes; a multiple of 8
constexpr std::size_t kMaxUdpPayload = 65507;
constexpr std::uint64_t kMicrosecondsInSecond = 1'000'000;

std::string bytes_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint16_t inverted(std::uint32_t sum) { return static_cast<std::uint16_t>(~sum); }

/// UDP header and payload.
std::string udp_datagram(const UdpEndpoint& from, const UdpEndpoint& to, std::string_view payload) {
  const auto length = static_cast<std::uint16_t>(kUdpBytes + payload.size());
  std::string pseudo = bytes_of(from.address) + bytes_of(to.address);
  append_big_endian(pseudo, std::uint16_t{kProtocolUdp});
  append_big_endian(pseudo, length);
  std::string head;
  append_big_endian(head, from.port);
  append_big_endian(head, to.port);
  append_big_endian(head, length);
  const std::uint16_t sum =
      inverted(add_to_checksum(payload, add_to_checksum(head, add_to_checksum(pseudo, 0))));
  append_big_endian(head, sum == 0 ? std::uint16_t{0xFFFF} : sum);  // 0 means no checksum
  return head.append(payload);
}

std::string ipv4_head(const UdpEndpoint& from, const UdpEndpoint& to, std::size_t bytes,
                      std::uint16_t datagram, std::uint16_t fragment) {
  constexpr std::uint8_t kVersionAndLength = 0x45, kTimeToLive = 64;
  std::string head;
  head += static_cast<char>(kVersionAndLength);
  head += '\0';
  append_big_endian(head, static_cast<std::uint16_t>(kIpv4Bytes + bytes));
  append_big_endian(head, datagram);
  append_big_endian(head, fragment);
  head += static_cast<char>(kTimeToLive);
  head += static_cast<char>(kProtocolUdp);
  const std::string ends = bytes_of(from.address) + bytes_of(to.address);
  append_big_endian(head, inverted(add_to_checksum(ends, add_to_checksum(head, 0))));
  return head + ends;
}

}  // namespace

CaptureWriter::CaptureWriter(const std::filesystem::path& path) : path_(path), file_(path) {
  std::string head;
  append_little_endian(head, kPcapMicroseconds);
  append_little_endian(head, std::uint16_t{2});
  append_little_endian(head, std::uint16_t{4});
  append_little_endian(head, std::uint64_t{0});  // time zone, accuracy
  append_little_endian(head, kSnapLength);
  append_little_endian(head, kLinkEthernet);
  file_.write(head);
}

void CaptureWriter::add(std::uint64_t time_us, const UdpEndpoint& from, const UdpEndpoint& to,
                        std::string_view payload) {
  if (payload.size() > kMaxUdpPayload)
    throw Error(ErrorKind::data, path_.string() + ": a datagram of " +
                                     std::to_string(payload.size()) + " bytes, expected at most " +
                                     std::to_string(kMaxUdpPayload));
  if (time_us / kMicrosecondsInSecond > UINT32_MAX)
    throw Error(ErrorKind::data, path_.string() + ": a time of " +
                                     std::to_string(time_us / kMicrosecondsInSecond) +
                                     " s since 1970 is beyond the range of PCAP (2106)");
  const std::string datagram = udp_datagram(from, to, payload);
  ++datagram_;
  for (std::size_t offset = 0; offset < datagram.size(); offset += kMaxIpPayload) {
    const std::string_view part = std::string_view(datagram).substr(offset, kMaxIpPayload);
    add_frame(time_us, from, to, part, offset, offset + part.size() < datagram.size());
  }
}

void CaptureWriter::add_frame(std::uint64_t time_us, const UdpEndpoint& from, const UdpEndpoint& to,
                              std::string_view part, std::size_t offset, bool more) {
  const auto fragment =
      static_cast<std::uint16_t>(offset / kFragmentUnit | (more ? kMoreFragments : 0U));
  const auto bytes = static_cast<std::uint32_t>(kEthernetBytes + kIpv4Bytes + part.size());
  std::string frame;
  append_little_endian(frame, static_cast<std::uint32_t>(time_us / kMicrosecondsInSecond));
  append_little_endian(frame, static_cast<std::uint32_t>(time_us % kMicrosecondsInSecond));
  append_little_endian(frame, bytes);
  append_little_endian(frame, bytes);
  frame += bytes_of(to.mac) + bytes_of(from.mac);
  append_big_endian(frame, kEtherIpv4);
  frame += ipv4_head(from, to, part.size(), datagram_, fragment);
  file_.write(frame.append(part));
}

}  // namespace adasplats
