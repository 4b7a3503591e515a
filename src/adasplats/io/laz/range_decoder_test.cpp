// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/range_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "adasplats/io/laz/plain_encoder_test.h"
#include "adasplats/io/laz/predictions.h"

namespace adasplats {
namespace {

using laz_test::PlainEncoder;
using laz_test::PlainModel;

// Oracle: what an encoder was given that is written down apart.
TEST(RangeDecoder, DecodesTheEncodedSymbols) {
  std::mt19937 random(1);
  for (const std::uint32_t symbols : {2U, 3U, 16U, 17U, 33U, 64U, 128U, 256U, 515U, 516U}) {
    SCOPED_TRACE(symbols);
    // Evenly spread, then rare ones but the first and the last.
    std::vector<std::uint32_t> sent;
    sent.reserve(60000);
    for (int k = 0; k < 20000; ++k) sent.push_back(static_cast<std::uint32_t>(random() % symbols));
    for (int k = 0; k < 40000; ++k)
      sent.push_back(static_cast<std::uint32_t>(
          random() % 50 == 0 ? random() % symbols : (k / 9000 % 2) * (symbols - 1)));
    PlainEncoder encoder;
    PlainModel plain(symbols);
    for (const std::uint32_t symbol : sent) encoder.put(plain, symbol);
    const std::vector<std::byte> bytes = encoder.finish();
    bool is_broken = false;
    RangeDecoder decoder(bytes, is_broken);
    SymbolModel model(symbols);
    std::vector<std::uint32_t> found;
    for (std::size_t k = 0; k < sent.size(); ++k) found.push_back(model.decode(decoder));
    EXPECT_EQ(found, sent);
    EXPECT_FALSE(is_broken);
  }
}

TEST(RangeDecoder, DecodesTheEncodedBits) {
  std::mt19937 random(2);
  PlainEncoder encoder;
  std::vector<std::uint32_t> sent;
  for (unsigned k = 0; k < 5000; ++k) {
    const unsigned bits = 1 + k % 32;
    sent.push_back(static_cast<std::uint32_t>(random()) >> (32 - bits));
    encoder.put_bits(sent.back(), bits);
  }
  const std::vector<std::byte> bytes = encoder.finish();
  bool is_broken = false;
  RangeDecoder decoder(bytes, is_broken);
  std::vector<std::uint32_t> found;
  for (unsigned k = 0; k < 5000; ++k) found.push_back(decoder.bits(1 + k % 32));
  EXPECT_EQ(found, sent);
  EXPECT_FALSE(is_broken);
}

// Whatever the bytes are: symbols stay below their number, and the end is noticed.
TEST(RangeDecoder, AnyBytesGiveSymbolsOfTheAlphabet) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::byte> bytes(random() % 60);
    for (std::byte& value : bytes)
      value = round % 2 == 0 ? std::byte{0xff} : static_cast<std::byte>(random());
    bool is_broken = false;
    RangeDecoder decoder(bytes, is_broken);
    SymbolModel small(3), large(515);
    BitModel bit;
    for (int k = 0; k < 20000; ++k) {
      ASSERT_LT(small.decode(decoder), 3U);
      ASSERT_LT(large.decode(decoder), 515U);
      ASSERT_LE(bit.decode(decoder), 1U);
      ASSERT_LT(decoder.bits(7), 128U);
    }
    EXPECT_TRUE(is_broken);
  }
}

// The least that a symbol costs, on which limits of memory rest: what goes on for ever ends.
TEST(RangeDecoder, EvenTheMostProbableSymbolCosts) {
  const std::vector<std::byte> bytes(1000, std::byte{0});
  bool is_broken = false;
  RangeDecoder decoder(bytes, is_broken);
  SymbolModel model(64);
  std::size_t symbols = 0;
  for (; !is_broken && symbols < 10000000; ++symbols) model.decode(decoder);
  EXPECT_LT(symbols, 1000 * std::size_t{8} * 361);  // -log2(1 - 63 / 2^15) = 1 / 360.2
  EXPECT_GT(symbols, 100000U);
}

// Five numbers of which every new one is among the sorted, by sorting.
TEST(RunningMedian, AgreesWithASortedList) {
  std::mt19937 random(4);
  for (const std::int32_t range : {2, 10, 1000000}) {
    RunningMedian median;
    std::array<std::int32_t, 6> sorted{};
    bool drops_largest = true;
    for (int k = 0; k < 2000; ++k) {
      const auto value =
          static_cast<std::int32_t>(random() % static_cast<unsigned>(range)) - range / 2;
      const std::int32_t middle = sorted[2];
      // The place of the one that goes takes the new one.
      sorted[drops_largest ? 4 : 0] = value;
      std::sort(sorted.begin(), sorted.begin() + 5);
      drops_largest = drops_largest ? value < middle : value <= middle;
      median.add(value);
      ASSERT_EQ(median.get(), sorted[2]);
    }
  }
}

}  // namespace
}  // namespace adasplats
