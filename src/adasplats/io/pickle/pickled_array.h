// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "adasplats/io/base/table.h"
#include "adasplats/io/pickle/pickle_values.h"

namespace adasplats {

/// An array of NumPy in a pickle: one dimension, or two of `lines` rows.
struct PickledArray {
  bool is_objects = false;                          ///< texts, say: no numbers
  const std::vector<PickleRef>* objects = nullptr;  ///< of those, where the pickle has them
  ColumnType type = ColumnType::u8;                 ///< of numbers; bool is u8
  std::string_view bytes;                           ///< of numbers, little-endian
  std::size_t lines = 1, length = 0;
  bool by_columns = false;  ///< a line's values are not side by side (Fortran's order)

  /// What a line of numbers takes.
  std::size_t bytes_of_line() const { return lines == 0 ? 0 : bytes.size() / lines; }
  /// A line of numbers as a column. `line` is below `lines`.
  Column column(std::string_view name, std::size_t line) const;
};

/// The array that `value` is: _reconstruct with a state, _frombuffer, or frombuffer. Errors: data
/// (no array, a type that is none of bool, integers and floats of little-endian order, sizes that
/// do not fit).
PickledArray pickled_array(const PickledValues& pickle, const PickleValue& value);

/// The name of what an object was made by; empty for what is no object.
std::string_view made_by(const PickledValues& pickle, const PickleValue& value);

/// An argument of an object, or nothing where it has not as many.
const PickleValue* argument_of(const PickledValues& pickle, const PickleValue& object,
                               std::size_t index);

/// The state that an object was given, or nothing.
const PickleValue* state_of(const PickledValues& pickle, const PickleValue& object);

}  // namespace adasplats
