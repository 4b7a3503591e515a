// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/io/e57/e57_content.h"

namespace adasplats {

/// Decodes the values of one field from its byte stream, which comes in parts: a value may begin in
/// one part and end in the next.
class FieldDecoder {
 public:
  /// The caller has checked `rows` against the size of the scan's section. A field without bits is
  /// complete at once.
  FieldDecoder(const E57Field& field, std::size_t rows);

  /// Decodes the next bytes of the stream; those after the last value are padding.
  void take(std::span<const std::byte> bytes);

  bool is_complete() const { return values_.size() == rows_; }
  const std::vector<double>& values() const { return values_; }
  std::vector<double> take_values() { return std::move(values_); }

 private:
  std::uint64_t stored_at(std::size_t bit) const;
  double value_of(std::uint64_t stored) const;

  E57Field field_;
  std::size_t rows_;
  std::vector<double> values_;
  std::vector<std::byte> bytes_;  ///< undecoded bytes, and room to load words
  std::size_t first_bit_ = 0;     ///< of the next value, in bytes_
};

}  // namespace adasplats
