// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

constexpr Vec3d kOrigin = {1000, 2000, 30};
constexpr ImageLayer kAll[] = {ImageLayer::depth, ImageLayer::range, ImageLayer::class_id,
                               ImageLayer::normal, ImageLayer::primitive};

/// Walls in front of a camera at kOrigin that looks along +x: a large one 10 m away, a small one
/// 4 m away to the left, tilted; nothing on the right.
struct Walls {
  std::vector<Disk> disks = {{{10, 3, 0}, 6, {1, 0, 0}}, {{4, 1.5, 0}, 0.5, {0.6F, 0.8F, 0}}};
  std::vector<std::uint16_t> classes = {50, 80};

  ImageScene scene() const {
    ImageScene scene;
    scene.view = {disks, nullptr};
    scene.attributes.classes = classes;
    scene.origin = kOrigin;
    return scene;
  }
};

Camera camera_with(bool is_fisheye, std::vector<double> k, double p1) {
  Lens lens;
  lens.width = 162;  // no multiples of a block
  lens.height = 101;
  lens.fx = 90;
  lens.fy = 91;
  lens.cx = 79.3;
  lens.cy = 51.9;
  lens.is_fisheye = is_fisheye;
  for (std::size_t i = 0; i < k.size(); ++i) lens.k[i] = k[i];
  lens.p1 = p1;
  Camera camera;
  camera.world_from_camera.translation = kOrigin;
  camera.width = lens.width;
  camera.height = lens.height;
  camera.lens = complete_lens(lens, "the test's");
  return camera;
}

std::vector<Camera> cameras() {
  Camera plain = camera_with(false, {}, 0);
  plain.lens.reset();
  return {plain, camera_with(false, {}, 0), camera_with(false, {-0.3, 0.1}, 0.01),
          camera_with(true, {-0.02, 0.01}, 0)};
}

LayerImages cast(const Walls& walls, const Camera& camera, int threads = 2) {
  const Executor executor(threads);
  const auto tracer = make_cpu_tracer({walls.disks, nullptr}, executor);
  return cast_layers(*tracer, walls.scene(), camera, kAll, executor);
}

// Oracle: the planes of the walls, and the rays of the camera through the centres of the pixels.
TEST(Layers, AreThoseOfTheSurfacesThatThePixelsShow) {
  const Walls walls;
  for (const Camera& camera : cameras()) {
    const LayerImages layers = cast(walls, camera);
    int hits[2] = {0, 0};
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const auto i = static_cast<std::size_t>(y * camera.width + x);
        const Vec3d ray = vec_cast<double>(camera.ray(x + 0.5, y + 0.5, kOrigin).direction);
        int expected = -1;
        double range = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 2; ++k) {
          const Disk& disk = walls.disks[static_cast<std::size_t>(k)];
          const Vec3d normal = vec_cast<double>(disk.normal),
                      center = vec_cast<double>(disk.center);
          const double t = dot(normal, center) / dot(normal, ray);
          const bool is_hit = t > 0 && length(t * ray - center) < static_cast<double>(disk.radius);
          if (is_hit && t < range) range = t, expected = k;
        }
        ASSERT_EQ(layers.primitives[i], expected) << x << " " << y;
        if (expected < 0) {
          ASSERT_TRUE(std::isnan(layers.depth_m[i]) && std::isnan(layers.range_m[i]));
          ASSERT_TRUE(std::isnan(layers.normals[3 * i]) && layers.classes[i] == -1);
          continue;
        }
        ++hits[expected];
        ASSERT_NEAR(layers.range_m[i], range, 1e-4);
        ASSERT_NEAR(layers.depth_m[i], range * ray.x, 1e-4);
        ASSERT_EQ(layers.classes[i], expected == 0 ? 50 : 80);
        const Vec3f normal = {layers.normals[3 * i], layers.normals[3 * i + 1],
                              layers.normals[3 * i + 2]};
        ASSERT_NEAR(length(normal), 1, 1e-6);
        ASSERT_LT(dot(vec_cast<double>(normal), ray), 0) << "towards the camera";
        ASSERT_NEAR(std::fabs(dot(normal, walls.disks[static_cast<std::size_t>(expected)].normal)),
                    1, 1e-6);
      }
    EXPECT_GT(hits[0], 1000);
    EXPECT_GT(hits[1], 100);
  }
}

// Oracle: the lens's own pixels without a ray.
TEST(Layers, PixelsThatTheLensShowsNothingInAreEmpty) {
  Walls walls;
  walls.disks = {{{10, 0, 0}, 1000, {1, 0, 0}}};
  walls.classes = {1};
  const Camera camera = camera_with(false, {-0.6}, 0);
  const LayerImages layers = cast(walls, camera);
  EXPECT_TRUE(std::isnan(layers.depth_m.front()) && std::isnan(layers.depth_m.back()));
  std::uint64_t without = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const bool is_lit = !(camera.lens->direction(x, y) == Vec3d{});
      without += is_lit ? 0 : 1;
      ASSERT_EQ(std::isnan(layers.depth_m[static_cast<std::size_t>(y * camera.width + x)]),
                !is_lit);
    }
  EXPECT_EQ(layers.unlit_pixels, without);
  EXPECT_GT(without, 100U);
  // The picture is black there, and has the surface elsewhere.
  const Executor executor(2);
  const auto tracer = make_cpu_tracer({walls.disks, nullptr}, executor);
  const Image image = render_image(*tracer, walls.scene(), camera, {}, executor);
  for (std::size_t i = 0; i < layers.depth_m.size(); ++i)
    ASSERT_EQ(image.pixels[3 * i] == 0, std::isnan(layers.depth_m[i])) << i;
}

TEST(Layers, AreTheSameOnAnyNumberOfThreads) {
  const Camera camera = camera_with(false, {-0.3, 0.1}, 0.01);
  const LayerImages one = cast({}, camera, 1), three = cast({}, camera, 3);
  EXPECT_EQ(one.primitives, three.primitives);
  EXPECT_EQ(one.classes, three.classes);
}

TEST(Layers, OnlyThoseWantedAreMade) {
  const Walls walls;
  const Executor executor(1);
  const auto tracer = make_cpu_tracer({walls.disks, nullptr}, executor);
  const Camera camera = camera_with(false, {}, 0);
  const ImageLayer range[] = {ImageLayer::range};
  const LayerImages layers = cast_layers(*tracer, walls.scene(), camera, range, executor);
  EXPECT_EQ(layers.range_m.size(), 162U * 101U);
  EXPECT_TRUE(layers.depth_m.empty() && layers.classes.empty() && layers.normals.empty() &&
              layers.primitives.empty());
  ImageScene scene = walls.scene();
  scene.attributes.classes = {};
  expect_error(ErrorKind::usage, {"no classes"},
               [&] { cast_layers(*tracer, scene, camera, kAll, executor); });
}

TEST(Layers, MillimetresCountWhatTheyCannotHold) {
  const std::vector<float> metres = {kNaN, 1.2345F, 65.535F, 65.5356F, 1000, -2, 0.0001F};
  const Millimetres mm = millimetres_of(metres);
  EXPECT_EQ(mm.values, (std::vector<std::uint16_t>{0, 1235, 65535, 65535, 65535, 0, 0}));
  EXPECT_EQ(mm.clipped, 4U);
}

}  // namespace
}  // namespace adasplats
