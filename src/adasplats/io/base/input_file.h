// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/error.h"

namespace adasplats {

/// A file open for reading, with its size at that time.
class InputDescriptor {
 public:
  /// Opens a regular file; rejects a FIFO or a device without blocking on it.
  /// Errors: ErrorKind::no_input.
  explicit InputDescriptor(std::filesystem::path path);
  ~InputDescriptor();
  InputDescriptor(const InputDescriptor&) = delete;
  InputDescriptor& operator=(const InputDescriptor&) = delete;

  int get() const { return descriptor_; }
  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size_bytes() const { return size_bytes_; }
  /// Fills `to` with the bytes from `offset` on. Errors: io (also a file that became shorter).
  void read_at(std::uint64_t offset, std::span<std::byte> to) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_bytes_ = 0;
};

/// Reads a file sequentially through a small buffer. Every access is checked against the size of
/// the file; a file that shrinks while it is read is an error, never a crash.
class InputFile {
 public:
  /// Errors: no_input (missing, a folder, a FIFO), data (empty).
  explicit InputFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return file_.path(); }
  std::uint64_t size_bytes() const { return file_.size_bytes(); }
  std::uint64_t offset() const { return offset_; }  ///< of the next byte
  std::uint64_t remaining() const { return size_bytes() - offset_; }

  /// The buffered bytes from offset() on, at least `bytes` of them, else a data error. The view is
  /// valid until the next call that reads or skips.
  std::span<const std::byte> peek(std::size_t bytes) {
    if (end_ - begin_ < bytes) fill(bytes);
    return {buffer_.data() + begin_, end_ - begin_};
  }
  /// Skips `bytes`; a data error if the file has fewer.
  void skip(std::uint64_t bytes);

  /// A data error at offset().
  Error error_here(const std::string& message) const;

 private:
  void fill(std::size_t bytes);
  void require(std::uint64_t bytes) const;

  InputDescriptor file_;
  std::vector<std::byte> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t offset_ = 0;
};

}  // namespace adasplats
