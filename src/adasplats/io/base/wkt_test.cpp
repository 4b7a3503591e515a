// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/wkt.h"

#include <gtest/gtest.h>

namespace adasplats {
namespace {

TEST(Wkt, NodesValuesAndQuotes) {
  const WktNode node = parse_wkt("A[\"x, [y]\", 1 ,\n B(2),C[ ],3] rest[1]");
  EXPECT_EQ(node.keyword, "a");
  EXPECT_EQ(node.values, (std::vector<std::string>{"x, [y]", "1", "3"}));
  ASSERT_EQ(node.nodes.size(), 2U);
  EXPECT_EQ(node.nodes[0], (WktNode{"b", {"2"}, {}}));
  EXPECT_EQ(node.nodes[1], (WktNode{"c", {}, {}}));
  EXPECT_EQ(node.find({"c", "d"}), &node.nodes[1]);
  EXPECT_EQ(node.find({"d"}), nullptr);
}

TEST(Wkt, BrokenTexts) {
  for (const char* text : {"", "]", "][", ",", "words", "\"[\""})
    EXPECT_EQ(parse_wkt(text).keyword, "") << text;
  // What is cut has what comes before.
  EXPECT_EQ(parse_wkt("A[1,B[2"), parse_wkt("A[1,B[]]"));
  EXPECT_EQ(parse_wkt("A[1,B[2,"), parse_wkt("A[1,B[2]]"));
}

// Nodes of nodes without end do not take the stack.
TEST(Wkt, DeepTextsAreCut) {
  std::string deep;
  for (int k = 0; k < 100000; ++k) deep += "A[1,";
  WktNode node = parse_wkt(deep);
  int depth = 1;
  for (const WktNode* at = &node; !at->nodes.empty(); at = &at->nodes.front()) ++depth;
  EXPECT_EQ(depth, 32);
  // What follows them is at its place all the same.
  std::string closed = deep + std::string(99999, ']') + ",B[2]]";
  node = parse_wkt(closed);
  EXPECT_NE(node.find({"b"}), nullptr);
}

}  // namespace
}  // namespace adasplats
