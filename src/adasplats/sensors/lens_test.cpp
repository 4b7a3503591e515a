// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/sensors/camera.h"
#include "adasplats/sensors/camera_file.h"

namespace adasplats {
namespace {

Lens wide_lens(const std::string& model, const std::vector<double>& coefficients) {
  Lens lens;
  lens.width = 1280;
  lens.height = 720;
  lens.fx = 1000;
  lens.fy = 1010;
  lens.cx = 640;
  lens.cy = 360;
  return distorted_lens(lens, model, coefficients, "front");
}

const std::vector<double> kBrown = {-0.31, 0.12, 0.001, -0.0007, -0.02};
const std::vector<double> kRational = {0.4, -0.1, 0.001, -0.002, 0.05, 0.7, -0.05, 0.01};
const std::vector<double> kFisheye = {-0.03, 0.01, -0.004, 0.0005};

/// Angle between two directions, rad; accurate near 0.
double angle(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

/// The formulas of OpenCV's documentation, term by term.
Lens::Point projected(const Lens& lens, Vec3d p) {
  double x = p.x / p.z, y = p.y / p.z;
  const double r = std::hypot(x, y);
  const double* k = lens.k;
  if (lens.is_fisheye) {
    const double theta = std::atan2(std::hypot(p.x, p.y), p.z);
    double distorted = theta;
    for (int i = 0; i < 4; ++i) distorted += k[i] * std::pow(theta, 2 * i + 3);
    const double across = std::hypot(p.x, p.y);
    return {lens.cx + lens.fx * distorted * p.x / across,
            lens.cy + lens.fy * distorted * p.y / across};
  }
  const double factor =
      (1 + k[0] * std::pow(r, 2) + k[1] * std::pow(r, 4) + k[2] * std::pow(r, 6)) /
      (1 + k[3] * std::pow(r, 2) + k[4] * std::pow(r, 4) + k[5] * std::pow(r, 6));
  const double u = x * factor + 2 * lens.p1 * x * y + lens.p2 * (r * r + 2 * x * x);
  const double v = y * factor + lens.p1 * (r * r + 2 * y * y) + 2 * lens.p2 * x * y;
  return {lens.cx + lens.fx * u, lens.cy + lens.fy * v};
}

// Oracle: OpenCV 4.6.0, projectPoints and fisheye.projectPoints.
TEST(Lens, HasTheRaysOfOpenCv) {
  const Vec3d points[] = {{0.3, -0.2, 2}, {-0.8, 0.5, 2.5}, {0.05, 0.7, 1.7}};
  const struct {
    Lens lens;
    Lens::Point pixels[3];
  } cases[] = {{wide_lens("plumb_bob", kBrown),
                {{788.4234095156249, 260.0790775928125},
                 {332.9948543553535, 553.877899188183},
                 {667.8612862050264, 755.81747621243}}},
               {wide_lens("rational", kRational),
                {{788.3774137518677, 260.0815997404091},
                 {331.8816567579804, 554.4637481715249},
                 {667.7136065989829, 756.8618592473345}}},
               {wide_lens("equidistant", kFisheye),
                {{788.2658160994898, 260.1676838263435},
                 {335.1564718280924, 552.4324771585167},
                 {667.7713820664898, 752.6873424201648}}}};
  for (const auto& [lens, pixels] : cases)
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(angle(lens.direction(pixels[i].x, pixels[i].y), points[i]), 1e-12) << i;
      const auto at = project(lens, points[i]);
      ASSERT_TRUE(at);
      EXPECT_NEAR(at->x, pixels[i].x, 1e-9);
      EXPECT_NEAR(at->y, pixels[i].y, 1e-9);
    }
}

// Oracle: the formulas above.
TEST(Lens, InvertsItsDistortionAtEveryPixel) {
  for (const Lens& lens : {wide_lens("none", {}), wide_lens("plumb_bob", kBrown),
                           wide_lens("plumb_bob", {0.2, -0.05, 0.003, 0.004}),
                           wide_lens("rational", kRational), wide_lens("fisheye", kFisheye)}) {
    for (int v = 0; v < lens.height; v += 17)
      for (int u = 0; u < lens.width; u += 13) {
        const Vec3d direction = lens.direction(u, v);
        ASSERT_NEAR(length(direction), 1, 1e-12) << u << " " << v;
        if (u == lens.cx && v == lens.cy) continue;
        const Lens::Point at = projected(lens, direction);
        ASSERT_NEAR(at.x, u, 1e-6);
        ASSERT_NEAR(at.y, v, 1e-6);
      }
    EXPECT_EQ(lens.direction(lens.cx, lens.cy), (Vec3d{0, 0, 1}));
  }
}

// Oracle: r (1 - 0.5 r^2) is largest at r = sqrt(2/3), with 2/3 of it: no light reaches the pixels
// beyond 544.33 pixels, though the polynomial has values for all radii.
TEST(Lens, HasNoRayWhereTheDistortionTurnsBack) {
  Lens lens;
  lens.width = lens.height = 1401;
  lens.fx = lens.fy = 1000;
  lens.cx = lens.cy = 700;
  lens = distorted_lens(lens, "plumb_bob", {-0.5, 0, 0, 0, 0}, "front");
  const double fold = std::sqrt(2.0 / 3);
  const double last_px = 1000 * fold * 2 / 3;
  EXPECT_NEAR(lens.max_radius, fold, 2e-4);
  for (int turn = 0; turn < 64; ++turn) {
    const double x = std::cos(turn * 0.1), y = std::sin(turn * 0.1);
    const double inside = last_px - 0.01, outside = last_px + 0.01;
    const Vec3d last = lens.direction(700 + inside * x, 700 + inside * y);
    ASSERT_NEAR(length(last), 1, 1e-12);
    EXPECT_LT(std::hypot(last.x, last.y) / last.z, fold);
    EXPECT_EQ(lens.direction(700 + outside * x, 700 + outside * y), Vec3d{});
  }
  EXPECT_EQ(lens.direction(0, 0), Vec3d{});
  EXPECT_FALSE(project(lens, {1, 0, 1})) << "beyond the fold, though its formula is in the picture";
  EXPECT_FALSE(project(lens, {0.1, 0, -1})) << "behind";
}

// The same with tangential terms: a ray is either exact and within the fold, or there is none.
TEST(Lens, NeverHasAWrongRay) {
  Lens lens;
  lens.width = lens.height = 1401;
  lens.fx = lens.fy = 1000;
  lens.cx = lens.cy = 700;
  int empty = 0, found = 0;
  for (const std::vector<double>& coefficients :
       {std::vector<double>{-0.5, 0, 0.01, -0.02, 0}, std::vector<double>{-0.9, 0.3, 0.05, 0.08, 0},
        std::vector<double>{-0.3, -0.2, 0, 0.1, 0.3}}) {
    const Lens strong = distorted_lens(lens, "plumb_bob", coefficients, "front");
    for (int v = 0; v < 1401; v += 7)
      for (int u = 0; u < 1401; u += 7) {
        const Vec3d direction = strong.direction(u, v);
        if (direction == Vec3d{}) {
          ++empty;
          continue;
        }
        ++found;
        const Lens::Point at = projected(strong, direction);
        ASSERT_NEAR(at.x, u, 1e-6);
        ASSERT_NEAR(at.y, v, 1e-6);
        ASSERT_LE(std::hypot(direction.x, direction.y), strong.max_radius * direction.z);
      }
  }
  EXPECT_GT(empty, 1000);
  EXPECT_GT(found, 10000);
}

// Oracle: the angle is the distance over the focal length, also beside and behind the camera.
TEST(Lens, AFisheyeSeesBehindItself) {
  Lens lens;
  lens.width = lens.height = 601;
  lens.fx = lens.fy = 120;
  lens.cx = lens.cy = 300;
  lens = distorted_lens(lens, "fisheye", {0, 0, 0, 0}, "top");
  const Vec3d behind = lens.direction(300 + 120 * 2.0, 300);
  EXPECT_NEAR(behind.x, std::sin(2.0), 1e-12);
  EXPECT_NEAR(behind.z, std::cos(2.0), 1e-12);
  EXPECT_EQ(lens.direction(0, 0), Vec3d{}) << "more than half a turn";
  const auto at = project(lens, behind);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->x, 540, 1e-9);
}

TEST(Lens, RefusesWrongValues) {
  const auto with = [](auto change) {
    return [change] {
      Lens lens = wide_lens("none", {});
      change(lens);
      complete_lens(lens, "front");
    };
  };
  expect_error(ErrorKind::config, {"front", "0 x 720"}, with([](Lens& lens) { lens.width = 0; }));
  expect_error(ErrorKind::config, {"32769"}, with([](Lens& lens) { lens.height = 32769; }));
  expect_error(ErrorKind::config, {"fx is -5"}, with([](Lens& lens) { lens.fx = -5; }));
  expect_error(ErrorKind::config, {"fy is 0"}, with([](Lens& lens) { lens.fy = 0; }));
  expect_error(ErrorKind::config, {"cx is not a number"}, with([](Lens& lens) { lens.cx = NAN; }));
  expect_error(ErrorKind::config, {"coefficient"}, with([](Lens& lens) { lens.k[4] = INFINITY; }));
  expect_error(ErrorKind::config, {"front", "plum_bob", "did you mean", "plumb_bob"},
               [] { wide_lens("plum_bob", {}); });
  expect_error(ErrorKind::config, {"3 coefficients of plumb_bob", "expected 5"}, [] {
    wide_lens("plumb_bob", {1, 2, 3});
  });
  expect_error(ErrorKind::config, {"5 coefficients of rational", "expected 8"}, [] {
    wide_lens("rational", {1, 2, 3, 4, 5});
  });
  expect_error(ErrorKind::config, {"5 coefficients of fisheye", "expected 4"}, [] {
    wide_lens("fisheye", {1, 2, 3, 4, 5});
  });
  expect_error(ErrorKind::config, {"1 coefficients of none"}, [] { wide_lens("none", {1}); });
}

// Oracle: the same picture as a pinhole's with half a pixel between the conventions.
TEST(Camera, ALensWithoutDistortionIsAPinhole) {
  Camera plain;
  plain.world_from_camera = {rotation_from_yaw_pitch_roll(0.3, 0.1, -0.2), {5, 6, 7}};
  plain.width = 1280;
  plain.height = 720;
  plain.horizontal_fov_rad = 2 * std::atan(640 / 1000.0);
  Camera camera = plain;
  Lens lens = wide_lens("none", {});
  lens.fy = 1000;
  lens.cx = 639.5;
  lens.cy = 359.5;
  camera.lens = complete_lens(lens, "front");
  for (const double u : {0.0, 100.5, 640.0, 1279.5})
    for (const double v : {0.5, 360.0, 700.25}) {
      const Ray ray = camera.ray(u, v, {1, 2, 3}), wanted = plain.ray(u, v, {1, 2, 3});
      EXPECT_EQ(ray.origin, wanted.origin);
      EXPECT_LT(length(ray.direction - wanted.direction), 2e-7F);
    }
}

}  // namespace
}  // namespace adasplats
