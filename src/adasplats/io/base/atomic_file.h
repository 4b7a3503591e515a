// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "adasplats/io/base/byte_sink.h"

namespace adasplats {

/// An output file that appears whole or not at all: written beside its place under a temporary
/// name, then fsync, rename, fsync of the folder. Without commit() (an exception, say) the
/// temporary is removed and an older file of that name stays as it was. Small writes are buffered.
/// A symbolic link is followed; anything else that is not a regular file is refused.
/// Errors: ErrorKind::cannot_create (no such folder, no permission), ErrorKind::io (disk full).
class AtomicFile final : public ByteSink {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile() override;

  using ByteSink::write;
  void write(const void* data, std::size_t bytes) override;
  /// Makes the file durable and visible under its name. Call once, last.
  void commit();

 private:
  void write_through(const char* data, std::size_t bytes);

  std::filesystem::path path_;
  std::filesystem::path temporary_;  ///< empty once it is renamed
  std::string buffer_;
  int descriptor_ = -1;
};

/// Writes a whole file at once, as AtomicFile does.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Writes a whole file at once under its own name, without waiting for the disk: for folders that
/// get their name when they are whole. What was there is replaced; an error or a kill can leave the
/// file half written. Errors: as AtomicFile's.
void write_file_in_place(const std::filesystem::path& path, std::string_view content);

/// A whole file's bytes. Errors: no_input (missing, a folder, not a regular file), io.
std::string read_file(const std::filesystem::path& path);

}  // namespace adasplats
