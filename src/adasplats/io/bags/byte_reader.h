// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/bags/recording.h"

namespace adasplats {

/// "FILE: byte OFFSET: the WHAT", the start of messages.
inline std::string place_in_file(const std::filesystem::path& path, std::uint64_t offset,
                                 const char* what) {
  return path.string() + ": byte " + std::to_string(offset) + ": the " + what;
}

/// Reads consecutive values from bytes in memory; every access is checked.
class ByteReader {
 public:
  /// `what` begins error messages, e.g. "drive.mcap: byte 17: the schema".
  ByteReader(std::string_view bytes, std::string what) : bytes_(bytes), what_(std::move(what)) {}

  template <class T>
  T number(bool swap_bytes = false) {
    static_assert(std::is_arithmetic_v<T>);
    char raw[sizeof(T)];
    std::memcpy(raw, take(sizeof(T)).data(), sizeof(T));
    if (swap_bytes) std::reverse(raw, raw + sizeof(T));
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }
  std::string_view take(std::uint64_t count) {
    if (count > remaining())
      throw error("ends early: " + std::to_string(count) + " bytes expected at byte " +
                  std::to_string(place_) + " of it, " + std::to_string(remaining()) + " found");
    const std::string_view part = bytes_.substr(place_, static_cast<std::size_t>(count));
    place_ += part.size();
    return part;
  }
  /// Bytes after their number, 32 bits.
  std::string_view text() { return take(number<std::uint32_t>()); }

  std::size_t place() const { return place_; }
  std::size_t remaining() const { return bytes_.size() - place_; }
  Error error(const std::string& message) const { return {ErrorKind::data, what_ + " " + message}; }

 private:
  std::string_view bytes_;
  std::string what_;
  std::size_t place_ = 0;
};

/// The last few decompressed chunks, for several threads.
class ChunkCache {
 public:
  /// A message in a chunk of the file `path`; unpack() returns the chunk if it is not in the cache.
  /// Errors: those of unpack(); data (the chunk changed since the message was found in it).
  template <class F>
  std::string message(const std::filesystem::path& path, const MessagePosition& place, F&& unpack) {
    const auto chunk = get(place.chunk, unpack);
    const auto begin = static_cast<std::size_t>(place.offset);
    if (begin > chunk->size() || place.size > chunk->size() - begin)
      throw data_error({path, place.chunk, {}}, "the chunk changed while it was read");
    return chunk->substr(begin, static_cast<std::size_t>(place.size));
  }

 private:
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

  struct Entry {
    std::uint64_t place = 0;
    std::shared_ptr<const std::string> chunk;
  };
  std::mutex mutex_;
  std::array<Entry, 4> entries_;
  std::size_t next_ = 0;
};

}  // namespace adasplats
