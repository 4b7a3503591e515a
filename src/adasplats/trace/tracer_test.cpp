// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "adasplats/core/random.h"

namespace adasplats {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Vec3d random_unit(Random& random) {
  Vec3d v;
  do {
    v = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  } while (dot(v, v) > 1 || dot(v, v) < 1e-3);
  return normalized(v);
}

Vec3d random_in_box(Random& random, Vec3d center, double half) {
  return center + Vec3d{random.uniform(-half, half), random.uniform(-half, half),
                        random.uniform(-half, half)};
}

constexpr std::array<Vec3f, 6> kAxes = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

/// Where a random scene lies and how large its primitives are.
struct Place {
  std::uint64_t seed;
  Vec3d center;
  double half_m;
  double smallest_m;  ///< radius, or size of a triangle
  double largest_m;
};

double random_size(const Place& place, Random& random) {
  return std::exp(random.uniform(std::log(place.smallest_m), std::log(place.largest_m)));
}

/// A fifth of the disks faces an axis exactly; some stand twice at the same place.
std::vector<Disk> random_disks(const Place& place, std::size_t count) {
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(place.seed, 0, i);
    Disk disk = {vec_cast<float>(random_in_box(random, place.center, place.half_m)),
                 static_cast<float>(random_size(place, random)),
                 vec_cast<float>(random_unit(random))};
    if (random.uniform() < 0.2) disk.normal = kAxes[random.next_bits() % 6];
    if (i > 0 && random.uniform() < 0.1) disk = disks[i - 1];
    disks.push_back(disk);
  }
  return disks;
}

/// Triangles, a part of them flat in an axis; every second one shares an edge with the one before.
TriangleMesh random_mesh(const Place& place, std::size_t count) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(place.seed, 1, i);
    const Vec3d middle = random_in_box(random, place.center, place.half_m);
    const double size_m = random_size(place, random);
    const bool flat = random.uniform() < 0.3;
    const auto corner = [&] {
      Vec3d offset = size_m * random_unit(random);
      if (flat) offset.z = 0;
      return vec_cast<float>(middle + offset);
    };
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    if (i % 2 == 1) {
      mesh.vertices.push_back(corner());
      mesh.triangles.push_back({first - 1, first - 2, first});
    } else {
      for (int k = 0; k < 3; ++k) mesh.vertices.push_back(corner());
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return mesh;
}

/// Rays of every kind that traversals get wrong: along axes, in a disk's plane, grazing it, at its
/// rim, with short ranges.
std::vector<Ray> random_rays(const Place& place, std::span<const Disk> disks, std::size_t count) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(place.seed, 2, i);
    const Disk& disk = disks[random.next_bits() % disks.size()];
    const Vec3d c = vec_cast<double>(disk.center), n = vec_cast<double>(disk.normal);
    const Vec3d in_plane = normalized(cross(n, random_unit(random)));
    Ray ray;
    ray.origin = vec_cast<float>(random_in_box(random, place.center, 1.5 * place.half_m));
    switch (i % 6) {
      case 0: ray.direction = vec_cast<float>(random_unit(random)); break;
      case 1: {  // along an axis through a disk
        const auto axis = random.next_bits() % 6;
        ray.direction = kAxes[axis];
        ray.origin = disk.center - static_cast<float>(place.half_m) * ray.direction;
        break;
      }
      case 2:  // in the plane of a disk
        ray.origin = vec_cast<float>(c - place.half_m * in_plane);
        ray.direction = vec_cast<float>(in_plane);
        break;
      case 3: {  // nearly in it
        const Vec3d d = normalized(in_plane + std::pow(10.0, random.uniform(-6, -1)) * n);
        ray.origin = vec_cast<float>(c - random.uniform(0.1, 1.5) * place.half_m * d);
        ray.direction = vec_cast<float>(d);
        break;
      }
      case 4: {  // at the rim
        const Vec3d rim = c + static_cast<double>(disk.radius) * in_plane;
        ray.direction = vec_cast<float>(normalized(rim - vec_cast<double>(ray.origin)));
        break;
      }
      default:  // at the centre, with a range that ends near it
        ray.direction = vec_cast<float>(normalized(c - vec_cast<double>(ray.origin)));
        ray.t_max = length(disk.center - ray.origin) * static_cast<float>(random.uniform(0.9, 1.1));
        ray.t_min = ray.t_max * static_cast<float>(random.uniform(0, 0.99));
    }
    rays.push_back(ray);
  }
  return rays;
}

std::size_t count_valid(std::span<const Hit> hits) {
  return static_cast<std::size_t>(std::ranges::count_if(hits, &Hit::valid));
}

void expect_equal_hits(std::span<const Hit> found, std::span<const Hit> expected) {
  ASSERT_EQ(found.size(), expected.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] == expected[i]) continue;
    if (++different <= 5)
      ADD_FAILURE() << "hit " << i << ": t " << found[i].t << " of " << found[i].primitive
                    << ", expected t " << expected[i].t << " of " << expected[i].primitive;
  }
  EXPECT_EQ(different, 0U);
}

/// Oracle: brute force, bit for bit.
void expect_same_as_brute_force(const SceneView& scene, std::span<const Ray> rays, int depth,
                                double smallest_hit_share) {
  const Executor executor(2);
  const auto oracle = make_brute_force_tracer(scene);
  const auto tracer = make_embree_tracer(scene, executor);
  const auto slots = static_cast<std::size_t>(depth);
  std::vector<Hit> expected_list(rays.size() * slots), found_list(rays.size() * slots);
  oracle->nearest_hits(rays, depth, expected_list, executor);
  tracer->nearest_hits(rays, depth, found_list, executor);
  expect_equal_hits(found_list, expected_list);

  std::vector<Hit> expected, found(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) expected.push_back(expected_list[i * slots]);
  tracer->nearest(rays, found, executor);
  expect_equal_hits(found, expected);
  EXPECT_GT(static_cast<double>(count_valid(expected)),
            smallest_hit_share * static_cast<double>(rays.size()));
}

class TracerInPlace : public testing::TestWithParam<Place> {};

TEST_P(TracerInPlace, DisksAreHitAsByBruteForce) {
  const auto disks = random_disks(GetParam(), 400);
  const auto rays = random_rays(GetParam(), disks, 100'000);
  expect_same_as_brute_force({disks, nullptr}, rays, 5, 0.1);
}

TEST_P(TracerInPlace, TrianglesAreHitAsByBruteForce) {
  const auto mesh = random_mesh(GetParam(), 400);
  std::vector<Disk> targets;  // rays need something to aim at: disks in the triangles' planes
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    const Vec3f normal = cross(t.b - t.a, t.c - t.a);
    if (length(normal) > 0)
      targets.push_back({(t.a + t.b + t.c) / 3.0F, length(t.b - t.a) / 3.0F, normalized(normal)});
  }
  const auto rays = random_rays(GetParam(), targets, 60'000);
  expect_same_as_brute_force({{}, &mesh}, rays, 3, 0.1);
}

TEST_P(TracerInPlace, DisksAndTrianglesTogetherAreHitAsByBruteForce) {
  const auto disks = random_disks(GetParam(), 200);
  const auto mesh = random_mesh(GetParam(), 200);
  const auto rays = random_rays(GetParam(), disks, 20'000);
  expect_same_as_brute_force({disks, &mesh}, rays, 5, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Places, TracerInPlace,
                         testing::Values(Place{1, {0, 0, 0}, 10, 0.3, 3},
                                         Place{2, {0, 0, 0}, 100, 1e-3, 100},
                                         Place{3, {1000, -1000, 1000}, 50, 0.05, 30},
                                         Place{4, {0, 0, 0}, 600, 0.02, 300},
                                         Place{5, {0, 0, 0}, 0.05, 1e-3, 0.02},
                                         Place{6, {-900, 20, 3}, 100, 30, 1000}));

// A laser row has 4 rays a centimetre apart at the target: packets take other paths than for
// rays in all directions.
TEST(Tracer, CoherentRowsAreHitAsByBruteForce) {
  const Place place = {7, {0, 0, 0}, 30, 0.2, 4};
  const auto disks = random_disks(place, 600);
  std::vector<Ray> rays;
  for (int ring = 0; ring < 16; ++ring) {
    for (int column = 0; column < 2250; ++column) {
      const double azimuth = column * 6.283185307179586 / 2250;
      const double elevation = 0.05 * (ring - 8);
      const Vec3d d = {std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      Ray ray;
      ray.direction = vec_cast<float>(d);
      ray.t_max = 25.0F;
      rays.push_back(ray);
    }
  }
  expect_same_as_brute_force({disks, nullptr}, rays, 2, 0.2);
}

class AnyTracer : public testing::TestWithParam<bool> {
 protected:
  std::unique_ptr<Tracer> make(const SceneView& scene) const {
    return GetParam() ? make_embree_tracer(scene, executor_) : make_brute_force_tracer(scene);
  }
  std::vector<Hit> nearest(const SceneView& scene, const std::vector<Ray>& rays) const {
    std::vector<Hit> hits(rays.size(), Hit{1.0F, 7});
    make(scene)->nearest(rays, hits, executor_);
    return hits;
  }
  std::vector<Hit> nearest_hits(const SceneView& scene, const std::vector<Ray>& rays,
                                int depth) const {
    std::vector<Hit> hits(rays.size() * static_cast<std::size_t>(depth), Hit{1.0F, 7});
    make(scene)->nearest_hits(rays, depth, hits, executor_);
    return hits;
  }

  Executor executor_{2};
};

// Oracle of the tests below: analytic.

TEST_P(AnyTracer, NothingIsHitInAnEmptyScene) {
  const TriangleMesh no_triangles;
  const std::vector<Ray> rays(20, Ray{{0, 0, 0}, 0, {1, 0, 0}});
  EXPECT_EQ(count_valid(nearest({}, rays)), 0U);
  EXPECT_EQ(count_valid(nearest({{}, &no_triangles}, rays)), 0U);
  EXPECT_EQ(count_valid(nearest_hits({}, rays, 3)), 0U);
}

TEST_P(AnyTracer, NoRaysGiveNoHits) {
  const std::vector<Disk> disks = {{{5, 0, 0}, 1, {1, 0, 0}}};
  EXPECT_TRUE(nearest({disks, nullptr}, {}).empty());
  EXPECT_TRUE(nearest_hits({disks, nullptr}, {}, 4).empty());
}

TEST_P(AnyTracer, RaysThatAreNotFiniteHitNothing) {
  const std::vector<Disk> disks = {{{5, 0, 0}, 1, {1, 0, 0}}};
  const Ray good = {{0, 0, 0}, 0, {1, 0, 0}};
  std::vector<Ray> rays;
  for (const float bad : {kNaN, kInfinity, -kInfinity, 2e18F}) {
    for (int axis = 0; axis < 3; ++axis) {
      Ray ray = good;
      ray.origin[axis] = bad;
      rays.push_back(ray);
      ray = good;
      ray.direction[axis] = bad;
      rays.push_back(ray);
    }
  }
  Ray no_range = good;
  no_range.t_min = kNaN;
  rays.push_back(no_range);
  no_range = good;
  no_range.t_max = kNaN;
  rays.push_back(no_range);
  rays.push_back({{0, 0, 0}, 0, {0, 0, 0}});
  EXPECT_EQ(count_valid(nearest({disks, nullptr}, rays)), 0U);
  EXPECT_EQ(count_valid(nearest_hits({disks, nullptr}, rays, 2)), 0U);
  // A bad ray leaves its neighbours in the packet alone.
  rays.push_back(good);
  EXPECT_EQ(nearest({disks, nullptr}, rays).back(), (Hit{5.0F, 0}));
}

TEST_P(AnyTracer, PrimitivesThatAreNotFiniteAreNeverHit) {
  std::vector<Disk> disks = {{{5, 0, 0}, 1, {1, 0, 0}}};
  disks.push_back({{kNaN, 0, 0}, 1, {1, 0, 0}});
  disks.push_back({{3, 0, 0}, kNaN, {1, 0, 0}});
  disks.push_back({{3, 0, 0}, 1, {kNaN, 0, 0}});
  disks.push_back({{3, 0, 0}, 1, {0, 0, 0}});
  disks.push_back({{kInfinity, 0, 0}, 1, {1, 0, 0}});
  TriangleMesh mesh;
  mesh.vertices = {{kNaN, 0, 0}, {3, 1, 1}, {3, -1, 1}};
  mesh.triangles = {{0, 1, 2}};
  const std::vector<Ray> rays(9, Ray{{0, 0, 0}, 0, {1, 0, 0}});
  for (const Hit& hit : nearest({disks, &mesh}, rays)) EXPECT_EQ(hit, (Hit{5.0F, 0}));
}

TEST_P(AnyTracer, EqualDistancesGoToTheSmallerIndex) {
  const std::vector<Disk> disks(50, Disk{{5, 0, 0}, 1, {1, 0, 0}});
  TriangleMesh mesh;
  mesh.vertices = {{5, -2, -2}, {5, 2, -2}, {5, 0, 2}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}};
  const std::vector<Ray> rays(40, Ray{{0, 0, 0}, 0, {1, 0, 0}});
  for (const Hit& hit : nearest({disks, &mesh}, rays)) EXPECT_EQ(hit, (Hit{5.0F, 0}));
  const auto hits = nearest_hits({disks, &mesh}, rays, 52);
  for (std::uint32_t i = 0; i < hits.size(); ++i) EXPECT_EQ(hits[i], (Hit{5.0F, i % 52}));
}

TEST_P(AnyTracer, TrianglesComeBehindTheDisksInTheIndex) {
  const std::vector<Disk> disks = {{{9, 0, 0}, 1, {1, 0, 0}}, {{8, 0, 0}, 1, {1, 0, 0}}};
  TriangleMesh mesh;
  mesh.vertices = {{5, -2, -2}, {5, 2, -2}, {5, 0, 2}, {4, -2, -2}, {4, 2, -2}, {4, 0, 2}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const auto hits = nearest_hits({disks, &mesh}, {Ray{{0, 0, 0}, 0, {1, 0, 0}}}, 6);
  const std::vector<Hit> expected = {{4, 3}, {5, 2}, {8, 1}, {9, 0}, {}, {}};
  EXPECT_EQ(hits, expected);
}

TEST_P(AnyTracer, RangesAreOpenBelowAndClosedAbove) {
  const std::vector<Disk> disks = {{{5, 0, 0}, 1, {1, 0, 0}}, {{6, 0, 0}, 1, {1, 0, 0}}};
  const std::vector<Ray> rays = {{{0, 0, 0}, 5, {1, 0, 0}},
                                 {{0, 0, 0}, 0, {1, 0, 0}, 5},
                                 {{0, 0, 0}, 5, {1, 0, 0}, 5.5F},
                                 {{0, 0, 0}, 5, {1, 0, 0}, 4},
                                 {{5.5F, 0, 0}, -9, {1, 0, 0}}};
  const std::vector<Hit> expected = {{6, 1}, {5, 0}, {}, {}, {0.5F, 1}};
  EXPECT_EQ(nearest({disks, nullptr}, rays), expected);
  EXPECT_EQ(nearest_hits({disks, nullptr}, rays, 1), expected);
}

TEST_P(AnyTracer, AWrongNumberOfHitsIsABug) {
  const std::vector<Ray> rays(3);
  std::vector<Hit> hits(4);
  const auto tracer = make({});
  EXPECT_THROW(tracer->nearest(rays, hits, executor_), std::logic_error);
  EXPECT_THROW(tracer->nearest_hits(rays, 2, hits, executor_), std::logic_error);
  EXPECT_THROW(tracer->nearest_hits({}, 0, {}, executor_), std::logic_error);
}

INSTANTIATE_TEST_SUITE_P(Backends, AnyTracer, testing::Bool(), [](const auto& backend) {
  return backend.param ? "Embree" : "BruteForce";
});

// Oracle: one thread.
TEST(Tracer, HitsDoNotDependOnTheNumberOfThreads) {
  const Place place = {8, {0, 0, 0}, 30, 0.2, 4};
  const auto disks = random_disks(place, 20'000);
  const auto rays = random_rays(place, disks, 30'000);
  const auto trace = [&](int threads) {
    const Executor executor(threads);
    const auto tracer = make_cpu_tracer({disks, nullptr}, executor);
    std::vector<Hit> hits(4 * rays.size());
    tracer->nearest(rays, std::span(hits).first(rays.size()), executor);
    tracer->nearest_hits(rays, 3, std::span(hits).subspan(rays.size()), executor);
    return hits;
  };
  const std::vector<Hit> expected = trace(1);
  EXPECT_GT(count_valid(expected), rays.size());
  expect_equal_hits(trace(2), expected);
  expect_equal_hits(trace(3), expected);
}

// Two tracers of different scenes in one process, built while the other lives.
TEST(Tracer, TwoScenesDoNotMix) {
  const std::vector<Disk> near = {{{2, 0, 0}, 1, {1, 0, 0}}};
  const std::vector<Disk> far = {{{7, 0, 0}, 1, {1, 0, 0}}};
  const Executor one(1), two(2);
  const auto first = make_embree_tracer({near, nullptr}, one);
  const auto second = make_embree_tracer({far, nullptr}, two);
  const std::vector<Ray> rays = {{{0, 0, 0}, 0, {1, 0, 0}}};
  std::vector<Hit> hits(1);
  first->nearest(rays, hits, two);
  EXPECT_EQ(hits[0].t, 2.0F);
  second->nearest(rays, hits, one);
  EXPECT_EQ(hits[0].t, 7.0F);
}

}  // namespace
}  // namespace adasplats
