// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#ifdef ADASPLATS_HAVE_SQLITE3

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "adasplats/io/bags/recording.h"
#include "adasplats/io/bags/recording_files_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/files_test.h"

namespace adasplats {
namespace {

void execute(sqlite3* database, const std::string& text) {
  char* problem = nullptr;
  ASSERT_EQ(sqlite3_exec(database, text.c_str(), nullptr, nullptr, &problem), SQLITE_OK)
      << text << ": " << problem;
}

/// Bytes in a message, of which some take hundreds of pages.
std::size_t message_bytes(int message) { return static_cast<std::size_t>(message) * 7919 % 60'000; }

constexpr int kMessages = 60;

/// A bag as SQLite itself writes it, with an index on the times as rosbag2 makes it; every third
/// message is deleted again, which leaves free pages.
void write_bag(const std::filesystem::path& path, const std::string& pragmas,
               const std::string& table_end = "") {
  sqlite3* made = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &made), SQLITE_OK);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> database(made, &sqlite3_close);
  execute(made, "PRAGMA synchronous = OFF; " + pragmas);
  execute(made,
          "BEGIN; CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT "
          "NULL, serialization_format TEXT NOT NULL); CREATE TABLE messages(id INTEGER PRIMARY "
          "KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)" +
              table_end +
              "; CREATE INDEX timestamp_idx ON messages (timestamp ASC); INSERT INTO topics "
              "VALUES(1, '/a', 'pkg/msg/One', 'cdr')");
  for (int k = 1; k <= kMessages; ++k)
    execute(made, "INSERT INTO messages VALUES(" + std::to_string(k) + ", 1, " + std::to_string(k) +
                      ", randomblob(" + std::to_string(message_bytes(k)) + "))");
  execute(made, "COMMIT; DELETE FROM messages WHERE id % 3 = 0");
}

/// Messages and their bytes, of which each is as long as it was written.
void read_bag(const std::filesystem::path& path) {
  const Recording recording(path);
  int messages = 0;
  recording.for_each_message([&](const RecordedMessage& message) {
    ++messages;
    EXPECT_EQ(message.bytes.size(), message_bytes(static_cast<int>(message.time_ns)));
  });
  EXPECT_EQ(messages, kMessages * 2 / 3);
}

// Oracle: what SQLite wrote. No good page may be taken for one with a record larger than the file.
TEST(SqliteDatabase, PagesOfEveryKindAreRead) {
  const TemporaryFolder folder;
  for (const char* size : {"512", "1024", "4096", "65536"})
    for (const char* more : {"auto_vacuum = NONE", "auto_vacuum = FULL",
                             "auto_vacuum = INCREMENTAL", "journal_mode = WAL"})
      for (const char* table_end : {"", " WITHOUT ROWID"}) {
        const std::string pragmas = std::string("PRAGMA page_size = ") + size + "; PRAGMA " + more;
        SCOPED_TRACE(pragmas + table_end);
        const std::filesystem::path path = folder.path() / "a.db3";
        write_bag(path, pragmas, table_end);
        read_bag(path);
        std::filesystem::remove(path);
      }
}

// rosbag2 without a serialization format means CDR.
TEST(SqliteDatabase, TopicsWithoutASerializationFormatAreCdr) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.db3";
  write_bag(path, "PRAGMA page_size = 4096");
  sqlite3* opened = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &opened), SQLITE_OK);
  {
    const std::unique_ptr<sqlite3, int (*)(sqlite3*)> database(opened, &sqlite3_close);
    execute(opened, "UPDATE topics SET serialization_format = ''");
  }
  int messages = 0;
  Recording(path).for_each_message([&](const RecordedMessage& message) {
    ++messages;
    EXPECT_EQ(message.topic.encoding, MessageEncoding::cdr);
  });
  EXPECT_GT(messages, 0);
}

/// Offset of the last page of a kind, given by its first byte, among those with messages.
std::size_t page_of_kind(const std::string& bytes, std::size_t page_bytes, char kind) {
  std::size_t found = bytes.size();
  for (std::size_t page = page_bytes; page < bytes.size(); page += page_bytes)
    if (bytes[page] == kind) found = page;
  return found;
}

/// Makes the first record of a page one of 4 GiB.
std::string with_large_record(std::string bytes, std::size_t page, std::size_t header,
                              std::size_t child_bytes) {
  const auto byte = [&](std::size_t at) {
    return std::size_t{static_cast<unsigned char>(bytes[at])};
  };
  const std::size_t pointer = page + header + 8 + child_bytes;
  const std::size_t cell = byte(pointer) << 8 | byte(pointer + 1);
  return bytes.replace(page + cell + child_bytes, 5, "\x8f\xff\xff\xff\x7f");
}

void expect_refused(const TemporaryFolder& folder, const std::string& bytes, std::size_t page) {
  const std::filesystem::path path = folder.write("b.db3", bytes);
  sqlite3_memory_highwater(1);
  const auto before = sqlite3_memory_used();
  expect_error(ErrorKind::data,
               {"b.db3: byte " + std::to_string(page) + ":", "a record of 4294967295",
                "in a file of " + std::to_string(bytes.size())},
               [&] { read_bag(path); });
  // The pages that it holds are a few MB at most.
  EXPECT_LT(sqlite3_memory_highwater(0) - before, 8'000'000);
}

// For such a record SQLite makes a list of 72 MB of the pages that it would have.
TEST(SqliteDatabase, RecordsBeyondTheFileAreRejectedBeforeTheyTakeMemory) {
  const TemporaryFolder folder;
  const std::string small = bags_test::small_db3();
  constexpr std::size_t kPage = 512, kFileHeader = 100;
  for (std::size_t page = 0; page < small.size(); page += kPage)
    expect_refused(folder, with_large_record(small, page, page == 0 ? kFileHeader : 0, 0), page);
  for (const auto& [kind, child_bytes] : {std::pair('\x02', 4), std::pair('\x0a', 0)}) {
    const std::filesystem::path path = folder.path() / "a.db3";
    std::filesystem::remove(path);
    write_bag(path, "PRAGMA page_size = 512", " WITHOUT ROWID");
    const std::string bytes = read_file(path);
    const std::size_t page = page_of_kind(bytes, kPage, kind);
    ASSERT_LT(page, bytes.size());
    expect_refused(folder, with_large_record(bytes, page, 0, static_cast<std::size_t>(child_bytes)),
                   page);
  }
}

// SQLite takes the pointer to a cell modulo the size of the page, and reads on behind the page.
TEST(SqliteDatabase, RecordsAtTheEndOfAPageAreRejected) {
  const TemporaryFolder folder;
  std::string bytes = bags_test::small_db3();
  constexpr std::size_t kTopics = 512, kPage = 512, kFirstPointer = 8;
  bytes.replace(kTopics + kFirstPointer, 2, "\x03\xfe");  // 510 and once the size of the page
  for (const auto& [size, said] : {std::pair("\xff\xff", "a record with a truncated size"),
                                   std::pair("\xff\x7f", "a record of 16383 bytes")}) {
    bytes.replace(kTopics + kPage - 2, 2, size);
    expect_error(ErrorKind::data, {"byte 512:", said},
                 [&] { read_bag(folder.write("a.db3", bytes)); });
  }
}

// What a fuzzer found: the record is of a size of 43 bits, of which SQLite takes 32.
TEST(SqliteDatabase, SizesOfMoreThan32BitsAreRejected) {
  const TemporaryFolder folder;
  std::string bytes = bags_test::small_db3();
  constexpr std::size_t kTopics = 512, kCell = 0x1d2;
  bytes.replace(kTopics + kCell, 6, std::string("\xfe\xff\xff\x9d\xdb\0", 6));
  expect_error(ErrorKind::data, {"byte 512:", "a record of 4363685162368 bytes"},
               [&] { read_bag(folder.write("a.db3", bytes)); });
}

}  // namespace
}  // namespace adasplats

#endif
