// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

namespace adasplats::spz_samples {

inline std::string words(std::initializer_list<std::uint32_t> values, std::size_t bytes = 4) {
  std::string text;
  for (const std::uint32_t value : values)
    for (std::size_t k = 0; k < bytes; ++k) text += static_cast<char>(value >> (8 * k));
  return text;
}

/// x = 1, y = -2, z = 0.5 m with 12 bits after the point; opacity 128/255; scales of 1, e and e^-6
/// m.
inline const std::string kPlace = words({1 << 12, 0x1000000 - (2 << 12), 1 << 11}, 3);
inline const std::string kAlpha = "\x80", kColor = std::string("\x00\x80\xff", 3),
                         kScale = "\xa0\xb0\x40";
/// A quarter turn about the x axis, in the layouts of version 2 and of the later ones: w is the
/// largest of equal components, so that x is 511 steps.
inline const std::string kThree = "\xda\x80\x80", kFour = words({3U << 30 | 511 << 20});

inline std::string head(std::uint32_t version, std::uint32_t count = 1) {
  return "NGSP" + words({version, count, 12U << 8});
}
inline std::string version_2() { return head(2) + kPlace + kAlpha + kColor + kScale + kThree; }
inline std::string version_3() { return head(3) + kPlace + kAlpha + kColor + kScale + kFour; }

/// A frame of zstd (RFC 8878): one segment with its size, one raw block.
inline std::string frame(const std::string& bytes) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  return "\x28\xb5\x2f\xfd\xa0" + words({size}) + words({size << 3 | 1}, 3) + bytes;
}

inline std::string version_4() {
  std::string table, streams;
  for (const std::string& stream : {kPlace, kAlpha, kColor, kScale, kFour}) {
    table += words({static_cast<std::uint32_t>(frame(stream).size()), 0,
                    static_cast<std::uint32_t>(stream.size()), 0});
    streams += frame(stream);
  }
  return "NGSP" + words({4, 1, 5U << 24 | 12 << 8, 32, 0, 0, 0}) + table + streams;
}

}  // namespace adasplats::spz_samples
