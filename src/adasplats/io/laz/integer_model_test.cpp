// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/integer_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "adasplats/io/laz/plain_encoder_test.h"

namespace adasplats {
namespace {

using laz_test::PlainEncoder;
using laz_test::PlainModel;

/// Packs a difference as LASzip's interval k = 1 to 31 has it: the lower half of 2^k places are the
/// negative numbers from -(2^k - 1), the upper half those above 2^(k - 1).
void put_difference(PlainEncoder& encoder, PlainModel& lengths, std::vector<PlainModel>& places,
                    std::int64_t difference) {
  unsigned k = 1;
  while (difference < -((std::int64_t{1} << k) - 1) || difference > (std::int64_t{1} << k)) ++k;
  encoder.put(lengths, k);
  const std::int64_t place =
      difference > 0 ? difference - 1 : difference + (std::int64_t{1} << k) - 1;
  const unsigned low = k > 8 ? k - 8 : 0;
  encoder.put(places[k], static_cast<std::uint32_t>(place >> low));
  if (low > 0)
    encoder.put_bits(static_cast<std::uint32_t>(place & ((std::int64_t{1} << low) - 1)), low);
}

TEST(IntegerModel, DecodesTheEncodedNumbers) {
  const std::vector<std::int64_t> differences = {2,     -1,    3,      4,          5,     -7,
                                                 100,   -255,  256,    257,        -256,  1000,
                                                 -1023, 65536, -70000, 2147483647, 100000};
  PlainEncoder encoder;
  PlainModel lengths(33);
  std::vector<PlainModel> places;
  for (unsigned k = 0; k <= 32; ++k) places.emplace_back(1U << std::clamp(k, 1U, 8U));
  for (const std::int64_t difference : differences)
    put_difference(encoder, lengths, places, difference);
  encoder.put(lengths, 32);  // means the minimum
  const std::vector<std::byte> bytes = encoder.finish();
  bool is_broken = false;
  RangeDecoder decoder(bytes, is_broken);
  IntegerModel integers(32);
  for (const std::int64_t difference : differences) {
    const std::int32_t prediction = -17;
    // Sums wrap.
    EXPECT_EQ(integers.decode_signed(decoder, prediction),
              static_cast<std::int32_t>(difference + prediction));
  }
  EXPECT_EQ(integers.decode_signed(decoder, 0), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(integers.last_bits(), 32U);
  EXPECT_FALSE(is_broken);
}

// 16 bits: 65535 is one below 0.
TEST(IntegerModel, NumbersOfFewerBitsWrap) {
  PlainEncoder encoder;
  PlainModel lengths(17);
  std::vector<PlainModel> places;
  for (unsigned k = 0; k <= 16; ++k) places.emplace_back(1U << std::clamp(k, 1U, 8U));
  put_difference(encoder, lengths, places, -3);
  put_difference(encoder, lengths, places, 3);
  const std::vector<std::byte> bytes = encoder.finish();
  bool is_broken = false;
  RangeDecoder decoder(bytes, is_broken);
  IntegerModel integers(16);
  EXPECT_EQ(integers.decode(decoder, 2), 65535U);
  EXPECT_EQ(integers.decode(decoder, 65535), 2U);
}

}  // namespace
}  // namespace adasplats
