// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/table.h"

/// What the tests of this folder share.
namespace adasplats::io_test {

/// Writes a file without the library's help.
inline void write_bytes(const std::filesystem::path& path, std::string_view content) {
  // ext4 flushes a file to disk that is truncated and written again, which takes milliseconds.
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary)
      .write(content.data(), static_cast<std::streamsize>(content.size()));
}

/// The bytes of a value in this machine's order (little-endian).
template <class T>
std::string bytes_of(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

template <class T>
std::string big_endian(T value) {
  const std::string bytes = bytes_of(value);
  return {bytes.rbegin(), bytes.rend()};
}

/// Puts a value into a file's bytes.
template <class T>
void put(std::string& bytes, std::size_t offset, T value) {
  if (bytes.size() < offset + sizeof(T)) throw std::out_of_range("put");
  std::memcpy(bytes.data() + offset, &value, sizeof(T));
}

/// All values of a column, as doubles.
inline std::vector<double> values_of(const Table& table, std::string_view name) {
  const Column* const column = table.find(name);
  if (column == nullptr) throw std::runtime_error("no column " + std::string(name));
  std::vector<double> values;
  for (std::size_t row = 0; row < table.rows; ++row) values.push_back(column->as_double(row));
  return values;
}

/// The error that `action` throws; a test failure and an empty one where it throws none.
template <class F>
Error error_of(F&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no adasplats::Error was thrown";
  return {ErrorKind::software, ""};
}

}  // namespace adasplats::io_test
