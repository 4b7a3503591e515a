// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/mcap/mcap_file.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "adasplats/io/base/input_file.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little, "MCAP files are little-endian");

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr std::size_t kChunkBytes = std::size_t{4} << 20;

enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f,
};

/// The consecutive fields of a record.
class Fields {
 public:
  template <class T>
  Fields& number(T value) {
    static_assert(std::is_integral_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  Fields& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
    return *this;
  }
  const std::string& get() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string record_header(Opcode opcode, std::uint64_t length) {
  return Fields().number(static_cast<std::uint8_t>(opcode)).number(length).get();
}

std::string record(Opcode opcode, std::string_view content) {
  return record_header(opcode, content.size()).append(content);
}

unsigned long crc_of(unsigned long crc, std::string_view bytes) {
  return crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

}  // namespace

McapMessage mcap_message(std::uint16_t channel, std::uint64_t time_ns, std::string bytes) {
  const auto crc = static_cast<std::uint32_t>(crc_of(0, bytes));
  return {channel, time_ns, std::move(bytes), crc};
}

void McapFile::Times::add(std::uint64_t time_ns) {
  first = std::min(first, time_ns);
  last = std::max(last, time_ns);
}

McapFile::McapFile(const std::filesystem::path& path, std::string_view profile) : file_(path) {
  put(kMagic);
  put(record(Opcode::header, Fields().text(profile).text("adasplats").get()));
}

void McapFile::put(std::string_view bytes) {
  file_.write(bytes);
  crc_ = crc_of(crc_, bytes);
  offset_ += bytes.size();
}

void McapFile::add_metadata(std::string_view name, std::string_view key, std::string_view value) {
  const std::string entry = Fields().text(key).text(value).get();
  const std::string bytes = record(Opcode::metadata, Fields().text(name).text(entry).get());
  Fields index;
  index.number(offset_).number(std::uint64_t{bytes.size()}).text(name);
  metadata_indexes_.push_back(record(Opcode::metadata_index, index.get()));
  put(bytes);
}

std::uint16_t McapFile::add_channel(const McapChannel& channel) {
  if (channels_.size() >= std::numeric_limits<std::uint16_t>::max())
    throw std::logic_error("McapFile: too many channels");
  const auto id = static_cast<std::uint16_t>(channels_.size());
  const auto schema_id = static_cast<std::uint16_t>(id + 1);  // 0 is no schema
  Fields schema, fields;
  schema.number(schema_id).text(channel.schema_name).text(channel.schema_encoding);
  schema.text(channel.schema);
  fields.number(id).number(schema_id).text(channel.topic).text(channel.message_encoding);
  fields.text("");  // no metadata
  ChannelState& state = channels_.emplace_back();
  state.schema_record = record(Opcode::schema, schema.get());
  state.channel_record = record(Opcode::channel, fields.get());
  put(state.schema_record);
  put(state.channel_record);
  return id;
}

void McapFile::add_message(const McapMessage& message) {
  ChannelState& state = channels_.at(message.channel);
  Fields fields;
  fields.number(message.channel).number(state.messages);
  fields.number(message.time_ns).number(message.time_ns);
  state.in_chunk.emplace_back(message.time_ns, chunk_.size());
  const std::string head =
      record_header(Opcode::message, fields.get().size() + message.bytes.size()) + fields.get();
  chunk_ += head;
  chunk_ += message.bytes;
  chunk_crc_ = crc32_combine(crc_of(chunk_crc_, head), message.crc,
                             static_cast<z_off_t>(message.bytes.size()));
  chunk_times_.add(message.time_ns);
  times_.add(message.time_ns);
  ++state.messages;
  if (chunk_.size() >= kChunkBytes) put_chunk();
}

void McapFile::put_chunk() {
  if (chunk_.empty()) return;
  const unsigned long records_crc = std::exchange(chunk_crc_, 0);
  Fields head;
  head.number(chunk_times_.begin()).number(chunk_times_.last);
  head.number(std::uint64_t{chunk_.size()}).number(static_cast<std::uint32_t>(records_crc));
  head.text("").number(std::uint64_t{chunk_.size()});  // not compressed
  const std::uint64_t start = offset_;
  put(record_header(Opcode::chunk, head.get().size() + chunk_.size()));
  put(head.get());
  file_.write(chunk_);
  crc_ = crc32_combine(crc_, records_crc, static_cast<z_off_t>(chunk_.size()));
  offset_ += chunk_.size();
  chunk_indexes_.push_back(put_message_indexes(start, offset_ - start));
  chunk_.clear();
  chunk_times_ = {};
}

std::string McapFile::put_message_indexes(std::uint64_t chunk_start, std::uint64_t chunk_length) {
  const std::uint64_t indexes_start = offset_;
  Fields places;
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    MessageIndex& index = channels_[id].in_chunk;
    if (index.empty()) continue;
    Fields entries;
    for (const auto& [time_ns, place] : index) entries.number(time_ns).number(place);
    index.clear();
    places.number(static_cast<std::uint16_t>(id)).number(offset_);
    Fields fields;
    fields.number(static_cast<std::uint16_t>(id)).text(entries.get());
    put(record(Opcode::message_index, fields.get()));
  }
  Fields chunk_index;
  chunk_index.number(chunk_times_.begin()).number(chunk_times_.last);
  chunk_index.number(chunk_start).number(chunk_length).text(places.get());
  chunk_index.number(offset_ - indexes_start).text("");
  const std::uint64_t size = chunk_.size();
  return chunk_index.number(size).number(size).get();
}

std::string McapFile::statistics() const {
  std::uint64_t messages = 0;
  Fields counts;
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    messages += channels_[id].messages;
    counts.number(static_cast<std::uint16_t>(id)).number(std::uint64_t{channels_[id].messages});
  }
  const auto channels = static_cast<std::uint32_t>(channels_.size());
  Fields fields;
  fields.number(messages).number(static_cast<std::uint16_t>(channels)).number(channels);
  fields
      .number(std::uint32_t{0})  // attachments
      .number(static_cast<std::uint32_t>(metadata_indexes_.size()));
  fields.number(static_cast<std::uint32_t>(chunk_indexes_.size()));
  return fields.number(times_.begin()).number(times_.last).text(counts.get()).get();
}

void McapFile::put_summary() {
  const std::uint64_t start = offset_;
  crc_ = 0;
  std::string offsets;
  const auto put_group = [&](Opcode opcode, auto&& put_records) {
    const std::uint64_t group_start = offset_;
    put_records();
    if (offset_ == group_start) return;
    Fields group;
    group.number(static_cast<std::uint8_t>(opcode)).number(group_start);
    offsets += record(Opcode::summary_offset, group.number(offset_ - group_start).get());
  };
  put_group(Opcode::schema, [&] {
    for (const ChannelState& channel : channels_) put(channel.schema_record);
  });
  put_group(Opcode::channel, [&] {
    for (const ChannelState& channel : channels_) put(channel.channel_record);
  });
  put_group(Opcode::statistics, [&] { put(record(Opcode::statistics, statistics())); });
  put_group(Opcode::chunk_index, [&] {
    for (const std::string& index : chunk_indexes_) put(record(Opcode::chunk_index, index));
  });
  put_group(Opcode::metadata_index, [&] {
    for (const std::string& index : metadata_indexes_) put(index);
  });
  const std::uint64_t offsets_start = offset_;
  put(offsets);
  // The checksum covers the footer up to itself.
  constexpr std::uint64_t kFooterBytes = 8 + 8 + 4;
  put(record_header(Opcode::footer, kFooterBytes));
  put(Fields().number(start).number(offsets_start).get());
  put(Fields().number(static_cast<std::uint32_t>(crc_)).get());
}

void McapFile::finish() {
  put_chunk();
  const auto data_crc = static_cast<std::uint32_t>(crc_);
  put(record(Opcode::data_end, Fields().number(data_crc).get()));
  put_summary();
  put(kMagic);
  file_.commit();
}

std::string read_mcap_metadata(const std::filesystem::path& path, std::string_view name,
                               std::string_view key) {
  constexpr std::size_t kHeadBytes = 1 + 8, kMaxBytes = 1 << 16;
  InputFile file(path);
  const auto peeked = [&file](std::size_t count) -> std::string_view {
    if (file.remaining() < count) return {};
    return {reinterpret_cast<const char*>(file.peek(count).data()), count};
  };
  if (peeked(kMagic.size()) != kMagic) return {};
  file.skip(kMagic.size());
  while (file.remaining() >= kHeadBytes) {
    const std::string_view head = peeked(kHeadBytes);
    const auto opcode = static_cast<Opcode>(head[0]);
    std::uint64_t length = 0;
    std::memcpy(&length, head.data() + 1, sizeof(length));
    if (opcode == Opcode::chunk || opcode == Opcode::message || opcode == Opcode::data_end)
      return {};
    file.skip(kHeadBytes);
    if (length > file.remaining()) return {};
    if (opcode == Opcode::metadata && length <= kMaxBytes) {
      // Of the form that add_metadata() writes: one entry.
      const std::string start = Fields().text(name).get();
      const std::string_view content = peeked(static_cast<std::size_t>(length));
      const std::string entry = Fields().text(key).get();
      const std::size_t value_at = start.size() + sizeof(std::uint32_t) + entry.size();
      if (content.starts_with(start) && content.size() >= value_at + sizeof(std::uint32_t) &&
          content.substr(value_at - entry.size(), entry.size()) == entry)
        return std::string(content.substr(value_at + sizeof(std::uint32_t)));
    }
    file.skip(length);
  }
  return {};
}

}  // namespace adasplats
