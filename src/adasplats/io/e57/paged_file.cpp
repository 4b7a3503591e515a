// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/paged_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <utility>

#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

constexpr std::string_view kE57Signature = "ASTM-E57";
constexpr std::size_t kE57HeaderBytes = 48;
constexpr std::size_t kE57ChecksumBytes = 4;
// The standard allows only 1024, stated in the header; other sizes are read, within limits.
constexpr std::uint64_t kMinPageBytes = 64;
constexpr std::uint64_t kMaxPageBytes = std::uint64_t{1} << 20;
constexpr std::uint64_t kE57BufferBytes = std::uint64_t{256} << 10;

std::string hexadecimal(std::uint32_t value) {
  std::array<char, 8> digits{};
  const auto end = std::to_chars(digits.begin(), digits.end(), value, 16).ptr;
  return "0x" + std::string(digits.begin(), end);
}

}  // namespace

PagedFile::PagedFile(std::filesystem::path path) : file_(std::move(path)) {
  if (file_.size_bytes() == 0) throw data_error({file_.path(), {}, {}}, "the file is empty");
  read_header();
}

void PagedFile::read_header() {
  std::array<std::byte, kE57HeaderBytes> header{};
  if (file_.size_bytes() < header.size())
    throw data_error({path(), file_.size_bytes(), {}}, "the file ends within its header");
  file_.read_at(0, header);
  if (std::memcmp(header.data(), kE57Signature.data(), kE57Signature.size()) != 0)
    throw data_error({path(), 0, {}}, "does not begin with 'ASTM-E57'");
  const auto major = load_value<std::uint32_t>(&header[8]);
  if (major != 1)
    throw data_error({path(), 8, {}}, "has version " + std::to_string(major) + "." +
                                          std::to_string(load_value<std::uint32_t>(&header[12])) +
                                          " of E57, expected version 1");
  page_bytes_ = load_value<std::uint64_t>(&header[40]);
  if (page_bytes_ < kMinPageBytes || page_bytes_ > kMaxPageBytes)
    throw data_error({path(), 40, {}}, "the header has pages of " + std::to_string(page_bytes_) +
                                           " bytes, expected 1024");
  pages_ = 1;
  if (file_.size_bytes() < page_bytes_)
    throw data_error({path(), file_.size_bytes(), {}}, "the file ends within its first page");
  checked_page(0, 1);
  const auto length = load_value<std::uint64_t>(&header[16]);
  if (length == 0 || length % page_bytes_ != 0)
    throw data_error({path(), 16, {}}, "the header states " + std::to_string(length) +
                                           " bytes, expected a multiple of the page size " +
                                           std::to_string(page_bytes_));
  if (length > file_.size_bytes())
    throw data_error({path(), file_.size_bytes(), {}},
                     "the file ends here, its header states " + std::to_string(length) + " bytes");
  pages_ = length / page_bytes_;
  xml_offset_ = logical_offset(load_value<std::uint64_t>(&header[24]), "the XML section");
  xml_bytes_ = load_value<std::uint64_t>(&header[32]);
  if (xml_bytes_ > size_bytes() - xml_offset_)
    throw data_error({path(), 32, {}}, "the header states " + std::to_string(xml_bytes_) +
                                           " bytes of XML, the file has room for " +
                                           std::to_string(size_bytes() - xml_offset_));
}

std::uint64_t PagedFile::logical_offset(std::uint64_t physical, std::string_view what) const {
  const std::uint64_t page = physical / page_bytes_;
  const std::uint64_t within = physical % page_bytes_;
  if (page >= pages_)
    throw data_error({path(), {}, {}}, std::string(what) + " begins at byte " +
                                           std::to_string(physical) + " of " +
                                           std::to_string(pages_ * page_bytes_));
  if (within >= payload_bytes())
    throw data_error({path(), physical, {}},
                     std::string(what) + " begins here, within the checksum of a page");
  return page * payload_bytes() + within;
}

void PagedFile::read(std::uint64_t offset, std::span<std::byte> to) {
  if (offset > size_bytes() || to.size() > size_bytes() - offset)
    throw data_error({path(), pages_ * page_bytes_, {}},
                     "the file ends here, more bytes were expected");
  while (!to.empty()) {
    const std::uint64_t page = offset / payload_bytes();
    const std::uint64_t within = offset % payload_bytes();
    const std::uint64_t wanted = (within + to.size() + payload_bytes() - 1) / payload_bytes();
    const std::byte* const bytes = checked_page(page, wanted);
    const std::size_t count = std::min<std::uint64_t>(to.size(), payload_bytes() - within);
    std::memcpy(to.data(), bytes + within, count);
    to = to.subspan(count);
    offset += count;
  }
}

Error PagedFile::error_at(std::uint64_t offset, const std::string& message) const {
  const std::uint64_t page = offset / payload_bytes();
  return data_error({path(), page * page_bytes_ + offset % payload_bytes(), {}}, message);
}

/// The bytes of a page. If it is not buffered, reads it and the wanted pages after it.
const std::byte* PagedFile::checked_page(std::uint64_t page, std::uint64_t wanted_pages) {
  if (page >= buffered_from_ && page - buffered_from_ < buffer_.size() / page_bytes_)
    return buffer_.data() + (page - buffered_from_) * page_bytes_;
  const std::uint64_t max_pages = std::max<std::uint64_t>(1, kE57BufferBytes / page_bytes_);
  const std::uint64_t count = std::min({wanted_pages, max_pages, pages_ - page});
  std::vector<std::byte> bytes = std::move(buffer_);
  buffer_.clear();  // stays empty if a page is damaged
  bytes.resize(count * page_bytes_);
  file_.read_at(page * page_bytes_, bytes);
  for (std::uint64_t k = 0; k < count; ++k)
    check_page(page + k, std::span(bytes).subspan(k * page_bytes_, page_bytes_));
  buffer_ = std::move(bytes);
  buffered_from_ = page;
  return buffer_.data();
}

void PagedFile::check_page(std::uint64_t page, std::span<const std::byte> bytes) const {
  // Unlike all other numbers of the file, the checksum is big-endian.
  const std::uint32_t stated =
      __builtin_bswap32(load_value<std::uint32_t>(&bytes[bytes.size() - kE57ChecksumBytes]));
  const std::uint32_t found = crc32c(bytes.first(bytes.size() - kE57ChecksumBytes));
  if (stated == found) return;
  throw data_error({path(), page * page_bytes_, {}},
                   "page " + std::to_string(page) + " (from 0) is damaged: its checksum is " +
                       hexadecimal(stated) + ", computed " + hexadecimal(found));
}

namespace {

constexpr std::uint32_t kCastagnoliReversed = 0x82f63b78;
constexpr std::size_t kCrcStep = 8;  // bytes at a time

/// kCrcTables[k][b]: the remainder of byte b followed by k zero bytes.
constexpr std::array<std::array<std::uint32_t, 256>, kCrcStep> make_crc_tables() {
  std::array<std::array<std::uint32_t, 256>, kCrcStep> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit)
      rest = (rest >> 1) ^ ((rest & 1) != 0 ? kCastagnoliReversed : 0);
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < kCrcStep; ++k)
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t rest = tables[k - 1][byte];
      tables[k][byte] = (rest >> 8) ^ tables[0][rest & 0xff];
    }
  return tables;
}

constexpr auto kCrcTables = make_crc_tables();

}  // namespace

std::uint32_t crc32c(std::span<const std::byte> bytes) {
  std::uint32_t rest = 0xffffffff;
  for (; bytes.size() >= kCrcStep; bytes = bytes.subspan(kCrcStep)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), kCrcStep);
    word ^= rest;
    rest = 0;
    for (std::size_t k = 0; k < kCrcStep; ++k)
      rest ^= kCrcTables[kCrcStep - 1 - k][(word >> (8 * k)) & 0xff];
  }
  for (const std::byte byte : bytes)
    rest = (rest >> 8) ^ kCrcTables[0][(rest ^ std::to_integer<std::uint32_t>(byte)) & 0xff];
  return ~rest;
}

}  // namespace adasplats
