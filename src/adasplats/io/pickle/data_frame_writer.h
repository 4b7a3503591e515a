// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace adasplats {

/// A column of a data frame: float64, int64, bool (0 or 1) or text. All have a value a row.
struct FrameColumn {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<bool>,
               std::vector<std::string>>
      values;
};

/// A pickle, protocol 3, of a pandas.DataFrame with these columns and the rows 0, 1, ... It calls
/// pandas.DataFrame and numpy.frombuffer by their public names, and knows nothing of how a version
/// of either is made inside: any pandas of Python 3 reads it. Opcodes: "pickletools.py" of Python.
/// Throws std::logic_error for columns of unequal length.
std::string pickled_data_frame(std::span<const FrameColumn> columns);

}  // namespace adasplats
