// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/npy.h"

#include <bit>
#include <stdexcept>
#include <string>

#include "adasplats/io/atomic_file.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Magic, version 1.0, header length, and the header padded so that the values begin at a multiple
/// of 64 bytes (numpy/lib/format.py, "Format Version 1.0").
std::string npy_header(const std::string& type, const std::string& shape) {
  std::string dictionary = "{'descr': '";
  dictionary.append(type).append("', 'fortran_order': False, 'shape': (").append(shape);
  dictionary.append("), }");
  constexpr std::size_t kPrefixBytes = 10;
  constexpr std::size_t kAlignmentBytes = 64;
  while ((kPrefixBytes + dictionary.size() + 1) % kAlignmentBytes != 0) dictionary += ' ';
  dictionary += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(dictionary.size() & 0xff);
  header += static_cast<char>(dictionary.size() >> 8);
  return header + dictionary;
}

}  // namespace

void write_npy(const std::filesystem::path& path, std::span<const float> values, std::size_t rows,
               std::size_t columns) {
  const bool matches = columns == 0
                           ? values.empty()
                           : values.size() % columns == 0 && values.size() / columns == rows;
  if (!matches) throw std::logic_error("write_npy: values.size() is not rows * columns");
  AtomicFile file(path);
  file.write(npy_header("<f4", std::to_string(rows) + ", " + std::to_string(columns)));
  file.write(values.data(), values.size_bytes());
  file.commit();
}

void write_npy(const std::filesystem::path& path, std::span<const std::uint32_t> values) {
  AtomicFile file(path);
  file.write(npy_header("<u4", std::to_string(values.size()) + ","));
  file.write(values.data(), values.size_bytes());
  file.commit();
}

}  // namespace adasplats
