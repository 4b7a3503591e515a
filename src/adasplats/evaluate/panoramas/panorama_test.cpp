// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/panoramas/panorama.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace adasplats {
namespace {

PanoramaLayout small_layout() {
  PanoramaLayout layout;
  layout.rows = 8;
  layout.columns = 12;
  return layout;
}

/// At an azimuth and elevation, deg.
Vec3f point_at(double azimuth_deg, double elevation_deg, double range_m) {
  const double a = azimuth_deg * kDegree, e = elevation_deg * kDegree;
  return vec_cast<float>(range_m *
                         Vec3d{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)});
}

// Round trip: each pixel's point falls into its pixel again.
TEST(Panorama, PixelsBecomePointsAndPixelsAgain) {
  for (const PanoramaLayout& layout : {small_layout(), PanoramaLayout()}) {
    Panorama image{std::vector<float>(layout.pixels()), std::vector<float>(layout.pixels())};
    for (std::size_t i = 0; i < image.ranges_m.size(); ++i) {
      image.ranges_m[i] = i % 5 == 3 ? 0.0F : 2.0F + static_cast<float>(i % 61);
      if (image.ranges_m[i] > 0) image.intensities[i] = static_cast<float>(i);
    }
    std::vector<float> intensities;
    for (const float intensity : image.intensities)
      if (intensity > 0) intensities.push_back(intensity);
    if (image.ranges_m[0] > 0) intensities.insert(intensities.begin(), 0.0F);
    const std::vector<Vec3f> points = points_of(image, layout);
    ASSERT_EQ(points.size(), intensities.size());
    const Panorama again = panorama_of(points, intensities, layout);
    for (std::size_t i = 0; i < image.ranges_m.size(); ++i) {
      ASSERT_NEAR(again.ranges_m[i], image.ranges_m[i], 1e-4) << i;
      ASSERT_EQ(again.intensities[i], image.intensities[i]) << i;
    }
  }
}

// Analytic: 30 degrees a column from the rear clockwise, 26.9 / 8 degrees a row from 2 degrees
// down.
TEST(Panorama, DirectionsOfPixels) {
  const PanoramaLayout layout = small_layout();
  const auto pixel_of = [&](Vec3f point) {
    const Panorama image = panorama_of({&point, 1}, {}, layout);
    for (std::size_t i = 0; i < image.ranges_m.size(); ++i)
      if (image.ranges_m[i] > 0) return static_cast<int>(i);
    return -1;
  };
  EXPECT_EQ(pixel_of(point_at(180, 2, 10)), 0);
  EXPECT_EQ(pixel_of(point_at(90, 2, 10)), 3);  // to the left
  EXPECT_EQ(pixel_of(point_at(0, 2, 10)), 6);   // ahead
  EXPECT_EQ(pixel_of(point_at(14, 2, 10)), 6);  // half a column is 15 degrees
  EXPECT_EQ(pixel_of(point_at(16, 2, 10)), 5);
  EXPECT_EQ(pixel_of(point_at(0, -1.3, 10)), 12 + 6);  // a row is 3.36 degrees
  EXPECT_EQ(pixel_of(point_at(0, 3.6, 10)), 6);
  EXPECT_EQ(pixel_of(point_at(0, 3.8, 10)), -1);        // above the first row
  EXPECT_EQ(pixel_of(point_at(0, -23.1, 10)), 84 + 6);  // the last row
  EXPECT_EQ(pixel_of(point_at(0, -23.5, 10)), -1);
  EXPECT_EQ(pixel_of(point_at(-164, 2, 10)), 11);
  EXPECT_EQ(pixel_of(point_at(-170, 2, 10)), -1);  // LiDAR4D does not wrap around
}

TEST(Panorama, TheNearestPointOfAPixelCounts) {
  const PanoramaLayout layout = small_layout();
  constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Vec3f> points = {point_at(0, 2, 30),    point_at(1, 2, 20), point_at(2, 2, 25),
                                     point_at(90, 2, 80.5), {kMissing, 0, 0},   {0, 0, 0},
                                     point_at(60, 2, 79)};
  const Panorama image = panorama_of(points, std::vector<float>{1, 2, 3, 4, 5, 6, 7}, layout);
  EXPECT_NEAR(image.ranges_m[6], 20, 1e-4);
  EXPECT_EQ(image.intensities[6], 2.0F);
  EXPECT_EQ(image.ranges_m[3], 0.0F);  // farther than 80 m
  EXPECT_NEAR(image.ranges_m[4], 79, 1e-4);
  EXPECT_EQ(points_of(image, layout).size(), 2U);
  EXPECT_TRUE(points_of(panorama_of({}, {}, layout), layout).empty());
}

// Oracle: the points of the pixels.
TEST(Panorama, TheSensorsRaysAreThePixels) {
  const PanoramaLayout layout = small_layout();
  const Panorama ones{std::vector<float>(layout.pixels(), 1.0F), {}};
  const std::vector<Vec3f> directions = points_of(ones, layout);
  const std::vector<Firing> firings = firings_of(sensor_of(layout));
  ASSERT_EQ(firings.size(), directions.size());
  for (const Firing& firing : firings) {
    const Vec3f expected = directions[firing.ring * layout.columns + firing.column];
    EXPECT_LT(length(firing.direction - expected), 1e-6F);
    EXPECT_EQ(firing.origin, Vec3f{});
  }
}

}  // namespace
}  // namespace adasplats
