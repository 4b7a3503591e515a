// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "adasplats/core/error.h"

struct sqlite3;

namespace adasplats {

/// Private to io/bags: an untrusted SQLite file, open for reading. Its schema cannot run code, and
/// no record is larger than the file. SQLite itself trusts the size of a record, up to 4 GiB: for a
/// damaged file of 1 kB it may allocate a list of pages of 72 MB.
class SqliteDatabase {
 public:
  /// Errors: no_input, io, data.
  explicit SqliteDatabase(std::filesystem::path path);
  ~SqliteDatabase();
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  sqlite3* get() const { return database_.get(); }
  const std::filesystem::path& path() const { return path_; }
  /// The last error of SQLite, as a data error.
  Error damaged() const;

 private:
  struct PageCheck;

  std::filesystem::path path_;
  std::unique_ptr<PageCheck> check_;  // outlives the database, which calls it
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
};

}  // namespace adasplats
