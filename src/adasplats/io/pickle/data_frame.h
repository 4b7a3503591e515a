// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "adasplats/io/base/table.h"

namespace adasplats {

/// The numbers of a pandas data frame in a pickle, gzipped (.pkl.gz) or not, the format of
/// PandaSet's scans: as written by pandas 0.23 to 2, and by pickled_data_frame(). Nothing in the
/// file is executed. Columns of texts and other objects are left out, and so is the index. Memory:
/// 2x the decompressed size, which is at most 1 GiB, and that of PickledValues. Errors: no_input,
/// io, data.
Table read_data_frame(const std::filesystem::path& path);

/// The same for the bytes of a pickle; `path` is for messages.
Table data_frame_of(const std::filesystem::path& path, std::string pickle);

/// A data frame with its columns of objects by name: texts, and empty texts for other objects
/// (None, NaN).
struct FrameTable {
  Table numbers;
  std::map<std::string, std::vector<std::string>, std::less<>> texts;
};

/// Same as read_data_frame() and data_frame_of(), with texts: at most 64 MiB.
FrameTable read_frame_table(const std::filesystem::path& path);
FrameTable frame_table_of(const std::filesystem::path& path, std::string pickle);

/// A column of a data frame: float64, int64, bool (0 or 1) or text, with a value for each row.
struct FrameColumn {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<bool>,
               std::vector<std::string>>
      values;
};

/// A pickle, protocol 3, of a pandas.DataFrame with these columns and the rows 0, 1, ... It calls
/// pandas.DataFrame and numpy.frombuffer by their public names and does not depend on their
/// internals: any pandas of Python 3 reads it. Opcodes: "pickletools.py" of Python.
/// Throws std::logic_error for columns of unequal length.
std::string pickled_data_frame(std::span<const FrameColumn> columns);

}  // namespace adasplats
