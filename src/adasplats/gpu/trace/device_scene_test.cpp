// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <string>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/optix/optix_library.h"
#include "adasplats/trace/tracer.h"
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/trace/device_scene.h"
#endif

namespace adasplats {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

enum class Backend { brute_force, embree, cuda, optix };

bool on_gpu(Backend backend) { return backend == Backend::cuda || backend == Backend::optix; }

std::string name_of(Backend backend) {
  switch (backend) {
    case Backend::brute_force: return "brute_force";
    case Backend::embree: return "embree";
    case Backend::cuda: return "cuda";
    case Backend::optix: return "optix";
  }
  return "";
}

/// Why a backend cannot run here; empty if it can.
std::string why_not(Backend backend) {
  if (!on_gpu(backend)) return "";
  const GpuSearch gpus = find_gpus();
  if (gpus.devices.empty()) return gpus.reason;
  return backend == Backend::optix ? find_optix().reason : "";
}

/// A scene of one backend, ready for casts.
class Caster {
 public:
  virtual ~Caster() = default;
  virtual std::vector<Hit> cast(std::span<const Ray> rays, int depth) const = 0;
};

class TracerCaster final : public Caster {
 public:
  TracerCaster(const SceneView& scene, bool embree)
      : tracer_(embree ? make_embree_tracer(scene, executor_) : make_brute_force_tracer(scene)) {}

  std::vector<Hit> cast(std::span<const Ray> rays, int depth) const override {
    std::vector<Hit> hits(rays.size() * static_cast<std::size_t>(depth), Hit{1.0F, 7});
    if (depth == 1) {
      tracer_->nearest(rays, hits, executor_);
    } else {
      tracer_->nearest_hits(rays, depth, hits, executor_);
    }
    return hits;
  }

 private:
  Executor executor_;
  std::unique_ptr<Tracer> tracer_;
};

#if defined(ADASPLATS_HAVE_CUDA)

std::unique_ptr<gpu::DeviceScene> make_device_scene(const SceneView& scene, Backend backend) {
  return backend == Backend::optix ? gpu::make_optix_scene(scene) : gpu::make_cuda_scene(scene);
}

gpu::RaySource given(const gpu::DeviceBuffer<Ray>& rays) {
  gpu::RaySource source;
  source.rays = rays.data();
  return source;
}

class GpuCaster final : public Caster {
 public:
  GpuCaster(const SceneView& scene, Backend backend) : scene_(make_device_scene(scene, backend)) {}

  std::vector<Hit> cast(std::span<const Ray> rays, int depth) const override {
    const gpu::DeviceBuffer<Ray> there(rays, stream_.get());
    return cast(given(there), rays.size(), depth);
  }

  std::vector<Hit> cast(const gpu::RaySource& source, std::size_t rays, int depth) const {
    gpu::DeviceBuffer<Hit> hits(rays * static_cast<std::size_t>(depth), stream_.get());
    hits.fill_bytes(0x11);
    scene_->cast(source, rays, depth, hits.data(), stream_.get());
    return hits.download();
  }

  const gpu::DeviceScene& scene() const { return *scene_; }
  cudaStream_t stream() const { return stream_.get(); }

 private:
  gpu::MemoryPoolGuard keep_memory_{0};
  gpu::Stream stream_;
  std::unique_ptr<gpu::DeviceScene> scene_;
};

#endif

std::unique_ptr<Caster> make_caster(const SceneView& scene, Backend backend) {
#if defined(ADASPLATS_HAVE_CUDA)
  if (on_gpu(backend)) return std::make_unique<GpuCaster>(scene, backend);
#endif
  return std::make_unique<TracerCaster>(scene, backend == Backend::embree);
}

Vec3d random_unit(Random& random) {
  Vec3d v;
  do {
    v = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  } while (dot(v, v) > 1 || dot(v, v) < 1e-3);
  return normalized(v);
}

/// Position of a random scene and size of its primitives.
struct Layout {
  std::uint64_t seed;
  Vec3d center;
  double half_m;
  double smallest_m, largest_m;

  Vec3d point(Random& random, double stretch = 1) const {
    const auto coordinate = [&] { return random.uniform(-stretch * half_m, stretch * half_m); };
    return center + Vec3d{coordinate(), coordinate(), coordinate()};
  }
  double size(Random& random) const {
    return std::exp(random.uniform(std::log(smallest_m), std::log(largest_m)));
  }
};

/// A fifth of the disks is exactly perpendicular to an axis; a tenth equals the previous one.
std::vector<Disk> random_disks(const Layout& layout, std::size_t count) {
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(layout.seed, 0, i);
    Disk disk = {vec_cast<float>(layout.point(random)), static_cast<float>(layout.size(random)),
                 vec_cast<float>(random_unit(random))};
    if (random.uniform() < 0.2) {
      disk.normal = {};
      disk.normal[static_cast<int>(random.next_bits() % 3)] = 1;
    }
    disks.push_back(i > 0 && random.uniform() < 0.1 ? disks[i - 1] : disk);
  }
  return disks;
}

/// Pairs of triangles with a common edge, some of them flat in an axis.
TriangleMesh random_mesh(const Layout& layout, std::size_t count) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; 2 * i < count; ++i) {
    Random random(layout.seed, 1, i);
    const Vec3d middle = layout.point(random);
    const double size_m = layout.size(random);
    const bool flat = random.uniform() < 0.3;
    for (int corner = 0; corner < 4; ++corner) {
      Vec3d offset = size_m * random_unit(random);
      if (flat) offset.z = 0;
      mesh.vertices.push_back(vec_cast<float>(middle + offset));
    }
    mesh.triangles.push_back({4 * i, 4 * i + 1, 4 * i + 2});
    mesh.triangles.push_back({4 * i + 2, 4 * i + 1, 4 * i + 3});
  }
  return mesh;
}

/// A target point for every primitive.
std::vector<Disk> targets_of(const SceneView& scene) {
  std::vector<Disk> targets(scene.disks.begin(), scene.disks.end());
  for (std::size_t i = 0; i < scene.triangle_count(); ++i) {
    const Triangle t = scene.mesh->triangle(i);
    const Vec3f normal = cross(t.b - t.a, t.c - t.a);
    if (length(normal) > 0)
      targets.push_back({(t.a + t.b + t.c) / 3.0F, length(t.b - t.a) / 3.0F, normalized(normal)});
  }
  return targets;
}

/// A ray towards a target, of the i-th kind of difficult rays.
Ray awkward_ray(std::size_t kind, const Disk& target, const Layout& layout, Random& random) {
  const Vec3d c = vec_cast<double>(target.center), n = vec_cast<double>(target.normal);
  const Vec3d in_plane = normalized(cross(n, random_unit(random)));
  const double r = static_cast<double>(target.radius);
  Vec3d origin = layout.point(random, 1.5);
  Vec3d d = random_unit(random);
  double range = 0;
  switch (kind % 8) {
    case 0: break;  // anywhere
    case 1:         // along an axis
      d = {};
      d[static_cast<int>(random.next_bits() % 3)] = random.uniform() < 0.5 ? -1 : 1;
      origin = c - layout.half_m * d;
      break;
    case 2:  // in the plane of the target
      d = in_plane;
      origin = c - layout.half_m * d;
      break;
    case 3:  // grazing it
      d = normalized(in_plane + std::pow(10.0, random.uniform(-6, -1)) * n);
      origin = c - random.uniform(0.1, 1.5) * layout.half_m * d;
      break;
    case 4: d = normalized(c + r * in_plane - origin); break;  // at the rim
    case 5:                                                    // ends near the target
      d = normalized(c - origin);
      range = length(c - origin) * random.uniform(0.9, 1.1);
      break;
    case 6: origin = c + r * random_unit(random); break;  // from inside its box
    default:                                              // from far away
      origin = c + random.uniform(100, 900) * random_unit(random);
      d = normalized(c - origin);
  }
  Ray ray = {vec_cast<float>(origin), 0, vec_cast<float>(d)};
  if (range > 0) {
    ray.t_max = static_cast<float>(range);
    ray.t_min = ray.t_max * static_cast<float>(random.uniform(-0.1, 0.99));
  }
  return ray;
}

std::vector<Ray> awkward_rays(const Layout& layout, const SceneView& scene, std::size_t count) {
  const std::vector<Disk> targets = targets_of(scene);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(layout.seed, 2, i);
    const Disk& target = targets[random.next_bits() % targets.size()];
    rays.push_back(awkward_ray(i, target, layout, random));
  }
  return rays;
}

/// The first `depth` of every `stride` hits.
std::vector<Hit> first_hits(std::span<const Hit> hits, std::size_t stride, std::size_t depth) {
  std::vector<Hit> first;
  for (std::size_t i = 0; i < hits.size(); i += stride)
    first.insert(first.end(), hits.begin() + static_cast<std::ptrdiff_t>(i),
                 hits.begin() + static_cast<std::ptrdiff_t>(i + depth));
  return first;
}

std::size_t count_different_hits(std::span<const Hit> found, std::span<const Hit> expected) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < found.size(); ++i) different += found[i] == expected[i] ? 0 : 1;
  return different;
}

void expect_equal_hits(std::span<const Hit> found, std::span<const Hit> expected) {
  ASSERT_EQ(found.size(), expected.size());
  int reported = 0;
  for (std::size_t i = 0; i < found.size() && reported < 5; ++i) {
    if (found[i] == expected[i]) continue;
    ++reported;
    ADD_FAILURE() << "hit " << i << ": t " << found[i].t << " of " << found[i].primitive
                  << ", expected t " << expected[i].t << " of " << expected[i].primitive;
  }
  EXPECT_EQ(count_different_hits(found, expected), 0U);
}

std::size_t count_valid(std::span<const Hit> hits) {
  return static_cast<std::size_t>(std::ranges::count_if(hits, &Hit::valid));
}

/// One per disk.
std::vector<float> random_opacities(std::size_t count) {
  std::vector<float> opacities;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(9, 0, i);
    opacities.push_back(static_cast<float>(random.uniform()));
  }
  return opacities;
}

class DeviceScene : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (const std::string reason = why_not(GetParam()); !reason.empty()) GTEST_SKIP() << reason;
  }

  static std::vector<Hit> cast(const SceneView& scene, std::span<const Ray> rays, int depth = 1) {
    return make_caster(scene, GetParam())->cast(rays, depth);
  }
};

/// Scenes compared with brute force.
class ComparedScene : public DeviceScene {
 protected:
  /// Oracle: brute force, bit for bit.
  static void expect_oracle(const SceneView& scene, std::span<const Ray> rays) {
    constexpr int kDeepest = 40;
    const auto expected = make_caster(scene, Backend::brute_force)->cast(rays, kDeepest);
    EXPECT_GT(10 * count_valid(first_hits(expected, kDeepest, 1)), rays.size());
    const auto caster = make_caster(scene, GetParam());
    for (const int depth : {1, 5, kDeepest}) {
      SCOPED_TRACE("depth " + std::to_string(depth));
      expect_equal_hits(caster->cast(rays, depth),
                        first_hits(expected, kDeepest, static_cast<std::size_t>(depth)));
    }
  }
};

constexpr std::array kLayouts = {
    Layout{1, {0, 0, 0}, 5, 0.05, 2},          // as a room
    Layout{2, {300, -200, 80}, 40, 0.02, 30},  // off the origin
    Layout{3, {0, 0, 0}, 200, 0.01, 100},      // sizes of four orders
    Layout{4, {0, 0, 0}, 0.05, 1e-3, 0.02},    // tiny
};

TEST_P(ComparedScene, DisksMatchBruteForce) {
  for (const Layout& layout : kLayouts) {
    SCOPED_TRACE("layout " + std::to_string(layout.seed));
    const auto disks = random_disks(layout, 400);
    const SceneView scene = {disks, nullptr};
    expect_oracle(scene, awkward_rays(layout, scene, 20'000));
  }
}

TEST_P(ComparedScene, TrianglesMatchBruteForce) {
  for (const Layout& layout : kLayouts) {
    SCOPED_TRACE("layout " + std::to_string(layout.seed));
    const auto mesh = random_mesh(layout, 400);
    const SceneView scene = {{}, &mesh};
    expect_oracle(scene, awkward_rays(layout, scene, 20'000));
  }
}

TEST_P(ComparedScene, DisksAndTrianglesMatchBruteForce) {
  for (const Layout& layout : kLayouts) {
    SCOPED_TRACE("layout " + std::to_string(layout.seed));
    const auto disks = random_disks(layout, 201);
    const auto mesh = random_mesh(layout, 200);
    const SceneView scene = {disks, &mesh};
    expect_oracle(scene, awkward_rays(layout, scene, 20'000));
  }
}

TEST_P(ComparedScene, AHundredThousandDisksMatchBruteForce) {
  const Layout layout = {5, {10, 20, 30}, 50, 0.1, 1};
  const auto disks = random_disks(layout, 100'000);
  const SceneView scene = {disks, nullptr};
  expect_oracle(scene, awkward_rays(layout, scene, 4'000));
}

// Oracle: Embree, which equals brute force bit for bit up to 1024 m. The margin of the boxes covers
// the rounding of any box test in single precision, also that of OptiX.
TEST_P(ComparedScene, AMillionRaysMatchEmbree) {
  const Layout layout = {6, {0, 0, 0}, 60, 0.05, 1};
  const auto disks = random_disks(layout, 300'000);
  const SceneView scene = {disks, nullptr};
  const auto rays = awkward_rays(layout, scene, 1'000'000);
  const auto expected = make_caster(scene, Backend::embree)->cast(rays, 1);
  const auto found = cast(scene, rays);
  const std::size_t different = count_different_hits(found, expected);
  RecordProperty("rays", static_cast<int>(rays.size()));
  RecordProperty("rays_that_differ", static_cast<int>(different));
  std::cout << name_of(GetParam()) << ": " << different << " of " << rays.size()
            << " rays differ from Embree\n";
  EXPECT_EQ(different, 0U);
  EXPECT_GT(3 * count_valid(expected), rays.size());
}

// Oracle: the tracer of the CPU (soft_hits_test.cpp), bit for bit.
TEST_P(ComparedScene, SoftDisksMatchTheCpu) {
  for (const Layout& layout : kLayouts) {
    SCOPED_TRACE("layout " + std::to_string(layout.seed));
    const auto disks = random_disks(layout, 400);
    const auto mesh = random_mesh(layout, 20);
    const auto opacities = random_opacities(disks.size());
    const SceneView scene = {disks, &mesh, opacities};
    const auto rays = awkward_rays(layout, scene, 20'000);
    const Executor executor;
    std::vector<Hit> expected(rays.size());
    make_cpu_tracer(scene, executor)->nearest(rays, expected, executor);
    EXPECT_GT(10 * count_valid(expected), rays.size());
    if (on_gpu(GetParam())) expect_equal_hits(cast(scene, rays), expected);
  }
}

// Oracle of the tests below: analytic.

TEST_P(DeviceScene, NothingIsHitInAnEmptyScene) {
  const TriangleMesh no_triangles;
  const std::vector<Ray> rays(100, Ray{{0, 0, 0}, 0, {1, 0, 0}});
  EXPECT_EQ(cast({}, rays), std::vector<Hit>(100));
  EXPECT_EQ(cast({{}, &no_triangles}, rays), std::vector<Hit>(100));
  EXPECT_EQ(cast({}, rays, 3), std::vector<Hit>(300));
}

TEST_P(DeviceScene, NoRaysGiveNoHits) {
  const std::vector<Disk> disks = {{{5, 0, 0}, 1, {1, 0, 0}}};
  EXPECT_TRUE(cast({disks, nullptr}, {}).empty());
  EXPECT_TRUE(cast({disks, nullptr}, {}, 4).empty());
}

TEST_P(DeviceScene, OnePrimitiveIsHit) {
  const std::vector<Disk> disks = {{{5, 0, 0}, 1, {1, 0, 0}}};
  TriangleMesh mesh;
  mesh.vertices = {{5, -2, -2}, {5, 2, -2}, {5, 0, 2}};
  mesh.triangles = {{0, 1, 2}};
  const std::vector<Ray> rays = {{{0, 0, 0}, 0, {1, 0, 0}}, {{0, 0, 0}, 0, {-1, 0, 0}}};
  for (const SceneView& scene : {SceneView{disks, nullptr}, SceneView{{}, &mesh}}) {
    EXPECT_EQ(cast(scene, rays), (std::vector<Hit>{{5, 0}, {}}));
    EXPECT_EQ(cast(scene, rays, 2), (std::vector<Hit>{{5, 0}, {}, {}, {}}));
  }
}

TEST_P(DeviceScene, EqualDistancesGoToTheSmallerIndex) {
  const std::vector<Disk> disks(70, Disk{{5, 0, 0}, 1, {1, 0, 0}});
  TriangleMesh mesh;
  mesh.vertices = {{5, -2, -2}, {5, 2, -2}, {5, 0, 2}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}};
  const std::vector<Ray> rays(40, Ray{{0, 0, 0}, 0, {1, 0, 0}});
  for (const int depth : {1, 2, 5, 40, 64}) {
    SCOPED_TRACE("depth " + std::to_string(depth));
    const auto hits = cast({disks, &mesh}, rays, depth);
    for (std::uint32_t i = 0; i < hits.size(); ++i)
      ASSERT_EQ(hits[i], (Hit{5.0F, i % static_cast<std::uint32_t>(depth)}));
  }
}

TEST_P(DeviceScene, RangesAreOpenBelowAndClosedAbove) {
  const std::vector<Disk> disks = {{{5, 0, 0}, 1, {1, 0, 0}}, {{6, 0, 0}, 1, {1, 0, 0}}};
  const std::vector<Ray> rays = {
      {{0, 0, 0}, 5, {1, 0, 0}},           {{0, 0, 0}, 0, {1, 0, 0}, 5},
      {{0, 0, 0}, 5, {1, 0, 0}, 5.5F},     {{0, 0, 0}, -kInfinity, {1, 0, 0}, 7},
      {{7, 0, 0}, -3, {1, 0, 0}},          {{0, 0, 0}, -5, {1, 0, 0}, -1},
      {{5, 0, 0}, 0, {1, 0, 0}},           {{0, 0, 0}, kInfinity, {1, 0, 0}, kInfinity},
      {{0, 0, 0}, 0, {0.5F, 0, 0}, 10.5F}, {{0, 0, 0}, 5, {1, 0, 0}, 4}};
  EXPECT_EQ(cast({disks, nullptr}, rays),
            (std::vector<Hit>{{6, 1}, {5, 0}, {}, {5, 0}, {}, {}, {1, 1}, {}, {10, 0}, {}}));
}

TEST_P(DeviceScene, NonFiniteRaysHitNothing) {
  const std::vector<Disk> disks = {{{5, 0, 0}, 1, {1, 0, 0}}};
  const Ray good = {{0, 0, 0}, 0, {1, 0, 0}};
  std::vector<Ray> rays;
  for (const float bad : {static_cast<float>(kNaN), kInfinity, -kInfinity, 2e18F}) {
    for (int axis = 0; axis < 3; ++axis) {
      rays.push_back(good);
      rays.back().origin[axis] = bad;
      rays.push_back(good);
      rays.back().direction[axis] = bad;
    }
  }
  rays.push_back(good);
  rays.back().t_min = kNaN;
  rays.push_back(good);
  rays.back().t_max = kNaN;
  rays.push_back({{0, 0, 0}, 0, {0, 0, 0}});
  EXPECT_EQ(count_valid(cast({disks, nullptr}, rays)), 0U);
  EXPECT_EQ(count_valid(cast({disks, nullptr}, rays, 2)), 0U);
  rays.push_back(good);  // a bad ray does not affect its neighbours
  EXPECT_EQ(cast({disks, nullptr}, rays).back(), (Hit{5.0F, 0}));
}

TEST_P(DeviceScene, NonFinitePrimitivesAreNeverHit) {
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
  EXPECT_EQ(cast({disks, &mesh}, rays), std::vector<Hit>(9, Hit{5.0F, 0}));
}

#if defined(ADASPLATS_HAVE_CUDA)

class GpuDeviceScene : public DeviceScene {
 protected:
  GpuCaster caster(std::size_t disk_count, bool soft = false) {
    disks_ = random_disks(kLayouts[0], disk_count);
    const auto opacities = random_opacities(soft ? disk_count : 0);
    return {{disks_, nullptr, opacities}, GetParam()};
  }
  std::vector<Ray> rays(std::size_t count) const {
    return awkward_rays(kLayouts[0], {disks_, nullptr}, count);
  }

 private:
  std::vector<Disk> disks_;
};

// Oracle: the same rays, made by ray_of() on the CPU and passed to the scene.
void expect_source(const GpuCaster& caster, const gpu::RaySource& on_gpu,
                   const gpu::RaySource& on_cpu, std::size_t count) {
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i)
    rays[gpu::place_of_ray(on_cpu, i)] = gpu::ray_of(on_cpu, i);
  for (const int depth : {1, 3}) {
    const auto expected = caster.cast(rays, depth);
    EXPECT_GT(10 * count_valid(expected), rays.size());
    expect_equal_hits(caster.cast(on_gpu, count, depth), expected);
  }
}

template <class T>
gpu::DeviceBuffer<T> on_device(const std::vector<T>& values, cudaStream_t stream) {
  return {std::span<const T>(values), stream};
}

/// Casts scans of sensors at rest and in motion, in two orders.
void expect_scans(const GpuCaster& scene) {
  constexpr std::uint32_t kFirings = 999;
  std::vector<FiringRay> firings;
  std::vector<std::uint32_t> order;
  std::vector<ScanPose> poses;
  const std::vector<std::uint32_t> first_poses = {0, 1, 3, 7};  // 1, 2 and 4 knots
  for (std::uint32_t i = 0; i < kFirings; ++i) {
    Random random(7, 0, i);
    firings.push_back({vec_cast<float>(random_unit(random)),
                       static_cast<float>(i) / kFirings,
                       {0, 0.01F * static_cast<float>(i % 7), 0.2F},
                       0});
    order.push_back(i * 500 % kFirings);
  }
  for (const double i : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0})
    poses.push_back(
        scan_pose({rotation_from_yaw_pitch_roll(i, 0.1, 0.2), {0.1 * i, 0, -0.2 * i}}, {}));
  const auto firings_there = on_device(firings, scene.stream());
  const auto first_poses_there = on_device(first_poses, scene.stream());
  const auto order_there = on_device(order, scene.stream());
  const auto poses_there = on_device(poses, scene.stream());
  for (const bool ordered : {false, true}) {
    for (const std::size_t scans : {std::size_t{1}, std::size_t{3}, poses.size()}) {
      gpu::RaySource on_cpu;
      on_cpu.kind = gpu::RaySource::Kind::scans;
      on_cpu.firing_count = kFirings;
      on_cpu.t_min = 0.5F;
      on_cpu.t_max = 6;
      on_cpu.pose = poses[2];
      gpu::RaySource on_gpu = on_cpu;
      on_cpu.firings = firings.data();
      on_gpu.firings = firings_there.data();
      on_cpu.order = ordered ? order.data() : nullptr;
      on_gpu.order = ordered ? order_there.data() : nullptr;
      on_cpu.poses = scans == 1 ? nullptr : poses.data();
      on_gpu.poses = scans == 1 ? nullptr : poses_there.data();
      on_cpu.first_poses = scans == 3 ? first_poses.data() : nullptr;
      on_gpu.first_poses = scans == 3 ? first_poses_there.data() : nullptr;
      expect_source(scene, on_gpu, on_cpu, kFirings * scans);
    }
  }
}

TEST_P(GpuDeviceScene, ScansAreMadeOnTheGpu) {
  for (const bool soft : {false, true}) expect_scans(caster(500, soft));
}

TEST_P(GpuDeviceScene, PicturesAreMadeOnTheGpu) {
  const GpuCaster scene = caster(500);
  Camera camera = look_at({9, 2, 3}, {0, 0, 0});
  camera.width = 80;
  camera.height = 60;
  gpu::RaySource source;
  source.kind = gpu::RaySource::Kind::image;
  source.camera = camera.rays({});
  source.columns = 160;
  source.rows = 120;
  source.samples_per_axis = 2;
  expect_source(scene, source, source, 160 * 120);
}

// The last case has more hits than a backend may buffer, in a different order.
TEST_P(GpuDeviceScene, HitsCanBeWrittenToPageLockedMemory) {
  const GpuCaster scene = caster(500);
  const auto some = rays(300'000);
  std::vector<FiringRay> firings;
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    firings.push_back({some[8 * i].direction, 0, {}, 0});
    order.push_back(999 - i);
  }
  const auto rays_there = on_device(some, scene.stream());
  const auto firings_there = on_device(firings, scene.stream());
  const auto order_there = on_device(order, scene.stream());
  const std::vector<ScanPose> poses(300, scan_pose(RigidTransform{}, {}));
  const auto poses_there = on_device(poses, scene.stream());
  gpu::RaySource scans;
  scans.kind = gpu::RaySource::Kind::scans;
  scans.firing_count = 1000;
  scans.t_max = 100;
  scans.firings = firings_there.data();
  scans.order = order_there.data();
  scans.poses = poses_there.data();
  for (const auto& source : {given(rays_there), scans}) {
    for (const int depth : {1, 6, 64}) {
      const gpu::PinnedBuffer<Hit> hits(some.size() * static_cast<std::size_t>(depth));
      scene.scene().cast(source, some.size(), depth, hits.data(), scene.stream());
      gpu::cuda_check(cudaStreamSynchronize(scene.stream()), "wait");
      EXPECT_GT(10 * count_valid(hits.span()), some.size());
      expect_equal_hits(hits.span(), scene.cast(source, some.size(), depth));
    }
  }
}

TEST_P(GpuDeviceScene, CastsMayOverlap) {
  const GpuCaster scene = caster(5'000);
  const auto some = rays(50'000);
  const auto expected = scene.cast(some, 2);
  const std::size_t half = some.size() / 2;
  const std::array<gpu::Stream, 3> streams;
  std::vector<gpu::DeviceBuffer<Ray>> sources;
  std::vector<gpu::DeviceBuffer<Hit>> hits;
  for (int round = 0; round < 12; ++round) {  // the halves in turn, each with other parameters
    const cudaStream_t stream = streams[static_cast<std::size_t>(round) % streams.size()].get();
    const std::span part = std::span(some).subspan(round % 2 == 0 ? 0 : half, half);
    sources.emplace_back(part, stream);
    hits.emplace_back(2 * half, stream);
    scene.scene().cast(given(sources.back()), half, 2, hits.back().data(), stream);
  }
  for (int round = 0; round < 12; ++round) {
    const std::span part = std::span(expected).subspan(round % 2 == 0 ? 0 : 2 * half, 2 * half);
    expect_equal_hits(hits[static_cast<std::size_t>(round)].download(), part);
  }
  hits.clear();
  sources.clear();
}

INSTANTIATE_TEST_SUITE_P(Backends, GpuDeviceScene, testing::Values(Backend::cuda, Backend::optix),
                         [](const auto& test) { return name_of(test.param); });

#endif

INSTANTIATE_TEST_SUITE_P(Backends, DeviceScene,
                         testing::Values(Backend::brute_force, Backend::embree, Backend::cuda,
                                         Backend::optix),
                         [](const auto& test) { return name_of(test.param); });

INSTANTIATE_TEST_SUITE_P(Backends, ComparedScene,
                         testing::Values(Backend::embree, Backend::cuda, Backend::optix),
                         [](const auto& test) { return name_of(test.param); });

}  // namespace
}  // namespace adasplats
