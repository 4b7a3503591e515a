// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "adasplats/core/error.h"

struct sqlite3;

namespace adasplats {

/// Private to io/bags: an SQLite file, to be read, that is no more trusted than any other: what is
/// in its schema runs nothing, and no record is larger than the file. SQLite itself believes the
/// size that a page states of a record, up to 4 GiB: for a file of 1 kB, whose record says so, it
/// makes a list of 72 MB of the pages that such a record would have.
class SqliteDatabase {
 public:
  /// Errors: no_input, io, data.
  explicit SqliteDatabase(std::filesystem::path path);
  ~SqliteDatabase();
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  sqlite3* get() const { return database_.get(); }
  const std::filesystem::path& path() const { return path_; }
  /// What SQLite said last, as a data error.
  Error broken() const;

 private:
  struct PageCheck;

  std::filesystem::path path_;
  std::unique_ptr<PageCheck> check_;  // outlives the database, which calls it
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
};

}  // namespace adasplats
