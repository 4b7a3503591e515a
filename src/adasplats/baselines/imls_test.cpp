// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/imls.h"

#include <gtest/gtest.h>

#include <optional>

#include "adasplats/baselines/shapes_test.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr double kVoxel_m = 0.07;

const Executor& executor() {
  static const Executor threads(2);
  return threads;
}

/// nullopt in a build without OpenVDB.
std::optional<TriangleMesh> surface(const OrientedPoints& points, const ImlsOptions& options = {}) {
  try {
    return imls_surface(points.positions, points.normals, options, executor());
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::unavailable) throw;
    return std::nullopt;
  }
}

#define SURFACE_OR_SKIP(name, points)              \
  const auto maybe_##name = surface(points);       \
  if (!maybe_##name) GTEST_SKIP() << "no OpenVDB"; \
  const TriangleMesh& name = *maybe_##name

OrientedPoints cloud_in_disorder(int count) {
  OrientedPoints points;
  Random random(7, 0, 0);
  for (int i = 0; i < count; ++i) {
    const auto coordinate = [&] { return static_cast<float>(3 * random.uniform() - 1.5); };
    points.positions.push_back({coordinate(), coordinate(), coordinate()});
    points.normals.push_back(normalized(Vec3f{coordinate(), coordinate(), coordinate() + 2.0F}));
  }
  return points;
}

// Oracle: eq. IMLS summed over all points, in double with std::exp.
TEST(ImlsField, EveryVoxelAgainstBruteForce) {
  const OrientedPoints points = cloud_in_disorder(60);
  const ImlsOptions options;
  const ImlsField field(points.positions, points.normals, options, executor());
  const double reach = options.truncation_voxels * options.voxel_m;
  const double sigma = options.sigma_voxels * options.voxel_m;
  std::size_t found = 0;
  for (std::size_t b = 0; b < field.size(); ++b) {
    const ImlsField::Block block = field.block(b);
    for (std::size_t v = 0; v < block.values.size(); ++v) {
      const Vec3d x = options.voxel_m * Vec3d{block.corner[0] + static_cast<double>(v / 64),
                                              block.corner[1] + static_cast<double>(v / 8 % 8),
                                              block.corner[2] + static_cast<double>(v % 8)};
      double distances = 0, weights = 0;
      bool at_the_limit = false;
      for (std::size_t k = 0; k < points.positions.size(); ++k) {
        const Vec3d d = x - vec_cast<double>(points.positions[k]);
        at_the_limit = at_the_limit || std::fabs(length(d) - reach) < 1e-6;
        if (length(d) > reach) continue;
        const double w = std::exp(-dot(d, d) / (sigma * sigma));
        distances += w * dot(vec_cast<double>(points.normals[k]), d);
        weights += w;
      }
      if (at_the_limit) continue;
      const bool known = (block.known[v / 64] >> (v % 64) & 1U) != 0;
      ASSERT_EQ(known, weights > 0) << b << " " << v;
      if (known) {
        ASSERT_NEAR(block.values[v], distances / weights, 2e-6);
      }
      found += known ? 1 : 0;
    }
  }
  // A ball of 3 voxels holds 113 nodes on average; none may be missing.
  EXPECT_GT(found, 60 * 100U);
  EXPECT_LT(found, 60 * 130U);
}

TEST(ImlsField, NoPointsAndOptionsOutOfRange) {
  EXPECT_EQ(ImlsField({}, {}, {}, executor()).size(), 0U);
  const OrientedPoints points = square(1, 2);
  for (const ImlsOptions& bad :
       {ImlsOptions{0, 2, 3}, ImlsOptions{-1, 2, 3}, ImlsOptions{NAN, 2, 3},
        ImlsOptions{1e-8, 2, 3}, ImlsOptions{0.07, 2, 9}, ImlsOptions{0.07, 2, 0.5},
        ImlsOptions{0.07, 0.5, 3}}) {
    EXPECT_THROW(ImlsField(points.positions, points.normals, bad, executor()), Error);
  }
}

// Oracle: the plane. The function is the exact distance, so the surface is the plane itself; it
// ends where values end, at most 3 voxels beyond the points.
TEST(Imls, OpenPlaneHasNoSheetsWhereTheBandEnds) {
  constexpr float kHalf_m = 2;
  SURFACE_OR_SKIP(mesh, square(kHalf_m, 101, 0.031F));
  ASSERT_FALSE(mesh.triangles.empty());
  for (const Vec3f v : mesh.vertices) {
    EXPECT_NEAR(v.z, 0.031F, 1e-5F);
    EXPECT_LE(std::max(std::fabs(v.x), std::fabs(v.y)), kHalf_m + 3 * 0.07F);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    EXPECT_GT(cross_of(mesh.triangle(i)).z, 0) << "a face looks down";
  const auto side_with = [&](double voxels) { return 2 * (kHalf_m + voxels * kVoxel_m); };
  EXPECT_GT(area_m2(mesh), side_with(1) * side_with(1));
  EXPECT_LT(area_m2(mesh), side_with(3) * side_with(3));
}

TEST(Imls, FlippedNormalsFlipTheFaces) {
  SURFACE_OR_SKIP(mesh, square(1, 51, 0, -1));
  ASSERT_FALSE(mesh.triangles.empty());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    EXPECT_LT(cross_of(mesh.triangle(i)).z, 0);
}

// Oracle: the sphere. Planes of points up to 3 voxels away lie outside of it, by the weights some
// sigma^2 / (2 R) = 5 mm, and cells cut off as much again.
TEST(Imls, SphereIsRoundAndClosed) {
  constexpr float kRadius_m = 1.7F;
  const Vec3f center = {0.3F, -0.2F, 10};
  SURFACE_OR_SKIP(mesh, sphere(center, kRadius_m, 40000));
  EXPECT_TRUE(is_closed(mesh));
  for (const Vec3f v : mesh.vertices) EXPECT_NEAR(length(v - center), kRadius_m, 0.010F);
  const double exact = 4.0 / 3 * 3.14159265 * std::pow(kRadius_m, 3);
  EXPECT_NEAR(volume_m3(mesh), exact, 0.02 * exact);
}

// Oracle: the two planes. Between walls seen from both sides the function keeps one sign; walls
// farther apart than two truncations have no surface between them.
TEST(Imls, TwoParallelPlanesStayApart) {
  constexpr float kGap_m = 8 * 0.07F;
  for (const float sign : {1.0F, -1.0F}) {
    OrientedPoints points = square(1, 51, 0.01F, -1);
    points.add(square(1, 51, 0.01F + kGap_m, sign));
    SURFACE_OR_SKIP(mesh, points);
    for (const Vec3f v : mesh.vertices)
      EXPECT_NEAR(std::fabs(v.z - 0.01F - kGap_m / 2), kGap_m / 2, 1e-3F);
    SURFACE_OR_SKIP(one, square(1, 51, 0.01F));
    EXPECT_NEAR(area_m2(mesh), 2 * area_m2(one), 0.05 * area_m2(mesh));
  }
  // A wall of 4 voxels, seen from both sides: the far side pulls a little.
  OrientedPoints wall = square(1, 51, 0.01F, -1);
  wall.add(square(1, 51, 0.29F, 1));
  SURFACE_OR_SKIP(mesh, wall);
  ASSERT_FALSE(mesh.vertices.empty());
  for (const Vec3f v : mesh.vertices) EXPECT_NEAR(std::fabs(v.z - 0.15F), 0.14F, 0.02F);
}

TEST(Imls, SameBytesForEveryNumberOfThreads) {
  const OrientedPoints points = cloud_in_disorder(3000);
  std::optional<TriangleMesh> first;
  for (const int threads : {1, 2, 5}) {
    TriangleMesh mesh;
    try {
      mesh = imls_surface(points.positions, points.normals, {}, Executor(threads));
    } catch (const Error&) {
      GTEST_SKIP() << "no OpenVDB";
    }
    ASSERT_GT(mesh.triangles.size(), 1000U);
    if (!first) first = mesh;
    EXPECT_EQ(mesh.triangles, first->triangles);
    EXPECT_EQ(mesh.vertices, first->vertices);
  }
}

TEST(Imls, NoPointsAndOnePoint) {
  SURFACE_OR_SKIP(nothing, OrientedPoints{});
  EXPECT_TRUE(nothing.triangles.empty());
  SURFACE_OR_SKIP(one, (OrientedPoints{{{5, 5, 5}}, {{0, 0, 1}}}));
  // Oracle: a disk of the truncation's radius, less the cells that the ball cuts.
  EXPECT_GT(area_m2(one), 0.0);
  EXPECT_LT(area_m2(one), 3.2 * 9 * kVoxel_m * kVoxel_m);
  for (const Vec3f v : one.vertices) EXPECT_NEAR(v.z, 5, 1e-5F);
}

TEST(Imls, ManyEqualPoints) {
  OrientedPoints points;
  points.positions.assign(100000, {1, 2, 3});
  points.normals.assign(100000, {0, 0, 1});
  SURFACE_OR_SKIP(mesh, points);
  SURFACE_OR_SKIP(one, (OrientedPoints{{{1, 2, 3}}, {{0, 0, 1}}}));
  EXPECT_EQ(mesh.triangles, one.triangles);
}

}  // namespace
}  // namespace adasplats
