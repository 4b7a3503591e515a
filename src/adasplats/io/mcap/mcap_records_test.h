// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: MCAP files taken apart by the letter of the specification.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace adasplats::mcap_test {

/// CRC-32 of ISO 3309 bit by bit.
inline std::uint32_t crc_of(std::string_view bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc;
}

/// Reads little-endian fields one behind the other; std::out_of_range beyond the end.
class FieldReader {
 public:
  explicit FieldReader(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size() - place_) throw std::out_of_range("a record ends early");
    const std::string_view part = bytes_.substr(place_, count);
    place_ += count;
    return part;
  }
  std::string_view text() { return take(number<std::uint32_t>()); }
  std::string_view rest() { return take(bytes_.size() - place_); }
  bool at_end() const { return place_ == bytes_.size(); }
  std::size_t place() const { return place_; }

 private:
  std::string_view bytes_;
  std::size_t place_ = 0;
};

struct Record {
  std::uint8_t opcode;
  std::uint64_t offset;  ///< in what was split
  std::uint64_t length;  ///< with opcode and length
  std::string_view content;
};

/// The records that `bytes` is made of.
inline std::vector<Record> records_of(std::string_view bytes) {
  std::vector<Record> records;
  FieldReader reader(bytes);
  while (!reader.at_end()) {
    const std::size_t offset = reader.place();
    const auto opcode = reader.number<std::uint8_t>();
    const auto length = reader.number<std::uint64_t>();
    const std::string_view content = reader.take(length);
    records.push_back({opcode, offset, reader.place() - offset, content});
  }
  return records;
}

struct Message {
  std::uint16_t channel;
  std::uint32_t sequence;
  std::uint64_t time_ns;
  std::string data;
};

inline Message message_of(const Record& record) {
  EXPECT_EQ(record.opcode, 0x05);
  FieldReader reader(record.content);
  Message message{reader.number<std::uint16_t>(),
                  reader.number<std::uint32_t>(),
                  reader.number<std::uint64_t>(),
                  {}};
  EXPECT_EQ(reader.number<std::uint64_t>(), message.time_ns) << "log and publish time";
  message.data = reader.rest();
  return message;
}

/// What a whole file holds, its structure, places and checksums checked on the way.
struct File {
  std::vector<Message> messages;
  std::vector<std::string> topics, schema_names, schemas;  ///< by channel
  std::size_t chunks = 0;
  std::uint64_t first_ns = 0, last_ns = 0;  ///< of the statistics
};

constexpr std::string_view kMagic = "\x89MCAP0\r\n";

/// The messages of a chunk.
inline void read_chunk(const Record& record, File& result) {
  FieldReader reader(record.content);
  reader.take(8 + 8);
  const auto size = reader.number<std::uint64_t>();
  const auto crc = reader.number<std::uint32_t>();
  EXPECT_EQ(reader.text(), "");
  EXPECT_EQ(reader.number<std::uint64_t>(), size);
  const std::string_view content = reader.take(size);
  EXPECT_TRUE(reader.at_end());
  EXPECT_EQ(crc, crc_of(content));
  for (const Record& inner : records_of(content)) result.messages.push_back(message_of(inner));
  ++result.chunks;
}

/// The messages that a chunk index and its message indexes point to; their number.
inline std::size_t follow_chunk_index(std::string_view file, const Record& record) {
  FieldReader reader(record.content);
  const auto first_ns = reader.number<std::uint64_t>(), last_ns = reader.number<std::uint64_t>();
  const auto start = reader.number<std::uint64_t>(), length = reader.number<std::uint64_t>();
  FieldReader places(reader.text());
  const auto indexes_length = reader.number<std::uint64_t>();
  EXPECT_EQ(reader.text(), "");
  const auto size = reader.number<std::uint64_t>();
  EXPECT_EQ(reader.number<std::uint64_t>(), size);
  const Record chunk = records_of(file.substr(start, length)).at(0);
  EXPECT_EQ(chunk.opcode, 0x06);
  const std::string_view content = chunk.content.substr(chunk.content.size() - size);
  const auto indexes = records_of(file.substr(start + length, indexes_length));
  FieldReader times(chunk.content);
  EXPECT_EQ(times.number<std::uint64_t>(), first_ns);
  EXPECT_EQ(times.number<std::uint64_t>(), last_ns);
  std::size_t messages = 0, index_number = 0;
  std::uint64_t min_ns = ~std::uint64_t{0}, max_ns = 0;
  while (!places.at_end()) {
    const auto channel = places.number<std::uint16_t>();
    const Record& index = indexes.at(index_number++);
    EXPECT_EQ(index.opcode, 0x07);
    EXPECT_EQ(start + length + index.offset, places.number<std::uint64_t>());
    FieldReader fields(index.content);
    EXPECT_EQ(fields.number<std::uint16_t>(), channel);
    FieldReader entries(fields.text());
    for (; !entries.at_end(); ++messages) {
      const auto time_ns = entries.number<std::uint64_t>();
      const std::string_view at = content.substr(entries.number<std::uint64_t>());
      FieldReader inner(at);
      const auto opcode = inner.number<std::uint8_t>();
      const Message message = message_of({opcode, 0, 0, inner.take(inner.number<std::uint64_t>())});
      EXPECT_EQ(message.channel, channel);
      EXPECT_EQ(message.time_ns, time_ns);
      min_ns = std::min(min_ns, time_ns);
      max_ns = std::max(max_ns, time_ns);
    }
  }
  EXPECT_EQ(index_number, indexes.size());
  EXPECT_EQ(first_ns, min_ns);
  EXPECT_EQ(last_ns, max_ns);
  return messages;
}

inline void read_summary(std::string_view file, std::string_view summary, File& result,
                         std::size_t& indexed) {
  for (const Record& record : records_of(summary)) {
    FieldReader reader(record.content);
    if (record.opcode == 0x03) {
      EXPECT_EQ(reader.number<std::uint16_t>(), result.schemas.size() + 1);
      result.schema_names.emplace_back(reader.text());
      EXPECT_EQ(reader.text(), "ros2msg");
      result.schemas.emplace_back(reader.text());
    } else if (record.opcode == 0x04) {
      EXPECT_EQ(reader.number<std::uint16_t>(), result.topics.size());
      EXPECT_EQ(reader.number<std::uint16_t>(), result.topics.size() + 1);
      result.topics.emplace_back(reader.text());
      EXPECT_EQ(reader.text(), "cdr");
    } else if (record.opcode == 0x0b) {
      EXPECT_EQ(reader.number<std::uint64_t>(), result.messages.size());
      EXPECT_EQ(reader.number<std::uint16_t>(), result.schemas.size());
      EXPECT_EQ(reader.number<std::uint32_t>(), result.topics.size());
      EXPECT_EQ(reader.number<std::uint64_t>(), 0U);  // attachments, metadata
      EXPECT_EQ(reader.number<std::uint32_t>(), result.chunks);
      result.first_ns = reader.number<std::uint64_t>();
      result.last_ns = reader.number<std::uint64_t>();
      std::uint64_t messages = 0;
      for (FieldReader counts(reader.text()); !counts.at_end();) {
        counts.number<std::uint16_t>();
        messages += counts.number<std::uint64_t>();
      }
      EXPECT_EQ(messages, result.messages.size());
    } else {
      EXPECT_EQ(record.opcode, 0x08);
      indexed += follow_chunk_index(file, record);
    }
  }
}

/// Every group of the summary has a summary offset, and none is missing.
inline void check_summary_offsets(std::string_view file, std::string_view offsets,
                                  std::uint64_t summary_start) {
  std::uint64_t next = summary_start;
  for (const Record& record : records_of(offsets)) {
    EXPECT_EQ(record.opcode, 0x0e);
    FieldReader reader(record.content);
    const auto opcode = reader.number<std::uint8_t>();
    EXPECT_EQ(reader.number<std::uint64_t>(), next);
    const auto length = reader.number<std::uint64_t>();
    for (const Record& inner : records_of(file.substr(next, length)))
      EXPECT_EQ(inner.opcode, opcode);
    next += length;
  }
  EXPECT_EQ(next, static_cast<std::uint64_t>(offsets.data() - file.data()));
}

inline File read(std::string_view file) {
  File result;
  EXPECT_TRUE(file.starts_with(kMagic) && file.ends_with(kMagic));
  constexpr std::size_t kFooterBytes = 9 + 20;
  const std::size_t footer_start = file.size() - kMagic.size() - kFooterBytes;
  const Record footer = records_of(file.substr(footer_start, kFooterBytes)).at(0);
  EXPECT_EQ(footer.opcode, 0x02);
  FieldReader fields(footer.content);
  const auto summary_start = fields.number<std::uint64_t>();
  const auto offsets_start = fields.number<std::uint64_t>();
  EXPECT_EQ(fields.number<std::uint32_t>(),
            crc_of(file.substr(summary_start, footer_start + kFooterBytes - 4 - summary_start)));

  const auto data = records_of(file.substr(kMagic.size(), summary_start - kMagic.size()));
  EXPECT_EQ(data.front().opcode, 0x01);
  EXPECT_EQ(data.back().opcode, 0x0f);
  const std::size_t data_end = kMagic.size() + data.back().offset;
  EXPECT_EQ(FieldReader(data.back().content).number<std::uint32_t>(),
            crc_of(file.substr(0, data_end)));
  for (const Record& record : data)
    if (record.opcode == 0x06) read_chunk(record, result);

  std::size_t indexed = 0;
  read_summary(file, file.substr(summary_start, offsets_start - summary_start), result, indexed);
  EXPECT_EQ(indexed, result.messages.size());
  check_summary_offsets(file, file.substr(offsets_start, footer_start - offsets_start),
                        summary_start);
  return result;
}

}  // namespace adasplats::mcap_test
