// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "adasplats/io/pickle/data_frame.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little, "pickles are little-endian");

/// What a pickle is made of.
class PickleText {
 public:
  PickleText() { bytes_ = "\x80\x03"; }

  void op(char code) { bytes_ += code; }
  void global(std::string_view module, std::string_view name) {
    ((bytes_ += 'c') += module) += '\n';
    (bytes_ += name) += '\n';
  }
  void text(std::string_view value) {
    op('X');
    size(value.size());
    bytes_ += value;
  }
  template <class T>
  void array(const std::vector<T>& values, std::string_view type) {
    global("numpy", "frombuffer");
    op('B');
    size(values.size() * sizeof(T));
    if (!values.empty())
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    text(type);
    op('\x86');  // a tuple of two: the arguments
    op('R');     // the call
  }
  std::string take() {
    op('.');
    return std::move(bytes_);
  }

 private:
  void size(std::size_t bytes) {
    if (bytes > std::numeric_limits<std::uint32_t>::max())
      throw std::logic_error("pickled_data_frame: a column of more than 4 GiB");
    for (int k = 0; k < 4; ++k) op(static_cast<char>(bytes >> (8 * k) & 0xff));
  }

  std::string bytes_;
};

void put_values(PickleText& pickle, const std::vector<double>& values) {
  pickle.array(values, "<f8");
}
void put_values(PickleText& pickle, const std::vector<std::int64_t>& values) {
  pickle.array(values, "<i8");
}
void put_values(PickleText& pickle, const std::vector<bool>& values) {
  const std::vector<std::uint8_t> bytes(values.begin(), values.end());
  pickle.array(bytes, "?");
}
void put_values(PickleText& pickle, const std::vector<std::string>& values) {
  pickle.op(']');
  pickle.op('(');
  for (const std::string& value : values) pickle.text(value);
  pickle.op('e');
}

}  // namespace

std::string pickled_data_frame(std::span<const FrameColumn> columns) {
  PickleText pickle;
  pickle.global("pandas", "DataFrame");
  pickle.op('}');
  pickle.op('(');
  const auto rows_of = [](const FrameColumn& column) {
    return std::visit([](const auto& values) { return values.size(); }, column.values);
  };
  for (const FrameColumn& column : columns) {
    if (rows_of(column) != rows_of(columns.front()))
      throw std::logic_error("pickled_data_frame: columns of unequal length");
    pickle.text(column.name);
    std::visit([&](const auto& values) { put_values(pickle, values); }, column.values);
  }
  pickle.op('u');
  pickle.op('\x85');  // a tuple of one: the dictionary of columns
  pickle.op('R');
  return pickle.take();
}

}  // namespace adasplats
