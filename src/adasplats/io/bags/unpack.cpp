// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/bags/unpack.h"

#ifdef ADASPLATS_HAVE_ZSTD
#include <zstd.h>
#endif
#ifdef ADASPLATS_HAVE_LZ4
#include <lz4frame.h>
#endif
#ifdef ADASPLATS_HAVE_BZIP2
#include <bzlib.h>
#endif

#include <algorithm>
#include <cstddef>
#include <memory>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr std::size_t kFirstBytes = std::size_t{1} << 20;

/// The remaining input and the output so far.
struct UnpackState {
  std::string_view in;
  std::string out;
  std::size_t filled = 0;
  std::size_t size;  ///< expected

  char* to() { return out.data() + filled; }
  std::size_t room() const { return out.size() - filled; }
};

/// Runs steps until the stream ends. `step(state)` consumes input, adds output, returns whether the
/// stream has ended, and throws if it is damaged.
template <class Step>
std::string unpack_by(Step&& step, std::string_view packed, std::size_t size,
                      const std::string& where) {
  UnpackState state{packed, {}, 0, size};
  for (;;) {
    // One byte more than expected detects a stream that is too long.
    if (state.room() == 0) {
      const std::size_t larger = std::max(kFirstBytes, 2 * state.out.size());
      state.out.resize(std::min(larger, size + 1));
    }
    const std::size_t in_before = state.in.size(), before = state.filled;
    const bool ended = step(state);
    if (state.filled > size)
      throw Error(ErrorKind::data, where + " decompresses to more than the stated " +
                                       std::to_string(size) + " bytes");
    if (ended) break;
    if (state.in.size() == in_before && state.filled == before)
      throw Error(ErrorKind::data, where + ": the compressed bytes end early");
  }
  // Some writers add padding after the stream, which is ignored.
  if (state.filled != size)
    throw Error(ErrorKind::data, where + " decompresses to " + std::to_string(state.filled) +
                                     " bytes, expected " + std::to_string(size));
  state.out.resize(size);
  return std::move(state.out);
}

[[maybe_unused]] Error damaged_stream(const std::string& where, std::string_view packing,
                                      const char* problem) {
  return {ErrorKind::data, where + ": damaged " + std::string(packing) + " data: " + problem};
}

#ifdef ADASPLATS_HAVE_ZSTD
std::string unpack_zstd(std::string_view packed, std::size_t size, const std::string& where) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             &ZSTD_freeDStream);
  if (!stream || ZSTD_isError(ZSTD_initDStream(stream.get())) != 0) throw std::bad_alloc();
  const auto step = [&](UnpackState& state) {
    ZSTD_inBuffer in{state.in.data(), state.in.size(), 0};
    ZSTD_outBuffer out{state.to(), state.room(), 0};
    const std::size_t left = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(left) != 0) throw damaged_stream(where, "zstd", ZSTD_getErrorName(left));
    state.in.remove_prefix(in.pos);
    state.filled += out.pos;
    return left == 0;
  };
  return unpack_by(step, packed, size, where);
}
#endif

#ifdef ADASPLATS_HAVE_LZ4
std::string unpack_lz4(std::string_view packed, std::size_t size, const std::string& where) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0)
    throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(
      made, &LZ4F_freeDecompressionContext);
  const auto step = [&](UnpackState& state) {
    std::size_t in_bytes = state.in.size(), out_bytes = state.room();
    const std::size_t left =
        LZ4F_decompress(context.get(), state.to(), &out_bytes, state.in.data(), &in_bytes, nullptr);
    if (LZ4F_isError(left) != 0) throw damaged_stream(where, "lz4", LZ4F_getErrorName(left));
    state.in.remove_prefix(in_bytes);
    state.filled += out_bytes;
    return left == 0;
  };
  return unpack_by(step, packed, size, where);
}
#endif

#ifdef ADASPLATS_HAVE_BZIP2
std::string unpack_bz2(std::string_view packed, std::size_t size, const std::string& where) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> end(&stream, &BZ2_bzDecompressEnd);
  const auto step = [&](UnpackState& state) {
    constexpr std::size_t kMaxAtOnce = std::size_t{1} << 30;  // bzip2 has sizes of 32 bits
    std::string taken(state.in.substr(0, kMaxAtOnce));        // and wants mutable input
    stream.next_in = taken.data();
    stream.avail_in = static_cast<unsigned>(taken.size());
    stream.next_out = state.to();
    stream.avail_out = static_cast<unsigned>(std::min(kMaxAtOnce, state.room()));
    const unsigned room = stream.avail_out;
    const int result = BZ2_bzDecompress(&stream);
    if (result != BZ_OK && result != BZ_STREAM_END)
      throw damaged_stream(where, "bz2", ("code " + std::to_string(result)).c_str());
    state.in.remove_prefix(taken.size() - stream.avail_in);
    state.filled += room - stream.avail_out;
    return result == BZ_STREAM_END;
  };
  return unpack_by(step, packed, size, where);
}
#endif

[[maybe_unused]] Error no_library(const std::string& where, const char* packing,
                                  const char* package) {
  return {ErrorKind::unavailable, where + " is compressed with " + packing +
                                      ", which this program was built without (" + package + ")"};
}

[[maybe_unused]] constexpr const char* kZstdPackage = "libzstd-dev";

}  // namespace

#ifdef ADASPLATS_HAVE_ZSTD
std::string unpack_sized(std::string_view packing, std::string_view packed,
                         const std::string& where) {
  if (packing != "zstd")
    throw Error(ErrorKind::data,
                where + " is compressed with " + shown(packing) + ", supported is zstd");
  if (packed.empty()) return {};
  const auto size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR) throw damaged_stream(where, packing, "wrong first bytes");
  if (size == ZSTD_CONTENTSIZE_UNKNOWN)
    throw Error(ErrorKind::data, where + " has no decompressed size");
  return unpack(packing, packed, size, where);
}

void unpack_zstd_stream(FunctionRef<std::string_view(std::size_t)> next,
                        FunctionRef<void(std::string_view)> take, const std::string& where) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             &ZSTD_freeDStream);
  if (!stream || ZSTD_isError(ZSTD_initDStream(stream.get())) != 0) throw std::bad_alloc();
  std::string part(ZSTD_DStreamOutSize(), '\0');
  std::size_t left = 0, done = 0;  // 0: a frame has ended
  bool is_full = false;            // the output filled the part, so more may be pending
  for (;;) {
    const std::string_view packed = next(done);
    if (packed.empty() && !is_full) break;
    ZSTD_inBuffer in{packed.data(), packed.size(), 0};
    ZSTD_outBuffer out{part.data(), part.size(), 0};
    left = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(left) != 0) throw damaged_stream(where, "zstd", ZSTD_getErrorName(left));
    take({part.data(), out.pos});
    done = in.pos;
    is_full = out.pos == part.size() && left != 0;
  }
  if (left != 0) throw Error(ErrorKind::data, where + ": the compressed bytes end early");
}
#else
std::string unpack_sized(std::string_view, std::string_view, const std::string& where) {
  throw no_library(where, "zstd", kZstdPackage);
}

void unpack_zstd_stream(FunctionRef<std::string_view(std::size_t)>,
                        FunctionRef<void(std::string_view)>, const std::string& where) {
  throw no_library(where, "zstd", kZstdPackage);
}
#endif

std::string unpack(std::string_view packing, std::string_view packed, std::uint64_t size,
                   const std::string& where) {
  if (size > kMaxChunkBytes)
    throw Error(ErrorKind::data, where + " states a size of " + std::to_string(size) +
                                     " bytes, expected at most " + std::to_string(kMaxChunkBytes));
  [[maybe_unused]] const auto bytes = static_cast<std::size_t>(size);
  if (packing.empty() || packing == "none") {
    if (packed.size() != bytes)
      throw Error(ErrorKind::data, where + " has " + std::to_string(packed.size()) +
                                       " bytes, expected " + std::to_string(bytes));
    return std::string(packed);
  }
#ifdef ADASPLATS_HAVE_ZSTD
  if (packing == "zstd") return unpack_zstd(packed, bytes, where);
#else
  if (packing == "zstd") throw no_library(where, "zstd", kZstdPackage);
#endif
#ifdef ADASPLATS_HAVE_LZ4
  if (packing == "lz4") return unpack_lz4(packed, bytes, where);
#else
  if (packing == "lz4") throw no_library(where, "lz4", "liblz4-dev");
#endif
#ifdef ADASPLATS_HAVE_BZIP2
  if (packing == "bz2") return unpack_bz2(packed, bytes, where);
#else
  if (packing == "bz2") throw no_library(where, "bz2", "libbz2-dev");
#endif
  throw Error(ErrorKind::data, where + " is compressed with " + shown(packing) +
                                   ", supported are zstd, lz4, bz2 and none");
}

}  // namespace adasplats
