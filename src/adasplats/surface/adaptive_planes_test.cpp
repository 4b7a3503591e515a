// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/adaptive_planes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/core/maths/random.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {
namespace {

constexpr double kCell_m = 0.05;

/// The tests' own numbers: the defaults may be tuned.
AdaptivePlaneOptions tested_options() {
  AdaptivePlaneOptions options;
  options.scales = {10, 20, 40, 80, 160};
  options.max_sigma_m = 0.025;
  options.trim_sigmas = 2.5;
  options.min_sigma_m = 0.01;
  options.max_shift_m = 0.1;
  return options;
}

struct Fitted {
  FusedPoints cells;
  std::vector<LocalPlane> planes;
};

Fitted fit(const std::vector<Vec3f>& points,
           const AdaptivePlaneOptions& options = tested_options()) {
  const Executor executor(2);
  Fitted fitted;
  fitted.cells = fuse_points(points, kCell_m, executor);
  const PointIndex index = PointIndex::from_sorted(fitted.cells.positions, executor);
  fitted.planes = adaptive_planes(fitted.cells, index, options, executor);
  return fitted;
}

/// The middle of a cell of the fusion.
Vec3f cell_middle(int x, int y, int z) {
  const auto middle = [](int cell) { return static_cast<float>(kCell_m * (cell + 0.5)); };
  return {middle(x), middle(y), middle(z)};
}

void expect_sound(const Fitted& fitted) {
  ASSERT_EQ(fitted.planes.size(), fitted.cells.size());
  for (const LocalPlane& plane : fitted.planes) {
    EXPECT_TRUE(is_finite(plane.center) && is_finite(plane.normal));
    EXPECT_NEAR(length(plane.normal), 1.0F, 1e-5F);
    EXPECT_GE(plane.spacing_m, 0.0F);
    EXPECT_TRUE(std::isfinite(plane.spacing_m));
  }
}

/// Root mean squares over all cells against the plane that the points were drawn on.
struct PlaneErrors {
  double angle_rad;
  double offset_m;
};

PlaneErrors errors_at(const std::vector<Vec3f>& points, Vec3d normal,
                      const AdaptivePlaneOptions& options) {
  const Fitted fitted = fit(points, options);
  expect_sound(fitted);
  double angles = 0, offsets = 0;
  for (const LocalPlane& plane : fitted.planes) {
    const double sine = length(cross(vec_cast<double>(plane.normal), normal));
    const double offset = dot(vec_cast<double>(plane.center), normal);
    angles += sine * sine;
    offsets += offset * offset;
  }
  const auto n = static_cast<double>(fitted.planes.size());
  return {std::sqrt(angles / n), std::sqrt(offsets / n)};
}

TEST(AdaptivePlanes, ErrorsOfANoisyPlaneShrinkWithTheScale) {
  // Oracle: the plane itself. Over n points of noise s within r ~ sqrt(n), the angle's error is
  // s / (r sqrt(n)) ~ 1 / n and the offset's s / sqrt(n): 4 and 2 times less for 4 times n.
  const Vec3d normal = normalized(Vec3d{0.2, -0.3, 1});
  std::vector<Vec3f> points;
  for (std::size_t i = 0; i < 4000; ++i) {
    Random random(1, 0, i);
    const double x = random.uniform(-4, 4), y = random.uniform(-4, 4);
    const Vec3d on_plane = {x, y, -0.2 * x + 0.3 * y};
    points.push_back(vec_cast<float>(on_plane + 0.01 * random.normal() * normal));
  }
  AdaptivePlaneOptions options = tested_options();
  options.scales = {10, 10, 10, 10, 10};
  const PlaneErrors at10 = errors_at(points, normal, options);
  options.scales = {10, 20, 40, 40, 40};
  const PlaneErrors at40 = errors_at(points, normal, options);
  const PlaneErrors at160 = errors_at(points, normal, tested_options());
  EXPECT_LT(at10.angle_rad, 0.1);
  EXPECT_LT(at40.angle_rad, 0.4 * at10.angle_rad);
  EXPECT_LT(at160.angle_rad, 0.4 * at40.angle_rad);
  EXPECT_LT(at10.offset_m, 0.006);
  EXPECT_LT(at40.offset_m, 0.7 * at10.offset_m);
  EXPECT_LT(at160.offset_m, 0.7 * at40.offset_m);
}

TEST(AdaptivePlanes, ScaleStaysSmallAtAnEdge) {
  // A floor and a wall of one point a cell that meet along y. Far from the edge the exact planes.
  std::vector<Vec3f> points;
  for (int y = 0; y < 40; ++y) {
    for (int a = 0; a < 40; ++a) {
      points.push_back(cell_middle(a, y, 0));
      if (a > 0) points.push_back(cell_middle(0, y, a));
    }
  }
  const Fitted fitted = fit(points);
  expect_sound(fitted);
  const float middle = cell_middle(0, 0, 0).x;
  int at_edge = 0, far_away = 0;
  for (std::size_t i = 0; i < fitted.planes.size(); ++i) {
    const Vec3f p = fitted.cells.positions[i];
    const float from_edge_m = std::max(p.x, p.z) - middle;
    const LocalPlane& plane = fitted.planes[i];
    if (from_edge_m < 0.06F) {
      ++at_edge;
      EXPECT_LE(plane.scale, 1) << from_edge_m;
    } else if (from_edge_m > 0.85F) {  // 160 cells in the corner of a patch reach 0.8 m
      ++far_away;
      EXPECT_EQ(plane.scale, 4);
      const bool floor = p.x > p.z;
      EXPECT_NEAR(std::fabs(floor ? plane.normal.z : plane.normal.x), 1.0F, 1e-6F);
      EXPECT_LT(length(plane.center - p), 1e-5F);
    }
  }
  EXPECT_GE(at_edge, 120);
  EXPECT_GE(far_away, 1600);
}

TEST(AdaptivePlanes, SpacingIsTheDistanceToTheSeventhCell) {
  // On a lattice of 1 the 4 nearest are at 1, the next 4 at sqrt(2).
  std::vector<Vec3f> points;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) points.push_back(cell_middle(2 * x, 2 * y, 0));
  const Fitted fitted = fit(points);
  int inside = 0;
  for (std::size_t i = 0; i < fitted.planes.size(); ++i) {
    const Vec3f p = fitted.cells.positions[i];
    if (std::min(p.x, p.y) < 0.1F || std::max(p.x, p.y) > 1.9F) continue;
    ++inside;
    EXPECT_NEAR(fitted.planes[i].spacing_m, 0.1 * std::sqrt(2.0), 1e-5);
  }
  EXPECT_EQ(inside, 18 * 18);
}

TEST(AdaptivePlanes, PlaneThroughCellsEqualsPlaneThroughPoints) {
  // Oracle: PCA of the points. Those of a cell are equal, so that fusing them loses nothing.
  std::vector<Vec3f> points;
  for (int i = 0; i < 9; ++i) {
    Random random(2, 0, static_cast<std::uint64_t>(i));
    const Vec3f p = cell_middle(i % 3, i / 3, static_cast<int>(3 * random.uniform()));
    points.insert(points.end(), 1 + random.next_bits() % 9, p);
  }
  AdaptivePlaneOptions options = tested_options();
  options.trim_sigmas = 1e6;
  options.max_shift_m = 1e6;
  const Fitted fitted = fit(points, options);
  ASSERT_EQ(fitted.planes.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i) {
    const Vec3f p = fitted.cells.positions[i];
    Moments moments;
    for (const Vec3f q : points) moments.add(q - p);
    const LocalShape shape = local_shape(moments);
    const Vec3d mean = moments.sum / moments.count;
    const LocalPlane& plane = fitted.planes[i];
    EXPECT_NEAR(std::fabs(dot(plane.normal, shape.normal)), 1.0F, 1e-5F);
    EXPECT_NEAR(dot(vec_cast<double>(plane.center - p) - mean, vec_cast<double>(shape.normal)), 0,
                1e-6);
    EXPECT_LT(length(cross(plane.center - p, shape.normal)), 1e-6F);  // it moves along its normal
  }
}

TEST(AdaptivePlanes, MeansMoveToTheirPlaneByALimitedDistance) {
  // Nine cells of a plane and one 0.4 m above it: with nearly all weight in the plane, the tenth is
  // off by 0.4 m and may move by 0.1 m.
  std::vector<Vec3f> points;
  for (int i = 0; i < 9; ++i) points.insert(points.end(), 1000, cell_middle(i % 3, i / 3, 0));
  points.push_back(cell_middle(1, 1, 8));
  const Fitted fitted = fit(points);
  int seen = 0;
  for (std::size_t i = 0; i < fitted.planes.size(); ++i) {
    if (fitted.cells.positions[i].z < 0.2F) continue;
    ++seen;
    EXPECT_NEAR(length(fitted.planes[i].center - fitted.cells.positions[i]), 0.1F, 1e-4F);
    EXPECT_NEAR(std::fabs(fitted.planes[i].normal.z), 1.0F, 1e-4F);
  }
  EXPECT_EQ(seen, 1);
}

TEST(AdaptivePlanes, TrimmingNeverLeavesTooFewCellsForAPlane) {
  // Two cells of 1000 points hold nearly all weight, so the deviation across any plane through
  // them is small; ten cells of one point are 4 cm on either side of the plane x = const. Together
  // they give the normal x; the two heavy ones alone are a line along y without a normal.
  std::vector<Vec3f> points;
  const Vec3f heavy = cell_middle(0, 0, 0);
  points.insert(points.end(), 1000, heavy);
  points.insert(points.end(), 1000, heavy + Vec3f{0, 0.05F, 0});
  for (int k = 0; k < 10; ++k) {
    const float angle = 0.6283185F * (static_cast<float>(k) + 0.25F);
    const float side = k % 2 == 0 ? 0.04F : -0.04F;
    points.push_back(heavy + Vec3f{side, 0.15F * std::cos(angle), 0.15F * std::sin(angle)});
  }
  const Fitted fitted = fit(points);
  int seen = 0;
  for (std::size_t i = 0; i < fitted.planes.size(); ++i) {
    if (fitted.cells.count(i) < 1000) continue;
    ++seen;
    EXPECT_GT(std::fabs(fitted.planes[i].normal.x), 0.9F);
  }
  EXPECT_EQ(seen, 2);
}

TEST(AdaptivePlanes, FewPointsAndLinesHaveValidNormals) {
  EXPECT_TRUE(fit({}).planes.empty());
  for (const std::size_t n : {1, 2, 3, 7, 8, 9, 10, 11}) {
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < n; ++i) {
      Random random(4, n, i);
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
      points.push_back(vec_cast<float>(Vec3d{x, y, random.uniform(-1, 1)}));
    }
    const Fitted fitted = fit(points);
    EXPECT_EQ(fitted.planes.size(), n);
    expect_sound(fitted);
  }
  const Fitted equal = fit(std::vector<Vec3f>(100, {1, 2, 3}));
  ASSERT_EQ(equal.planes.size(), 1U);
  expect_sound(equal);
  EXPECT_EQ(equal.planes[0].spacing_m, 0.0F);

  std::vector<Vec3f> line;
  const Vec3f along = normalized(Vec3f{1, 2, -1});
  for (int i = 0; i < 300; ++i) line.push_back((0.03F * static_cast<float>(i)) * along);
  const Fitted fitted = fit(line);
  expect_sound(fitted);
  for (const LocalPlane& plane : fitted.planes) EXPECT_NEAR(dot(plane.normal, along), 0, 1e-3);
}

TEST(AdaptivePlanes, FarOutliersDoNotReachTheirNeighbors) {
  std::vector<Vec3f> points;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) points.push_back(cell_middle(x, y, 0));
  points.insert(points.end(), {{1e30F, 0, 0}, {-3e38F, 0, 3e38F}});
  const Fitted fitted = fit(points);
  expect_sound(fitted);
  int near = 0;
  for (const LocalPlane& plane : fitted.planes) {
    if (!(length(plane.center) < 10.0F)) continue;
    ++near;
    EXPECT_NEAR(std::fabs(plane.normal.z), 1.0F, 1e-6F);
  }
  EXPECT_EQ(near, 400);
}

}  // namespace
}  // namespace adasplats
