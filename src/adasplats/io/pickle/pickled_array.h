// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "adasplats/io/base/table.h"
#include "adasplats/io/pickle/pickle_values.h"

namespace adasplats {

/// A NumPy array in a pickle, of one dimension, or of two with `lines` rows.
struct PickledArray {
  bool is_objects = false;                          ///< e.g. texts, not numbers
  const std::vector<PickleRef>* objects = nullptr;  ///< the objects, if the pickle has them
  ColumnType type = ColumnType::u8;                 ///< of numbers; bool is u8
  std::string_view bytes;                           ///< of numbers, little-endian
  std::size_t lines = 1, length = 0;
  bool by_columns = false;  ///< Fortran order: the values of a line are not adjacent

  /// Index of a value of a line. `line` is below `lines`, `i` below `length`.
  std::size_t index_of(std::size_t line, std::size_t i) const {
    return by_columns ? line + i * lines : line * length + i;
  }
  /// Size of a line of numbers.
  std::size_t bytes_of_line() const { return lines == 0 ? 0 : bytes.size() / lines; }
  /// A line of numbers as a column. `line` is below `lines`.
  Column column(std::string_view name, std::size_t line) const;
};

/// The array of `value`: _reconstruct with a state, _frombuffer, or frombuffer. Errors: data (not
/// an array, a type other than bool and little-endian integers and floats, inconsistent sizes).
PickledArray pickled_array(const PickledValues& pickle, const PickleValue& value);

/// The name of the global that made an object; empty for other values.
std::string_view made_by(const PickledValues& pickle, const PickleValue& value);

/// An argument of an object; null if it has fewer.
const PickleValue* argument_of(const PickledValues& pickle, const PickleValue& object,
                               std::size_t index);

/// The state of an object; null if it has none.
const PickleValue* state_of(const PickledValues& pickle, const PickleValue& object);

}  // namespace adasplats
