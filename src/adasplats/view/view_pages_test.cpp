// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/view_pages.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "adasplats/view/page_files.h"
#include "adasplats/view/room_test.h"

namespace adasplats {
namespace {

// Oracle: the protocol's table.
TEST(ViewPages, LayersAreTheirTrees) {
  const Room room;
  const ViewPages pages(room.view);
  const HttpReply table = pages.get("layers/0/nodes.bin");
  ASSERT_EQ(table.status, 200);
  std::uint32_t nodes = 0;
  std::memcpy(&nodes, table.body->data(), sizeof(nodes));
  ASSERT_EQ(table.body->size(), 8 + 48 * std::size_t{nodes});
  std::size_t in_leaves = 0;
  for (std::uint32_t n = 0; n < nodes; ++n) {
    std::uint32_t children = 0, count = 0;
    std::memcpy(&children, table.body->data() + 8 + 48 * n + 36, 4);
    std::memcpy(&count, table.body->data() + 8 + 48 * n + 40, 4);
    const HttpReply node = pages.get("layers/0/nodes/" + std::to_string(n) + ".bin");
    ASSERT_EQ(node.status, 200);
    EXPECT_EQ(node.body->size(), 16 * std::size_t{count});
    if (children == 0) in_leaves += count;
  }
  EXPECT_EQ(in_leaves, room.model.splats()->size());
}

TEST(ViewPages, WhatThereIsNotIsNotFound) {
  const Room room;
  const ViewPages pages(room.view);
  for (const char* path : {"layers",
                           "layers/",
                           "layers/0",
                           "layers/2/nodes.bin",
                           "layers/-1/nodes.bin",
                           "layers/0x0/nodes.bin",
                           "layers/0/nodes/999999.bin",
                           "layers/0/nodes/.bin",
                           "layers/0/nodes/1",
                           "layers/0/nodes/+1.bin",
                           "layers/0/nodes/1.bin/",
                           "layers/18446744073709551616/nodes.bin",
                           "scans/0.bin",
                           "scans/../scene.json",
                           "/etc/passwd",
                           "../scene_json.cpp",
                           "scene.jso",
                           "live",
                           "app.js.map",
                           "\\",
                           "index.htm"})
    EXPECT_EQ(pages.get(path).status, 404) << path;
}

TEST(ViewPages, ThePageIsThereWhereItWasBuilt) {
  const Room room;
  const ViewPages pages(room.view);
  if (page_files().empty()) {
    EXPECT_EQ(pages.get("").status, 404);
    GTEST_SKIP() << "built without Node.js";
  }
  const HttpReply page = pages.get("");
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.body->find("app.js"), std::string::npos);
  EXPECT_EQ(pages.get("app.js").content_type, "text/javascript; charset=utf-8");
  EXPECT_GT(pages.get("app.js").body->size(), 100'000U) << "three is in it";
}

}  // namespace
}  // namespace adasplats
