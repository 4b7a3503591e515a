// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/arrow/arrow_file.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/arrow/arrow_layout.h"
#include "adasplats/io/arrow/flat_table.h"
#include "adasplats/io/bags/unpack.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

float float_of_half(std::uint16_t half) {
  const std::uint32_t sign = (half & 0x8000U) << 16U, exponent = (half >> 10U) & 31U;
  const std::uint32_t fraction = half & 0x3ffU;
  constexpr float kSubnormalStep = 0x1p-24F;
  if (exponent == 0) {
    const float value = kSubnormalStep * static_cast<float>(fraction);
    return sign == 0 ? value : -value;
  }
  const std::uint32_t wide = exponent == 31 ? 255U : exponent + 112U;
  return std::bit_cast<float>(sign | (wide << 23U) | (fraction << 13U));
}

/// How the values of a column are stored.
struct ArrowField {
  std::string name;
  TypeKind kind = int_type;
  std::size_t bits = 0;  ///< of a number, or of an offset to text
  bool is_signed = false;
};

/// Adds values of one type to a column, converted from the type in the file.
template <class Stored, class Value, class Convert>
void append(std::string_view bytes, std::vector<Value>& values, Convert&& convert) {
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(Stored)) {
    Stored stored;
    std::memcpy(&stored, bytes.data() + at, sizeof(Stored));
    values.push_back(convert(stored));
  }
}

class ArrowReader {
 public:
  ArrowReader(std::string path, std::string_view bytes) : path_(std::move(path)), bytes_(bytes) {}

  ArrowTable read() {
    const FlatBytes footer(footer_bytes(), path_ + ": the footer");
    const FlatTable root = FlatTable::root(footer);
    read_schema(root.table(footer_schema));
    if (fields_.empty()) throw fault("has no columns");
    const auto [blocks, count] = root.elements(footer_batches, kBlockBytes);
    const FlatBytes places(blocks, path_ + ": the footer");
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = k * kBlockBytes;
      batch_ = path_ + ": record batch " + std::to_string(k);
      read_batch(places.number<std::uint64_t>(at), places.number<std::int32_t>(at + 8),
                 places.number<std::uint64_t>(at + 16));
    }
    return std::move(table_);
  }

 private:
  Error fault(const std::string& problem) const {
    return {ErrorKind::data, path_ + ": " + problem};
  }

  std::string_view footer_bytes() const {
    const std::size_t tail = kArrowMagic.size() + sizeof(std::uint32_t);
    if (bytes_.starts_with("FEA1"))
      throw fault(
          "is Feather version 1, only version 2 (an Arrow file) is read; rewrite it with pyarrow: "
          "feather.write_feather(feather.read_table('a.feather'), 'b.feather')");
    if (!bytes_.starts_with(kArrowMagic))
      throw fault("does not begin with ARROW1, so it is not an Arrow file (Feather version 2)");
    if (bytes_.size() < tail || !bytes_.ends_with(kArrowMagic))
      throw fault("does not end with ARROW1, so it is incomplete; copy it again");
    const std::size_t end = bytes_.size() - tail;
    const FlatBytes all(bytes_, path_ + ": the file");
    const auto size = all.number<std::uint32_t>(end);
    if (size > end) throw fault("its footer of " + std::to_string(size) + " bytes does not fit");
    return bytes_.substr(end - size, size);
  }

  void read_schema(const FlatTable& schema) {
    if (schema.number<std::int16_t>(schema_endianness) != 0)
      throw fault("is big-endian, only little-endian Arrow files are read");
    const std::size_t count = schema.elements(schema_fields, sizeof(std::uint32_t)).second;
    for (std::size_t k = 0; k < count; ++k) {
      ArrowField field = field_of(schema.element(schema_fields, k));
      if (field.bits == 0) throw fault("column '" + field.name + "' has no known type");
      const bool is_text = field.kind == utf8_type || field.kind == large_utf8_type;
      const bool is_new = is_text ? table_.texts.try_emplace(field.name).second
                                  : table_.numbers.find(field.name) == nullptr;
      if (!is_new) throw fault("column '" + field.name + "' exists twice");
      if (!is_text) table_.numbers.columns.push_back({field.name, values_of(field)});
      fields_.push_back(std::move(field));
    }
  }

  ArrowField field_of(const FlatTable& entry) const {
    ArrowField field{shown(entry.text(field_name)).substr(0, 100)};
    field.name = std::string(entry.text(field_name));
    const auto kind = entry.number<std::uint8_t>(field_type_kind);
    if (entry.has(field_dictionary))
      throw fault("column '" + field.name +
                  "' is dictionary-encoded (categories), which is not read; write it as text");
    field.kind = static_cast<TypeKind>(kind);
    const FlatTable type = entry.table(field_type);
    switch (kind) {
      case int_type:
        field.bits = static_cast<std::size_t>(type.number<std::int32_t>(0));
        field.is_signed = type.number<std::uint8_t>(1) != 0;
        if (field.bits != 8 && field.bits != 16 && field.bits != 32 && field.bits != 64)
          field.bits = 0;
        return field;
      case float_type: {
        const auto precision = type.number<std::int16_t>(0);  // half, single, double
        if (precision >= 0 && precision <= 2) field.bits = std::size_t{16} << precision;
        return field;
      }
      case bool_type: field.bits = 1; return field;
      case utf8_type: field.bits = 32; return field;
      case large_utf8_type: field.bits = 64; return field;
      default:
        throw fault("column '" + field.name + "' has Arrow type number " + std::to_string(kind) +
                    ", only integers (2), floats (3), text (5, 20) and booleans (6) are read");
    }
  }

  static Column::Values values_of(const ArrowField& field) {
    if (field.kind == float_type)
      return field.bits == 64 ? Column::Values(std::vector<double>())
                              : Column::Values(std::vector<float>());
    switch (field.bits) {
      case 16:
        return field.is_signed ? Column::Values(std::vector<std::int16_t>())
                               : Column::Values(std::vector<std::uint16_t>());
      case 32:
        return field.is_signed ? Column::Values(std::vector<std::int32_t>())
                               : Column::Values(std::vector<std::uint32_t>());
      case 64:
        return field.is_signed ? Column::Values(std::vector<std::int64_t>())
                               : Column::Values(std::vector<std::uint64_t>());
      default:
        return field.is_signed ? Column::Values(std::vector<std::int8_t>())
                               : Column::Values(std::vector<std::uint8_t>());
    }
  }

  /// Batches and their buffers follow each other, so no byte is read twice.
  void read_batch(std::uint64_t offset, std::int32_t head_bytes, std::uint64_t body_bytes) {
    const FlatBytes all(bytes_, batch_);
    if (offset < end_ || head_bytes < 8)
      throw all.error("is damaged: it begins at byte " + std::to_string(offset));
    std::string_view head = all.part(offset, static_cast<std::uint64_t>(head_bytes));
    body_ = all.part(offset + head.size(), body_bytes);
    end_ = offset + head.size() + body_.size();
    const auto begin = FlatBytes(head, batch_).number<std::uint32_t>(0);
    head.remove_prefix(begin == kContinues ? 8 : 4);  // since Arrow 0.15
    const FlatBytes message(head, batch_);
    const FlatTable root = FlatTable::root(message);
    if (root.number<std::uint8_t>(message_kind) != kRecordBatch)
      throw message.error("is a message of another kind");
    const FlatTable batch = root.table(message_header);
    const auto rows = batch.number<std::int64_t>(batch_rows);
    if (rows < 0) throw message.error("has " + std::to_string(rows) + " rows");
    rows_ = static_cast<std::size_t>(rows);
    packing_ = packing_of(batch);
    const auto [nodes, node_count] = batch.elements(batch_nodes, kNodeBytes);
    const auto [buffers, buffer_count] = batch.elements(batch_buffers, kBufferBytes);
    if (node_count != fields_.size())
      throw message.error("has " + std::to_string(node_count) + " columns, expected " +
                          std::to_string(fields_.size()));
    nodes_ = nodes;
    buffers_ = buffers;
    next_buffer_ = 0;
    body_end_ = 0;
    std::size_t column = 0;
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      require_full(k);
      const bool is_text = fields_[k].kind == utf8_type || fields_[k].kind == large_utf8_type;
      if (is_text)
        read_text(fields_[k]);
      else
        read_numbers(fields_[k], table_.numbers.columns[column++].values);
    }
    table_.numbers.rows += rows_;
  }

  std::string_view packing_of(const FlatTable& batch) const {
    if (!batch.has(batch_compression)) return {};
    const auto codec = batch.table(batch_compression).number<std::int8_t>(0);
    if (codec != 0 && codec != 1)
      throw Error(ErrorKind::data, batch_ + " has compression " + std::to_string(codec) +
                                       ", supported are LZ4 (0) and Zstandard (1)");
    return codec == 0 ? "lz4" : "zstd";
  }

  /// A column has as many values as the batch has rows, and no nulls.
  void require_full(std::size_t k) const {
    const FlatBytes nodes(nodes_, batch_);
    const auto length = nodes.number<std::int64_t>(k * kNodeBytes);
    const auto nulls = nodes.number<std::int64_t>(k * kNodeBytes + 8);
    const std::string column = "column '" + fields_[k].name + "' ";
    if (length < 0 || static_cast<std::uint64_t>(length) != rows_)
      throw nodes.error(column + "has " + std::to_string(length) + " values, expected " +
                        std::to_string(rows_));
    if (nulls != 0)
      throw nodes.error(column + "has " + std::to_string(nulls) +
                        " null values, expected a value in every row");
  }

  /// The next buffer, decompressed, at least `bytes` of it.
  std::string_view buffer(const ArrowField& field, std::uint64_t bytes, std::string& unpacked) {
    const FlatBytes places(buffers_, batch_), body(body_, batch_);
    const std::size_t at = kBufferBytes * next_buffer_++;
    const auto offset = places.number<std::uint64_t>(at);
    const auto size = places.number<std::uint64_t>(at + 8);
    std::string_view stored = size == 0 ? std::string_view() : body.part(offset, size);
    if (size != 0 && offset < body_end_) throw body.error("is damaged: its buffers overlap");
    if (size != 0) body_end_ = offset + size;
    if (!packing_.empty() && size != 0) {
      const auto length = FlatBytes(stored, batch_).number<std::int64_t>(0);
      stored.remove_prefix(sizeof(length));
      if (length != -1) {  // -1: this buffer is not compressed
        unpacked = unpack(packing_, stored, static_cast<std::uint64_t>(length),
                          batch_ + ": column '" + field.name + "'");
        stored = unpacked;
      }
    }
    if (stored.size() < bytes)
      throw body.error("column '" + field.name + "' has " + std::to_string(stored.size()) +
                       " bytes, expected " + std::to_string(bytes));
    return stored;
  }

  void skip_validity() { ++next_buffer_; }

  /// Bytes of `count` values of `bits`; too many for a file fail when they are read.
  static std::uint64_t bytes_of(std::uint64_t count, std::size_t bits) {
    constexpr std::uint64_t kMaxCount = std::uint64_t{1} << 50;
    if (count > kMaxCount) return std::numeric_limits<std::uint64_t>::max();
    return (count * bits + 7) / 8;
  }

  void read_numbers(const ArrowField& field, Column::Values& values) {
    skip_validity();
    const std::uint64_t size = bytes_of(rows_, field.bits);
    std::string unpacked;
    const std::string_view bytes =
        buffer(field, size, unpacked).substr(0, static_cast<std::size_t>(size));
    if (field.kind == bool_type) {
      auto& flags = std::get<std::vector<std::uint8_t>>(values);
      for (std::size_t i = 0; i < rows_; ++i)
        flags.push_back((static_cast<std::uint8_t>(bytes[i / 8]) >> (i % 8)) & 1U);
      return;
    }
    if (field.kind == float_type && field.bits == 16)
      return append<std::uint16_t>(bytes, std::get<std::vector<float>>(values), &float_of_half);
    std::visit(
        [&](auto& same) {
          using T = typename std::remove_reference_t<decltype(same)>::value_type;
          append<T>(bytes, same, [](T value) { return value; });
        },
        values);
  }

  void read_text(const ArrowField& field) {
    skip_validity();
    std::string unpacked_offsets, unpacked_text;
    const std::size_t width = field.bits / 8;
    const std::uint64_t size = rows_ == 0 ? 0 : bytes_of(std::uint64_t{rows_} + 1, field.bits);
    const FlatBytes offsets(buffer(field, size, unpacked_offsets), batch_);
    const FlatBytes text(buffer(field, 0, unpacked_text), batch_ + ": column '" + field.name + "'");
    const auto offset = [&](std::size_t i) -> std::uint64_t {
      return width == 4 ? offsets.number<std::uint32_t>(i * width)
                        : offsets.number<std::uint64_t>(i * width);
    };
    std::vector<std::string>& values = table_.texts.at(field.name);
    for (std::size_t i = 0; i < rows_; ++i) {
      if (offset(i + 1) < offset(i)) throw text.error("is damaged: its texts overlap");
      values.emplace_back(text.part(offset(i), offset(i + 1) - offset(i)));
    }
  }

  std::string path_;
  std::string_view bytes_;
  std::vector<ArrowField> fields_;
  ArrowTable table_;
  std::uint64_t end_ = 0;  ///< of the previous batch
  // Of the batch that is read
  std::string batch_;
  std::string_view body_, nodes_, buffers_, packing_;
  std::size_t rows_ = 0, next_buffer_ = 0;
  std::uint64_t body_end_ = 0;
};

}  // namespace

ArrowTable read_arrow_file(const std::filesystem::path& path) {
  return arrow_table_of(path, read_file(path));
}

ArrowTable arrow_table_of(const std::filesystem::path& path, std::string_view bytes) {
  return ArrowReader(path.string(), bytes).read();
}

}  // namespace adasplats
