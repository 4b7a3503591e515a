// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/serve/request_check.h"

#include <gtest/gtest.h>

#include <set>

#include "adasplats/serve/http_server.h"

namespace adasplats {
namespace {

using namespace std::string_literals;

std::string path_of(std::string_view target) {
  return path_after_token(target, "tok").value_or("-");
}

TEST(PathAfterToken, IsDecodedWithoutQuery) {
  EXPECT_EQ(path_of("/tok/"), "");
  EXPECT_EQ(path_of("/tok/layers/0/table/0.bin"), "layers/0/table/0.bin");
  EXPECT_EQ(path_of("/tok/a?b=/../c"), "a");
  EXPECT_EQ(path_of("/tok/?"), "");
  EXPECT_EQ(path_of("/tok/a%20b%C3%a4"), "a b\u00e4");
  EXPECT_EQ(path_of("/tok/l\xd5..\xd5#\xd5/../a&b"), "l\xd5..\xd5");
  EXPECT_EQ(path_of("/tok/...") + path_of("/tok/a..b") + path_of("/tok/.a"), "...a..b.a");
}

TEST(PathAfterToken, NeedsTheToken) {
  for (const char* target : {"", "/", "tok/", "/tok", "/to/", "/tokk/", "/Tok/", "//tok/", "/tok?/",
                             "/%74ok/", "http://h/tok/", "*", "/tox/", "/xok/"})
    EXPECT_EQ(path_of(target), "-") << target;
  EXPECT_EQ(path_after_token("/x/", ""), std::nullopt);
}

TEST(PathAfterToken, RejectsInvalidPaths) {
  for (const char* target :
       {"/tok/..",     "/tok/../",        "/tok/a/../b", "/tok/a/..",  "/tok/./a", "/tok/%2e%2e/a",
        "/tok/%2E%2e", "/tok/a%2f..%2fb", "/tok/a\\b",   "/tok/a%5cb", "/tok/%00", "/tok/a%00.html",
        "/tok/%0d%0a", "/tok/%7f",        "/tok/%",      "/tok/%1",    "/tok/%zz", "/tok/%-1",
        "/tok/%+1",    "/tok/%0x",        "/tok/% 1"})
    EXPECT_EQ(path_of(target), "-") << target;
  // Decoded once: the name contains a percent sign.
  EXPECT_EQ(path_of("/tok/%252e%252e/a"), "%2e%2e/a");
}

TEST(OwnHost, IsTheAddressOrThisMachine) {
  const ListenAddress listening{"127.0.0.1", 8123};
  for (const char* host : {"127.0.0.1:8123", "localhost:8123", "LocalHost:8123", "[::1]:8123",
                           "[0:0:0:0:0:0:0:1]:8123"})
    EXPECT_TRUE(is_own_host(host, listening)) << host;
  const std::string zero = "localhost\0:8123"s;
  for (const std::string& host : {""s,
                                  ":"s,
                                  ":8123"s,
                                  "localhost"s,
                                  "localhost:"s,
                                  "localhost:8124"s,
                                  "localhost:08123 "s,
                                  "localhost:+8123"s,
                                  "localhost:73659"s,
                                  "evil.example:8123"s,
                                  "127.0.0.1.evil.example:8123"s,
                                  "localhost.:8123"s,
                                  "127.1:8123"s,
                                  "192.168.0.1:8123"s,
                                  "[::1"s,
                                  "[::1]8123"s,
                                  "::1:8123"s,
                                  "[127.0.0.1]:8123"s,
                                  "[localhost]:8123"s,
                                  "127.0.0.1:8123:8123"s,
                                  "a@127.0.0.1:8123"s,
                                  zero})
    EXPECT_FALSE(is_own_host(host, listening)) << host;
}

TEST(OwnHost, MayOmitTheDefaultPort) {
  EXPECT_TRUE(is_own_host("localhost", {"127.0.0.1", 80}));
  EXPECT_TRUE(is_own_host("127.0.0.1", {"127.0.0.1", 80}));
  EXPECT_FALSE(is_own_host("localhost:", {"127.0.0.1", 80}));
}

TEST(OwnHost, IsAnyNumericAddressBeyondThisMachine) {
  const ListenAddress listening{"0.0.0.0", 8123};
  EXPECT_TRUE(is_own_host("192.168.0.1:8123", listening));
  EXPECT_TRUE(is_own_host("[fe80::1]:8123", listening));
  EXPECT_FALSE(is_own_host("evil.example:8123", listening));
  EXPECT_TRUE(is_own_host("127.0.0.2:1", {"127.0.0.2", 1}));
  EXPECT_FALSE(is_own_host("127.0.0.3:1", {"127.0.0.2", 1}));
}

TEST(OwnOrigin, IsTheHostOverHttp) {
  EXPECT_TRUE(is_own_origin("http://localhost:1", "localhost:1"));
  EXPECT_TRUE(is_own_origin("HTTP://LOCALHOST:1", "localhost:1"));
  for (const char* origin : {"", "null", "http://", "http://localhost", "http://localhost:12",
                             "https://localhost:1", "http://127.0.0.1:1", "http://localhost:1/"})
    EXPECT_FALSE(is_own_origin(origin, "localhost:1")) << origin;
}

TEST(HostOf, CanBeOpenedByABrowser) {
  EXPECT_EQ(host_of({"127.0.0.1", 1}), "127.0.0.1:1");
  EXPECT_EQ(host_of({"::1", 1}), "[::1]:1");
  EXPECT_EQ(host_of({"0.0.0.0", 1}), "127.0.0.1:1");
  EXPECT_EQ(host_of({"::", 1}), "[::1]:1");
  EXPECT_TRUE(is_loopback("127.8.0.1") && is_loopback("::1"));
  EXPECT_FALSE(is_loopback("0.0.0.0") || is_loopback("::") || is_loopback("x"));
}

TEST(RandomToken, IsLongAndUnique) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 32);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 100);
}

}  // namespace
}  // namespace adasplats
