// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las.h"

#include <algorithm>
#include <string>

#include "adasplats/io/base/point_files.h"
#include "adasplats/io/las/las_header.h"
#include "adasplats/io/las/las_table.h"
#include "adasplats/io/las/las_vlrs.h"
#include "adasplats/io/las/laz_layout.h"

namespace adasplats {
namespace {

constexpr std::size_t kLasChunkBytes = std::size_t{128} << 10;

/// The number of records to read: as in the header, or with `salvage` those within the file.
std::uint64_t records_to_read(const InputFile& file, const LasHeader& header, bool salvage) {
  const std::uint64_t room = file.remaining() / header.record_bytes;
  if (header.points <= room) return header.points;
  if (salvage) return room;
  throw file.error_here("the file holds " + std::to_string(room) + " of " +
                        std::to_string(header.points) + " point records of " +
                        std::to_string(header.record_bytes) + " bytes; `salvage` reads them");
}

}  // namespace

Table read_las(const std::filesystem::path& path, const LasReadOptions& options) {
  InputFile file(path);
  LasHeader header = read_las_header(file);
  if (header.is_compressed) return read_laz(path, options);
  require_no_levels(path, options.selection);
  file.skip(header.points_offset_bytes);
  RecordSpan span = {0, records_to_read(file, header, options.salvage)};
  if (options.selection.records) {
    const std::uint64_t all = span.count;
    span = options.selection.records->within(all);
    header.points = options.selection.records->within(header.points).count;
    file.skip(span.first * header.record_bytes);
  }
  const auto rows = static_cast<std::size_t>(span.count);
  LasTable table(path, header, options, rows);
  const std::size_t chunk_rows = std::max<std::size_t>(1, kLasChunkBytes / header.record_bytes);
  while (table.records() < rows) {
    const std::size_t count = std::min(chunk_rows, rows - table.records());
    table.take(file.peek(count * header.record_bytes).data(), count);
    file.skip(count * header.record_bytes);
  }
  return table.finish();
}

std::optional<std::uint64_t> las_records_at_random(const std::filesystem::path& path,
                                                   bool salvage) {
  InputFile file(path);
  const LasHeader header = read_las_header(file);
  if (header.is_compressed) {
    const LazLayout layout = read_laz_layout(path, salvage);
    return layout.has_table ? std::optional(layout.header.points) : std::nullopt;
  }
  file.skip(header.points_offset_bytes);
  return records_to_read(file, header, salvage);
}

LasFacts read_las_facts(const std::filesystem::path& path) {
  InputFile file(path);
  const LasHeader header = read_las_header(file);
  LasFacts facts;
  facts.version = "1." + std::to_string(header.minor_version);
  facts.point_format = header.format;
  facts.points = header.points;
  facts.scale = header.scale;
  facts.offset = header.offset;
  facts.box_min = header.box_min;
  facts.box_max = header.box_max;
  facts.software = header.software;
  LasDescription description = read_las_description(path, header);
  facts.crs = std::move(description.crs);
  facts.labels = std::move(description.labels);
  for (LasExtraField& field : description.extra_fields)
    facts.extra_fields.push_back(std::move(field.name));
  return facts;
}

}  // namespace adasplats
