// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace adasplats {

/// Asks the system for large pages where it has them to give (Linux' madvise); a page fault less
/// for every 4 KiB. Changes no value, and nothing where `bytes` are less than a few such pages.
void prefer_large_pages(void* memory, std::size_t bytes);

/// `values` with another size, as std::vector::resize() does it, on large pages where it grows.
template <class T>
void resize_large(std::vector<T>& values, std::size_t size) {
  if (size > values.capacity()) {
    values.reserve(size);
    prefer_large_pages(values.data(), values.capacity() * sizeof(T));
  }
  values.resize(size);
}

}  // namespace adasplats
