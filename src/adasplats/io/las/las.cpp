// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/io/base/point_files.h"
#include "adasplats/io/base/records.h"
#include "adasplats/io/las/las_header.h"
#include "adasplats/io/las/las_records.h"
#include "adasplats/io/las/las_vlrs.h"
#include "adasplats/io/las/laz.h"

namespace adasplats {
namespace {

constexpr std::size_t kLasChunkBytes = std::size_t{128} << 10;

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

/// How many records to read: all that the header says, or with `salvage` those that are there.
std::uint64_t records_to_read(const InputFile& file, const LasHeader& header, bool salvage) {
  const std::uint64_t room = file.remaining() / header.record_bytes;
  if (header.points <= room) return header.points;
  if (salvage) return room;
  throw file.error_here("found room for " + std::to_string(room) + " point records of " +
                        std::to_string(header.record_bytes) + " bytes, the header says " +
                        std::to_string(header.points) + " (salvage reads what is there)");
}

/// The columns of what a file describes itself, filled as records come.
class ExtraColumns {
 public:
  ExtraColumns(std::vector<LasExtraField> fields, std::size_t rows) : fields_(std::move(fields)) {
    for (const LasExtraField& field : fields_)
      columns_.push_back(make_column(field.name, field.type, rows));
  }

  void take(const std::byte* records, std::size_t record_bytes, std::size_t first,
            std::size_t count) {
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      const std::size_t bytes = type_bytes(fields_[k].type);
      gather_values(records + fields_[k].offset_bytes, record_bytes, bytes, false, count,
                    column_bytes(columns_[k]) + first * bytes);
    }
  }

  void append_to(Table& table) {
    for (std::size_t k = 0; k < fields_.size(); ++k)
      table.columns.push_back(fields_[k].is_scaled ? scaled(fields_[k], columns_[k])
                                                   : std::move(columns_[k]));
  }

 private:
  static Column scaled(const LasExtraField& field, const Column& stored) {
    std::vector<double> values(stored.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = field.scale * stored.as_double(i) + field.offset;
    return {field.name, std::move(values)};
  }

  std::vector<LasExtraField> fields_;
  std::vector<Column> columns_;
};

}  // namespace

Table read_las(const std::filesystem::path& path, const LasReadOptions& options) {
  InputFile file(path);
  const LasHeader header = read_las_header(file);
  if (header.is_compressed) return read_laz(path, options);
  const LasFormat& format = las_format(header.format);
  file.skip(header.points_offset_bytes);
  const auto rows = static_cast<std::size_t>(records_to_read(file, header, options.salvage));
  LasColumns columns(format, rows);
  LasDescription description = read_las_description(path, header);
  ExtraColumns extras(std::move(description.extra_fields), rows);
  const std::size_t chunk_rows = std::max<std::size_t>(1, kLasChunkBytes / header.record_bytes);
  for (std::size_t first = 0; first < rows; first += chunk_rows) {
    const std::size_t count = std::min(chunk_rows, rows - first);
    const std::byte* const records = file.peek(count * header.record_bytes).data();
    for (std::size_t row = 0; row < count; ++row)
      columns.push(decode_point(header, format, records + row * header.record_bytes));
    extras.take(records, header.record_bytes, first, count);
    file.skip(count * header.record_bytes);
  }
  Table table = columns.take();
  extras.append_to(table);
  columns.drop_withheld(table);
  for (std::string& comment : description.comments()) table.comments.push_back(std::move(comment));
  if (rows < header.points) {
    table.comments.push_back("salvaged " + std::to_string(rows) + " of " +
                             std::to_string(header.points) + " records");
  }
  return table;
}

}  // namespace adasplats
