// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace adasplats::capture_test {

/// Numbers in either order, written after the descriptions of the formats.
template <class T>
std::string number_text_of(T value, bool big_endian) {
  std::string bytes;
  for (std::size_t k = 0; k < sizeof(T); ++k) {
    const std::size_t shift = 8 * (big_endian ? sizeof(T) - 1 - k : k);
    bytes += static_cast<char>(static_cast<std::uint64_t>(value) >> shift & 0xFFU);
  }
  return bytes;
}

/// A frame of Ethernet with a datagram from 10.0.0.1:5000 to 10.0.0.2:`port`, or a fragment of one;
/// `tags` of VLANs come first. Without checksums.
inline std::string ip_frame(std::string_view ip_payload, std::uint16_t name, std::uint16_t fragment,
                            int tags = 0) {
  const auto big = [](auto value) { return number_text_of(value, true); };
  std::string frame(12, '\1');
  for (int k = 0; k < tags; ++k)
    frame += big(std::uint16_t{0x8100}) + big(static_cast<std::uint16_t>(5 + k));
  frame += big(std::uint16_t{0x0800}) + "\x45" + std::string(1, '\0');
  frame += big(static_cast<std::uint16_t>(20 + ip_payload.size())) + big(name) + big(fragment);
  frame += std::string("\x40\x11") + std::string(2, '\0') + std::string("\x0a\0\0\1\x0a\0\0\2", 8);
  return frame.append(ip_payload);
}

inline std::string udp_text(std::uint16_t port, std::string_view payload) {
  const auto big = [](std::uint16_t value) { return number_text_of(value, true); };
  return big(5000) + big(port) + big(static_cast<std::uint16_t>(8 + payload.size())) + big(0) +
         std::string(payload);
}

struct FrameSample {
  std::uint64_t time_ns = 0;
  std::string bytes;
};

/// A classic capture.
inline std::string pcap_of(const std::vector<FrameSample>& frames, bool big_endian, bool nano,
                           std::uint32_t link = 1) {
  const auto u32 = [&](std::uint64_t value) {
    return number_text_of(static_cast<std::uint32_t>(value), big_endian);
  };
  const auto u16 = [&](std::uint16_t value) { return number_text_of(value, big_endian); };
  std::string file = u32(nano ? 0xA1B23C4D : 0xA1B2C3D4) + u16(2) + u16(4) + u32(0) + u32(0) +
                     u32(65535) + u32(link);
  for (const FrameSample& frame : frames) {
    const std::uint64_t part_ns = frame.time_ns % 1'000'000'000;
    file += u32(frame.time_ns / 1'000'000'000) + u32(nano ? part_ns : part_ns / 1000) +
            u32(frame.bytes.size()) + u32(frame.bytes.size()) + frame.bytes;
  }
  return file;
}

inline std::string ng_block(std::uint32_t type, std::string body, bool big_endian) {
  while (body.size() % 4 != 0) body += '\0';
  const std::string length =
      number_text_of(static_cast<std::uint32_t>(12 + body.size()), big_endian);
  return number_text_of(type, big_endian) + length + body + length;
}

/// A capture of the next generation: a block that is skipped, and two interfaces, the second of
/// which counts nanoseconds.
inline std::string pcapng_of(const std::vector<FrameSample>& frames, bool big_endian) {
  const auto u32 = [&](std::uint64_t value) {
    return number_text_of(static_cast<std::uint32_t>(value), big_endian);
  };
  const auto u16 = [&](std::uint16_t value) { return number_text_of(value, big_endian); };
  std::string file =
      ng_block(0x0A0D0D0A, u32(0x1A2B3C4D) + u16(1) + u16(0) + std::string(8, '\xFF'), big_endian);
  file += ng_block(1, u16(1) + u16(0) + u32(0), big_endian);
  file += ng_block(
      1,
      u16(1) + u16(0) + u32(0) + u16(9) + u16(1) + std::string("\x09\0\0\0", 4) + u16(0) + u16(0),
      big_endian);
  file += ng_block(0xBAD, "who knows what", big_endian);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::uint64_t ticks = frames[k].time_ns / (k % 2 == 0 ? 1000 : 1);
    file +=
        ng_block(6,
                 u32(k % 2) + u32(ticks >> 32U) + u32(ticks & 0xFFFFFFFFU) +
                     u32(frames[k].bytes.size()) + u32(frames[k].bytes.size()) + frames[k].bytes,
                 big_endian);
  }
  return file;
}

}  // namespace adasplats::capture_test
