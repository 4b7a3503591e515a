// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "adasplats/io/base/point_files.h"
#include "adasplats/io/las/las_header.h"
#include "adasplats/io/las/las_table.h"
#include "adasplats/io/las/las_vlrs.h"
#include "adasplats/io/las/laz.h"

namespace adasplats {
namespace {

constexpr std::size_t kLasChunkBytes = std::size_t{128} << 10;

/// How many records to read: all that the header says, or with `salvage` those that are there.
std::uint64_t records_to_read(const InputFile& file, const LasHeader& header, bool salvage) {
  const std::uint64_t room = file.remaining() / header.record_bytes;
  if (header.points <= room) return header.points;
  if (salvage) return room;
  throw file.error_here("found room for " + std::to_string(room) + " point records of " +
                        std::to_string(header.record_bytes) + " bytes, the header says " +
                        std::to_string(header.points) + " (salvage reads what is there)");
}

}  // namespace

Table read_las(const std::filesystem::path& path, const LasReadOptions& options) {
  InputFile file(path);
  const LasHeader header = read_las_header(file);
  if (header.is_compressed) return read_laz(path, options);
  require_no_levels(path, options.selection);
  file.skip(header.points_offset_bytes);
  const auto rows = static_cast<std::size_t>(records_to_read(file, header, options.salvage));
  LasTable table(path, header, options.selection.extent, rows);
  const std::size_t chunk_rows = std::max<std::size_t>(1, kLasChunkBytes / header.record_bytes);
  while (table.records() < rows) {
    const std::size_t count = std::min(chunk_rows, rows - table.records());
    table.take(file.peek(count * header.record_bytes).data(), count);
    file.skip(count * header.record_bytes);
  }
  return table.finish();
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
  facts.crs = read_las_description(path, header).crs;
  return facts;
}

}  // namespace adasplats
