// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Files of ROS 2 bags in SQLite, as rosbag2's storage plugin "sqlite3" lays them out (schema 1 to
// 4): topics(id, name, type, serialization_format), messages(id, topic_id, timestamp, data).

#include "adasplats/core/error.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/bags/unpack.h"

#ifdef ADASPLATS_HAVE_SQLITE3
#include <sqlite3.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "adasplats/io/base/input_file.h"
#endif

namespace adasplats {

#ifdef ADASPLATS_HAVE_SQLITE3
namespace {

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;

Error database_error(const std::filesystem::path& path, sqlite3* database) {
  return {ErrorKind::data, path.string() + ": as an SQLite database it is broken: " +
                               (database == nullptr ? "no memory" : sqlite3_errmsg(database))};
}

/// One query, row by row.
class Query {
 public:
  Query(const std::filesystem::path& path, sqlite3* database, const char* text)
      : path_(path), database_(database), statement_(nullptr, &sqlite3_finalize) {
    sqlite3_stmt* made = nullptr;
    if (sqlite3_prepare_v2(database, text, -1, &made, nullptr) != SQLITE_OK)
      throw database_error(path_, database_);
    statement_.reset(made);
  }
  void bind(std::int64_t value) { sqlite3_bind_int64(statement_.get(), 1, value); }
  /// Whether there is another row.
  bool next() {
    const int result = sqlite3_step(statement_.get());
    if (result != SQLITE_ROW && result != SQLITE_DONE) throw database_error(path_, database_);
    return result == SQLITE_ROW;
  }
  std::int64_t number(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  /// Text or bytes, until the next row.
  std::string_view bytes(int column) const {
    const void* const data = sqlite3_column_blob(statement_.get(), column);
    const int size = sqlite3_column_bytes(statement_.get(), column);
    if (data == nullptr) return {};
    return {static_cast<const char*>(data), static_cast<std::size_t>(size)};
  }

 private:
  const std::filesystem::path& path_;
  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
};

class SqliteRecording final : public RecordingFile {
 public:
  explicit SqliteRecording(const std::filesystem::path& path) : path_(path), database_(open(path)) {
    require_tables();
    Query topics(path_, database_.get(), "SELECT id, name, type, serialization_format FROM topics");
    while (topics.next()) {
      RecordedTopic topic{std::string(topics.bytes(1)), short_type_name(topics.bytes(2)),
                          topics.bytes(3) == "cdr" ? MessageEncoding::cdr : MessageEncoding::other};
      topics_.insert_or_assign(topics.number(0), std::move(topic));
    }
  }

  void for_each_message(MessageVisitor visit) const override {
    const std::lock_guard lock(mutex_);
    Query messages(path_, database_.get(),
                   "SELECT id, topic_id, timestamp, data FROM messages ORDER BY id");
    std::optional<std::int64_t> before;
    while (messages.next()) {
      // Broken pages give rows twice or out of order, and would give others when asked by number.
      if (before && messages.number(0) <= *before)
        throw Error(ErrorKind::data, path_.string() + ": as an SQLite database it is broken: row " +
                                         std::to_string(messages.number(0)) +
                                         " of messages behind " + std::to_string(*before));
      before = messages.number(0);
      const auto topic = topics_.find(messages.number(1));
      if (topic == topics_.end())
        throw Error(ErrorKind::data, path_.string() + ": message " +
                                         std::to_string(messages.number(0)) + " is of topic " +
                                         std::to_string(messages.number(1)) +
                                         ", which the table of topics lacks");
      const std::string_view bytes = messages.bytes(3);
      visit({topic->second,
             static_cast<std::uint64_t>(messages.number(2)),
             {0, MessagePlace::kNoChunk, static_cast<std::uint64_t>(messages.number(0)),
              bytes.size()},
             bytes});
    }
  }

  std::string message(const MessagePlace& place) const override {
    const std::lock_guard lock(mutex_);
    Query query(path_, database_.get(), "SELECT data FROM messages WHERE id = ?");
    query.bind(static_cast<std::int64_t>(place.offset));
    if (!query.next())
      throw Error(ErrorKind::io, path_.string() + ": message " + std::to_string(place.offset) +
                                     " is gone: the file changed while it was read");
    const std::string_view bytes = query.bytes(0);
    if (bytes.size() != place.size)
      throw Error(ErrorKind::data,
                  path_.string() + ": as an SQLite database it is broken: message " +
                      std::to_string(place.offset) + " has " + std::to_string(bytes.size()) +
                      " bytes, and had " + std::to_string(place.size));
    return std::string(bytes);
  }

 private:
  static Database open(const std::filesystem::path& path) {
    const InputFile file(path);  // what is missing, empty or no file is said as everywhere
    sqlite3* made = nullptr;
    const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_FULLMUTEX;
    const int result = sqlite3_open_v2(path.c_str(), &made, flags, nullptr);
    Database database(made, &sqlite3_close);
    if (result != SQLITE_OK) throw database_error(path, made);
    // The file is no more to be trusted than any other: what is in its schema runs nothing.
    sqlite3_db_config(made, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(made, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_limit(made, SQLITE_LIMIT_LENGTH,
                  static_cast<int>(std::min(kMostChunkBytes - 1, file.size_bytes())));
    return database;
  }

  /// Views could compute without end.
  void require_tables() const {
    Query tables(path_, database_.get(),
                 "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND sql NOT LIKE "
                 "'%VIRTUAL%' AND name IN ('topics', 'messages')");
    constexpr std::int64_t kTables = 2;
    if (!tables.next() || tables.number(0) != kTables)
      throw Error(ErrorKind::data,
                  path_.string() + ": has no tables 'topics' and 'messages', as ROS 2 bags do");
  }

  std::filesystem::path path_;
  Database database_;
  std::map<std::int64_t, RecordedTopic> topics_;
  mutable std::mutex mutex_;
};

}  // namespace

std::unique_ptr<RecordingFile> open_sqlite(const std::filesystem::path& path) {
  return std::make_unique<SqliteRecording>(path);
}

#else

std::unique_ptr<RecordingFile> open_sqlite(const std::filesystem::path& path) {
  throw Error(
      ErrorKind::unavailable,
      path.string() + ": is an SQLite file, which this program was built without (libsqlite3-dev)");
}

#endif

}  // namespace adasplats
