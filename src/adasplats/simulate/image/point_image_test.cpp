// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/point_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/simulate/image/pixels_test.h"
#include "adasplats/simulate/image/point_colors.h"

namespace adasplats {
namespace {

constexpr Vec3d kCloudOrigin = {7000, -300, 50};

PointImageOptions on_white(PointImageOptions options = {}) {
  options.background = kWhite;
  options.sky = false;
  return options;
}

/// Every point is one pixel, without relief: what is where can be said exactly.
PointImageOptions single_pixels() {
  PointImageOptions options = on_white();
  options.min_px = options.max_px = 1;
  options.relief = false;
  return on_white(options);
}

Camera camera_of(int width, int height) {
  Camera camera = look_at(kCloudOrigin + Vec3d{3, -5, 4}, kCloudOrigin + Vec3d{20, 9, 1});
  camera.width = width;
  camera.height = height;
  return camera;
}

Image draw(const std::vector<Vec3f>& points, const std::vector<Rgb>& colors, const Camera& camera,
           const PointImageOptions& options, int threads = 1) {
  return draw_points(points, kCloudOrigin, colors, camera, options, Executor(threads));
}

// Oracle: Camera::ray, which goes the other way.
TEST(DrawPoints, PointsOnTheRaysOfPixelsAreDrawnThere) {
  Camera parallel = camera_of(40, 30), lens = parallel;
  parallel.orthographic_width_m = 12;
  lens.lens = Lens{.width = 40, .height = 30, .fx = 30, .fy = 31, .cx = 18, .cy = 15.5};
  lens.lens->k[0] = -0.1;
  lens.lens->p1 = 0.01;
  lens.lens = complete_lens(*lens.lens, "the test's");
  for (const Camera& camera : {camera_of(40, 30), parallel, lens}) {
    for (int y = 0; y < camera.height; y += 7) {
      for (int x = 0; x < camera.width; x += 3) {
        const Ray ray = camera.ray(x + 0.5, y + 0.5, kCloudOrigin);
        const Image image =
            draw({ray.origin + 8.0F * ray.direction}, {kRed}, camera, single_pixels());
        EXPECT_EQ(pixel(image, x, y), kRed);
        EXPECT_EQ(count(image, kWhite), 40U * 30U - 1);
      }
    }
  }
}

TEST(DrawPoints, TheNearestThenTheFirstPointWins) {
  const Camera camera = camera_of(20, 20);
  const Ray ray = camera.ray(10.5, 10.5, kCloudOrigin);
  const Vec3f near = ray.origin + 5.0F * ray.direction;
  const Vec3f far = ray.origin + 5.01F * ray.direction;
  EXPECT_EQ(pixel(draw({far, near}, {kRed, kGreen}, camera, single_pixels()), 10, 10), kGreen);
  EXPECT_EQ(pixel(draw({near, far}, {kRed, kGreen}, camera, single_pixels()), 10, 10), kRed);
  EXPECT_EQ(pixel(draw({near, near}, {kRed, kGreen}, camera, single_pixels()), 10, 10), kRed);
}

// Analytic: 10 cm at 4 m are 10 pixels where 100 pixels are 4 m wide there (tan of half the angle
// is 0.5), and 5 pixels at twice the distance.
TEST(DrawPoints, SquaresShrinkWithDistanceWithinTheirBounds) {
  Camera camera = look_at(kCloudOrigin, kCloudOrigin + Vec3d{1, 0, 0});
  camera.width = camera.height = 100;
  camera.horizontal_fov_rad = 2 * std::atan(0.5);
  PointImageOptions options = on_white();
  options.relief = false;
  options.point_size_m = 0.4;
  options.max_px = 1000;
  const auto pixels_at = [&](float distance_m) {
    return count(draw({{distance_m, 0, 0}}, {kRed}, camera, options), kRed);
  };
  EXPECT_EQ(pixels_at(4), 100U);
  EXPECT_EQ(pixels_at(8), 25U);
  EXPECT_EQ(pixels_at(4000), 4U);  // 2 x 2 at least
  options.max_px = 3;
  EXPECT_EQ(pixels_at(4), 9U);
}

TEST(DrawPoints, PointsBehindNonFiniteOrFarOutsideAreNotDrawn) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  Camera camera = look_at(kCloudOrigin, kCloudOrigin + Vec3d{1, 0, 0});
  camera.width = camera.height = 50;
  const std::vector<Vec3f> points = {{-5, 0, 0},    {0, 0, 0},        {nan, 0, 0},
                                     {5, 0, nan},   {infinity, 0, 0}, {5, -infinity, 0},
                                     {1, 1e30F, 0}, {1, 0, -100},     {1e-20F, 1e20F, 1e20F}};
  const std::vector<Rgb> colors(points.size(), kRed);
  EXPECT_EQ(count(draw(points, colors, camera, on_white()), kWhite), 2500U);
  EXPECT_EQ(count(draw({}, {}, camera, on_white()), kWhite), 2500U);
}

TEST(DrawPoints, SameBytesForAnyThreads) {
  std::vector<Vec3f> points;
  std::vector<Rgb> colors;
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    Random random(1, 0, i);
    points.push_back(vec_cast<float>(
        Vec3d{random.uniform(0, 40), random.uniform(-20, 20), std::floor(random.uniform(0, 3))}));
    colors.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 7});
  }
  const Camera camera = camera_of(160, 90);
  const Image one = draw(points, colors, camera, on_white(), 1);
  EXPECT_LT(count(one, kWhite), 160U * 90U / 2);
  for (const int threads : {2, 3})
    EXPECT_EQ(one.pixels, draw(points, colors, camera, on_white(), threads).pixels);
}

// Analytic: far pixels beside near ones are darker, near ones and flat parts are not.
TEST(DrawPoints, ReliefDarkensPointsBehind) {
  Camera camera = look_at(kCloudOrigin, kCloudOrigin + Vec3d{1, 0, 0});
  camera.width = camera.height = 60;
  PointImageOptions options = on_white();
  options.min_px = options.max_px = 60;
  const Rgb grey = {200, 200, 200};
  EXPECT_EQ(count(draw({{10, 0, 0}}, {grey}, camera, options), grey), 3600U);
  options.min_px = 20;
  options.point_size_m = 1e3;
  const Image image = draw({{1000, 0, 0}, {5, 0, 4}}, {grey, kRed}, camera, options);
  EXPECT_EQ(pixel(image, 30, 50), grey);
  EXPECT_GT(count(image, kRed), 0U);
  EXPECT_LT(count(image, grey) + count(image, kRed), 3600U);
}

TEST(DrawPoints, Errors) {
  EXPECT_THROW(draw({{1, 0, 0}}, {}, camera_of(10, 10), {}), std::logic_error);
  EXPECT_THROW(draw({}, {}, camera_of(0, 10), {}), Error);
  EXPECT_THROW(draw({}, {}, camera_of(10, 1 << 16), {}), Error);
}

/// Five points at different heights, classes and intensities.
PointCloud tiny_cloud() {
  PointCloud cloud;
  for (int i = 0; i < 5; ++i) cloud.positions.push_back({0, 0, static_cast<float>(i)});
  cloud.intensities = {4, 3, 2, 1, std::numeric_limits<float>::quiet_NaN()};
  cloud.classes = {40, 50, 0, 12345, 40};  // road, building, unlabelled (black), unknown, road
  return cloud;
}

constexpr Rgb kGrey = {184, 184, 184}, kDarkest = {68, 1, 84}, kBrightest = {253, 231, 37};

TEST(PointColors, ByClassThenIntensityThenHeight) {
  PointCloud cloud = tiny_cloud();
  const LabelScheme& labels = semantickitti_labels();
  const Rgb road = labels.find(std::string_view("road"))->rgb;
  const Rgb building = labels.find(std::string_view("building"))->rgb;
  EXPECT_EQ(point_colors(cloud, &labels, {}, {}),
            (std::vector<Rgb>{road, building, kGrey, kGrey, road}));
  const std::vector<Rgb> by_intensity = point_colors(cloud, nullptr, {}, {});
  EXPECT_EQ(by_intensity[0], kBrightest);
  EXPECT_EQ(by_intensity[3], kDarkest);
  EXPECT_EQ(by_intensity[4], kGrey);
  cloud.intensities.clear();
  const std::vector<Rgb> by_height = point_colors(cloud, nullptr, {}, {});
  EXPECT_EQ(by_height[0], kDarkest);
  EXPECT_EQ(by_height[4], kBrightest);
}

TEST(PointColors, AsTold) {
  const PointCloud cloud = tiny_cloud();
  const std::vector<Rgb> by_range = point_colors(cloud, nullptr, ImageColor::range, {0, 0, -100});
  EXPECT_EQ(by_range[0], kDarkest);
  EXPECT_EQ(point_colors(cloud, nullptr, ImageColor::range, {0, 0, 1})[0], kBrightest);
  EXPECT_EQ(point_colors(cloud, nullptr, ImageColor::shading, {})[3], kGrey);
  EXPECT_TRUE(point_colors({}, nullptr, {}, {}).empty());
  EXPECT_THROW(point_colors(cloud, nullptr, ImageColor::normal, {}), Error);
  EXPECT_THROW(point_colors(cloud, nullptr, ImageColor::semantic, {}), Error);
}

}  // namespace
}  // namespace adasplats
