// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/table.h"
#include "adasplats/io/las/las_header.h"
#include "adasplats/io/laz/laz_item.h"

namespace adasplats {

/// Position and size of a chunk of compressed points.
struct LazChunk {
  std::uint64_t offset_bytes = 0;  ///< in the file
  std::uint64_t bytes = 0;
  std::uint64_t points = 0;
  std::uint64_t first_record = 0;  ///< number of its first point in the file
};

/// Layout of a LAZ file, checked as far as possible without decompressing points.
struct LazLayout {
  LasHeader header;
  LazPacking packing;
  std::uint64_t first_chunk_bytes = 0;  ///< its offset in the file
  /// False: a chunk begins where decompression of the previous one ends.
  bool has_table = false;
  std::vector<LazChunk> chunks;    ///< of a file that has a table
  std::optional<RecordSpan> span;  ///< of the records to read; nothing: all of the chunks
};

/// Reads the header, LASzip's record and the chunk table. With `salvage` a damaged table of chunks
/// with a fixed number of points is ignored. Errors: data.
LazLayout read_laz_layout(const std::filesystem::path& path, bool salvage);

/// Finds LASzip's record among the variable length records of a LAZ file, and checks that it
/// describes items of the header's point format in known versions. `file` is at its beginning.
/// Errors: data.
LazPacking read_laz_packing(InputFile& file, const LasHeader& header);

}  // namespace adasplats
