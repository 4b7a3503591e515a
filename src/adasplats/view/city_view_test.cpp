// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/city/small_city_test.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/trace/tracer.h"
#include "adasplats/view/city_picker.h"
#include "adasplats/view/view_pages.h"
#include "adasplats/view/view_scene.h"

namespace adasplats::city_views {
namespace {

ViewScene scene_of(const TemporaryFolder& folder, const CityManifest& city) {
  ViewScene scene;
  scene.name = "city";
  scene.origin = city.origin;
  scene.layers.push_back(
      city_layer("city", std::make_shared<const CityLevels>(folder.path(), city)));
  return scene;
}

// Oracle: the table of the protocol and the manifest.
TEST(CityView, PagesServeTheCityAsOneLayer) {
  const TemporaryFolder folder;
  const CityManifest city = small_city::write_city_with_levels(folder.path());
  const ViewScene scene = scene_of(folder, city);
  const ViewPages pages(scene);
  const auto scene_json = nlohmann::json::parse(*pages.get("scene.json").body);
  EXPECT_EQ(scene_json["layers"].size(), 1U);
  EXPECT_EQ(scene_json["layers"][0]["kind"], "splats");
  EXPECT_EQ(scene_json["layers"][0]["count"], city.splats());
  EXPECT_TRUE(scene_json["layers"][0]["has_classes"]);
  const HttpReply table = pages.get("layers/0/table/0.bin");
  ASSERT_EQ(table.status, 200);
  const std::uint32_t nodes = scene_json["layers"][0]["nodes"];
  ASSERT_EQ(table.body->size(), 48 * std::size_t{nodes});
  std::size_t in_leaves = 0;
  std::vector<bool> is_child(nodes, false);
  for (std::uint32_t n = 0; n < nodes; ++n) {
    std::uint32_t first = 0, children = 0, count = 0;
    std::memcpy(&first, table.body->data() + 48 * n + 32, 4);
    std::memcpy(&children, table.body->data() + 48 * n + 36, 4);
    std::memcpy(&count, table.body->data() + 48 * n + 40, 4);
    const HttpReply node = pages.get("layers/0/nodes/" + std::to_string(n) + ".bin");
    ASSERT_EQ(node.status, 200);
    EXPECT_EQ(node.body->size(), 16 * std::size_t{count});
    if (children == 0) in_leaves += count;
    for (std::uint32_t c = first; children > 0 && c < first + children; ++c) {
      ASSERT_GT(c, n);
      ASSERT_LT(c, nodes);
      EXPECT_FALSE(is_child[c]);
      is_child[c] = true;
    }
  }
  EXPECT_EQ(in_leaves, city.splats());
  EXPECT_EQ(pages.get("layers/0/nodes/" + std::to_string(nodes) + ".bin").status, 404);
}

TEST(CityView, WithoutPosesTheSensorIsAboveTheGround) {
  const TemporaryFolder folder;
  const CityManifest city = small_city::write_city_with_levels(folder.path());
  const ViewScene scene = scene_of(folder, city);
  const RigidTransform pose = start_pose_of(scene, 1.8, Executor(1));
  EXPECT_NEAR(pose.translation.z, 1.8, 0.05);
  EXPECT_NEAR(pose.translation.x, 5000, 25);
}

// Oracle: a tracer over all splats.
TEST(CityPicker, HitsTheSameSplatsAsATracer) {
  const TemporaryFolder folder;
  const CityManifest city = small_city::write_city(folder.path());
  CityPicker picker(folder.path(), city);
  const SplatModel all = load_city(folder.path());
  const std::unique_ptr<Tracer> tracer = make_brute_force_tracer({.disks = all.disks});
  const Executor executor(1);
  std::size_t hits = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    Random random(9, 1, i);
    const Vec3d from = {random.uniform(-12, 22), random.uniform(-12, 22), random.uniform(0.5, 3)};
    const Vec3d to = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.5, 0.1)};
    const Ray ray = {vec_cast<float>(from), 0, vec_cast<float>(normalized(to)), 1e4F};
    Hit expected;
    tracer->nearest(std::span(&ray, 1), std::span(&expected, 1), executor);
    const auto found = picker.nearest(ray);
    ASSERT_EQ(found.has_value(), expected.valid()) << i;
    if (!found) continue;
    ++hits;
    EXPECT_EQ(found->range_m, expected.t);
    EXPECT_EQ(found->splat, expected.primitive);
    EXPECT_EQ(found->class_id, all.classes[expected.primitive]);
    EXPECT_EQ(found->intensity, all.intensities[expected.primitive]);
  }
  EXPECT_GT(hits, 100U);
}

TEST(CityPicker, RaysPastTheCityHitNothing) {
  const TemporaryFolder folder;
  const CityManifest city = small_city::write_city(folder.path());
  CityPicker picker(folder.path(), city);
  EXPECT_FALSE(picker.nearest({{0, 0, 3}, 0, {0, 0, 1}, 1e4F}));
  EXPECT_FALSE(picker.nearest({{500, 0, 1}, 0, {1, 0, 0}, 1e4F}));
}

}  // namespace
}  // namespace adasplats::city_views
