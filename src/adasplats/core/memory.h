// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace adasplats {

/// Largest resident memory of this process so far, in bytes (VmHWM).
std::uint64_t peak_memory_bytes();

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

/// Addresses without memory behind them until they are written to.
class ReservedMemory {
 public:
  ReservedMemory() = default;
  /// Errors: unavailable (the system has no such range of addresses).
  explicit ReservedMemory(std::size_t bytes);
  ~ReservedMemory();
  ReservedMemory(ReservedMemory&& other) noexcept { swap(other); }
  ReservedMemory& operator=(ReservedMemory&& other) noexcept {
    swap(other);
    return *this;
  }

  std::byte* data() const { return data_; }
  /// Gives back the memory of the pages that lie in [begin, end); they read as zeros.
  void release(std::size_t begin, std::size_t end);

 private:
  void swap(ReservedMemory& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
  }

  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0;
};

/// An array with a place for every element of something larger than memory: only what was written
/// takes some, until it is released. Elements are zeros at first. Parts that do not overlap may be
/// written, read and released by several threads.
template <class T>
class SparseArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  SparseArray() = default;
  /// Errors: unavailable (more than the address space has).
  explicit SparseArray(std::size_t size) : memory_(size * sizeof(T)), size_(size) {}

  T* data() const { return reinterpret_cast<T*>(memory_.data()); }
  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) const { return data()[i]; }
  /// Elements [begin, end) are not needed any more. Of pages that others share nothing is given
  /// back: some keep their values.
  void release(std::size_t begin, std::size_t end) {
    memory_.release(begin * sizeof(T), end * sizeof(T));
  }

 private:
  ReservedMemory memory_;
  std::size_t size_ = 0;
};

}  // namespace adasplats
