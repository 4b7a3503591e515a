// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// ROS 1 bags, after "Bags/Format/2.0" of the ROS wiki.

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/bags/byte_reader.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/bags/unpack.h"
#include "adasplats/io/base/input_file.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little, "bags are little-endian");

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
constexpr std::uint64_t kNanosecondsOfBagSecond = 1'000'000'000;

constexpr std::uint8_t kBagMessage = 0x02, kBagHeader = 0x03, kBagChunk = 0x05,
                       kBagConnection = 0x07;

/// The fields "name=value" of a record's header. Errors: data.
class BagFields {
 public:
  explicit BagFields(ByteReader reader) : what_(reader) {
    while (reader.remaining() > 0) {
      const std::string_view field = reader.text();
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos)
        throw reader.error("has a field without '=' in its header");
      values_.insert_or_assign(field.substr(0, equals), field.substr(equals + 1));
    }
  }
  std::string_view text(std::string_view name) const {
    const auto value = values_.find(name);
    if (value == values_.end())
      throw what_.error("has no field '" + std::string(name) + "' in its header");
    return value->second;
  }
  template <class T>
  T number(std::string_view name) const {
    const std::string_view value = text(name);
    if (value.size() != sizeof(T))
      throw what_.error("has a field '" + std::string(name) + "' of " +
                        std::to_string(value.size()) + " bytes, expected " +
                        std::to_string(sizeof(T)));
    return ByteReader(value, "").number<T>();
  }

 private:
  ByteReader what_;
  std::map<std::string_view, std::string_view> values_;
};

class RosbagRecording final : public RecordingFile {
 public:
  explicit RosbagRecording(const std::filesystem::path& path) : path_(path) {
    InputFile file(path_);
    if (view(file, std::min<std::uint64_t>(kBagMagic.size(), file.size_bytes())) != kBagMagic)
      throw data_error({path_, 0, {}}, "is not a ROS bag of format 2.0 (wrong first bytes)");
  }

  void for_each_message(MessageVisitor visit) const override {
    InputFile file(path_);
    file.skip(kBagMagic.size());
    Connections connections;
    std::optional<std::uint32_t> chunks_left;  // as in the header
    while (file.remaining() > 0) {
      const std::uint64_t offset = file.offset();
      const std::string header(sized(file, offset));
      const BagFields fields(ByteReader(header, place_in_file(path_, offset, "record")));
      const auto op = fields.number<std::uint8_t>("op");
      const std::uint64_t data_offset = file.offset() + sizeof(std::uint32_t);
      const std::string_view data = peek_sized(file, offset);
      if (op == kBagHeader) {
        require_closed(fields);
        chunks_left = fields.number<std::uint32_t>("chunk_count");
      }
      if (op == kBagChunk && chunks_left) --*chunks_left;
      if (op == kBagChunk)
        visit_chunk(unpacked(fields, data, offset), offset, connections, visit);
      else
        visit_record(op, fields, data, {0, MessagePosition::kNoChunk, data_offset, data.size()},
                     connections, visit);
      file.skip(sizeof(std::uint32_t) + data.size());
    }
    if (!chunks_left) throw data_error({path_, {}, {}}, "has no bag header");
    if (*chunks_left != 0)
      throw data_error({path_, file.size_bytes(), {}},
                       "has another number of chunks than its header states: the bag is damaged or "
                       "cut off (repair it with `rosbag reindex`)");
  }

  std::string message(const MessagePosition& place) const override {
    if (place.chunk == MessagePosition::kNoChunk) {
      InputFile file(path_);
      file.skip(place.offset);
      return std::string(view(file, place.size));
    }
    return cache_.message(path_, place, [&] {
      InputFile file(path_);
      file.skip(place.chunk);
      const std::string header(sized(file, place.chunk));
      const BagFields fields(ByteReader(header, place_in_file(path_, place.chunk, "chunk")));
      return unpacked(fields, peek_sized(file, place.chunk), place.chunk);
    });
  }

 private:
  using Connections = std::map<std::uint32_t, RecordedTopic>;

  static std::string_view view(InputFile& file, std::uint64_t bytes) {
    const auto count = static_cast<std::size_t>(bytes);
    if (count == 0) return {};
    return {reinterpret_cast<const char*>(file.peek(count).data()), count};
  }

  /// The size that precedes the next bytes; `record` is the offset of their record.
  static std::uint32_t size_here(InputFile& file, std::uint64_t record) {
    const auto size =
        ByteReader(view(file, sizeof(std::uint32_t)), file.path().string()).number<std::uint32_t>();
    if (size > file.remaining() - sizeof(std::uint32_t))
      throw data_error(
          {file.path(), record, {}},
          "a record of " + std::to_string(size) + " bytes, but " +
              std::to_string(file.remaining() - sizeof(std::uint32_t)) +
              " follow: the bag is damaged, or the recording was cut off (repair it with "
              "`rosbag reindex`)");
    if (size > kMaxChunkBytes)
      throw data_error({file.path(), record, {}}, "a record of " + std::to_string(size) +
                                                      " bytes, expected at most " +
                                                      std::to_string(kMaxChunkBytes));
    return size;
  }
  /// Bytes after their number, without moving on in the file.
  static std::string_view peek_sized(InputFile& file, std::uint64_t record) {
    const std::uint32_t size = size_here(file, record);
    return view(file, sizeof(std::uint32_t) + std::uint64_t{size}).substr(sizeof(std::uint32_t));
  }
  /// The same, moving on.
  static std::string sized(InputFile& file, std::uint64_t record) {
    std::string bytes(peek_sized(file, record));
    file.skip(sizeof(std::uint32_t) + bytes.size());
    return bytes;
  }

  void require_closed(const BagFields& header) const {
    if (header.number<std::uint64_t>("index_pos") == 0)
      throw data_error({path_, {}, {}},
                       "the recording was not closed, its end may be missing (repair it with "
                       "`rosbag reindex`)");
  }

  std::string unpacked(const BagFields& fields, std::string_view data, std::uint64_t offset) const {
    return unpack(fields.text("compression"), data, fields.number<std::uint32_t>("size"),
                  place_in_file(path_, offset, "chunk"));
  }

  void visit_chunk(const std::string& records, std::uint64_t offset, Connections& connections,
                   MessageVisitor visit) const {
    ByteReader reader(records, place_in_file(path_, offset, "chunk"));
    while (reader.remaining() > 0) {
      const BagFields fields(ByteReader(reader.text(), place_in_file(path_, offset, "chunk")));
      const std::string_view data = reader.text();
      visit_record(fields.number<std::uint8_t>("op"), fields, data,
                   {0, offset, reader.place() - data.size(), data.size()}, connections, visit);
    }
  }

  /// `place` is the position of the data.
  void visit_record(std::uint8_t op, const BagFields& fields, std::string_view data,
                    const MessagePosition& place, Connections& connections,
                    MessageVisitor visit) const {
    if (op == kBagConnection) {
      const std::string where = place_in_file(
          path_, place.chunk == MessagePosition::kNoChunk ? place.offset : place.chunk,
          "connection");
      const BagFields described(ByteReader(data, where));
      RecordedTopic topic{std::string(fields.text("topic")),
                          short_type_name(described.text("type")), MessageEncoding::ros1};
      // Repeated after the data; messages refer to the first.
      connections.try_emplace(fields.number<std::uint32_t>("conn"), std::move(topic));
    } else if (op == kBagMessage) {
      const auto number = fields.number<std::uint32_t>("conn");
      const auto topic = connections.find(number);
      if (topic == connections.end())
        throw data_error(
            {path_, place.chunk == MessagePosition::kNoChunk ? place.offset : place.chunk, {}},
            "a message of connection " + std::to_string(number) +
                ", which no earlier record describes");
      const auto time = fields.number<std::uint64_t>("time");  // seconds, then nanoseconds
      const std::uint64_t time_ns = (time & 0xffffffff) * kNanosecondsOfBagSecond + (time >> 32);
      visit({topic->second, time_ns, place, data});
    }
  }

  std::filesystem::path path_;
  mutable ChunkCache cache_;
};

}  // namespace

std::unique_ptr<RecordingFile> open_rosbag(const std::filesystem::path& path) {
  return std::make_unique<RosbagRecording>(path);
}

}  // namespace adasplats
