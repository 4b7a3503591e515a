// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/pickle/gzip.h"

#include <gtest/gtest.h>

#include "adasplats/core/maths/random.h"
#include "adasplats/io/base/files_test.h"

namespace adasplats {
namespace {

std::string noise(std::size_t bytes) {
  Random random(3, 0, bytes);
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text += static_cast<char>(random.next_bits());
  return text;
}

// Oracle: round trip, also of data larger than a step of the reader that hardly shrink.
TEST(Gzip, RoundTrip) {
  for (const std::string& text :
       {std::string(), std::string("a"), std::string(5'000'000, 'x'), noise(3'000'001)}) {
    const std::string packed = gzipped(text);
    EXPECT_EQ(packed, gzipped(text));
    EXPECT_EQ(gunzipped("f", packed, text.size()), text);
    EXPECT_EQ(gunzipped("f", packed + packed, 2 * text.size()), text + text);
  }
}

// Oracle: the bytes of `printf abc | gzip -n`.
TEST(Gzip, ReadsWhatGzipWrites) {
  const std::string packed(
      "\x1f\x8b\x08\0\0\0\0\0\0\x03\x4b\x4c\x4a\x06\0\xc2\x41\x24\x35\x03\0\0\0", 23);
  EXPECT_EQ(gunzipped("f", packed, 3), "abc");
}

TEST(Gzip, BrokenFiles) {
  const std::string packed = gzipped(std::string(5'000'000, 'x'));
  expect_error(ErrorKind::data, {"f: decompresses to more than 4999999 bytes"},
               [&] { gunzipped("f", packed, 4'999'999); });
  expect_error(ErrorKind::data, {"f: byte", "end early"},
               [&] { gunzipped("f", packed.substr(0, packed.size() - 1), 5'000'000); });
  std::string broken = packed;
  broken[packed.size() - 6] ^= 1;  // of the checksum
  expect_error(ErrorKind::data, {"damaged"}, [&] { gunzipped("f", broken, 5'000'000); });
  expect_error(ErrorKind::data, {"not gzip data"},
               [&] { gunzipped("f", packed + "x y z", 5'000'000); });
}

}  // namespace
}  // namespace adasplats
