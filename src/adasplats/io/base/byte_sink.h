// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace adasplats {

/// Destination of the bytes of a file, on disk or in memory.
class ByteSink {
 public:
  ByteSink() = default;
  virtual ~ByteSink() = default;
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;

  virtual void write(const void* data, std::size_t bytes) = 0;
  void write(std::string_view text) { write(text.data(), text.size()); }
};

/// The bytes of a file in memory.
class ByteBuffer final : public ByteSink {
 public:
  /// `expected_bytes` are reserved.
  explicit ByteBuffer(std::size_t expected_bytes = 0) { bytes_.reserve(expected_bytes); }

  using ByteSink::write;
  void write(const void* data, std::size_t bytes) override {
    if (bytes > 0) bytes_.append(static_cast<const char*>(data), bytes);
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

}  // namespace adasplats
