// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/trace/wide_kernel.h"

namespace adasplats {
namespace {

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

/// Position of a random scene and size of its primitives.
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

/// A fifth of the disks faces an axis exactly; some are duplicates.
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

/// A way to make a tracer.
struct Backend {
  std::string name;
  std::function<std::unique_ptr<Tracer>(const SceneView&, const Executor&)> make;
};

/// All but brute force: Embree, and ours in each kind of vectors that this machine has.
std::vector<Backend> fast_backends() {
  std::vector<Backend> backends = {{"embree", make_embree_tracer}};
  for (const detail::WideVersion& version : detail::wide_versions())
    backends.push_back({"wide_" + std::string(version.name),
                        [version](const SceneView& scene, const Executor& executor) {
                          return detail::make_wide_tracer(scene, version, executor);
                        }});
  return backends;
}

std::vector<Backend> all_backends() {
  std::vector<Backend> backends = fast_backends();
  backends.push_back({"brute_force", [](const SceneView& scene, const Executor&) {
                        return make_brute_force_tracer(scene);
                      }});
  return backends;
}

/// Oracle: brute force, bit for bit.
void expect_same_as_brute_force(const SceneView& scene, std::span<const Ray> rays, int depth,
                                double smallest_hit_share) {
  const Executor executor(2);
  const auto oracle = make_brute_force_tracer(scene);
  const auto slots = static_cast<std::size_t>(depth);
  std::vector<Hit> expected_list(rays.size() * slots), found_list(rays.size() * slots);
  oracle->nearest_hits(rays, depth, expected_list, executor);
  std::vector<Hit> expected, found(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) expected.push_back(expected_list[i * slots]);

  for (const Backend& backend : fast_backends()) {
    SCOPED_TRACE(backend.name);
    const auto tracer = backend.make(scene, executor);
    tracer->nearest_hits(rays, depth, found_list, executor);
    expect_equal_hits(found_list, expected_list);
    tracer->nearest(rays, found, executor);
    expect_equal_hits(found, expected);
  }
  EXPECT_GT(static_cast<double>(count_valid(expected)),
            smallest_hit_share * static_cast<double>(rays.size()));
}

class TracerInPlace : public testing::TestWithParam<Place> {};

TEST_P(TracerInPlace, DisksEqualBruteForce) {
  const auto disks = random_disks(GetParam(), 400);
  const auto rays = random_rays(GetParam(), disks, 100'000);
  expect_same_as_brute_force({disks, nullptr}, rays, 5, 0.1);
}

TEST_P(TracerInPlace, TrianglesEqualBruteForce) {
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

TEST_P(TracerInPlace, DisksWithTrianglesEqualBruteForce) {
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

/// Rays of adjacent rows. With `travel_m` they start along a line, as from a moving
/// sensor; `pitch_rad` apart in azimuth.
std::vector<Ray> laser_rows(int rows, int columns, double pitch_rad, double travel_m) {
  std::vector<Ray> rays;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double azimuth = pitch_rad * column;
      const double elevation = 0.05 * (row - rows / 2);
      const Vec3d d = {std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      Ray ray;
      ray.origin.x = static_cast<float>(travel_m * column / columns);
      ray.direction = vec_cast<float>(d);
      ray.t_max = 25.0F;
      rays.push_back(ray);
    }
  }
  return rays;
}

// A laser row has 4 rays a centimetre apart at the target: packets take other paths than for
// rays in all directions.
TEST(Tracer, CoherentRowsEqualBruteForce) {
  const Place place = {7, {0, 0, 0}, 30, 0.2, 4};
  const auto disks = random_disks(place, 600);
  const auto rays = laser_rows(16, 2250, 6.283185307179586 / 2250, 0);
  expect_same_as_brute_force({disks, nullptr}, rays, 2, 0.2);
}

// Rows from a moving sensor, packets up to the maximum width and beyond, and partial last packets.
TEST(Tracer, RowsOfEveryWidthEqualBruteForce) {
  const Place place = {9, {0, 0, 0}, 20, 2, 8};
  const auto disks = random_disks(place, 300);
  const auto mesh = random_mesh(place, 100);
  for (const double pitch_rad : {0.0, 1e-6, 0.003, 0.02, 0.03, 0.3})
    for (const double travel_m : {0.0, 5.0})
      expect_same_as_brute_force({disks, &mesh}, laser_rows(8, 333, pitch_rad, travel_m), 8, 0.1);
}

// Rays of a packet that cannot be cast, have other ranges or directions of another length.
TEST(Tracer, OddRaysInAPacketEqualBruteForce) {
  const Place place = {10, {0, 0, 0}, 30, 0.5, 6};
  const auto disks = random_disks(place, 200);
  std::vector<Ray> rays = laser_rows(16, 500, 0.003, 0);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Random random(place.seed, 3, i);
    switch (random.next_bits() % 8) {
      case 0: rays[i].direction = {}; break;
      case 1: rays[i].t_max = static_cast<float>(random.uniform(-1, 20)); break;
      case 2: rays[i].t_min = static_cast<float>(random.uniform(-5, 30)); break;
      case 3: rays[i].origin.z = kNaN; break;
      case 4: rays[i].t_max = kInfinity; break;
      default: break;
    }
  }
  expect_same_as_brute_force({disks, nullptr}, rays, 3, 0.1);
  for (Ray& ray : rays) ray.direction = 1.02F * ray.direction;
  expect_same_as_brute_force({disks, nullptr}, rays, 3, 0.1);
}

/// Scenes at the limits of a tree's build.
struct Arrangement {
  std::string name;
  std::vector<Disk> disks;
};

std::vector<Arrangement> arrangements() {
  const Place place = {11, {0, 0, 0}, 10, 0.3, 3};
  std::vector<Arrangement> result;
  for (const std::size_t count : {1U, 2U, 7U, 8U, 9U, 15U, 16U, 17U, 33U, 257U})
    result.push_back({std::to_string(count), random_disks(place, count)});
  result.push_back({"all equal", std::vector<Disk>(300, Disk{{1, 2, 3}, 2, {0, 0, 1}})});
  auto line = random_disks(place, 500);
  for (std::size_t i = 0; i < line.size(); ++i)
    line[i].center = {0.04F * static_cast<float>(i) - 10, 0, 0};
  result.push_back({"in a line", line});
  auto one_giant = random_disks({12, {0, 0, 0}, 10, 0.01, 0.5}, 500);
  one_giant[77] = {{0, 0, 0}, 1e6F, normalized(Vec3f{0.1F, 0.2F, 1})};
  result.push_back({"one giant", one_giant});
  auto far_apart = random_disks(place, 300);
  for (std::size_t i = 0; i < 20; ++i) far_apart[i].center = {1e17F, -1e12F, 1e6F};
  far_apart[50] = {{0, 0, 0}, 3e18F, {0, 0, 1}};
  result.push_back({"far apart", far_apart});
  auto other_normals = random_disks(place, 300);
  for (std::size_t i = 0; i < other_normals.size(); i += 3)
    other_normals[i].normal = 1.5F * other_normals[i].normal;
  result.push_back({"normals of other lengths", other_normals});
  auto points = random_disks(place, 300);
  for (std::size_t i = 0; i < points.size(); i += 2) points[i].radius = 0;
  result.push_back({"radius 0", points});
  return result;
}

/// All hits of rays as (ray, t, primitive), sorted.
std::vector<std::tuple<std::uint32_t, float, std::uint32_t>> all_hits_of(
    const Tracer& tracer, std::span<const Ray> rays) {
  std::vector<std::tuple<std::uint32_t, float, std::uint32_t>> all;
  tracer.all_hits(rays, [&](std::span<const RayHit> hits) {
    for (const RayHit& found : hits) all.emplace_back(found.ray, found.hit.t, found.hit.primitive);
  });
  std::ranges::sort(all);
  return all;
}

// Oracle: brute force, for single rays, packets and lists. (Embree omits primitives beyond 1e18.)
TEST(Tracer, WideTreesOfOddScenesEqualBruteForce) {
  const Executor executor(2);
  for (const Arrangement& scene : arrangements()) {
    SCOPED_TRACE(scene.name);
    const SceneView view = {scene.disks, nullptr};
    std::vector<Ray> rays = random_rays({11, {0, 0, 0}, 10, 0.3, 3}, scene.disks, 3000);
    for (const Ray& ray : laser_rows(4, 500, 0.0126, 0)) rays.push_back(ray);
    constexpr int kDepth = 12;
    std::vector<Hit> expected(kDepth * rays.size()), nearest, found(expected.size());
    make_brute_force_tracer(view)->nearest_hits(rays, kDepth, expected, executor);
    for (std::size_t i = 0; i < rays.size(); ++i) nearest.push_back(expected[kDepth * i]);
    EXPECT_GT(count_valid(nearest), 0U);
    const auto all = all_hits_of(*make_brute_force_tracer(view), rays);
    for (const detail::WideVersion& version : detail::wide_versions()) {
      const auto tracer = detail::make_wide_tracer(view, version, executor);
      EXPECT_EQ(all_hits_of(*tracer, rays), all);
      tracer->nearest_hits(rays, kDepth, found, executor);
      expect_equal_hits(found, expected);
      std::vector<Hit> found_nearest(rays.size());
      tracer->nearest(rays, found_nearest, executor);
      expect_equal_hits(found_nearest, nearest);
    }
  }
}

class AnyTracer : public testing::TestWithParam<Backend> {
 protected:
  std::unique_ptr<Tracer> make(const SceneView& scene) const {
    return GetParam().make(scene, executor_);
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
  for (const float bad : {static_cast<float>(kNaN), kInfinity, -kInfinity, 2e18F}) {
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

TEST_P(AnyTracer, TriangleIndicesFollowDiskIndices) {
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

TEST_P(AnyTracer, AWrongNumberOfHitsThrowsLogicError) {
  const std::vector<Ray> rays(3);
  std::vector<Hit> hits(4);
  const auto tracer = make({});
  EXPECT_THROW(tracer->nearest(rays, hits, executor_), std::logic_error);
  EXPECT_THROW(tracer->nearest_hits(rays, 2, hits, executor_), std::logic_error);
  EXPECT_THROW(tracer->nearest_hits({}, 0, {}, executor_), std::logic_error);
}

INSTANTIATE_TEST_SUITE_P(Backends, AnyTracer, testing::ValuesIn(all_backends()),
                         [](const auto& backend) { return backend.param.name; });

// Oracle: one thread.
TEST(Tracer, HitsDoNotDependOnTheNumberOfThreads) {
  const Place place = {8, {0, 0, 0}, 30, 0.2, 4};
  const auto disks = random_disks(place, 20'000);
  const auto rays = random_rays(place, disks, 30'000);
  const auto trace = [&](const Backend& backend, int threads) {
    const Executor executor(threads);
    const auto tracer = backend.make({disks, nullptr}, executor);
    std::vector<Hit> hits(4 * rays.size());
    tracer->nearest(rays, std::span(hits).first(rays.size()), executor);
    tracer->nearest_hits(rays, 3, std::span(hits).subspan(rays.size()), executor);
    return hits;
  };
  for (const Backend& backend : fast_backends()) {
    SCOPED_TRACE(backend.name);
    const std::vector<Hit> expected = trace(backend, 1);
    EXPECT_GT(count_valid(expected), rays.size());
    expect_equal_hits(trace(backend, 2), expected);
    expect_equal_hits(trace(backend, 3), expected);
  }
}

// Oracle: the tree that one thread builds, byte for byte; large enough for splits in parallel.
TEST(WideBvh, DoesNotDependOnTheNumberOfThreads) {
  const auto disks = random_disks({13, {0, 0, 0}, 30, 0.02, 0.4}, 150'000);
  const auto mesh = random_mesh({13, {0, 0, 0}, 30, 0.02, 0.4}, 20'000);
  const auto bytes_of = [](const auto& items) {
    return std::string(reinterpret_cast<const char*>(items.data()),
                       items.size() * sizeof(items[0]));
  };
  const WideBvh one = build_wide_bvh({disks, &mesh}, Executor(1));
  for (const int threads : {2, 3}) {
    const WideBvh other = build_wide_bvh({disks, &mesh}, Executor(threads));
    EXPECT_EQ(other.root.bits, one.root.bits);
    EXPECT_TRUE(bytes_of(other.nodes) == bytes_of(one.nodes));
    EXPECT_TRUE(bytes_of(other.disks) == bytes_of(one.disks));
    EXPECT_TRUE(bytes_of(other.triangles) == bytes_of(one.triangles));
  }
}

// Oracle: every primitive is in one leaf, in the boxes of all nodes above it.
TEST(WideBvh, HoldsEveryPrimitiveOnceWithinItsBoxes) {
  const auto disks = random_disks({14, {0, 0, 0}, 30, 0.02, 2}, 70'000);
  const auto mesh = random_mesh({14, {0, 0, 0}, 30, 0.02, 2}, 3'000);
  const WideBvh bvh = build_wide_bvh({disks, &mesh}, Executor(2));
  std::vector<int> seen(disks.size() + mesh.triangles.size());
  const auto visit = [&](const auto& self, WideRef ref, Vec3f low, Vec3f high) -> void {
    const auto expect_within = [&](Vec3f p) {
      ASSERT_TRUE(min(p, low) == low && max(p, high) == high);
    };
    if (ref.kind() == WideRef::Kind::node) {
      const WideNode& node = bvh.nodes[ref.index()];
      for (unsigned child = 0; child < kWide; ++child) {
        if (node.children[child].kind() == WideRef::Kind::nothing) continue;
        const auto end = [&](int e) {
          return Vec3f{node.bounds[e][0][child], node.bounds[e][1][child],
                       node.bounds[e][2][child]};
        };
        expect_within(end(0));
        expect_within(end(1));
        self(self, node.children[child], end(0), end(1));
      }
      return;
    }
    for (unsigned lane = 0; lane < kWide; ++lane) {
      const bool is_disk = ref.kind() == WideRef::Kind::disks;
      const std::uint32_t primitive = is_disk ? bvh.disks[ref.index()].primitive[lane]
                                              : bvh.triangles[ref.index()].primitive[lane];
      if (primitive == Hit::kNone) continue;
      ++seen[primitive];
      if (is_disk) {
        const Vec3f half = disk_half_extent(disks[primitive]);
        expect_within(disks[primitive].center - half);
        expect_within(disks[primitive].center + half);
      } else {
        const Triangle triangle = mesh.triangle(primitive - disks.size());
        for (const Vec3f corner : {triangle.a, triangle.b, triangle.c}) expect_within(corner);
      }
    }
  };
  visit(visit, bvh.root, {-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity});
  EXPECT_EQ(std::ranges::count(seen, 1), static_cast<std::ptrdiff_t>(seen.size()));
}

// Meshes use Embree, which is as fast for them on any machine.
TEST(Tracer, CpuTracerDependsOnTheScene) {
  const Executor executor(1);
  const std::vector<Disk> disks = {{{2, 0, 0}, 1, {1, 0, 0}}};
  const TriangleMesh mesh = random_mesh({15, {0, 0, 0}, 30, 0.2, 4}, 10);
  const bool has_vectors = detail::wide_versions().front().name != "portable";
  EXPECT_EQ(make_cpu_tracer({disks, nullptr}, executor)->name(), has_vectors ? "wide" : "embree");
  EXPECT_EQ(make_cpu_tracer({disks, &mesh}, executor)->name(), "embree");
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

// Embree builds its scene within one of our loops. An interruption of that loop also cancelled
// Embree's tasks, which caused a crash or a deadlock in one of a hundred runs.
TEST(Tracer, InterruptionsDoNotReachARunningBuild) {
  const TriangleMesh mesh = random_mesh({15, {0, 0, 0}, 30, 0.2, 4}, 20'000);
  for (int k = 0; k < 100; ++k) {
    int calls = 0;
    const Executor executor(4, [&] {
      if (++calls == 2) throw std::runtime_error("interrupted");
    });
    EXPECT_NO_THROW(make_embree_tracer({{}, &mesh}, executor));
    EXPECT_EQ(calls, 1);
  }
}

}  // namespace
}  // namespace adasplats
