// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "adasplats/io/e57/e57_file_test.h"
#include "adasplats/io/e57/paged_file.h"

namespace adasplats {
namespace {

std::uint32_t crc_of_text(const std::string& text) {
  return crc32c(std::as_bytes(std::span(text)));
}

// Oracle: RFC 3720, appendix B.4, and the check value of the catalogue of CRCs.
TEST(Crc32c, PublishedValues) {
  EXPECT_EQ(crc_of_text("123456789"), 0xe3069283U);
  EXPECT_EQ(crc_of_text(std::string(32, '\0')), 0x8a9136aaU);
  EXPECT_EQ(crc_of_text(std::string(32, '\xff')), 0x62a8ab43U);
  std::string ascending;
  for (char byte = 0; byte < 32; ++byte) ascending += byte;
  EXPECT_EQ(crc_of_text(ascending), 0x46dd794eU);
  EXPECT_EQ(crc_of_text(""), 0U);
}

// Oracle: the definition, a bit at a time.
TEST(Crc32c, OfEveryLength) {
  std::string text;
  for (int k = 0; k < 70; ++k) {
    EXPECT_EQ(crc_of_text(text), io_test::plain_crc32c(text)) << text.size();
    text += static_cast<char>(37 * k + 11);
  }
}

}  // namespace
}  // namespace adasplats
