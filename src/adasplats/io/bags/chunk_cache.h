// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace adasplats {

/// The last few chunks that were unpacked, for several threads.
class ChunkCache {
 public:
  /// The chunk that begins at `place`; `unpack()` gives it where it is not here.
  template <class F>
  std::shared_ptr<const std::string> get(std::uint64_t place, F&& unpack) {
    {
      const std::lock_guard lock(mutex_);
      for (const Entry& entry : entries_)
        if (entry.chunk && entry.place == place) return entry.chunk;
    }
    auto chunk = std::make_shared<const std::string>(unpack());
    const std::lock_guard lock(mutex_);
    entries_[next_] = {place, chunk};
    next_ = (next_ + 1) % entries_.size();
    return chunk;
  }

 private:
  struct Entry {
    std::uint64_t place = 0;
    std::shared_ptr<const std::string> chunk;
  };
  std::mutex mutex_;
  std::array<Entry, 4> entries_;
  std::size_t next_ = 0;
};

}  // namespace adasplats
