// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/extent.h"
#include "adasplats/io/base/records.h"
#include "adasplats/io/las/copc.h"
#include "adasplats/io/las/las.h"
#include "adasplats/io/las/las_columns.h"
#include "adasplats/io/las/las_table.h"
#include "adasplats/io/las/laz_layout.h"
#include "adasplats/io/laz/packed_chunk.h"

namespace adasplats {
namespace {

// Decompressed records of one chunk at a time: all of an ordinary chunk (50,000 points).
constexpr std::size_t kUnpackedBytes = std::size_t{4} << 20;
// Models of all chunks in work; at most one model for each byte of a record.
constexpr std::size_t kModelBytes = std::size_t{256} << 20;
constexpr std::size_t kBytesPerModel = 2560;

/// Counts the leading records within the enlarged box of the header: damaged data decode to random
/// points. A box of zeros was never set.
class PlausibleRecords {
 public:
  explicit PlausibleRecords(const LasHeader& header)
      : header_(header),
        has_box_(!(header.box_min == Vec3d{} && header.box_max == Vec3d{})),
        box_{header.plausible_low(), header.plausible_high()} {}

  std::size_t count(const std::byte* records, std::size_t limit) const {
    if (!has_box_) return limit;
    for (std::size_t row = 0; row < limit; ++row)
      if (!contains(records + row * header_.record_bytes)) return row;
    return limit;
  }

 private:
  bool contains(const std::byte* record) const {
    return box_.contains(header_.position(load_value<std::int32_t>(record),
                                          load_value<std::int32_t>(record + 4),
                                          load_value<std::int32_t>(record + 8)));
  }

  const LasHeader& header_;
  bool has_box_;
  Extent box_;
};

/// A chunk in work.
struct OpenChunk {
  LazChunk place;
  std::vector<std::byte> packed;
  std::unique_ptr<PackedChunk> decoder;
  std::uint64_t left = 0;             // points still compressed
  std::uint64_t next_record = 0;      // number of the next one
  std::vector<std::byte> records;     // the next ones, decompressed
  std::size_t wanted = 0, sound = 0;  // expected and valid leading ones
  std::size_t taken = 0;              // valid ones within the span, in front
  bool is_cut_short = false;          // the compressed bytes end too early
  KeptRecords kept;                   // of the records
};

/// Reads the records in order; decompresses several chunks in parallel.
class LazReader {
 public:
  LazReader(const std::filesystem::path& path, const LazLayout& layout, const Executor* executor,
            LasTable& table)
      : table_(table),
        layout_(layout),
        executor_(executor),
        file_(path),
        plausible_(layout.header),
        rows_at_once_(std::max<std::size_t>(1, kUnpackedBytes / layout.header.record_bytes)),
        unread_(layout.header.points),
        next_offset_(layout.first_chunk_bytes) {
    if (!layout.has_table || executor == nullptr) return;
    const std::size_t affordable = kModelBytes / (kBytesPerModel * layout.header.record_bytes);
    max_open_ = std::clamp<std::size_t>(2 * static_cast<std::size_t>(executor->threads()), 1,
                                        std::max<std::size_t>(1, affordable));
  }

  /// Passes all records to the table, up to the first fault.
  void read() {
    while (fault_.empty() && (unread_ > 0 || !open_.empty())) {
      while (unread_ > 0 && open_.size() < max_open_) open_next();
      unpack();
      hand_over();
    }
  }

  /// The reason why records are missing; empty if none are.
  const std::string& fault() const { return fault_; }

 private:
  LazChunk next_place() const {
    if (layout_.has_table) return layout_.chunks[next_chunk_];
    LazChunk place{next_offset_, file_.size_bytes() - next_offset_,
                   std::min<std::uint64_t>(unread_, layout_.packing.chunk_points)};
    if (layout_.packing.chunk_points == kVariableChunks) place.points = unread_;
    // Compressed points are hardly ever larger than uncompressed ones.
    const std::uint64_t largest =
        (std::uint64_t{1} << 16) + 2 * place.points * layout_.packing.record_bytes;
    if (place.points < (std::uint64_t{1} << 32)) place.bytes = std::min(place.bytes, largest);
    return place;
  }

  void open_next() {
    OpenChunk& chunk = open_.emplace_back();
    chunk.place = next_place();
    ++next_chunk_;
    file_.skip(chunk.place.offset_bytes - file_.offset());
    const auto bytes = static_cast<std::size_t>(chunk.place.bytes);
    const std::span<const std::byte> packed = file_.peek(bytes).first(bytes);
    chunk.packed.assign(packed.begin(), packed.end());
    chunk.decoder = make_packed_chunk(layout_.packing, chunk.packed);
    chunk.left = chunk.place.points;
    chunk.next_record = chunk.place.first_record;
    unread_ -= chunk.left;
  }

  /// Decompresses the next records of open chunks that have none.
  void unpack() {
    const auto unpack_one = [this](std::size_t k, std::size_t) {
      OpenChunk& chunk = open_[k];
      if (chunk.wanted > 0) return;
      chunk.wanted = static_cast<std::size_t>(std::min<std::uint64_t>(chunk.left, rows_at_once_));
      chunk.records.resize(chunk.wanted * layout_.packing.record_bytes);
      const std::size_t whole = chunk.decoder->decode(chunk.records.data(), chunk.wanted);
      chunk.sound = plausible_.count(chunk.records.data(), whole);
      chunk.left -= chunk.wanted;
      if (chunk.sound < chunk.wanted) chunk.is_cut_short = whole < chunk.wanted;
      take_span(chunk);
      chunk.kept = keep_wanted(table_.schema(), chunk.records.data(), chunk.taken);
    };
    if (executor_ != nullptr)
      executor_->for_chunks(open_.size(), 1, unpack_one);
    else
      for (std::size_t k = 0; k < open_.size(); ++k) unpack_one(k, k + 1);
  }

  /// Moves the valid records within the span to the front.
  void take_span(OpenChunk& chunk) const {
    const std::uint64_t begin = chunk.next_record, end = begin + chunk.sound;
    chunk.next_record += chunk.wanted;
    chunk.taken = chunk.sound;
    if (!layout_.span) return;
    const std::uint64_t first = std::clamp(layout_.span->first, begin, end);
    const std::uint64_t last = std::clamp(layout_.span->first + layout_.span->count, first, end);
    chunk.taken = static_cast<std::size_t>(last - first);
    const std::size_t bytes = layout_.packing.record_bytes;
    if (first > begin)
      std::memmove(chunk.records.data(),
                   chunk.records.data() + static_cast<std::size_t>(first - begin) * bytes,
                   chunk.taken * bytes);
  }

  /// Passes on the decompressed records up to the first gap.
  void hand_over() {
    std::vector<WantedRecords> parts;
    for (const OpenChunk& chunk : open_) {
      if (chunk.wanted == 0 || !fault_.empty()) break;
      parts.push_back({chunk.records.data(), chunk.taken, chunk.kept});
      if (chunk.sound < chunk.wanted)
        fault_ = "the chunk at byte " + std::to_string(chunk.place.offset_bytes) +
                 (chunk.is_cut_short ? " ends within a point"
                                     : " has a point far outside the header's box");
      if (chunk.left > 0) break;  // its next records precede those of later chunks
    }
    table_.add(parts, executor_);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      OpenChunk& chunk = open_.front();
      chunk.wanted = 0;
      if (chunk.left > 0) return;
      next_offset_ = chunk.place.offset_bytes + chunk.decoder->bytes();
      open_.pop_front();
    }
  }

  LasTable& table_;
  const LazLayout& layout_;
  const Executor* executor_;
  InputFile file_;
  PlausibleRecords plausible_;
  std::size_t rows_at_once_;
  std::size_t max_open_ = 1;
  std::deque<OpenChunk> open_;
  std::uint64_t unread_;  // points of chunks that are not yet open
  std::size_t next_chunk_ = 0;
  std::uint64_t next_offset_;  // of the next chunk, without a table
  std::string fault_;
};

/// Keeps only the chunks with points of a span; returns the number of their points in it.
std::uint64_t choose_span(RecordSpan span, LazLayout& layout) {
  if (!layout.has_table)
    throw std::logic_error("read_laz: records of a file without random access");
  std::uint64_t wanted = 0;
  const auto is_outside = [&](const LazChunk& chunk) {
    const std::uint64_t begin = std::max(span.first, chunk.first_record);
    const std::uint64_t end = std::min(span.first + span.count, chunk.first_record + chunk.points);
    wanted += begin < end ? end - begin : 0;
    return begin >= end;
  };
  std::erase_if(layout.chunks, is_outside);
  layout.span = span;
  layout.header.points = 0;
  for (const LazChunk& chunk : layout.chunks) layout.header.points += chunk.points;
  return wanted;
}

}  // namespace

Table read_laz(const std::filesystem::path& path, const LasReadOptions& options) {
  LazLayout layout = read_laz_layout(path, options.salvage);
  const std::uint64_t all = layout.header.points;
  choose_chunks(path, options.selection, layout);
  std::uint64_t points = layout.header.points;
  if (options.selection.records && points > 0)
    points = choose_span(options.selection.records->within(all), layout);
  LasHeader header = layout.header;
  header.points = points;
  // The count is not trusted before the points are read; a point of a sensor takes at least two
  // bytes.
  InputFile file(path);
  LasTable table(path, header, options,
                 static_cast<std::size_t>(std::min(points, file.size_bytes() / 2)));
  LazReader reader(path, layout, options.executor, table);
  reader.read();
  if (!reader.fault().empty() && !options.salvage) {
    throw data_error({path, {}, {}}, "damaged LAZ at point " + std::to_string(table.records()) +
                                         " of " + std::to_string(points) + ": " + reader.fault());
  }
  return table.finish();
}

}  // namespace adasplats
