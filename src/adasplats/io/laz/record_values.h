// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace adasplats {

/// A value of a point record, at any place.
template <class T>
T load_value(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

template <class T>
void store_value(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof(T));
}

}  // namespace adasplats
