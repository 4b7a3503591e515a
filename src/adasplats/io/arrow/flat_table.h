// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/core/error.h"

namespace adasplats {

/// The bytes of a flatbuffer (flatbuffers.dev, "FlatBuffer Internals"). All reads are checked.
class FlatBytes {
 public:
  /// `what` begins error messages: "a.feather: the footer".
  FlatBytes(std::string_view bytes, std::string what) : bytes_(bytes), what_(std::move(what)) {}

  std::string_view part(std::uint64_t at, std::uint64_t count) const {
    if (at > bytes_.size() || count > bytes_.size() - at)
      throw error("is damaged: it refers to byte " + std::to_string(at) + " of " +
                  std::to_string(bytes_.size()));
    return bytes_.substr(static_cast<std::size_t>(at), static_cast<std::size_t>(count));
  }
  template <class T>
  T number(std::uint64_t at) const {
    T value;
    std::memcpy(&value, part(at, sizeof(T)).data(), sizeof(T));
    return value;
  }
  /// Where the 32-bit offset at a place leads.
  std::uint64_t target(std::uint64_t at) const { return at + number<std::uint32_t>(at); }
  Error error(const std::string& problem) const { return {ErrorKind::data, what_ + " " + problem}; }

 private:
  std::string_view bytes_;
  std::string what_;
};

/// A table of a flatbuffer. Fields are numbered in the order of the schema; a union counts as two.
class FlatTable {
 public:
  FlatTable(const FlatBytes& bytes, std::uint64_t at) : bytes_(&bytes), at_(at) {
    const std::int64_t back = bytes.number<std::int32_t>(at);
    layout_ = at - static_cast<std::uint64_t>(back);  // a place outside fails when it is read
    layout_bytes_ = bytes.number<std::uint16_t>(layout_);
  }
  static FlatTable root(const FlatBytes& bytes) { return {bytes, bytes.target(0)}; }

  bool has(std::size_t field) const { return place_of(field) != 0; }
  template <class T>
  T number(std::size_t field) const {
    const std::uint64_t place = place_of(field);
    return place == 0 ? T{} : bytes_->number<T>(place);
  }
  FlatTable table(std::size_t field) const { return {*bytes_, target_of(field)}; }
  std::string_view text(std::size_t field) const { return elements(field, 1).first; }
  /// The elements of a vector and their count; nothing if the field is absent.
  std::pair<std::string_view, std::size_t> elements(std::size_t field, std::size_t bytes) const {
    if (!has(field)) return {};
    const std::uint64_t at = target_of(field);
    const auto count = bytes_->number<std::uint32_t>(at);
    return {bytes_->part(at + sizeof(count), std::uint64_t{count} * bytes), count};
  }
  /// Table number `index` of a vector of tables.
  FlatTable element(std::size_t field, std::size_t index) const {
    return {*bytes_, bytes_->target(target_of(field) + sizeof(std::uint32_t) * (1 + index))};
  }

 private:
  std::uint64_t place_of(std::size_t field) const {
    const std::size_t entry = sizeof(std::uint16_t) * (2 + field);
    if (entry + sizeof(std::uint16_t) > layout_bytes_) return 0;
    const auto offset = bytes_->number<std::uint16_t>(layout_ + entry);
    return offset == 0 ? 0 : at_ + offset;
  }
  std::uint64_t target_of(std::size_t field) const {
    const std::uint64_t place = place_of(field);
    if (place == 0)
      throw bytes_->error("is damaged: field " + std::to_string(field) + " is missing");
    return bytes_->target(place);
  }

  const FlatBytes* bytes_;
  std::uint64_t at_, layout_ = 0;
  std::size_t layout_bytes_ = 0;
};

}  // namespace adasplats
