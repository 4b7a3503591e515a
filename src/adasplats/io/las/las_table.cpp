// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las_table.h"

#include <algorithm>
#include <string>
#include <utility>

#include "adasplats/core/executor.h"
#include "adasplats/io/base/records.h"

namespace adasplats {

LasTable::LasTable(const std::filesystem::path& path, const LasHeader& header,
                   const LasReadOptions& options, std::size_t expected_rows)
    : schema_{header, read_las_description(path, header), options.selection.extent,
              options.all_fields},
      columns_(schema_) {
  if (!options.selection.extent) columns_.reserve(expected_rows);
}

void LasTable::take(const std::byte* records, std::size_t count) {
  buffer_.assign(records, records + count * schema_.header.record_bytes);
  const WantedRecords part = {buffer_.data(), count, keep_wanted(schema_, buffer_.data(), count)};
  add({&part, 1}, nullptr);
}

void LasTable::add(std::span<const WantedRecords> parts, const Executor* executor) {
  std::vector<std::size_t> first(1, columns_.rows());
  for (const WantedRecords& part : parts) {
    first.push_back(first.back() + part.kept.rows);
    records_ += part.count;
    withheld_ += part.kept.withheld;
  }
  columns_.add_rows(first.back() - first.front(), executor);
  const auto fill = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      columns_.fill(first[k], parts[k].records, parts[k].kept.rows);
  };
  if (executor != nullptr)
    executor->for_chunks(parts.size(), 1, fill);
  else
    fill(0, parts.size());
}

void LasTable::note_unread(std::vector<ReaderNote>& notes) const {
  const LasFormat& format = las_format(schema_.header.format);
  std::size_t unread = schema_.header.record_bytes - format.min_bytes;
  for (const LasExtraField& field : schema_.description.extra_fields)
    unread -= std::min(unread, type_bytes(field.type));
  if (unread > 0)
    notes.push_back({NoteKind::left_out, std::to_string(unread) +
                                             " extra bytes of each point that are not described, "
                                             "or are arrays"});
  if (format.has_waves) notes.push_back({NoteKind::left_out, "the waveforms"});
}

Table LasTable::finish() {
  Table table = columns_.take_table();
  if (withheld_ > 0)
    table.notes.push_back({NoteKind::withheld, std::to_string(withheld_) + " of " +
                                                   std::to_string(records()) + " points"});
  schema_.description.add_notes(table.notes);
  table.crs = schema_.description.crs;
  if (schema_.all_fields) note_unread(table.notes);
  if (records() < schema_.header.points)
    table.notes.push_back(
        {NoteKind::salvaged,
         std::to_string(records()) + " of " + std::to_string(schema_.header.points) + " records"});
  return table;
}

}  // namespace adasplats
