// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/field_decoder.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace adasplats {
namespace {

// A value of 64 bits that begins within a byte ends in the ninth byte.
constexpr std::size_t kWordRoom = 9;

}  // namespace

FieldDecoder::FieldDecoder(const E57Field& field, std::size_t rows) : field_(field), rows_(rows) {
  if (field_.bits == 0) {
    values_.assign(rows_, value_of(0));
  } else {
    values_.reserve(rows_);
  }
}

void FieldDecoder::take(std::span<const std::byte> bytes) {
  if (is_complete()) return;
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  const std::size_t stream_bits = 8 * bytes_.size();
  bytes_.resize(bytes_.size() + kWordRoom);
  const std::size_t whole = (stream_bits - first_bit_) / field_.bits;
  const std::size_t count = std::min(whole, rows_ - values_.size());
  for (std::size_t k = 0; k < count; ++k, first_bit_ += field_.bits)
    values_.push_back(value_of(stored_at(first_bit_)));
  bytes_.resize(bytes_.size() - kWordRoom);
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(first_bit_ / 8));
  first_bit_ %= 8;
}

/// Values begin with their lowest bit, in the lowest free bit of a byte.
std::uint64_t FieldDecoder::stored_at(std::size_t bit) const {
  const std::byte* const from = bytes_.data() + bit / 8;
  const std::size_t shift = bit % 8;
  std::uint64_t word = 0;
  std::memcpy(&word, from, sizeof(word));
  word >>= shift;
  if (shift + field_.bits > 64) word |= std::to_integer<std::uint64_t>(from[8]) << (64 - shift);
  return field_.bits == 64 ? word : word & ((std::uint64_t{1} << field_.bits) - 1);
}

double FieldDecoder::value_of(std::uint64_t stored) const {
  if (field_.codec == E57Codec::f64) return std::bit_cast<double>(stored);
  if (field_.codec == E57Codec::f32)
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(stored)));
  const auto whole = static_cast<std::int64_t>(static_cast<std::uint64_t>(field_.minimum) + stored);
  return static_cast<double>(whole) * field_.scale + field_.offset;
}

}  // namespace adasplats
