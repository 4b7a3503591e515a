// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <string_view>

namespace adasplats::gpu {

/// Private to gpu/: the memory of one GPU that this process holds, without what CUDA itself needs
/// (about half a gigabyte). Thread-safe.
class MemoryAccount {
 public:
  /// The account of the current device.
  static MemoryAccount& current();
  static MemoryAccount& of(int device);

  /// Errors: unavailable (more than the limit). Nothing is taken then.
  void take(std::size_t bytes, std::string_view doing);
  void give_back(std::size_t bytes) { held_ -= bytes; }

  void set_limit(std::size_t bytes) { limit_ = bytes; }  ///< 0: none
  std::size_t limit() const { return limit_; }
  std::size_t held() const { return held_; }
  std::size_t peak() const { return peak_; }

 private:
  std::atomic<std::size_t> held_ = 0, peak_ = 0, limit_ = 0;
};

}  // namespace adasplats::gpu
