// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace adasplats {

/// Composes a flatbuffer (flatbuffers.dev, "FlatBuffer Internals"), parents before children.
class FlatComposer {
 public:
  std::string bytes = std::string(4, '\0');  ///< begins with the offset of the root

  template <class T>
  void set(std::size_t place, T value) {
    std::memcpy(bytes.data() + place, &value, sizeof(T));
  }
  template <class T>
  void add(T value) {
    bytes.resize(bytes.size() + sizeof(T));
    set(bytes.size() - sizeof(T), value);
  }
  void align(std::size_t to, std::size_t ahead = 0) {
    while ((bytes.size() + ahead) % to != 0) bytes += '\0';
  }
  /// Makes the offset at `place` lead to what is added next.
  void link(std::size_t place) {
    align(4);
    set(place, static_cast<std::uint32_t>(bytes.size() - place));
  }
  /// Adds a table with the flagged fields, 8 bytes each, and links it from `place`.
  std::size_t table(std::size_t place, const std::vector<bool>& fields) {
    const std::size_t layout_bytes = 4 + 2 * fields.size();
    align(8, layout_bytes);
    const std::size_t layout = bytes.size();
    add(static_cast<std::uint16_t>(layout_bytes));
    add(static_cast<std::uint16_t>(8 + 8 * fields.size()));
    for (std::size_t k = 0; k < fields.size(); ++k)
      add(static_cast<std::uint16_t>(fields[k] ? 8 + 8 * k : 0));
    const std::size_t at = bytes.size();
    set(place, static_cast<std::uint32_t>(at - place));
    add(static_cast<std::int32_t>(at - layout));
    bytes.resize(at + 8 + 8 * fields.size());
    return at;
  }
  static std::size_t field(std::size_t table, std::size_t number) { return table + 8 + 8 * number; }
};

}  // namespace adasplats
