// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/arrays/npy.h"

#include <bit>
#include <limits>
#include <stdexcept>
#include <string>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little);

/// numpy.dtype.str of a type.
std::string npy_type(ColumnType type) {
  switch (type) {
    case ColumnType::i8: return "|i1";
    case ColumnType::u8: return "|u1";
    case ColumnType::i16: return "<i2";
    case ColumnType::u16: return "<u2";
    case ColumnType::i32: return "<i4";
    case ColumnType::u32: return "<u4";
    case ColumnType::i64: return "<i8";
    case ColumnType::u64: return "<u8";
    case ColumnType::f32: return "<f4";
    case ColumnType::f64: return "<f8";
  }
  throw std::logic_error("npy_header: no such type");
}

/// A tuple as Python writes it: "7," and "2, 3".
std::string shape_text(std::span<const std::size_t> shape) {
  std::string text = std::to_string(shape.front());
  if (shape.size() == 1) return text + ",";
  for (const std::size_t length : shape.subspan(1)) text += ", " + std::to_string(length);
  return text;
}

}  // namespace

std::size_t NpyArray::size_bytes() const {
  std::size_t bytes = type_bytes(type);
  for (const std::size_t length : shape) {
    if (length != 0 && bytes > std::numeric_limits<std::size_t>::max() / length)
      throw std::logic_error("NpyArray: the shape has more values than there are addresses");
    bytes *= length;
  }
  return bytes;
}

// Magic, version 1.0, header length, and the header padded so that the values begin at a multiple
// of 64 bytes (numpy/lib/format.py, "Format Version 1.0").
std::string npy_header(const NpyArray& array) {
  if (array.shape.empty()) throw std::logic_error("npy_header: an array without a dimension");
  std::string dictionary = "{'descr': '";
  dictionary.append(npy_type(array.type)).append("', 'fortran_order': False, 'shape': (");
  dictionary.append(shape_text(array.shape)).append("), }");
  constexpr std::size_t kPrefixBytes = 10;
  constexpr std::size_t kAlignmentBytes = 64;
  while ((kPrefixBytes + dictionary.size() + 1) % kAlignmentBytes != 0) dictionary += ' ';
  dictionary += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(dictionary.size() & 0xff);
  header += static_cast<char>(dictionary.size() >> 8);
  return header + dictionary;
}

void put_npy(ByteSink& file, const NpyArray& array) {
  file.write(npy_header(array));
  file.write(array.data, array.size_bytes());
}

void write_npy(const std::filesystem::path& path, const NpyArray& array) {
  AtomicFile file(path);
  put_npy(file, array);
  file.commit();
}

void write_npy(const std::filesystem::path& path, std::span<const float> values, std::size_t rows,
               std::size_t columns) {
  const bool matches = columns == 0
                           ? values.empty()
                           : values.size() % columns == 0 && values.size() / columns == rows;
  if (!matches) throw std::logic_error("write_npy: values.size() is not rows * columns");
  write_npy(path, NpyArray{ColumnType::f32, {rows, columns}, values.data()});
}

void write_npy(const std::filesystem::path& path, std::span<const std::uint32_t> values) {
  write_npy(path, NpyArray{ColumnType::u32, {values.size()}, values.data()});
}

}  // namespace adasplats
