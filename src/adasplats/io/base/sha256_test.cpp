// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/sha256.h"

#include <gtest/gtest.h>

#include "adasplats/io/base/files_test.h"

namespace adasplats {
namespace {

std::string digest_of(std::string_view text, std::size_t piece) {
  Sha256 hash;
  for (std::size_t i = 0; i < text.size(); i += piece) hash.add(text.substr(i, piece));
  return hash.digest();
}

// Oracle: NIST, "Cryptographic Standards and Guidelines: example values", SHA-256, and the empty
// message and the million of FIPS 180-2, appendix B.3.
TEST(Sha256, PublishedValues) {
  const std::pair<std::string, std::string> examples[] = {
      {"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
      {"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
      {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
       "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"},
      {std::string(1000000, 'a'),
       "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"}};
  for (const auto& [text, digest] : examples) {
    EXPECT_EQ(digest_of(text, 1 + text.size()), digest);
    EXPECT_EQ(digest_of(text, 63), digest);
  }
}

// Oracle: one call for all; every length around the ends of blocks.
TEST(Sha256, PiecesDoNotMatter) {
  for (std::size_t length = 0; length < 200; ++length) {
    const std::string text(length, 'x');
    const std::string whole = digest_of(text, 1000);
    for (const std::size_t piece : {1U, 7U, 64U, 65U}) EXPECT_EQ(digest_of(text, piece), whole);
  }
}

TEST(Sha256, OfFiles) {
  const TemporaryFolder folder;
  const std::string content(600000, 'y');
  EXPECT_EQ(sha256_of_file(folder.write("a", content)), digest_of(content, content.size()));
  EXPECT_EQ(sha256_of_file(folder.write("b", "")), digest_of("", 1));
  expect_error(ErrorKind::no_input, {"missing"},
               [&] { sha256_of_file(folder.path() / "missing"); });
}

}  // namespace
}  // namespace adasplats
