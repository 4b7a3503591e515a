// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/field_decoder.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "adasplats/io/e57/e57_file_test.h"

namespace adasplats {
namespace {

/// What the decoder makes of a stream that comes in pieces of that many bytes.
std::vector<double> decoded(const E57Field& field, std::size_t rows, const std::string& stream,
                            std::size_t piece) {
  FieldDecoder decoder(field, rows);
  for (std::size_t from = 0; from < stream.size(); from += piece)
    decoder.take(std::as_bytes(std::span(stream))
                     .subspan(from)
                     .first(std::min(piece, stream.size() - from)));
  EXPECT_TRUE(decoder.is_complete());
  return decoder.take_values();
}

// Oracle: bits put one by one.
TEST(FieldDecoder, IntegersOfEveryWidthInPiecesOfEverySize) {
  std::mt19937_64 random(1);
  for (unsigned bits = 1; bits <= 64; ++bits) {
    io_test::PackedBits stream;
    std::vector<double> expected;
    for (int k = 0; k < 50; ++k) {
      const std::uint64_t stored = bits == 64 ? random() : random() % (std::uint64_t{1} << bits);
      stream.put_bits(stored, bits);
      expected.push_back(static_cast<double>(static_cast<std::int64_t>(stored - 17)));
    }
    const E57Field field{"f", "f", E57Codec::integer, -17, bits, 1, 0};
    for (const std::size_t piece : {1U, 2U, 7U, 64U, 1000U})
      EXPECT_EQ(decoded(field, 50, stream.bytes(), piece), expected) << bits << ", " << piece;
  }
}

TEST(FieldDecoder, RealsAndConstants) {
  const std::vector<double> expected = {1.5, -2, 1e30};
  const E57Field single{"f", "f", E57Codec::f32, 0, 32, 1, 0};
  const E57Field real{"f", "f", E57Codec::f64, 0, 64, 1, 0};
  const E57Field constant{"f", "f", E57Codec::integer, 5, 0, 0.5, 1};
  EXPECT_EQ(decoded(single, 2, io_test::stream_of<float>({1.5F, -2}), 3),
            (std::vector<double>{1.5, -2}));
  EXPECT_EQ(decoded(real, 3, io_test::stream_of(expected), 5), expected);
  EXPECT_EQ(decoded(constant, 2, "", 1), (std::vector<double>{3.5, 3.5}));
  EXPECT_EQ(decoded(real, 0, "padding", 1), std::vector<double>());
}

TEST(FieldDecoder, PaddingAndWhatIsMissing) {
  const E57Field field{"f", "f", E57Codec::integer, 0, 3, 1, 0};
  EXPECT_EQ(decoded(field, 1, "\x05zzzz", 1), std::vector<double>{5});
  FieldDecoder decoder(field, 3);
  const std::string byte = "\x05";
  decoder.take(std::as_bytes(std::span(byte)));
  EXPECT_FALSE(decoder.is_complete());
  EXPECT_EQ(decoder.values().size(), 2U);
}

}  // namespace
}  // namespace adasplats
