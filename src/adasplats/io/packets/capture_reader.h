// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "adasplats/io/base/input_file.h"

namespace adasplats {

/// A network interface of a capture.
struct CaptureLink {
  std::uint32_t type = 0;         ///< LINKTYPE_ of tcpdump.org
  std::uint64_t ticks_per_s = 0;  ///< of times
  std::int64_t offset_s = 0;      ///< added to times
};

/// A position in a capture, with all that is needed to continue reading there.
struct CapturePosition {
  std::uint64_t offset = 0;
  bool is_swapped = false, is_next_generation = false;
  std::shared_ptr<const std::vector<CaptureLink>> links;
};

/// A frame as it was captured.
struct CapturedFrame {
  std::optional<std::uint64_t> time_ns;  ///< since 1970; nothing if the capture has no time
  std::uint32_t link_type = 0;
  std::string_view bytes;  ///< valid until the next frame
  bool is_cut = false;     ///< only the beginning was captured
  CapturePosition place;   ///< where its record begins
};

/// Reads the frames of a capture from front to back: classic PCAP (micro- and nanoseconds, either
/// byte order) and PCAPNG (draft-ietf-opsawg-pcapng; sections, interfaces, enhanced and simple
/// packet blocks; others are skipped). Memory: one frame or block, 16 MiB at most.
class CaptureReader {
 public:
  /// Errors: no_input, data (neither of these formats).
  explicit CaptureReader(const std::filesystem::path& path);
  /// Starts at a frame found by another reader of the file.
  CaptureReader(const std::filesystem::path& path, const CapturePosition& place);

  /// The next frame; nothing at the end. Errors: data (damaged, truncated, compressed), io.
  std::optional<CapturedFrame> next();
  const std::filesystem::path& path() const { return file_.path(); }
  std::uint64_t size_bytes() const { return file_.size_bytes(); }

 private:
  void read_head();
  std::optional<CapturedFrame> next_classic();
  std::optional<CapturedFrame> next_block();
  void begin_section();
  void add_link(std::string_view body);
  CapturedFrame enhanced_packet(std::string_view body) const;
  CapturedFrame simple_packet(std::string_view body) const;
  std::string_view take(std::uint64_t bytes, const char* what);
  template <class T>
  T number_at(std::string_view bytes, std::size_t place) const;

  InputFile file_;
  CapturePosition place_;  ///< of the next record
};

/// Whether a path is a capture by its name: .pcap, .pcapng.
bool is_capture(const std::filesystem::path& path);

}  // namespace adasplats
