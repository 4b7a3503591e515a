// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/packets/datagram_reader.h"

#include <algorithm>

#include "adasplats/io/packets/network_bytes.h"

namespace adasplats {
namespace {

constexpr std::size_t kMaxOpenDatagrams = 32;
constexpr std::size_t kMaxDatagramBytes = 65535;

/// The IPv4 packet of a frame; nothing for other protocols.
std::optional<std::string_view> ipv4_of(std::uint32_t link_type, std::string_view frame) {
  constexpr std::uint32_t kNull = 0, kEthernet = 1, kRaw = 101, kLoop = 108, kCooked = 113,
                          kIpv4 = 228, kCooked2 = 276;
  std::size_t place = 0;
  switch (link_type) {
    case kEthernet: place = 12; break;
    case kCooked: place = 14; break;
    case kNull:
    case kLoop: return frame.size() > 4 ? std::optional(frame.substr(4)) : std::nullopt;
    case kRaw:
    case kIpv4: return frame;
    case kCooked2:
      if (frame.size() < 20 || big_endian_at<std::uint16_t>(frame, 0) != kEtherIpv4)
        return std::nullopt;
      return frame.substr(20);
    default: return std::nullopt;
  }
  constexpr std::uint16_t kTags[] = {0x8100, 0x88A8, 0x9100};
  constexpr std::size_t kTagBytes = 4;
  while (frame.size() >= place + 2) {
    const auto type = big_endian_at<std::uint16_t>(frame, place);
    if (type == kEtherIpv4) return frame.substr(place + 2);
    if (std::ranges::find(kTags, type) == std::end(kTags)) return std::nullopt;
    place += kTagBytes;
  }
  return std::nullopt;
}

}  // namespace

struct DatagramReader::Packet {
  std::uint32_t from = 0, to = 0;
  std::uint16_t name = 0;
  std::size_t offset = 0;
  bool has_more = false;
  std::string_view payload;
};

std::optional<Datagram> DatagramReader::next() {
  while (const auto frame = capture_.next()) {
    ++counts_.frames;
    if (auto datagram = datagram_of(*frame)) {
      ++counts_.datagrams;
      return datagram;
    }
  }
  counts_.torn += parts_.size();
  parts_.clear();
  return std::nullopt;
}

std::optional<Datagram> DatagramReader::datagram_of(const CapturedFrame& frame) {
  const auto ip = ipv4_of(frame.link_type, frame.bytes);
  constexpr std::size_t kUnit = 4;
  const std::size_t head =
      ip && !ip->empty() ? kUnit * (static_cast<std::uint8_t>(ip->front()) & 0xFU) : 0;
  const bool is_udp = ip && ip->size() >= kIpv4Bytes &&
                      static_cast<std::uint8_t>(ip->front()) >> 4U == 4 && head >= kIpv4Bytes &&
                      static_cast<std::uint8_t>((*ip)[9]) == kProtocolUdp;
  if (!is_udp) {
    ++counts_.others;
    return std::nullopt;
  }
  if (!frame.time_ns) {
    ++counts_.timeless;
    return std::nullopt;
  }
  // 0 if segmentation is left to the network card of the sender.
  const std::size_t stated = big_endian_at<std::uint16_t>(*ip, 2);
  const std::size_t length = stated == 0 ? ip->size() : stated;
  if (frame.is_cut || length < head || ip->size() < length) {
    ++counts_.cut;
    return std::nullopt;
  }
  const auto fragment = big_endian_at<std::uint16_t>(*ip, 6);
  return joined({big_endian_at<std::uint32_t>(*ip, 12), big_endian_at<std::uint32_t>(*ip, 16),
                 big_endian_at<std::uint16_t>(*ip, 4), kFragmentUnit * (fragment & kFragmentOffset),
                 (fragment & kMoreFragments) != 0, ip->substr(head, length - head)},
                frame);
}

std::optional<Datagram> DatagramReader::joined(const Packet& packet, const CapturedFrame& frame) {
  std::string_view bytes = packet.payload;
  CapturePosition place = frame.place;
  if (packet.offset != 0 || packet.has_more) {
    const std::size_t end = packet.offset + bytes.size();
    if (end > kMaxDatagramBytes || (packet.has_more && bytes.size() % kFragmentUnit != 0)) {
      ++counts_.cut;
      return std::nullopt;
    }
    const PartsKey key{packet.from, packet.to, packet.name};
    Parts& parts = parts_[key];
    if (parts.began == 0) {
      parts.began = counts_.frames;
      parts.place = frame.place;
    }
    if (parts.bytes.size() < end) parts.bytes.resize(end);
    const std::size_t units = (parts.bytes.size() + kFragmentUnit - 1) / kFragmentUnit;
    parts.missing += units - parts.is_there.size();
    parts.is_there.resize(units, false);
    bytes.copy(parts.bytes.data() + packet.offset, bytes.size());
    for (std::size_t unit = packet.offset / kFragmentUnit;
         unit < (end + kFragmentUnit - 1) / kFragmentUnit; ++unit) {
      if (!parts.is_there[unit]) --parts.missing;
      parts.is_there[unit] = true;
    }
    parts.has_end = parts.has_end || !packet.has_more;
    if (parts.missing != 0 || !parts.has_end) {
      if (parts_.size() > kMaxOpenDatagrams) drop_oldest();
      return std::nullopt;
    }
    whole_ = std::move(parts.bytes);
    place = parts.place;
    parts_.erase(key);
    bytes = whole_;
  }
  if (bytes.size() < kUdpBytes || big_endian_at<std::uint16_t>(bytes, 4) < kUdpBytes ||
      big_endian_at<std::uint16_t>(bytes, 4) > bytes.size()) {
    ++counts_.cut;
    return std::nullopt;
  }
  const std::size_t length = big_endian_at<std::uint16_t>(bytes, 4);
  return Datagram{*frame.time_ns,
                  packet.from,
                  packet.to,
                  big_endian_at<std::uint16_t>(bytes, 0),
                  big_endian_at<std::uint16_t>(bytes, 2),
                  bytes.substr(kUdpBytes, length - kUdpBytes),
                  place};
}

void DatagramReader::drop_oldest() {
  const auto oldest =
      std::ranges::min_element(parts_, {}, [](const auto& entry) { return entry.second.began; });
  parts_.erase(oldest);
  ++counts_.torn;
}

std::string address_text(std::uint32_t address) {
  return std::to_string(address >> 24U) + "." + std::to_string(address >> 16U & 0xFFU) + "." +
         std::to_string(address >> 8U & 0xFFU) + "." + std::to_string(address & 0xFFU);
}

}  // namespace adasplats
