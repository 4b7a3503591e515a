// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/pickle/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr int kGzipWindow = 15 + 16;  // of 32 KiB, with gzip's header
// Higher levels hardly shrink coordinates further, and take three times as long.
constexpr int kGzipLevel = 3;
constexpr std::size_t kMaxAtOnce = std::numeric_limits<uInt>::max();

Bytef* bytes_for_zlib(std::string_view bytes) {
  // zlib only reads these bytes, although its interface lacks const.
  return reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // NOLINT
}

/// Owns a stream of zlib.
class Inflater {
 public:
  Inflater() {
    if (inflateInit2(&stream_, kGzipWindow) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  z_stream& get() { return stream_; }

 private:
  z_stream stream_{};
};

}  // namespace

std::string gzipped(std::string_view bytes) {
  if (bytes.size() > kMaxAtOnce) throw std::logic_error("gzipped: more than 4 GiB");
  z_stream stream{};
  constexpr int kMemoryLevel = 8;  // zlib's default
  if (deflateInit2(&stream, kGzipLevel, Z_DEFLATED, kGzipWindow, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string packed(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = bytes_for_zlib(bytes);
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int result = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw std::logic_error("gzipped: the bound was too small");
  return packed;
}

std::string gunzipped(const std::filesystem::path& file, std::string_view bytes,
                      std::size_t max_bytes) {
  constexpr std::size_t kStep = std::size_t{1} << 20;
  Inflater inflater;
  z_stream& stream = inflater.get();
  std::string content, part(std::min(kStep, max_bytes + 1), '\0');
  std::string_view left = bytes;
  for (bool is_whole = left.empty(); !is_whole;) {
    stream.next_in = bytes_for_zlib(left);
    stream.avail_in = static_cast<uInt>(std::min(left.size(), kMaxAtOnce));
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    const std::size_t given = stream.avail_in;
    const int result = inflate(&stream, Z_NO_FLUSH);
    const std::size_t used = given - stream.avail_in, made = part.size() - stream.avail_out;
    if (content.size() + made > max_bytes)
      throw Error(ErrorKind::data, file.string() + ": decompresses to more than " +
                                       std::to_string(max_bytes) + " bytes");
    content.append(part, 0, made);
    left.remove_prefix(used);
    is_whole = result == Z_STREAM_END && left.empty();
    if (result == Z_STREAM_END && !is_whole) inflateReset(&stream);  // one more member
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result == Z_STREAM_END || (result == Z_OK && (used > 0 || made > 0))) continue;
    throw data_error({file, bytes.size() - left.size(), {}},
                     left.empty() ? "the gzip data end early" : "not gzip data, or damaged");
  }
  return content;
}

}  // namespace adasplats
