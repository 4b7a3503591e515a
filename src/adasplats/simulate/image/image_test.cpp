// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/simulate/image/color_map.h"
#include "adasplats/simulate/image/developing.h"
#include "adasplats/simulate/image/pixels_test.h"
#include "adasplats/simulate/image/shading.h"

namespace adasplats {
namespace {

std::size_t count_not(const Image& image, Rgb rgb) {
  std::size_t count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += pixel(image, x, y) != rgb ? 1 : 0;
  return count;
}

/// A picture of one scene with the defaults of these tests: from above, 100 pixels for 20 m.
struct Shot {
  std::vector<Disk> disks;
  std::vector<std::uint16_t> classes;
  std::vector<float> intensities;
  std::vector<SemanticGroup> groups;
  TriangleMesh mesh;
  const LabelScheme* labels = nullptr;
  Camera camera = birds_eye({-10, -10, 0}, {10, 10, 5}, 100, 100);
  ImageOptions options = bare();

  /// Every sample has its own colour alone, on white.
  static ImageOptions bare() {
    ImageOptions options;
    options.background = {255, 255, 255};
    options.sky = options.relief = false;
    return options;
  }

  Image render(int threads = 2) const {
    const Executor executor(threads);
    const SceneView view = {disks, &mesh};
    const auto tracer = make_embree_tracer(view, executor);
    const ImageScene scene = {view, {classes, {}, intensities}, groups, labels, {0, 0, 0}};
    return render_image(*tracer, scene, camera, options, executor);
  }
};

// Oracle of the tests here where nothing else is said: analytic.

TEST(RenderImage, AnEmptySceneIsBackground) {
  Shot shot;
  shot.options.background = {1, 2, 3};
  const Image image = shot.render();
  EXPECT_EQ(image.pixels.size(), 30'000U);
  EXPECT_EQ(count_not(image, {1, 2, 3}), 0U);
}

TEST(RenderImage, ADiskCoversItsArea) {
  Shot shot;
  shot.disks = {{{0, 0, 1}, 8, {0, 0, 1}}};
  const auto pixels = static_cast<double>(count_not(shot.render(), kWhite));
  const double expected = std::numbers::pi * 64 * std::pow(100 / 20.4, 2);
  EXPECT_NEAR(pixels, expected, 0.01 * expected);
}

TEST(RenderImage, NorthIsUpAndEastIsRight) {
  Shot shot;
  shot.disks = {{{7, 7, 1}, 2, {0, 0, 1}}};
  const Image image = shot.render();
  EXPECT_NE(pixel(image, 84, 16), kWhite);
  EXPECT_EQ(pixel(image, 16, 84), kWhite);
  EXPECT_EQ(pixel(image, 16, 16), kWhite);
  EXPECT_EQ(pixel(image, 84, 84), kWhite);
}

TEST(RenderImage, ClassesHaveTheirColours) {
  const LabelScheme labels("mine",
                           {{1, "red", SemanticGroup::ground, Mobility::fixed, {200, 0, 0}},
                            {9, "blue", SemanticGroup::ground, Mobility::fixed, {0, 0, 200}}});
  Shot shot;
  shot.labels = &labels;
  shot.disks = {{{-5, 0, 1}, 3, {0, 0, 1}}, {{5, 0, 1}, 3, {0, 0, 1}}, {{0, 7, 1}, 2, {0, 0, 1}}};
  shot.classes = {1, 9, 777};
  const Image image = shot.render();
  const Rgb red = pixel(image, 25, 50), blue = pixel(image, 75, 50), unknown = pixel(image, 50, 16);
  EXPECT_GT(red[0], 150);
  EXPECT_LT(red[1] + red[2], 100) << "muted";
  EXPECT_EQ(blue[2], red[0]) << "the same light";
  EXPECT_EQ(blue[0] + blue[1], red[1] + red[2]);
  EXPECT_EQ(unknown[0], unknown[1]) << "an id that the scheme lacks is grey";
  EXPECT_EQ(unknown[0], unknown[2]);
}

TEST(RenderImage, UnclassifiedSurfacesShowTheirGroup) {
  const LabelScheme labels(
      "mine", {{0, "unlabeled", SemanticGroup::non_surface, Mobility::fixed, {0, 0, 0}}});
  Shot shot;
  shot.labels = &labels;
  shot.disks = {{{0, 0, 1}, 8, {0, 0, 1}}};
  shot.classes = {0};
  const Rgb grey = pixel(shot.render(), 50, 50);
  EXPECT_GT(grey[0], 100);
  EXPECT_EQ(grey[0], grey[1]);
  shot.groups = {SemanticGroup::linear};
  const Rgb reddish = pixel(shot.render(), 50, 50);
  EXPECT_GT(reddish[0], reddish[1] + 50);
}

TEST(RenderImage, GroupsReplaceMissingClassesAndGreyReplacesBoth) {
  Shot shot;
  shot.disks = {{{-5, 0, 1}, 3, {0, 0, 1}}, {{5, 0, 1}, 3, {0, 0, 1}}};
  shot.groups = {SemanticGroup::linear, SemanticGroup::non_surface};
  const Image image = shot.render();
  EXPECT_GT(pixel(image, 25, 50)[0], pixel(image, 25, 50)[1] + 50) << "reddish";
  EXPECT_GT(pixel(image, 75, 50)[1], pixel(image, 75, 50)[0] + 30) << "greenish";
  shot.groups.clear();
  const Rgb grey = pixel(shot.render(), 25, 50);
  EXPECT_EQ(grey[0], grey[1]);
  EXPECT_EQ(grey[0], grey[2]);
}

TEST(RenderImage, BothSidesAreLitEqually) {
  Shot shot;
  shot.options.color = ImageColor::shading;
  shot.disks = {{{0, 0, 1}, 8, {0, 0.6F, 0.8F}}};
  const Image up = shot.render();
  shot.disks[0].normal = {0, -0.6F, -0.8F};
  EXPECT_EQ(shot.render().pixels, up.pixels);
}

TEST(RenderImage, GroundAndFacadeSeenAtTheSameAngleDiffer) {
  Shot shot;
  shot.options.color = ImageColor::shading;
  shot.camera = look_at({-10, 0, 10}, {0, 0, 0});
  shot.camera.width = shot.camera.height = 21;
  shot.disks = {{{0, 0, 0}, 3, {0, 0, 1}}};
  const int ground = pixel(shot.render(), 10, 10)[0];
  shot.disks[0].normal = {1, 0, 0};
  const int facade = pixel(shot.render(), 10, 10)[0];
  EXPECT_GT(ground, facade + 10);
}

TEST(RenderImage, NormalsFaceTheCamera) {
  Shot shot;
  shot.options.color = ImageColor::normal;
  shot.disks = {{{0, 0, 1}, 8, {0, 0, -1}}};
  EXPECT_EQ(pixel(shot.render(), 50, 50), (Rgb{128, 128, 255}));
}

TEST(RenderImage, TrianglesHaveNormalsToo) {
  Shot shot;
  shot.options.color = ImageColor::normal;
  shot.mesh.vertices = {{-9, -9, 1}, {9, -9, 1}, {0, 9, 1}};
  shot.mesh.triangles = {{0, 2, 1}};
  EXPECT_EQ(pixel(shot.render(), 50, 50), (Rgb{128, 128, 255}));
}

TEST(RenderImage, IntensitiesMapFromDarkToBright) {
  Shot shot;
  shot.options.color = ImageColor::intensity;
  shot.disks = {{{-5, 0, 1}, 3, {0, 0, 1}}, {{5, 0, 1}, 3, {0, 0, 1}}, {{0, 7, 1}, 2, {0, 0, 1}}};
  shot.intensities = {0.1F, 0.9F, std::numeric_limits<float>::quiet_NaN()};
  const Image image = shot.render();
  const auto sum = [](Rgb rgb) { return rgb[0] + rgb[1] + rgb[2]; };
  EXPECT_LT(sum(pixel(image, 25, 50)), sum(pixel(image, 75, 50)) - 200);
  EXPECT_EQ(pixel(image, 50, 16)[0], pixel(image, 50, 16)[1]) << "NaN is grey";
  shot.intensities.clear();
  EXPECT_EQ(pixel(shot.render(), 25, 50)[0], pixel(shot.render(), 25, 50)[1]);
}

TEST(RenderImage, RangesMapFromBrightToDark) {
  Shot shot;
  shot.options.color = ImageColor::range;
  shot.camera = birds_eye({-10, -10, 0}, {10, 10, 99}, 100, 100);
  shot.disks = {{{-5, 0, 99}, 3, {0, 0, 1}}, {{5, 0, 0}, 3, {0, 0, 1}}};
  const Image image = shot.render();
  EXPECT_EQ(pixel(image, 25, 50), (Rgb{253, 231, 37})) << "1 m";
  EXPECT_EQ(pixel(image, 75, 50), (Rgb{68, 1, 84})) << "100 m";
}

TEST(RenderImage, SamplesOfAPixelAreAveraged) {
  Shot shot;
  shot.options.color = ImageColor::normal;
  shot.options.samples_per_axis = 2;
  shot.options.background = {0, 0, 0};
  shot.camera.width = shot.camera.height = 1;
  // The left half of the only pixel: two of its four samples.
  shot.mesh.vertices = {{-40, -40, 1}, {0, -40, 1}, {0, 40, 1}, {-40, 40, 1}};
  shot.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(pixel(shot.render(), 0, 0), (Rgb{64, 64, 128}));
}

TEST(RenderImage, TheSkyIsAboveTheHorizon) {
  Shot shot;
  shot.camera = look_at({0, 0, 2}, {10, 0, 2});
  shot.camera.width = shot.camera.height = 64;
  EXPECT_EQ(count_not(shot.render(), kWhite), 0U);
  shot.options.sky = true;
  const Image image = shot.render();
  const Rgb above = pixel(image, 32, 0), below = pixel(image, 32, 63);
  EXPECT_GT(above[2], above[0] + 10) << "blue";
  EXPECT_NEAR(below[2], below[0], 5) << "grey";
}

std::vector<Disk> random_disks() {
  std::vector<Disk> disks;
  for (std::uint64_t i = 0; i < 300; ++i) {
    Random random(1, 0, i);
    const Vec3d c = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(0, 5)};
    const Vec3d n = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)};
    disks.push_back({vec_cast<float>(c), static_cast<float>(random.uniform(0.1, 2)),
                     vec_cast<float>(normalized(n))});
  }
  return disks;
}

// Oracle: the ray through each pixel's centre, one by one. Sizes that no block or tile divides.
TEST(RenderImage, EveryPixelHasItsOwnRay) {
  Shot shot;
  shot.disks = random_disks();
  shot.options.color = ImageColor::normal;
  for (const auto& [width, height] : {std::pair{131, 67}, std::pair{1, 1}, std::pair{64, 3}}) {
    shot.camera = birds_eye({-10, -10, 0}, {10, 10, 5}, width, height);
    const Image image = shot.render();
    const auto oracle = make_brute_force_tracer({shot.disks, nullptr});
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Ray ray = shot.camera.ray(x + 0.5, y + 0.5, {});
        Hit hit;
        oracle->nearest({&ray, 1}, {&hit, 1}, Executor(1));
        Rgb expected = kWhite;
        if (hit.valid())
          for (int axis = 0; axis < 3; ++axis)
            expected[static_cast<std::size_t>(axis)] = static_cast<std::uint8_t>(
                std::lround(127.5F * (1.0F + shot.disks[hit.primitive].normal[axis])));
        ASSERT_EQ(pixel(image, x, y), expected) << x << ", " << y;
      }
    }
  }
}

// Oracle: one thread.
TEST(RenderImage, BytesDoNotDependOnThreads) {
  Shot shot;
  shot.disks = random_disks();
  shot.options.samples_per_axis = 3;
  const Image expected = shot.render(1);
  EXPECT_EQ(shot.render(2).pixels, expected.pixels);
  EXPECT_EQ(shot.render(3).pixels, expected.pixels);
}

// Oracle: the mean of the samples of every pixel, one by one; a step of a channel for the order of
// their sum.
TEST(RenderImage, APixelIsTheMeanOfItsSamples) {
  Shot shot;
  shot.disks = random_disks();
  shot.options.color = ImageColor::normal;
  const ImageScene scene = {{shot.disks, nullptr}, {}, {}, nullptr, {0, 0, 0}};
  const auto tracer = make_brute_force_tracer(scene.view);
  for (const int axis : {3, 10}) {
    shot.options.samples_per_axis = axis;
    const Image image = shot.render();
    const Shading shading(scene, shot.options);
    const float weight = 1.0F / static_cast<float>(axis * axis);
    for (int y = 0; y < 100; ++y) {
      for (int x = 0; x < 100; ++x) {
        Vec3f sum;
        for (int k = 0; k < axis * axis; ++k) {
          const Ray ray = shot.camera.ray((x * axis + k % axis + 0.5) / axis,
                                          (y * axis + k / axis + 0.5) / axis, {});
          Hit hit;
          tracer->nearest({&ray, 1}, {&hit, 1}, Executor(1));
          sum = sum + (hit.valid() ? shade(shading.tables(), ray, hit) : Vec3f{1, 1, 1});
        }
        for (int channel = 0; channel < 3; ++channel)
          ASSERT_NEAR(pixel(image, x, y)[static_cast<std::size_t>(channel)],
                      to_byte(weight * sum[channel]), 1)
              << x << ", " << y << " of " << axis;
      }
    }
  }
}

TEST(RenderImage, HeightsMapFromDarkToBright) {
  Shot shot;
  shot.options.color = ImageColor::height;
  shot.disks = {{{-5, 0, 1}, 3, {0, 0, 1}}, {{5, 0, 4}, 3, {0, 0, 1}}};
  const Image image = shot.render();
  EXPECT_LT(pixel(image, 25, 50)[1] + 100, pixel(image, 75, 50)[1]);
  shot.options.range = ValueRange{4, 9};
  EXPECT_EQ(pixel(shot.render(), 75, 50), pixel(image, 25, 50)) << "the low end";
}

/// A floor, and walls where they are asked for, seen aslant; grey.
Shot room(bool walls) {
  Shot shot;
  shot.options.color = ImageColor::shading;
  shot.options.relief = true;
  shot.camera = look_at({-8, 0, 6}, {0, 0, 0});
  shot.camera.width = shot.camera.height = 200;
  shot.mesh.vertices = {{-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}};
  shot.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  if (walls) {
    shot.mesh.vertices.insert(shot.mesh.vertices.end(),
                              {{2, -20, 9}, {2, 20, 9}, {2, -20, 0}, {2, 20, 0}});
    shot.mesh.triangles.insert(shot.mesh.triangles.end(), {{6, 7, 4}, {4, 7, 5}});
  }
  return shot;
}

// Analytic: a plane rises nowhere above itself, however aslant it is seen.
TEST(Relief, APlaneHasNoShadow) {
  for (const bool parallel : {false, true}) {
    Shot shot = room(false);
    if (parallel) shot.camera.orthographic_width_m = 12;
    const Image with = shot.render();
    shot.options.relief = false;
    EXPECT_EQ(with.pixels, shot.render().pixels);
  }
}

TEST(Relief, CornersAreDarkerThanOpenSurfaces) {
  for (const bool parallel : {false, true}) {
    Shot shot = room(true);
    if (parallel) shot.camera.orthographic_width_m = 12;
    const Image with = shot.render();
    shot.options.relief = false;
    const Image without = shot.render();
    // The column down the middle crosses wall, joint and floor.
    int most = 0, at = 0;
    for (int y = 30; y < 190; ++y) {
      const int darker = pixel(without, 100, y)[0] - pixel(with, 100, y)[0];
      ASSERT_GE(darker, 0);
      if (darker > most) most = darker, at = y;
    }
    EXPECT_GT(most, 40);
    const int joint = pixel(without, 100, at)[0] - pixel(without, 100, at - 3)[0];
    EXPECT_NE(joint, 0) << "wall above, floor below";
    EXPECT_EQ(pixel(with, 100, 185), pixel(without, 100, 185)) << "far from it";
  }
}

/// A board of splats seen from above, one left out of it at the middle.
Shot board_with_a_gap() {
  Shot shot;
  shot.options.relief = true;
  shot.camera = birds_eye({-10, -10, 0}, {10, 10, 5}, 400, 400);
  for (int x = -8; x <= 8; ++x)
    for (int y = -8; y <= 8; ++y)
      if (x != 0 || y != 0)
        shot.disks.push_back(
            {{0.5F * static_cast<float>(x), 0.5F * static_cast<float>(y), 1}, 0.36F, {0, 0, 1}});
  return shot;
}

TEST(Relief, OnlyGapsWithinASurfaceAreDark) {
  const Image image = board_with_a_gap().render();
  EXPECT_LT(pixel(image, 200, 200)[0], 60);
  EXPECT_EQ(pixel(image, 5, 200), kWhite);
  EXPECT_GT(pixel(image, 220, 200)[0], 100) << "the board";
}

// Two splats of one plane with different colours: from one to the other the red never falls.
TEST(Relief, SplatsOfOneSurfaceBlend) {
  Shot shot;
  shot.options.color = ImageColor::intensity;
  shot.options.range = ValueRange{0, 1};
  shot.camera = birds_eye({-10, -10, 0}, {10, 10, 5}, 400, 400);
  shot.mesh = {};
  shot.disks = {{{-3, 0, 1}, 4, {0, 0, 1}}, {{3, 0, 1.001F}, 4, {0, 0, 1}}};
  shot.intensities = {0.5F, 1};
  const auto steps = [&] {
    std::array<int, 2> largest_and_count{};
    const Image image = shot.render();
    for (int x = 150; x < 250; ++x) {
      const int step = std::abs(pixel(image, x, 200)[0] - pixel(image, x - 1, 200)[0]);
      largest_and_count[0] = std::max(largest_and_count[0], step);
      largest_and_count[1] += step > 0 ? 1 : 0;
    }
    return largest_and_count;
  };
  const auto hard = steps();
  shot.options.relief = true;
  const auto soft = steps();
  EXPECT_EQ(hard[1], 1);
  EXPECT_GT(soft[1], 4);
  EXPECT_LT(soft[0], hard[0] / 2);
}

// Oracle: one thread.
TEST(Relief, BytesDoNotDependOnThreads) {
  Shot shot;
  shot.disks = random_disks();
  shot.options = {};
  shot.options.samples_per_axis = 2;
  const Image expected = shot.render(1);
  EXPECT_EQ(shot.render(2).pixels, expected.pixels);
  EXPECT_EQ(shot.render(3).pixels, expected.pixels);
}

TEST(RenderImage, InvalidOptionsAreUsageErrors) {
  const auto expect_usage = [](const Shot& shot) {
    try {
      shot.render();
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
    }
  };
  Shot shot;
  shot.camera.width = 0;
  expect_usage(shot);
  shot = {};
  shot.camera.height = 1 << 20;
  expect_usage(shot);
  shot = {};
  shot.options.samples_per_axis = 0;
  expect_usage(shot);
  shot = {};
  shot.camera.orthographic_width_m = 0;
  shot.camera.horizontal_fov_rad = 3.2;
  expect_usage(shot);
}

TEST(RenderImage, AttributesOfAnotherSizeAreLogicErrors) {
  Shot shot;
  shot.disks = random_disks();
  shot.classes = {1, 2};
  EXPECT_THROW(shot.render(), std::logic_error);
}

TEST(Viridis, HasItsEndsAndClampsTheRest) {
  EXPECT_EQ(viridis(0.0F), color_of({68, 1, 84}));
  EXPECT_EQ(viridis(1.0F), color_of({253, 231, 37}));
  EXPECT_EQ(viridis(-5.0F), viridis(0.0F));
  EXPECT_EQ(viridis(5.0F), viridis(1.0F));
  EXPECT_EQ(viridis(std::numeric_limits<float>::quiet_NaN()), viridis(0.0F));
  EXPECT_EQ(viridis(0.5F), color_of({33, 144, 141}));
}

TEST(QuantileRange, IgnoresNonFiniteValues) {
  const std::vector<float> values = {3, kNaN, 1, 2, HUGE_VALF, 5, 4};
  const ValueRange all = quantile_range(values, 0, 1);
  EXPECT_EQ(all.low, 1.0F);
  EXPECT_EQ(all.high, 5.0F);
  EXPECT_EQ(quantile_range(values, 0.25, 0.75).low, 2.0F);
  const ValueRange none = quantile_range({}, 0.02, 0.98);
  EXPECT_EQ(none.low, 0.0F);
  EXPECT_EQ(none.high, 1.0F);
  const std::vector<float> equal = {7, 7, 7};
  EXPECT_GT(quantile_range(equal, 0.02, 0.98).high, 7.0F);
}

}  // namespace
}  // namespace adasplats
