// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace adasplats {

/// An output file that appears whole or not at all: written beside its place under a temporary
/// name, then fsync, rename, fsync of the folder. Without commit() (an exception, say) the
/// temporary is removed and an older file of that name stays as it was. Small writes are buffered.
/// A symbolic link is followed; anything else that is not a regular file is refused.
/// Errors: ErrorKind::cannot_create (no such folder, no permission), ErrorKind::io (disk full).
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Makes the file durable and visible under its name. Call once, last.
  void commit();

 private:
  void write_through(const char* data, std::size_t bytes);

  std::filesystem::path path_;
  std::filesystem::path temporary_;  ///< empty once it is renamed
  std::string buffer_;
  int descriptor_ = -1;
};

/// Writes a whole file at once.
void write_file(const std::filesystem::path& path, std::string_view content);

/// A whole file's bytes. Errors: no_input (missing, a folder, not a regular file), io.
std::string read_file(const std::filesystem::path& path);

}  // namespace adasplats
