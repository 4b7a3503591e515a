// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#ifdef ADASPLATS_HAVE_SQLITE3

#include "adasplats/io/bags/sqlite_database.h"

#include <sqlite3.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "adasplats/io/bags/unpack.h"
#include "adasplats/io/base/input_file.h"

namespace adasplats {
namespace {

using PageBytes = std::span<const unsigned char>;

// "Database File Format", 1.6: the first byte of a page of a tree.
constexpr unsigned char kIndexInterior = 2, kIndexLeaf = 10, kTableLeaf = 13;
constexpr std::size_t kFileHeader = 100;  // on the first page, before that of the tree
constexpr std::uint64_t kCutOff = std::numeric_limits<std::uint64_t>::max();
constexpr std::size_t kMinPage = 512, kMaxPage = 65536;

std::size_t number_of_16_bits(PageBytes page, std::size_t at) {
  return std::size_t{page[at]} << 8 | page[at + 1];
}

/// The size of a record at the beginning of its cell: seven bits in each byte, the last one below
/// 128; kCutOff if the page ends first, where SQLite would read on.
std::uint64_t record_bytes(PageBytes cell) {
  constexpr std::size_t kMaxBytes = 9;
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < std::min(kMaxBytes, cell.size()); ++k) {
    value = value << 7 | (cell[k] & 0x7fU);
    if (cell[k] < 0x80 || k + 1 == kMaxBytes) return value;
  }
  return kCutOff;
}

/// The largest record of a page; 0 if the page is not of a tree, or has no records.
std::uint64_t largest_record(PageBytes page, std::size_t header) {
  const unsigned char kind = page[header];
  if (kind != kIndexInterior && kind != kIndexLeaf && kind != kTableLeaf) return 0;
  // Cells of inner pages begin with the number of the page below; so ends their header.
  const std::size_t child = kind == kIndexInterior ? 4 : 0;
  const std::size_t cells = number_of_16_bits(page, header + 3);
  const std::size_t pointers = header + 8 + child;
  std::uint64_t largest = 0;
  for (std::size_t k = 0; k < cells && pointers + 2 * k + 2 <= page.size(); ++k) {
    // A pointer beyond the page is taken modulo its size, as SQLite does.
    const std::size_t cell = number_of_16_bits(page, pointers + 2 * k) % page.size() + child;
    largest = std::max(largest, record_bytes(page.subspan(std::min(cell, page.size()))));
  }
  return largest;
}

}  // namespace

/// The methods of an open file; reading a page also checks its records.
struct SqliteDatabase::PageCheck : sqlite3_io_methods {
  const sqlite3_io_methods* own = nullptr;
  std::uint64_t file_bytes = 0;
  struct Fault {
    std::uint64_t page_offset = 0, record_bytes = 0;
  };
  mutable std::optional<Fault> fault;

  void watch(sqlite3_file& file);
  bool holds(PageBytes page, std::uint64_t offset) const;
  static int read(sqlite3_file* file, void* bytes, int count, sqlite3_int64 offset);
};

void SqliteDatabase::PageCheck::watch(sqlite3_file& file) {
  own = file.pMethods;
  static_cast<sqlite3_io_methods&>(*this) = *own;
  xRead = &PageCheck::read;
  if (iVersion >= 3)  // pages in memory must be read, too
    xFetch = [](sqlite3_file*, sqlite3_int64, int, void** page) {
      *page = nullptr;
      return SQLITE_OK;
    };
  file.pMethods = this;
}

bool SqliteDatabase::PageCheck::holds(PageBytes page, std::uint64_t offset) const {
  // Overflow pages begin with the number of the next page, i.e. with 0 or 1 if there are less than
  // 2^25 pages. In larger files the list of pages does not matter.
  constexpr std::uint64_t kMaxPages = 1ULL << 25;
  const bool is_page = std::has_single_bit(page.size()) && page.size() >= kMinPage &&
                       page.size() <= kMaxPage && offset % page.size() == 0;
  if (!is_page || file_bytes / page.size() >= kMaxPages) return true;
  const std::uint64_t largest = largest_record(page, offset == 0 ? kFileHeader : 0);
  if (largest <= file_bytes) return true;
  fault = Fault{offset, largest};
  return false;
}

int SqliteDatabase::PageCheck::read(sqlite3_file* file, void* bytes, int count,
                                    sqlite3_int64 offset) {
  const auto& check = *static_cast<const PageCheck*>(file->pMethods);
  const int result = check.own->xRead(file, bytes, count, offset);
  if (result != SQLITE_OK && result != SQLITE_IOERR_SHORT_READ) return result;
  const PageBytes page(static_cast<const unsigned char*>(bytes), static_cast<std::size_t>(count));
  return check.holds(page, static_cast<std::uint64_t>(offset)) ? result : SQLITE_CORRUPT;
}

SqliteDatabase::SqliteDatabase(std::filesystem::path path)
    : path_(std::move(path)),
      check_(std::make_unique<PageCheck>()),
      database_(nullptr, &sqlite3_close) {
  const InputFile file(path_);  // reports missing, empty and irregular files as usual
  sqlite3* made = nullptr;
  const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_FULLMUTEX;
  const int result = sqlite3_open_v2(path_.c_str(), &made, flags, nullptr);
  database_.reset(made);
  if (result != SQLITE_OK) throw damaged();
  sqlite3_db_config(made, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(made, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(made, SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::min(kMaxChunkBytes - 1, file.size_bytes())));
  check_->file_bytes = file.size_bytes();
  sqlite3_file* opened = nullptr;
  if (sqlite3_file_control(made, "main", SQLITE_FCNTL_FILE_POINTER, &opened) != SQLITE_OK ||
      opened == nullptr || opened->pMethods == nullptr)
    throw std::logic_error("SQLite does not give access to the file of a database");
  check_->watch(*opened);
}

SqliteDatabase::~SqliteDatabase() = default;

Error SqliteDatabase::damaged() const {
  const std::string what = "damaged SQLite database: ";
  if (!check_->fault)
    return data_error({path_, std::nullopt, std::nullopt},
                      what + (database_ ? sqlite3_errmsg(database_.get()) : "no memory"));
  const auto [offset, bytes] = *check_->fault;
  const std::string size =
      bytes == kCutOff ? "with a truncated size" : "of " + std::to_string(bytes) + " bytes";
  return data_error({path_, offset, std::nullopt}, what + "a record " + size +
                                                       " on this page, in a file of " +
                                                       std::to_string(check_->file_bytes));
}

}  // namespace adasplats

#endif
