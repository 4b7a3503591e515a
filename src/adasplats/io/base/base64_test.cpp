// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/base64.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace adasplats {
namespace {

// Oracle: the examples of RFC 4648, section 10.
TEST(Base64, ExamplesOfRfc4648) {
  const std::array<std::string, 7> plain = {"", "f", "fo", "foo", "foob", "fooba", "foobar"};
  const std::array<std::string, 7> coded = {"",         "Zg==",     "Zm8=",    "Zm9v",
                                            "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
  for (std::size_t k = 0; k < plain.size(); ++k) {
    EXPECT_EQ(to_base64(plain[k]), coded[k]);
    EXPECT_EQ(from_base64(coded[k]), plain[k]);
  }
  EXPECT_EQ(to_base64("\xff\xfe\xfd"), "//79");
  EXPECT_EQ(from_base64("Zm8"), "fo");  // without padding
  for (const char* const wrong : {"Zm9v\n", " Zm9v", "Zm=v", "Zm9-"})
    EXPECT_FALSE(from_base64(wrong).has_value()) << wrong;
}

}  // namespace
}  // namespace adasplats
