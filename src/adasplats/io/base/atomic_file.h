// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "adasplats/io/base/byte_sink.h"

namespace adasplats {

/// An output file that appears complete or not at all: it is written to a temporary file in the
/// same folder, .adasplats-NAME-0.tmp, then flushed and renamed, and the folder is flushed. Without
/// commit() (e.g. after an exception) the temporary file is removed and an older file of that name
/// is unchanged. The temporary file is locked (flock), so the next writer of that name replaces one
/// that a killed program left; programs that write the same file at once use -1, -2 ... Small
/// writes are buffered. Follows symbolic links; rejects anything else that is not a regular file.
/// Errors: cannot_create (no such folder, no permission), io (disk full).
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
  std::filesystem::path temporary_;  ///< empty after the rename
  std::string buffer_;
  int descriptor_ = -1;
};

/// Writes a file through AtomicFile.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Writes a file directly under its own name, without flushing it: for folders that are renamed
/// when complete. Replaces an older file; an error or a kill can leave the file incomplete. Errors:
/// as AtomicFile.
void write_file_in_place(const std::filesystem::path& path, std::string_view content);

/// The content of a file. Errors: no_input (missing, a folder, not a regular file), io.
std::string read_file(const std::filesystem::path& path);

}  // namespace adasplats
