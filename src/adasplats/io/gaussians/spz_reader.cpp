// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/gaussians/spz_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/bags/unpack.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/pickle/gzip.h"

namespace adasplats {
namespace {

constexpr std::string_view kSpzMagic = "NGSP";
constexpr std::uint32_t kMaxGaussians = 1U << 26;
constexpr std::array<const char*, 14> kSpzColumns = {
    "x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
    "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};

/// Components x, y, z, w.
using SpzRotation = std::array<double, 4>;

struct SpzHead {
  std::uint32_t version = 0, count = 0;
  std::uint8_t fractional_bits = 0;
  std::uint8_t streams = 0;  ///< from version 4 on
};

/// The attributes of all Gaussians, one after the other, in the order of the file.
constexpr std::size_t kPositions = 0, kAlphas = 1, kColors = 2, kScales = 3, kRotations = 4;
constexpr std::size_t kSpzStreams = 5;

std::uint64_t whole_number(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t k = size; k-- > 0;)
    value = value << 8 | static_cast<std::uint8_t>(bytes[at + k]);
  return value;
}

std::string_view bytes_of(InputFile& file) {
  const auto size = static_cast<std::size_t>(file.size_bytes());
  return {reinterpret_cast<const char*>(file.peek(size).data()), size};
}

class SpzFile {
 public:
  explicit SpzFile(const std::filesystem::path& path) : path_(path), file_(path) {
    const std::string_view bytes = bytes_of(file_);
    if (bytes.starts_with(kSpzMagic)) {
      read_head(bytes, 4, 4);
      read_streams(bytes);
      return;
    }
    if (!bytes.starts_with("\x1f\x8b"))
      throw error("is not SPZ: it begins neither with NGSP nor as gzip");
    constexpr std::size_t kMaxBytes = std::size_t{1} << 34;
    constexpr std::size_t kMaxGrowth = 256;  // real ones grow less than tenfold
    content_ = gunzipped(path, bytes, std::min(kMaxBytes, kMaxGrowth * (bytes.size() + 1024)));
    read_head(content_, 2, 3);
    std::string_view rest = std::string_view(content_).substr(kHeadBytes);
    for (std::size_t k = 0; k < kSpzStreams; ++k) {
      const std::size_t size = head_.count * bytes_each(k);
      if (rest.size() < size) throw error("is truncated");
      streams_[k] = rest.substr(0, size);
      rest.remove_prefix(size);
    }
  }

  std::size_t count() const { return head_.count; }

  /// Columns of kSpzColumns, with the axes of the file.
  Vec3d position(std::size_t i) const {
    constexpr int kBits = 24;
    Vec3d at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto value =
          static_cast<std::int64_t>(whole_number(streams_[kPositions], 9 * i + 3 * axis, 3));
      if (value >= std::int64_t{1} << (kBits - 1)) value -= std::int64_t{1} << kBits;
      at[static_cast<int>(axis)] = std::ldexp(static_cast<double>(value), -head_.fractional_bits);
    }
    return at;
  }
  double byte(std::size_t stream, std::size_t index) const {
    return static_cast<double>(static_cast<std::uint8_t>(streams_[stream][index]));
  }
  SpzRotation rotation(std::size_t i) const {
    return head_.version == 2 ? first_three(i) : smallest_three(i);
  }

 private:
  static constexpr std::size_t kHeadBytes = 16;

  Error error(const std::string& text) const { return data_error({path_, {}, {}}, text); }

  std::size_t bytes_each(std::size_t stream) const {
    const std::array<std::size_t, kSpzStreams> bytes = {9, 1, 3, 3, head_.version == 2 ? 3U : 4U};
    return bytes.at(stream);
  }

  void read_head(std::string_view bytes, std::uint32_t first_version, std::uint32_t last_version) {
    if (bytes.size() < kHeadBytes || !bytes.starts_with(kSpzMagic))
      throw error("is not SPZ: its content does not begin with NGSP");
    const auto at = [&](std::size_t k) { return static_cast<std::uint8_t>(bytes[k]); };
    head_ = {static_cast<std::uint32_t>(whole_number(bytes, 4, 4)),
             static_cast<std::uint32_t>(whole_number(bytes, 8, 4)), at(13), at(15)};
    if (head_.version < first_version || head_.version > last_version)
      throw error("SPZ version " + std::to_string(head_.version) + ", expected 2 to 4");
    if (head_.count == 0) throw error("contains no Gaussians");
    if (head_.count > kMaxGaussians)
      throw error(std::to_string(head_.count) + " Gaussians, at most " +
                  std::to_string(kMaxGaussians) + " can be read");
    if (head_.fractional_bits > 24)
      throw error(std::to_string(head_.fractional_bits) +
                  " bits after the point, expected 0 to 24");
  }

  /// Version 4: a table of the sizes of streams, each compressed on its own.
  void read_streams(std::string_view bytes) {
    constexpr std::size_t kPlainHeadBytes = 32, kRowBytes = 16;
    if (bytes.size() < kPlainHeadBytes) throw error("is truncated");
    const std::size_t table = whole_number(bytes, 16, 4);
    std::size_t begin = table + kRowBytes * head_.streams;
    if (head_.streams < kSpzStreams || table < kPlainHeadBytes || begin > bytes.size())
      throw error("its table of streams is damaged");
    for (std::size_t k = 0; k < kSpzStreams; ++k) {
      const std::uint64_t packed = whole_number(bytes, table + kRowBytes * k, 8);
      const std::uint64_t size = whole_number(bytes, table + kRowBytes * k + 8, 8);
      if (size != head_.count * bytes_each(k)) throw error("its table of streams is damaged");
      if (packed > bytes.size() - begin) throw error("is truncated");
      unpacked_[k] = unpack("zstd", bytes.substr(begin, packed), size, path_.string());
      streams_[k] = unpacked_[k];
      begin += packed;
    }
  }

  /// Version 2: x, y and z as 8 bits each; w is not negative.
  SpzRotation first_three(std::size_t i) const {
    SpzRotation q{};
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      q[k] = byte(kRotations, 3 * i + k) / 127.5 - 1;
      square += q[k] * q[k];
    }
    q[3] = std::sqrt(std::max(0.0, 1 - square));
    return q;
  }

  /// The index of the largest component in two bits, then the others in ten: sign and magnitude.
  SpzRotation smallest_three(std::size_t i) const {
    constexpr std::uint64_t kSteps = 511;
    std::uint64_t packed = whole_number(streams_[kRotations], 4 * i, 4);
    const auto largest = static_cast<std::size_t>(packed >> 30);
    SpzRotation q{};
    double square = 0;
    for (std::size_t k = 4; k-- > 0;) {
      if (k == largest) continue;
      const double size = static_cast<double>(packed & kSteps) / (kSteps * std::numbers::sqrt2);
      q[k] = (packed >> 9 & 1) != 0 ? -size : size;
      square += size * size;
      packed >>= 10;
    }
    q[largest] = std::sqrt(std::max(0.0, 1 - square));
    return q;
  }

  std::filesystem::path path_;
  InputFile file_;
  SpzHead head_;
  std::string content_;  ///< of versions 2 and 3
  std::array<std::string, kSpzStreams> unpacked_;
  std::array<std::string_view, kSpzStreams> streams_;
};

/// The product of the rotation from the axes of SPZ to ours with q, as w, x, y, z.
std::array<double, 4> turned(const SpzRotation& q) {
  const auto [x, y, z, w] = q;
  return {0.5 * (w - x + y + z), 0.5 * (w + x + y - z), 0.5 * (y - z - w - x),
          0.5 * (x + y + z - w)};
}

}  // namespace

bool is_spz(const std::filesystem::path& path) {
  return lower_case(path.extension().string()) == ".spz";
}

Table read_spz(const std::filesystem::path& path) {
  const SpzFile file(path);
  std::array<std::vector<double>, kSpzColumns.size()> columns;
  for (std::vector<double>& column : columns) column.reserve(file.count());
  for (std::size_t i = 0; i < file.count(); ++i) {
    const Vec3d at = file.position(i);
    const std::array<double, 4> turn = turned(file.rotation(i));
    const double opacity = file.byte(kAlphas, i) / 255;
    const auto color = [&](std::size_t k) {
      return (file.byte(kColors, 3 * i + k) / 255 - 0.5) / 0.15;
    };
    const auto scale = [&](std::size_t k) { return file.byte(kScales, 3 * i + k) / 16 - 10; };
    const std::array<double, kSpzColumns.size()> row = {-at.z,
                                                        -at.x,
                                                        at.y,
                                                        color(0),
                                                        color(1),
                                                        color(2),
                                                        std::log(opacity / (1 - opacity)),
                                                        scale(0),
                                                        scale(1),
                                                        scale(2),
                                                        turn[0],
                                                        turn[1],
                                                        turn[2],
                                                        turn[3]};
    for (std::size_t k = 0; k < row.size(); ++k) columns[k].push_back(row[k]);
  }
  Table table;
  table.rows = file.count();
  table.columns.reserve(columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k)
    table.columns.push_back({kSpzColumns[k], std::move(columns[k])});
  return table;
}

}  // namespace adasplats
