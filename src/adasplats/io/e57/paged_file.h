// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/input_file.h"

namespace adasplats {

/// An E57 file without its checksums (ASTM E2807-11, section 6, "binary file layout"): it consists
/// of pages with a CRC-32C in their last four bytes. Logical offsets exclude the checksums,
/// physical offsets are those of the file. Every page that is read is checked.
class PagedFile {
 public:
  /// Reads the header. Errors: no_input; data (not E57, another version, truncated).
  explicit PagedFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return file_.path(); }
  std::uint64_t size_bytes() const { return pages_ * payload_bytes(); }  ///< logical
  std::uint64_t xml_offset() const { return xml_offset_; }               ///< logical
  std::uint64_t xml_bytes() const { return xml_bytes_; }

  /// The logical offset of a physical one; `what` is for messages. Errors: data (beyond the end of
  /// the file, or in a checksum).
  std::uint64_t logical_offset(std::uint64_t physical, std::string_view what) const;

  /// Fills `to` with the logical bytes from `offset` on. Errors: data (beyond the end of the file,
  /// a page with a wrong checksum), io.
  void read(std::uint64_t offset, std::span<std::byte> to);

  /// A data error at a logical offset.
  Error error_at(std::uint64_t offset, const std::string& message) const;

 private:
  std::uint64_t payload_bytes() const { return page_bytes_ - 4; }
  void read_header();
  const std::byte* checked_page(std::uint64_t page, std::uint64_t wanted_pages);
  void check_page(std::uint64_t page, std::span<const std::byte> bytes) const;

  InputDescriptor file_;
  std::uint64_t page_bytes_ = 0;
  std::uint64_t pages_ = 0;
  std::uint64_t xml_offset_ = 0;
  std::uint64_t xml_bytes_ = 0;
  std::vector<std::byte> buffer_;    ///< consecutive checked pages
  std::uint64_t buffered_from_ = 0;  ///< the first of them
};

/// CRC-32C (Castagnoli's polynomial, RFC 3720 appendix B.4), as in pages of E57.
std::uint32_t crc32c(std::span<const std::byte> bytes);

}  // namespace adasplats
