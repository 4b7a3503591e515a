// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/error.h"
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

/// A folder of its own for a test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "adasplats-io-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Writes a file of this folder.
  std::filesystem::path file(const std::string& name, std::string_view content) const {
    const std::filesystem::path path = path_ / name;
    write_bytes(path, content);
    return path;
  }
  std::size_t file_count() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++count;
    return count;
  }

 private:
  std::filesystem::path path_;
};

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

/// Expects an error of the given kind whose message has all of `parts`.
template <class F>
void expect_error(ErrorKind kind, const std::vector<std::string>& parts, F&& action) {
  const Error error = error_of(action);
  EXPECT_EQ(exit_code(error.kind()), exit_code(kind)) << error.what();
  for (const std::string& part : parts)
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
        << "'" << part << "' is missing in: " << error.what();
}

}  // namespace adasplats::io_test
