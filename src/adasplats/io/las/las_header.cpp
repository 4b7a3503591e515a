// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

constexpr std::size_t kMinHeaderBytes = 227;    // 1.0 to 1.2
constexpr std::size_t kMinHeaderBytes14 = 375;  // 1.4: 64-bit counts
// No coordinate on Earth, in any unit that surveys use, is larger.
constexpr double kLargestCoordinate = 1e12;

/// Fields of the header by their offset, which is within `bytes`.
class HeaderBytes {
 public:
  HeaderBytes(const InputFile& file, std::span<const std::byte> bytes)
      : file_(file), bytes_(bytes) {}

  template <class T>
  T at(std::size_t offset) const {
    return load_value<T>(&bytes_[offset]);
  }
  Vec3d vector_at(std::size_t offset) const {
    return {at<double>(offset), at<double>(offset + 8), at<double>(offset + 16)};
  }
  /// Text up to the first zero; characters other than printable ASCII become '?'.
  std::string text_at(std::size_t offset, std::size_t bytes) const {
    std::string text(reinterpret_cast<const char*>(bytes_.subspan(offset, bytes).data()), bytes);
    text.erase(std::min(text.find('\0'), text.size()));
    std::ranges::replace_if(
        text, [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
  }
  Error error(std::size_t offset, const std::string& message) const {
    return data_error({file_.path(), offset, {}}, message);
  }

 private:
  const InputFile& file_;
  std::span<const std::byte> bytes_;
};

void check_signature(InputFile& file) {
  const std::span<const std::byte> start =
      file.peek(static_cast<std::size_t>(std::min<std::uint64_t>(4, file.size_bytes())));
  const std::string_view signature(reinterpret_cast<const char*>(start.data()),
                                   std::min<std::size_t>(4, start.size()));
  if (signature != "LASF")
    throw file.error_here("found the signature " + shown(signature) + ", expected 'LASF'");
}

void check_layout(const InputFile& file, const HeaderBytes& bytes, const LasHeader& header) {
  if (header.points_offset_bytes < header.header_bytes ||
      header.points_offset_bytes > file.size_bytes()) {
    throw bytes.error(96, "found " + std::to_string(header.points_offset_bytes) +
                              " as the offset of the points, expected " +
                              std::to_string(header.header_bytes) + " (the header's end) to " +
                              std::to_string(file.size_bytes()) + " (the file's end)");
  }
  const std::uint64_t room = (header.points_offset_bytes - header.header_bytes) / kVlrHeaderBytes;
  if (header.vlr_count > room) {
    throw bytes.error(100, "found " + std::to_string(header.vlr_count) +
                               " as the number of variable length records, but at most " +
                               std::to_string(room) + " fit before the points");
  }
  if (header.format >= kLasFormatCount) {
    throw bytes.error(104, "found point format " + std::to_string(header.format) +
                               ", expected 0 to " + std::to_string(kLasFormatCount - 1));
  }
  if (header.record_bytes < las_format(header.format).min_bytes) {
    throw bytes.error(105, "found point records of " + std::to_string(header.record_bytes) +
                               " bytes, format " + std::to_string(header.format) +
                               " has at least " +
                               std::to_string(las_format(header.format).min_bytes));
  }
}

void check_transform(const HeaderBytes& bytes, const LasHeader& header) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t shift = 8 * static_cast<std::size_t>(axis);
    const double scale = header.scale[axis];
    const double offset = header.offset[axis];
    const std::string name(1, "xyz"[axis]);
    // 2^31 steps of the scale reach the largest coordinate. NaN fails the comparison too.
    if (!(scale > 0.0 && std::ldexp(scale, 31) <= kLargestCoordinate)) {
      throw bytes.error(131 + shift, "found the " + name + " scale " + std::to_string(scale) +
                                         ", expected a positive number below 400");
    }
    if (!(std::fabs(offset) <= kLargestCoordinate)) {
      throw bytes.error(155 + shift, "the " + name +
                                         " offset is not a number or above 1e12, more than any "
                                         "coordinate");
    }
  }
}

}  // namespace

LasHeader read_las_header(InputFile& file) {
  check_signature(file);
  const HeaderBytes first(file, file.peek(kMinHeaderBytes));
  const int major = first.at<std::uint8_t>(24);
  const int minor = first.at<std::uint8_t>(25);
  if (major != 1 || minor > 4) {
    throw first.error(24, "found LAS version " + std::to_string(major) + "." +
                              std::to_string(minor) + ", expected 1.0 to 1.4");
  }
  const std::size_t header_bytes = first.at<std::uint16_t>(94);
  const std::size_t min_bytes = minor == 4 ? kMinHeaderBytes14 : kMinHeaderBytes;
  if (header_bytes < min_bytes) {
    throw first.error(94, "found a header of " + std::to_string(header_bytes) +
                              " bytes, expected at least " + std::to_string(min_bytes));
  }
  const HeaderBytes bytes(file, file.peek(min_bytes));
  LasHeader header;
  header.minor_version = static_cast<unsigned>(minor);
  header.software = bytes.text_at(58, 32);
  header.header_bytes = header_bytes;
  // Reserved before 1.2, and zero there.
  const auto encoding = bytes.at<std::uint16_t>(6);
  header.has_adjusted_times = (encoding & 1U) != 0;
  header.has_wkt = (encoding & 1U << 4) != 0;
  header.vlr_count = bytes.at<std::uint32_t>(100);
  header.points_offset_bytes = bytes.at<std::uint32_t>(96);
  if (minor == 4) {
    header.evlrs_offset_bytes = bytes.at<std::uint64_t>(235);
    header.evlr_count = bytes.at<std::uint32_t>(243);
  }
  const std::uint8_t format = bytes.at<std::uint8_t>(104);
  // LASzip marks compressed files in the two upper bits of the format.
  header.is_compressed = (format & 0xc0) != 0;
  header.format = format & 0x3f;
  header.record_bytes = bytes.at<std::uint16_t>(105);
  header.points = bytes.at<std::uint32_t>(107);
  // The 64-bit count of LAS 1.4 has precedence; the old field is 0 if it cannot hold the count.
  if (minor == 4 && bytes.at<std::uint64_t>(247) != 0) header.points = bytes.at<std::uint64_t>(247);
  header.scale = bytes.vector_at(131);
  header.offset = bytes.vector_at(155);
  header.box_max = {bytes.at<double>(179), bytes.at<double>(195), bytes.at<double>(211)};
  header.box_min = {bytes.at<double>(187), bytes.at<double>(203), bytes.at<double>(219)};
  check_layout(file, bytes, header);
  check_transform(bytes, header);
  return header;
}

const LasFormat& las_format(std::size_t number) {
  static constexpr std::array<LasFormat, kLasFormatCount> kFormats = {{{20, false, 0, 0},
                                                                       {28, false, 20, 0},
                                                                       {26, false, 0, 20},
                                                                       {34, false, 20, 28},
                                                                       {57, false, 20, 0, true},
                                                                       {63, false, 20, 28, true},
                                                                       {30, true, 22, 0},
                                                                       {36, true, 22, 30},
                                                                       {38, true, 22, 30},
                                                                       {59, true, 22, 0, true},
                                                                       {67, true, 22, 30, true}}};
  return kFormats.at(number);
}

}  // namespace adasplats
