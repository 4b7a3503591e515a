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

/// Asks the system for large pages (madvise of Linux), which saves a page fault for every 4 KiB.
/// Does nothing if `bytes` is less than a few large pages.
void prefer_large_pages(void* memory, std::size_t bytes);

/// std::vector::resize(), on large pages if it grows.
template <class T>
void resize_large(std::vector<T>& values, std::size_t size) {
  if (size > values.capacity()) {
    values.reserve(size);
    prefer_large_pages(values.data(), values.capacity() * sizeof(T));
  }
  values.resize(size);
}

/// A range of addresses that takes no memory until it is written to.
class ReservedMemory {
 public:
  ReservedMemory() = default;
  /// Errors: unavailable (no such range of addresses).
  explicit ReservedMemory(std::size_t bytes);
  ~ReservedMemory();
  ReservedMemory(ReservedMemory&& other) noexcept { swap(other); }
  ReservedMemory& operator=(ReservedMemory&& other) noexcept {
    swap(other);
    return *this;
  }

  std::byte* data() const { return data_; }
  /// Returns the memory of the pages within [begin, end) to the system; they then read as zeros.
  void release(std::size_t begin, std::size_t end);

 private:
  void swap(ReservedMemory& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
  }

  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0;
};

/// An array that may be larger than memory: only elements that were written and not released take
/// memory. Elements are zero at first. Several threads may write, read and release parts that do
/// not overlap.
template <class T>
class SparseArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  SparseArray() = default;
  /// Errors: unavailable (more than the address space).
  explicit SparseArray(std::size_t size) : memory_(size * sizeof(T)), size_(size) {}

  T* data() const { return reinterpret_cast<T*>(memory_.data()); }
  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) const { return data()[i]; }
  /// Releases elements [begin, end). Pages shared with other elements stay, so some elements keep
  /// their values.
  void release(std::size_t begin, std::size_t end) {
    memory_.release(begin * sizeof(T), end * sizeof(T));
  }

 private:
  ReservedMemory memory_;
  std::size_t size_ = 0;
};

}  // namespace adasplats
