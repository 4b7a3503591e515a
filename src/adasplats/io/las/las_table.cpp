// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las_table.h"

#include <cstring>
#include <string>
#include <utility>
#include <variant>

#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

template <class T>
T field(const std::byte* record, std::size_t offset) {
  T value;
  std::memcpy(&value, record + offset, sizeof(T));
  return value;
}

/// One record (tables 7 to 17 of the specification); `record` has the format's least bytes.
LasPoint decode_point(const LasHeader& header, const LasFormat& format, const std::byte* record) {
  LasPoint point;
  point.position = header.position(field<std::int32_t>(record, 0), field<std::int32_t>(record, 4),
                                   field<std::int32_t>(record, 8));
  point.intensity = field<std::uint16_t>(record, 12);
  const auto returns = field<std::uint8_t>(record, 14);
  if (format.is_extended) {
    point.return_number = returns & 0x0f;
    point.number_of_returns = static_cast<std::uint8_t>(returns >> 4);
    point.is_withheld = (field<std::uint8_t>(record, 15) & kLasExtendedWithheld) != 0;
    point.classification = field<std::uint8_t>(record, 16);
    point.user_data = field<std::uint8_t>(record, 17);
    point.point_source_id = field<std::uint16_t>(record, 20);
  } else {
    point.return_number = returns & 0x07;
    point.number_of_returns = static_cast<std::uint8_t>((returns >> 3) & 0x07);
    // The upper three bits are flags (synthetic, key point, withheld).
    constexpr unsigned kWithheld = 1U << 7;
    const auto classification = field<std::uint8_t>(record, 15);
    point.is_withheld = (classification & kWithheld) != 0;
    point.classification = classification & 0x1f;
    point.user_data = field<std::uint8_t>(record, 17);
    point.point_source_id = field<std::uint16_t>(record, 18);
  }
  if (format.gps_time_offset != 0) point.gps_time = field<double>(record, format.gps_time_offset);
  if (format.colour_offset != 0) {
    point.red = field<std::uint16_t>(record, format.colour_offset);
    point.green = field<std::uint16_t>(record, format.colour_offset + 2);
    point.blue = field<std::uint16_t>(record, format.colour_offset + 4);
  }
  return point;
}

Column scaled(const LasExtraField& field, const Column& stored) {
  std::vector<double> values(stored.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = field.scale * stored.as_double(i) + field.offset;
  return {field.name, std::move(values)};
}

}  // namespace

LasTable::LasTable(const std::filesystem::path& path, const LasHeader& header,
                   std::size_t expected_rows)
    : header_(header),
      description_(read_las_description(path, header)),
      columns_(las_format(header.format), expected_rows) {
  for (const LasExtraField& field : description_.extra_fields) {
    extra_columns_.push_back(make_column(field.name, field.type, 0));
    std::visit([=](auto& values) { values.reserve(expected_rows); }, extra_columns_.back().values);
  }
}

void LasTable::take(const std::byte* records, std::size_t count) {
  const std::size_t first = rows();
  const LasFormat& format = las_format(header_.format);
  for (std::size_t row = 0; row < count; ++row)
    columns_.push(decode_point(header_, format, records + row * header_.record_bytes));
  take_extra_fields(records, first, count);
}

void LasTable::take_extra_fields(const std::byte* records, std::size_t first, std::size_t count) {
  for (std::size_t k = 0; k < extra_columns_.size(); ++k) {
    const LasExtraField& field = description_.extra_fields[k];
    std::visit([=](auto& values) { values.resize(first + count); }, extra_columns_[k].values);
    const std::size_t bytes = type_bytes(field.type);
    gather_values(records + field.offset_bytes, header_.record_bytes, bytes, false, count,
                  column_bytes(extra_columns_[k]) + first * bytes);
  }
}

void LasTable::append_extra_fields(Table& table) {
  for (std::size_t k = 0; k < extra_columns_.size(); ++k) {
    const LasExtraField& field = description_.extra_fields[k];
    table.columns.push_back(field.is_scaled ? scaled(field, extra_columns_[k])
                                            : std::move(extra_columns_[k]));
  }
}

Table LasTable::finish() {
  const std::size_t found = rows();
  Table table = columns_.take();
  append_extra_fields(table);
  columns_.drop_withheld(table);
  for (std::string& comment : description_.comments()) table.comments.push_back(std::move(comment));
  table.crs = description_.crs;
  if (found < header_.points) {
    table.comments.push_back("salvaged " + std::to_string(found) + " of " +
                             std::to_string(header_.points) + " records");
  }
  return table;
}

}  // namespace adasplats
