// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace adasplats::gpu {

/// Private to gpu/: a range of addresses on the current device; its pages have memory while they
/// are held.
class ReservedDeviceMemory {
 public:
  /// Errors: unavailable (the driver cannot reserve the range).
  explicit ReservedDeviceMemory(std::size_t bytes);
  ~ReservedDeviceMemory();
  ReservedDeviceMemory(const ReservedDeviceMemory&) = delete;
  ReservedDeviceMemory& operator=(const ReservedDeviceMemory&) = delete;

  std::byte* data() const { return data_; }
  /// Maps memory to [begin, end), initially undefined. Errors: unavailable (not enough memory; then
  /// nothing is mapped).
  void hold(std::size_t begin, std::size_t end);
  /// Ends a hold() of the same range, which the device must no longer use.
  void release(std::size_t begin, std::size_t end);

 private:
  struct Page {
    unsigned long long memory = 0;  ///< the driver's handle
    std::uint32_t holders = 0;
  };
  void map(std::size_t page);
  void unmap(std::size_t page);

  std::byte* data_ = nullptr;
  std::size_t page_bytes_ = 0;
  std::size_t bytes_ = 0;  ///< whole pages
  int device_ = 0;
  std::vector<Page> pages_;
};

/// An array on the current device that may be larger than its memory; only held parts have memory.
/// hold() and release() are not thread-safe.
template <class T>
class SparseDeviceArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit SparseDeviceArray(std::size_t size) : memory_(size * sizeof(T)) {}

  T* data() const { return reinterpret_cast<T*>(memory_.data()); }
  void hold(std::size_t begin, std::size_t end) {
    memory_.hold(begin * sizeof(T), end * sizeof(T));
  }
  void release(std::size_t begin, std::size_t end) {
    memory_.release(begin * sizeof(T), end * sizeof(T));
  }

 private:
  ReservedDeviceMemory memory_;
};

}  // namespace adasplats::gpu
