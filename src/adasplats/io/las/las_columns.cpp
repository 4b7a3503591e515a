// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las_columns.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "adasplats/core/executor.h"
#include "adasplats/core/memory.h"
#include "adasplats/io/base/records.h"
#include "adasplats/io/las/las_header.h"

namespace adasplats {
namespace {

// Fields of all formats, and of formats 0 to 5 or 6 to 10 (tables 7 to 17 of the specification).
constexpr std::size_t kIntensityAt = 12, kReturnsAt = 14, kUserDataAt = 17;
constexpr std::size_t kClassAt = 15, kSourceAt = 18;
constexpr std::size_t kExtendedFlagsAt = 15, kExtendedClassAt = 16, kExtendedSourceAt = 20;
// In formats 0 to 5 the upper three bits of the class are flags (synthetic, key point, withheld).
constexpr unsigned kWithheld = 1U << 7, kClassBits = 0x1f;

constexpr std::size_t kAngleAt = 16, kExtendedAngleAt = 18, kInfraredAt = 36;
constexpr float kExtendedAngleStep_deg = 0.006F;

/// Bits of a byte.
struct BitsOfByte {
  const char* name;
  std::size_t offset;
  unsigned shift, mask;
};
constexpr std::array<BitsOfByte, 4> kFlags = {{{"synthetic", kClassAt, 5, 1},
                                               {"key_point", kClassAt, 6, 1},
                                               {"scan_direction_flag", kReturnsAt, 6, 1},
                                               {"edge_of_flight_line", kReturnsAt, 7, 1}}};
constexpr std::array<BitsOfByte, 6> kExtendedFlags = {
    {{"synthetic", kExtendedFlagsAt, 0, 1},
     {"key_point", kExtendedFlagsAt, 1, 1},
     {"overlap", kExtendedFlagsAt, 3, 1},
     {"scanner_channel", kExtendedFlagsAt, 4, 3},
     {"scan_direction_flag", kExtendedFlagsAt, 6, 1},
     {"edge_of_flight_line", kExtendedFlagsAt, 7, 1}}};

std::span<const BitsOfByte> flags_of(const LasFormat& format) {
  return format.is_extended ? std::span<const BitsOfByte>(kExtendedFlags) : kFlags;
}

bool has_infrared(const LasFormat& format) {
  return format.is_extended && format.colour_offset != 0 &&
         format.min_bytes >= kInfraredAt + sizeof(std::uint16_t);
}

bool is_zero(const Column& column) {
  return std::visit(
      [](const auto& values) {
        return std::ranges::all_of(values, [](auto value) { return value == 0; });
      },
      column.values);
}

std::int32_t step_of(const std::byte* record, int axis) {
  return load_value<std::int32_t>(record + 4 * static_cast<std::size_t>(axis));
}

/// Sets the values of rows from `first` on, from records that are `stride` bytes apart.
template <class Get>
void set_values(Column& column, std::size_t first, const std::byte* records, std::size_t stride,
                std::size_t count, Get get) {
  using T = decltype(get(records));
  T* const to = std::get<std::vector<T>>(column.values).data() + first;
  for (std::size_t row = 0; row < count; ++row) to[row] = get(records + row * stride);
}

template <class T>
auto field_at(std::size_t offset) {
  return [offset](const std::byte* record) { return load_value<T>(record + offset); };
}

/// Bits of a byte.
auto bits_at(std::size_t offset, unsigned shift, unsigned mask) {
  return [=](const std::byte* record) {
    return static_cast<std::uint8_t>(std::to_integer<unsigned>(record[offset]) >> shift & mask);
  };
}

Column scaled(const LasExtraField& field, const Column& stored) {
  std::vector<double> values(stored.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = field.scale * stored.as_double(i) + field.offset;
  return {field.name, std::move(values)};
}

}  // namespace

KeptRecords keep_wanted(const LasSchema& schema, std::byte* records, std::size_t count) {
  const LasHeader& header = schema.header;
  const std::size_t bytes = header.record_bytes;
  const bool is_extended = las_format(header.format).is_extended;
  const std::size_t flags_at = is_extended ? kExtendedFlagsAt : kClassAt;
  const unsigned withheld = is_extended ? kLasExtendedWithheld : kWithheld;
  KeptRecords kept;
  for (std::size_t row = 0; row < count; ++row) {
    std::byte* const record = records + row * bytes;
    if (schema.extent && !schema.extent->contains(header.position(
                             step_of(record, 0), step_of(record, 1), step_of(record, 2))))
      continue;
    if ((std::to_integer<unsigned>(record[flags_at]) & withheld) != 0) {
      ++kept.withheld;
      continue;
    }
    if (kept.rows != row) std::memcpy(records + kept.rows * bytes, record, bytes);
    ++kept.rows;
  }
  return kept;
}

LasColumns::LasColumns(const LasSchema& schema) : schema_(schema) {
  const LasFormat& format = las_format(schema.header.format);
  const auto add = [this](const char* name, ColumnType type) {
    columns_.push_back(make_column(name, type, 0));
  };
  for (const char* const name : {"x", "y", "z"}) add(name, ColumnType::f64);
  add("intensity", ColumnType::u16);
  for (const char* const name : {"classification", "return_number", "number_of_returns"})
    add(name, ColumnType::u8);
  if (format.gps_time_offset != 0) add("gps_time", ColumnType::f64);
  if (format.colour_offset != 0)
    for (const char* const name : {"red", "green", "blue"}) add(name, ColumnType::u16);
  add("point_source_id", ColumnType::u16);
  add("user_data", ColumnType::u8);
  first_rare_ = columns_.size();
  if (schema.all_fields) {
    add("scan_angle", ColumnType::f32);
    for (const BitsOfByte& flag : flags_of(format)) add(flag.name, ColumnType::u8);
    if (has_infrared(format)) add("nir", ColumnType::u16);
  }
  for (const LasExtraField& field : schema.description.extra_fields)
    columns_.push_back(make_column(field.name, field.type, 0));
}

void LasColumns::reserve(std::size_t rows) {
  for (Column& column : columns_)
    std::visit(
        [rows](auto& values) {
          values.reserve(rows);
          prefer_large_pages(values.data(), values.capacity() * sizeof(values[0]));
        },
        column.values);
}

void LasColumns::add_rows(std::size_t rows, const Executor* executor) {
  const auto add = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      std::visit([rows](auto& values) { values.resize(values.size() + rows); }, columns_[k].values);
  };
  // Most of the time goes into page faults.
  if (executor != nullptr)
    executor->for_chunks(columns_.size(), 1, add);
  else
    add(0, columns_.size());
}

void LasColumns::fill(std::size_t first, const std::byte* records, std::size_t count) {
  // Every column reads the records again: a block fits into the cache.
  constexpr std::size_t kBlockRows = 1024;
  for (std::size_t row = 0; row < count; row += kBlockRows)
    fill_block(first + row, records + row * schema_.header.record_bytes,
               std::min(kBlockRows, count - row));
}

void LasColumns::fill_block(std::size_t first, const std::byte* records, std::size_t count) {
  const LasHeader& header = schema_.header;
  const LasFormat& format = las_format(header.format);
  const bool is_extended = format.is_extended;
  auto column = columns_.begin();
  const auto add = [&](auto get) {
    set_values(*column++, first, records, header.record_bytes, count, get);
  };
  for (int axis = 0; axis < 3; ++axis)
    add([=, scale = header.scale[axis], offset = header.offset[axis]](const std::byte* record) {
      return step_of(record, axis) * scale + offset;
    });
  add(field_at<std::uint16_t>(kIntensityAt));
  if (is_extended)
    add(field_at<std::uint8_t>(kExtendedClassAt));
  else
    add(bits_at(kClassAt, 0, kClassBits));
  add(bits_at(kReturnsAt, 0, is_extended ? 0x0f : 0x07));
  add(is_extended ? bits_at(kReturnsAt, 4, 0x0f) : bits_at(kReturnsAt, 3, 0x07));
  if (format.gps_time_offset != 0) add(field_at<double>(format.gps_time_offset));
  if (format.colour_offset != 0)
    for (const std::size_t colour : {0U, 2U, 4U})
      add(field_at<std::uint16_t>(format.colour_offset + colour));
  add(field_at<std::uint16_t>(is_extended ? kExtendedSourceAt : kSourceAt));
  add(field_at<std::uint8_t>(kUserDataAt));
  if (schema_.all_fields) {
    if (is_extended)
      add([](const std::byte* record) {
        return kExtendedAngleStep_deg *
               static_cast<float>(load_value<std::int16_t>(record + kExtendedAngleAt));
      });
    else
      add([](const std::byte* record) {
        return static_cast<float>(load_value<std::int8_t>(record + kAngleAt));
      });
    for (const BitsOfByte& flag : flags_of(format))
      add(bits_at(flag.offset, flag.shift, flag.mask));
    if (has_infrared(format)) add(field_at<std::uint16_t>(kInfraredAt));
  }
  for (const LasExtraField& field : schema_.description.extra_fields)
    std::visit(
        [&](auto& values) {
          using T = typename std::decay_t<decltype(values)>::value_type;
          add(field_at<T>(field.offset_bytes));
        },
        column->values);
}

Table LasColumns::take_table() {
  Table table;
  table.rows = rows();
  const auto& extras = schema_.description.extra_fields;
  const std::size_t standard = columns_.size() - extras.size();
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    if (k >= first_rare_ && k < standard && is_zero(columns_[k])) continue;
    const bool is_scaled = k >= standard && extras[k - standard].is_scaled;
    table.columns.push_back(is_scaled ? scaled(extras[k - standard], columns_[k])
                                      : std::move(columns_[k]));
  }
  columns_.clear();
  return table;
}

}  // namespace adasplats
