// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// MCAP files, after Foxglove's "MCAP Format Specification", version 0.

#include <zlib.h>

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

static_assert(std::endian::native == std::endian::little, "MCAP files are little-endian");

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::size_t kRecordHeadBytes = 1 + 8;

enum class McapOpcode : std::uint8_t {
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  data_end = 0x0f,
};

std::string_view view_of(std::span<const std::byte> bytes, std::size_t count) {
  return {reinterpret_cast<const char*>(bytes.data()), count};
}

/// The fields of a chunk before its records.
struct McapChunk {
  std::uint64_t size = 0;  ///< decompressed
  std::uint32_t crc = 0;   ///< of the decompressed records; 0: none
  std::string_view packing, packed;
};

McapChunk chunk_of(ByteReader reader) {
  McapChunk chunk;
  reader.take(8 + 8);  // first and last time
  chunk.size = reader.number<std::uint64_t>();
  chunk.crc = reader.number<std::uint32_t>();
  chunk.packing = reader.text();
  chunk.packed = reader.take(reader.number<std::uint64_t>());
  return chunk;
}

/// The content of a record in the file. Errors: data (larger than the file or the limit of chunks).
std::string_view content_here(InputFile& file, std::uint64_t offset, std::uint64_t length) {
  if (length > kMaxChunkBytes)
    throw data_error({file.path(), offset, {}}, "a record of " + std::to_string(length) +
                                                    " bytes, expected at most " +
                                                    std::to_string(kMaxChunkBytes));
  const auto size = static_cast<std::size_t>(length);
  return size == 0 ? std::string_view() : view_of(file.peek(size), size);
}

class McapRecording final : public RecordingFile {
 public:
  explicit McapRecording(const std::filesystem::path& path) : path_(path) {
    InputFile file(path_);
    const bool begins = file.size_bytes() >= kMcapMagic.size() &&
                        view_of(file.peek(kMcapMagic.size()), kMcapMagic.size()) == kMcapMagic;
    if (!begins) throw data_error({path_, 0, {}}, "is not an MCAP file (wrong first bytes)");
  }

  void for_each_message(MessageVisitor visit) const override {
    InputFile file(path_);
    file.skip(kMcapMagic.size());
    Channels channels;
    while (file.remaining() > 0) {
      const std::uint64_t offset = file.offset();
      if (file.remaining() < kRecordHeadBytes) break;
      ByteReader head(view_of(file.peek(kRecordHeadBytes), kRecordHeadBytes), "");
      const auto opcode = head.number<McapOpcodeNumber>();
      const auto length = head.number<std::uint64_t>();
      file.skip(kRecordHeadBytes);
      if (length > file.remaining())
        throw data_error(
            {path_, offset, {}},
            "a record of " + std::to_string(length) + " bytes, but " +
                std::to_string(file.remaining()) +
                " follow: the file is damaged, or the recording was cut off (repair it with "
                "`mcap recover`)");
      const auto kind = static_cast<McapOpcode>(opcode);
      if (kind == McapOpcode::data_end) return require_end();
      if (kind == McapOpcode::footer) break;
      if (kind == McapOpcode::chunk)
        visit_chunk(content_here(file, offset, length), offset, channels, visit);
      else if (is_relevant(kind))
        visit_record(kind, content_here(file, offset, length),
                     {0, MessagePosition::kNoChunk, offset + kRecordHeadBytes, 0}, channels, visit);
      file.skip(length);
    }
    throw data_error(
        {path_, file.size_bytes(), {}},
        "has no record that closes its data: the recording was cut off (repair it with "
        "`mcap recover`)");
  }

  std::string message(const MessagePosition& place) const override {
    if (place.chunk == MessagePosition::kNoChunk) {
      InputFile file(path_);
      file.skip(place.offset);
      return std::string(content_here(file, place.offset, place.size));
    }
    return cache_.message(path_, place, [&] {
      InputFile file(path_);
      file.skip(place.chunk + 1);
      const auto length =
          ByteReader(view_of(file.peek(8), 8), path_.string()).number<std::uint64_t>();
      file.skip(8);
      return unpacked(content_here(file, place.chunk, length), place.chunk);
    });
  }

 private:
  using McapOpcodeNumber = std::uint8_t;

  struct Channels {
    std::map<std::uint16_t, std::string> types;  ///< by the number of the schema
    std::map<std::uint16_t, RecordedTopic> topics;
  };

  static bool is_relevant(McapOpcode kind) {
    return kind == McapOpcode::schema || kind == McapOpcode::channel || kind == McapOpcode::message;
  }

  void require_end() const {
    InputFile file(path_);
    file.skip(file.size_bytes() - kMcapMagic.size());
    if (view_of(file.peek(kMcapMagic.size()), kMcapMagic.size()) != kMcapMagic)
      throw data_error({path_, file.offset(), {}},
                       "does not end like MCAP: the file is damaged or cut off");
  }

  std::string unpacked(std::string_view content, std::uint64_t offset) const {
    const std::string where = place_in_file(path_, offset, "chunk");
    const McapChunk chunk = chunk_of(ByteReader(content, where));
    std::string records = unpack(chunk.packing, chunk.packed, chunk.size, where);
    const auto crc = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(records.data()), records.size()));
    if (chunk.crc != 0 && crc != chunk.crc)
      throw Error(ErrorKind::data, where + " is damaged: wrong checksum");
    return records;
  }

  void visit_chunk(std::string_view content, std::uint64_t offset, Channels& channels,
                   MessageVisitor visit) const {
    const std::string records = unpacked(content, offset);
    ByteReader reader(records, place_in_file(path_, offset, "chunk"));
    while (reader.remaining() > 0) {
      const auto kind = static_cast<McapOpcode>(reader.number<McapOpcodeNumber>());
      const auto length = reader.number<std::uint64_t>();
      const std::size_t begin = reader.place();
      const std::string_view record = reader.take(length);
      if (is_relevant(kind)) visit_record(kind, record, {0, offset, begin, 0}, channels, visit);
    }
  }

  /// `place` is the position of the record's content.
  void visit_record(McapOpcode kind, std::string_view content, MessagePosition place,
                    Channels& channels, MessageVisitor visit) const {
    const std::uint64_t offset =
        place.chunk == MessagePosition::kNoChunk ? place.offset : place.chunk;
    if (kind == McapOpcode::message) {
      ByteReader reader(content, place_in_file(path_, offset, "message"));
      const auto channel = reader.number<std::uint16_t>();
      const auto topic = channels.topics.find(channel);
      if (topic == channels.topics.end())
        throw reader.error("is of channel " + std::to_string(channel) +
                           ", which no earlier record describes");
      reader.take(4);  // sequence
      const auto time_ns = reader.number<std::uint64_t>();
      reader.take(8);  // when it was published
      place.offset += reader.place();
      place.size = reader.remaining();
      visit({topic->second, time_ns, place, reader.take(place.size)});
    } else if (kind == McapOpcode::schema) {
      ByteReader reader(content, place_in_file(path_, offset, "schema"));
      const auto number = reader.number<std::uint16_t>();
      channels.types.insert_or_assign(number, short_type_name(reader.text()));
    } else {
      add_channel(ByteReader(content, place_in_file(path_, offset, "channel")), channels);
    }
  }

  static void add_channel(ByteReader reader, Channels& channels) {
    const auto number = reader.number<std::uint16_t>();
    const auto schema = reader.number<std::uint16_t>();
    RecordedTopic topic;
    topic.name = reader.text();
    const std::string_view encoding = reader.text();
    topic.encoding = encoding == "cdr"    ? MessageEncoding::cdr
                     : encoding == "ros1" ? MessageEncoding::ros1
                                          : MessageEncoding::other;
    const auto type = channels.types.find(schema);
    if (schema != 0 && type == channels.types.end())
      throw reader.error("is of schema " + std::to_string(schema) +
                         ", which no earlier record describes");
    if (schema != 0) topic.type = type->second;
    // Repeated in other chunks; messages refer to the first.
    channels.topics.try_emplace(number, std::move(topic));
  }

  std::filesystem::path path_;
  mutable ChunkCache cache_;
};

}  // namespace

std::unique_ptr<RecordingFile> open_mcap(const std::filesystem::path& path) {
  return std::make_unique<McapRecording>(path);
}

}  // namespace adasplats
