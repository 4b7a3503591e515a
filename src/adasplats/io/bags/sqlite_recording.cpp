// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Files of ROS 2 bags in SQLite, as rosbag2's storage plugin "sqlite3" lays them out (schema 1 to
// 4): topics(id, name, type, serialization_format), messages(id, topic_id, timestamp, data).

#include "adasplats/core/error.h"
#include "adasplats/io/bags/recording.h"

#ifdef ADASPLATS_HAVE_SQLITE3
#include <sqlite3.h>

#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "adasplats/io/bags/sqlite_database.h"
#endif

namespace adasplats {

#ifdef ADASPLATS_HAVE_SQLITE3
namespace {

/// One query, row by row.
class Query {
 public:
  Query(const SqliteDatabase& database, const char* text)
      : database_(database), statement_(nullptr, &sqlite3_finalize) {
    sqlite3_stmt* made = nullptr;
    if (sqlite3_prepare_v2(database.get(), text, -1, &made, nullptr) != SQLITE_OK)
      throw database_.damaged();
    statement_.reset(made);
  }
  void bind(std::int64_t value) { sqlite3_bind_int64(statement_.get(), 1, value); }
  /// Whether there is another row.
  bool next() {
    const int result = sqlite3_step(statement_.get());
    if (result != SQLITE_ROW && result != SQLITE_DONE) throw database_.damaged();
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
  const SqliteDatabase& database_;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
};

class SqliteRecording final : public RecordingFile {
 public:
  explicit SqliteRecording(const std::filesystem::path& path) : database_(path) {
    require_tables();
    Query topics(database_, "SELECT id, name, type, serialization_format FROM topics");
    while (topics.next()) {
      const auto format = topics.bytes(3);  // some writers leave it empty; CDR is rosbag2's default
      RecordedTopic topic{
          std::string(topics.bytes(1)), short_type_name(topics.bytes(2)),
          format.empty() || format == "cdr" ? MessageEncoding::cdr : MessageEncoding::other};
      topics_.insert_or_assign(topics.number(0), std::move(topic));
    }
  }

  void for_each_message(MessageVisitor visit) const override {
    const std::lock_guard lock(mutex_);
    Query messages(database_, "SELECT id, topic_id, timestamp, data FROM messages ORDER BY id");
    std::optional<std::int64_t> before;
    while (messages.next()) {
      // Damaged pages give rows twice or out of order, and other rows by number.
      if (before && messages.number(0) <= *before)
        throw Error(ErrorKind::data, database_.path().string() + ": damaged SQLite database: row " +
                                         std::to_string(messages.number(0)) +
                                         " of messages after " + std::to_string(*before));
      before = messages.number(0);
      const auto topic = topics_.find(messages.number(1));
      if (topic == topics_.end())
        throw Error(ErrorKind::data, database_.path().string() + ": message " +
                                         std::to_string(messages.number(0)) + " is of topic " +
                                         std::to_string(messages.number(1)) +
                                         ", which the table of topics lacks");
      const std::string_view bytes = messages.bytes(3);
      visit({topic->second,
             static_cast<std::uint64_t>(messages.number(2)),
             {0, MessagePosition::kNoChunk, static_cast<std::uint64_t>(messages.number(0)),
              bytes.size()},
             bytes});
    }
  }

  std::string message(const MessagePosition& place) const override {
    const std::lock_guard lock(mutex_);
    Query query(database_, "SELECT data FROM messages WHERE id = ?");
    query.bind(static_cast<std::int64_t>(place.offset));
    if (!query.next())
      throw Error(ErrorKind::io, database_.path().string() + ": message " +
                                     std::to_string(place.offset) +
                                     " is gone: the file changed while it was read");
    const std::string_view bytes = query.bytes(0);
    if (bytes.size() != place.size)
      throw Error(ErrorKind::data,
                  database_.path().string() + ": damaged SQLite database: message " +
                      std::to_string(place.offset) + " has " + std::to_string(bytes.size()) +
                      " bytes instead of " + std::to_string(place.size));
    return std::string(bytes);
  }

 private:
  /// Rejects views, which could compute forever.
  void require_tables() const {
    Query tables(database_,
                 "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND sql NOT LIKE "
                 "'%VIRTUAL%' AND name IN ('topics', 'messages')");
    constexpr std::int64_t kTables = 2;
    if (!tables.next() || tables.number(0) != kTables)
      throw Error(ErrorKind::data, database_.path().string() +
                                       ": is not a ROS 2 bag: no tables 'topics' and 'messages'");
  }

  SqliteDatabase database_;
  std::map<std::int64_t, RecordedTopic> topics_;
  mutable std::mutex mutex_;
};

}  // namespace

std::unique_ptr<RecordingFile> open_sqlite(const std::filesystem::path& path) {
  return std::make_unique<SqliteRecording>(path);
}

#else

std::unique_ptr<RecordingFile> open_sqlite(const std::filesystem::path& path) {
  throw Error(ErrorKind::unavailable,
              path.string() + ": this program was built without SQLite (libsqlite3-dev)");
}

#endif

}  // namespace adasplats
