// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/packets/capture_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little,
              "detection of the byte order relies on it");

constexpr std::uint32_t kMicrosecondMagic = 0xA1B2C3D4, kNanosecondMagic = 0xA1B23C4D;
constexpr std::uint32_t kSectionBlock = 0x0A0D0D0A, kByteOrderMagic = 0x1A2B3C4D;
constexpr std::uint32_t kInterfaceBlock = 1, kSimplePacketBlock = 3, kEnhancedPacketBlock = 6;
constexpr std::size_t kClassicHeadBytes = 24, kRecordHeadOfCapture = 16, kBlockFrameBytes = 12;
constexpr std::uint32_t kMaxFrameBytes = 262'144;  // libpcap's limit
constexpr std::uint32_t kMaxBlockBytes = 16U << 20U;
constexpr std::size_t kMaxLinks = 4096;
constexpr std::uint64_t kMillion = 1'000'000, kBillion = 1'000'000'000;

std::uint32_t swapped(std::uint32_t value) {
  return value >> 24U | (value >> 8U & 0xFF00U) | (value << 8U & 0xFF0000U) | value << 24U;
}

std::uint64_t time_ns_of(std::uint64_t ticks, const CaptureLink& link) {
  const std::uint64_t seconds = ticks / link.ticks_per_s;
  const auto rest = static_cast<long double>(ticks % link.ticks_per_s);
  const auto part_ns = static_cast<std::uint64_t>(rest * static_cast<long double>(kBillion) /
                                                  static_cast<long double>(link.ticks_per_s));
  return (seconds + static_cast<std::uint64_t>(link.offset_s)) * kBillion + part_ns;
}

/// Ticks a second of the option if_tsresol, a negative power of 10 or of 2; 0: unsupported.
std::uint64_t ticks_of_resolution(std::uint8_t option) {
  const unsigned power = option & 0x7FU;
  if ((option & 0x80U) != 0) return power < 63 ? std::uint64_t{1} << power : 0;
  std::uint64_t ticks = 1;
  for (unsigned k = 0; k < power; ++k) ticks = power > 18 ? 0 : ticks * 10;
  return ticks;
}

}  // namespace

CaptureReader::CaptureReader(const std::filesystem::path& path) : file_(path) { read_head(); }

CaptureReader::CaptureReader(const std::filesystem::path& path, const CapturePosition& place)
    : file_(path), place_(place) {
  file_.skip(place.offset);
}

std::string_view CaptureReader::take(std::uint64_t bytes, const char* what) {
  if (file_.remaining() < bytes)
    throw file_.error_here(std::string(what) + " ends early: " + std::to_string(bytes) +
                           " bytes expected, " + std::to_string(file_.remaining()) +
                           " found; the capture was cut off (repair it with editcap)");
  const auto view = file_.peek(static_cast<std::size_t>(bytes));
  return {reinterpret_cast<const char*>(view.data()), static_cast<std::size_t>(bytes)};
}

template <class T>
T CaptureReader::number_at(std::string_view bytes, std::size_t place) const {
  if (place + sizeof(T) > bytes.size())
    throw file_.error_here("a block of " + std::to_string(bytes.size()) +
                           " bytes is too short for its type");
  char raw[sizeof(T)];
  std::memcpy(raw, bytes.data() + place, sizeof(T));
  if (place_.is_swapped) std::reverse(raw, raw + sizeof(T));
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

void CaptureReader::read_head() {
  const auto magic = number_at<std::uint32_t>(take(4, "the head of the capture"), 0);
  if (magic == kSectionBlock) {
    place_.is_next_generation = true;
    return;
  }
  place_.is_swapped = swapped(magic) == kMicrosecondMagic || swapped(magic) == kNanosecondMagic;
  const std::uint32_t in_order = place_.is_swapped ? swapped(magic) : magic;
  if (in_order != kMicrosecondMagic && in_order != kNanosecondMagic)
    throw file_.error_here("neither PCAP nor PCAPNG: found " + std::to_string(magic) +
                           " as the first number");
  const std::string_view head = take(kClassicHeadBytes, "the head of the capture");
  constexpr std::uint32_t kTypeBits = 0xFFFF;
  const std::uint32_t type = number_at<std::uint32_t>(head, 20) & kTypeBits;
  place_.links = std::make_shared<const std::vector<CaptureLink>>(
      1, CaptureLink{type, in_order == kNanosecondMagic ? kBillion : kMillion, 0});
  file_.skip(kClassicHeadBytes);
}

std::optional<CapturedFrame> CaptureReader::next() {
  place_.offset = file_.offset();
  if (!place_.is_next_generation) return next_classic();
  while (file_.remaining() > 0) {
    place_.offset = file_.offset();
    if (auto frame = next_block()) return frame;
  }
  return std::nullopt;
}

std::optional<CapturedFrame> CaptureReader::next_classic() {
  if (file_.remaining() == 0) return std::nullopt;
  const std::string_view head = take(kRecordHeadOfCapture, "a frame");
  const CaptureLink& link = place_.links->front();
  const auto seconds = number_at<std::uint32_t>(head, 0), part = number_at<std::uint32_t>(head, 4);
  const auto bytes = number_at<std::uint32_t>(head, 8), whole = number_at<std::uint32_t>(head, 12);
  if (bytes > kMaxFrameBytes)
    throw file_.error_here("a frame of " + std::to_string(bytes) + " bytes, expected at most " +
                           std::to_string(kMaxFrameBytes) + ": the capture is damaged");
  if (part >= link.ticks_per_s)
    throw file_.error_here("a frame whose fraction of a second is " + std::to_string(part) +
                           " of " + std::to_string(link.ticks_per_s) + ": the capture is damaged");
  const std::string_view record = take(kRecordHeadOfCapture + std::uint64_t{bytes}, "a frame");
  CapturedFrame frame;
  frame.time_ns = time_ns_of(std::uint64_t{seconds} * link.ticks_per_s + part, link);
  frame.link_type = link.type;
  frame.bytes = record.substr(kRecordHeadOfCapture);
  frame.is_cut = bytes < whole;
  frame.place = place_;
  file_.skip(record.size());
  return frame;
}

std::optional<CapturedFrame> CaptureReader::next_block() {
  std::string_view head = take(8, "a block");
  if (number_at<std::uint32_t>(head, 0) == kSectionBlock) {
    begin_section();
    head = take(8, "a block");
  }
  const auto type = number_at<std::uint32_t>(head, 0), bytes = number_at<std::uint32_t>(head, 4);
  if (bytes < kBlockFrameBytes || bytes % 4 != 0 || bytes > kMaxBlockBytes)
    throw file_.error_here("a block of " + std::to_string(bytes) +
                           " bytes, expected a multiple of 4 from 12 to " +
                           std::to_string(kMaxBlockBytes) + ": the capture is damaged");
  const std::string_view block = take(bytes, "a block");
  if (number_at<std::uint32_t>(block, bytes - 4) != bytes)
    throw file_.error_here("a block whose two lengths differ: the capture is damaged");
  const std::string_view body = block.substr(8, bytes - kBlockFrameBytes);
  std::optional<CapturedFrame> frame;
  if (type == kInterfaceBlock) add_link(body);
  if (type == kEnhancedPacketBlock) frame = enhanced_packet(body);
  if (type == kSimplePacketBlock) frame = simple_packet(body);
  file_.skip(bytes);
  return frame;
}

/// Sets the byte order and clears the interfaces.
void CaptureReader::begin_section() {
  place_.is_swapped = false;
  const auto order = number_at<std::uint32_t>(take(12, "the head of a section"), 8);
  place_.is_swapped = swapped(order) == kByteOrderMagic;
  if (!place_.is_swapped && order != kByteOrderMagic)
    throw file_.error_here("a section without a byte order: the capture is damaged");
  place_.links = std::make_shared<const std::vector<CaptureLink>>();
}

void CaptureReader::add_link(std::string_view body) {
  constexpr std::size_t kFixedBytes = 8;
  constexpr std::uint16_t kEndOfOptions = 0, kResolution = 9, kOffset = 14;
  CaptureLink link{number_at<std::uint16_t>(body, 0), kMillion, 0};
  for (std::size_t place = kFixedBytes; place + 4 <= body.size();) {
    const auto code = number_at<std::uint16_t>(body, place);
    const auto bytes = number_at<std::uint16_t>(body, place + 2);
    if (code == kEndOfOptions) break;
    if (code == kResolution && bytes >= 1)
      link.ticks_per_s = ticks_of_resolution(number_at<std::uint8_t>(body, place + 4));
    if (code == kOffset && bytes >= 8) link.offset_s = number_at<std::int64_t>(body, place + 4);
    place += 4 + (bytes + 3U) / 4U * 4U;
  }
  if (link.ticks_per_s == 0)
    throw file_.error_here("an interface with an unsupported resolution of times");
  if (place_.links->size() >= kMaxLinks)
    throw file_.error_here("more than " + std::to_string(kMaxLinks) + " interfaces");
  std::vector<CaptureLink> links = *place_.links;
  links.push_back(link);
  place_.links = std::make_shared<const std::vector<CaptureLink>>(std::move(links));
}

CapturedFrame CaptureReader::enhanced_packet(std::string_view body) const {
  constexpr std::size_t kFixedBytes = 20;
  const auto interface = number_at<std::uint32_t>(body, 0);
  if (interface >= place_.links->size())
    throw file_.error_here("a packet of interface " + std::to_string(interface) + " of " +
                           std::to_string(place_.links->size()));
  const std::uint64_t ticks =
      std::uint64_t{number_at<std::uint32_t>(body, 4)} << 32U | number_at<std::uint32_t>(body, 8);
  const auto bytes = number_at<std::uint32_t>(body, 12), whole = number_at<std::uint32_t>(body, 16);
  if (bytes > body.size() - kFixedBytes)
    throw file_.error_here("a packet of " + std::to_string(bytes) + " bytes in a block of " +
                           std::to_string(body.size()));
  const CaptureLink& link = (*place_.links)[interface];
  return {time_ns_of(ticks, link), link.type, body.substr(kFixedBytes, bytes), bytes < whole,
          place_};
}

CapturedFrame CaptureReader::simple_packet(std::string_view body) const {
  const auto whole = number_at<std::uint32_t>(body, 0);
  if (place_.links->empty()) throw file_.error_here("a packet without an interface");
  const std::size_t bytes = std::min<std::size_t>(whole, body.size() - 4);
  return {std::nullopt, place_.links->front().type, body.substr(4, bytes), bytes < whole, place_};
}

bool is_capture(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".pcap" || extension == ".pcapng";
}

}  // namespace adasplats
