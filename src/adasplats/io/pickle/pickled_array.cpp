// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/pickle/pickled_array.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

constexpr std::array<std::pair<std::string_view, ColumnType>, 12> kArrayTypes = {
    {{"f8", ColumnType::f64},
     {"f4", ColumnType::f32},
     {"i8", ColumnType::i64},
     {"i4", ColumnType::i32},
     {"i2", ColumnType::i16},
     {"i1", ColumnType::i8},
     {"u8", ColumnType::u64},
     {"u4", ColumnType::u32},
     {"u2", ColumnType::u16},
     {"u1", ColumnType::u8},
     {"b1", ColumnType::u8},
     {"?", ColumnType::u8}}};

Error array_fault(const PickledValues& pickle, const std::string& what) {
  return {ErrorKind::data, pickle.file().string() + ": " + what};
}

/// "<f8", "f8", "|b1" or "O8".
void take_type(const PickledValues& pickle, std::string_view word, PickledArray& array) {
  const std::string_view whole = word;
  const bool has_order = !word.empty() && std::string_view("<|=").find(word[0]) != word.npos;
  if (has_order) word.remove_prefix(1);
  array.is_objects = word == "O8" || word == "O";
  if (array.is_objects) return;
  for (const auto& [name, type] : kArrayTypes) {
    if (name != word) continue;
    array.type = type;
    return;
  }
  throw array_fault(pickle, "an array of type " + shown(whole) +
                                ", expected little-endian integers, floats or bool");
}

/// A dtype: a call with its word, and a state with the byte order as its second value.
void take_dtype(const PickledValues& pickle, const PickleValue& dtype, PickledArray& array) {
  const PickleValue* const word = argument_of(pickle, dtype, 0);
  if (made_by(pickle, dtype) != "numpy.dtype" || word == nullptr || word->kind != PickleKind::text)
    throw array_fault(pickle, "expected a type of an array");
  std::string text(word->text);
  const PickleValue* const state = state_of(pickle, dtype);
  const bool has_order = state != nullptr && state->items.size() > 1 &&
                         pickle[state->items[1]].kind == PickleKind::text;
  if (has_order) text = std::string(pickle[state->items[1]].text) + text;
  take_type(pickle, text, array);
}

void take_shape(const PickledValues& pickle, const PickleValue& shape, PickledArray& array) {
  const std::size_t dimensions = shape.items.size();
  bool good = shape.kind == PickleKind::sequence && (dimensions == 1 || dimensions == 2);
  for (std::size_t k = 0; good && k < dimensions; ++k) {
    const PickleValue& size = pickle[shape.items[k]];
    good = size.kind == PickleKind::integer && size.integer >= 0 && size.integer <= INT32_MAX;
    if (!good) break;
    if (dimensions == 2 && k == 0)
      array.lines = static_cast<std::size_t>(size.integer);
    else
      array.length = static_cast<std::size_t>(size.integer);
  }
  if (!good) throw array_fault(pickle, "expected an array of one or two dimensions");
}

/// Numbers as bytes, or a list of objects.
void take_content(const PickledValues& pickle, const PickleValue& content, PickledArray& array) {
  // Both are below 2^31, see take_shape().
  const std::uint64_t count = std::uint64_t{array.lines} * array.length;
  if (array.is_objects) {
    if (content.kind != PickleKind::sequence || content.items.size() != count)
      throw array_fault(pickle,
                        "an array of " + std::to_string(count) + " objects has other content");
    array.objects = &content.items;
    return;
  }
  const std::size_t size = type_bytes(array.type);
  if (content.kind != PickleKind::bytes || content.text.size() % size != 0 ||
      content.text.size() / size != count)
    throw array_fault(pickle, "an array of " + std::to_string(count) + " values of " +
                                  std::to_string(size) + " bytes has " +
                                  std::to_string(content.text.size()) + " bytes");
  array.bytes = content.text;
}

/// A state: version, shape, type, Fortran order, content.
PickledArray array_of_state(const PickledValues& pickle, const PickleValue& state) {
  if (state.kind != PickleKind::sequence || state.items.size() != 5)
    throw array_fault(pickle, "an array without shape, type and values");
  PickledArray array;
  take_shape(pickle, pickle[state.items[1]], array);
  take_dtype(pickle, pickle[state.items[2]], array);
  array.by_columns = pickle[state.items[3]].integer != 0;
  take_content(pickle, pickle[state.items[4]], array);
  return array;
}

}  // namespace

Column PickledArray::column(std::string_view name, std::size_t line) const {
  Column column;
  column.name = name;
  with_type(type, [&](auto zero) {
    using Value = decltype(zero);
    std::vector<Value> values(length);
    for (std::size_t i = 0; i < length; ++i)
      std::memcpy(&values[i], bytes.data() + index_of(line, i) * sizeof(Value), sizeof(Value));
    column.values = std::move(values);
  });
  return column;
}

PickledArray pickled_array(const PickledValues& pickle, const PickleValue& value) {
  const std::string_view maker = made_by(pickle, value);
  const auto argument = [&](std::size_t index) -> const PickleValue& {
    const PickleValue* const found = argument_of(pickle, value, index);
    if (found == nullptr) throw array_fault(pickle, "an array without its values");
    return *found;
  };
  if (maker.ends_with("._reconstruct")) {
    const PickleValue* const state = state_of(pickle, value);
    if (state == nullptr) throw array_fault(pickle, "an array without its values");
    return array_of_state(pickle, *state);
  }
  PickledArray array;
  if (maker.ends_with("._frombuffer")) {
    take_dtype(pickle, argument(1), array);
    take_shape(pickle, argument(2), array);
    array.by_columns = argument(3).text == "F";
    take_content(pickle, argument(0), array);
    return array;
  }
  if (maker != "numpy.frombuffer") throw array_fault(pickle, "expected a NumPy array");
  take_type(pickle, argument(1).text, array);
  if (array.is_objects) throw array_fault(pickle, "a buffer cannot contain objects");
  array.length = argument(0).text.size() / type_bytes(array.type);
  take_content(pickle, argument(0), array);
  return array;
}

std::string_view made_by(const PickledValues& pickle, const PickleValue& value) {
  return value.kind == PickleKind::object ? std::string_view(pickle[value.items[0]].name)
                                          : std::string_view();
}

const PickleValue* argument_of(const PickledValues& pickle, const PickleValue& object,
                               std::size_t index) {
  if (object.kind != PickleKind::object) return nullptr;
  const PickleValue& arguments = pickle[object.items[1]];
  return index < arguments.items.size() ? &pickle[arguments.items[index]] : nullptr;
}

const PickleValue* state_of(const PickledValues& pickle, const PickleValue& object) {
  if (object.kind != PickleKind::object || object.items.size() < 3) return nullptr;
  return &pickle[object.items[2]];
}

}  // namespace adasplats
