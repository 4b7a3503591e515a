// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/base/table.h"

namespace adasplats {

/// The columns of an Arrow file: numbers in `numbers` (booleans as 0 and 1, float16 as float), text
/// by name.
struct ArrowTable {
  Table numbers;
  std::map<std::string, std::vector<std::string>> texts;
};

/// Reads an Arrow IPC file, which is Feather version 2 ("Arrow Columnar Format", sections IPC File
/// Format and Recordbatch body compression; flatbuffers File.fbs, Message.fbs, Schema.fbs): all
/// record batches, plain or compressed with LZ4 or Zstandard. Memory: the file and its columns.
/// Errors: no_input, io, unavailable (a compression that the program was built without), data
/// (damage; Feather version 1; types other than integers, floats, booleans and text; null values).
ArrowTable read_arrow_file(const std::filesystem::path& path);

/// The same for the bytes of a file; `path` is for messages.
ArrowTable arrow_table_of(const std::filesystem::path& path, std::string_view bytes);

}  // namespace adasplats
