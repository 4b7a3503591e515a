// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/view_pages.h"

#include <gtest/gtest.h>

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/levels/level_tree.h"
#include "adasplats/view/page_files.h"
#include "adasplats/view/room_test.h"

namespace adasplats {
namespace {

// Oracle: the protocol's table.
TEST(ViewPages, LayersAreTheirTrees) {
  const Room room;
  const ViewPages pages(room.view);
  const HttpReply table = pages.get("layers/0/table/0.bin");
  ASSERT_EQ(table.status, 200);
  const std::size_t nodes = room.view.layers[0].tree.nodes().size();
  ASSERT_EQ(table.body->size(), 48 * nodes);
  std::size_t in_leaves = 0;
  for (std::size_t n = 0; n < nodes; ++n) {
    std::uint32_t children = 0, count = 0;
    std::memcpy(&children, table.body->data() + 48 * n + 36, 4);
    std::memcpy(&count, table.body->data() + 48 * n + 40, 4);
    const HttpReply node = pages.get("layers/0/nodes/" + std::to_string(n) + ".bin");
    ASSERT_EQ(node.status, 200);
    EXPECT_EQ(node.body->size(), 16 * std::size_t{count});
    if (children == 0) in_leaves += count;
  }
  EXPECT_EQ(in_leaves, room.model.splats()->size());
}

// Oracle: the tree. Its table has several blocks, the last of which is not full.
TEST(ViewPages, LargeTablesComeInBlocks) {
  std::vector<Vec3f> points;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    Random random(3, 1, i);
    points.push_back(
        vec_cast<float>(Vec3d{random.uniform(0, 90), random.uniform(0, 90), random.uniform(0, 9)}));
  }
  ViewScene scene;
  const LevelInput input{
      .disks = {}, .positions = points, .classes = {}, .intensities = {}, .errors_m = {}};
  scene.layers.push_back({"points",
                          false,
                          false,
                          false,
                          false,
                          LevelTree(input, {.leaf_size = 12}, Executor(2)),
                          {},
                          {}});
  const std::span<const LevelNode> nodes = nodes_of(scene.layers[0]);
  ASSERT_GT(nodes.size(), 2 * kTableBlock);
  ASSERT_NE(nodes.size() % kTableBlock, 0U);
  const ViewPages pages(scene);
  std::string all;
  for (std::size_t block = 0; block * kTableBlock < nodes.size(); ++block) {
    const HttpReply reply = pages.get("layers/0/table/" + std::to_string(block) + ".bin");
    ASSERT_EQ(reply.status, 200);
    EXPECT_LE(reply.body->size(), kTableBlock * sizeof(LevelNode));
    all += *reply.body;
  }
  ASSERT_EQ(all.size(), nodes.size_bytes());
  EXPECT_EQ(std::memcmp(all.data(), nodes.data(), all.size()), 0);
  const std::size_t beyond = nodes.size() / kTableBlock + 1;
  EXPECT_EQ(pages.get("layers/0/table/" + std::to_string(beyond) + ".bin").status, 404);
}

TEST(ViewPages, UnknownPathsAreNotFound) {
  const Room room;
  const ViewPages pages(room.view);
  for (const char* path : {"layers",
                           "layers/",
                           "layers/0",
                           "layers/2/table/0.bin",
                           "layers/-1/table/0.bin",
                           "layers/0x0/table/0.bin",
                           "layers/0/nodes/999999.bin",
                           "layers/0/nodes/.bin",
                           "layers/0/nodes/1",
                           "layers/0/nodes/+1.bin",
                           "layers/0/nodes/1.bin/",
                           "layers/18446744073709551616/table/0.bin",
                           "layers/0/table",
                           "layers/0/table/",
                           "layers/0/table/1.bin",
                           "layers/0/table/-1.bin",
                           "layers/0/table/18014398509481984.bin",
                           "layers/0/nodes.bin",
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

TEST(ViewPages, ServesThePageIfItWasBuilt) {
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
  EXPECT_GT(pages.get("app.js").body->size(), 100'000U) << "includes three.js";
}

}  // namespace
}  // namespace adasplats
