// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/gpu/simulate/gpu_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {
namespace {

constexpr Vec3d kOrigin = {1000, 2000, 30};

Vec3f random_direction(Random& random) {
  const Vec3d v = {random.normal(), random.normal(), random.normal()};
  return vec_cast<float>(normalized(v));
}

std::vector<Disk> room_of_disks(std::uint64_t count) {
  std::vector<Disk> disks;
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(11, 0, i);
    const Vec3f outward = random_direction(random);
    const auto distance = static_cast<float>(random.uniform(3, 20));
    disks.push_back({distance * outward, static_cast<float>(random.uniform(0.05, 0.4)),
                     random_direction(random)});
  }
  return disks;
}

LidarModel small_lidar() {
  LidarModel sensor;
  sensor.elevations_rad = {0.3, 0.2, 0.1, 0, -0.1, -0.2, -0.3};
  sensor.columns = 181;  // no multiple of a tile
  for (int i = 0; i < 7; ++i) {
    sensor.beam_origins_m.push_back({0.05, 0.01 * i, 0.1});
    sensor.firing_times_s.push_back(2e-6 * i);
  }
  sensor.min_range_m = 0.5;
  sensor.max_range_m = 18;
  return sensor;
}

/// Scans alternately at rest, in uniform motion and in motion of three parts.
std::vector<ScanMotion> motions(std::size_t count) {
  const auto pose = [](double t) {
    return RigidTransform{rotation_from_yaw_pitch_roll(t, 0.1, -0.05),
                          kOrigin + Vec3d{t, -0.5 * t, 0.1}};
  };
  std::vector<ScanMotion> result;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = 0.1 * static_cast<double>(i);
    result.push_back({{t, pose(t)}, {}});
    for (std::size_t k = 0; k < 2 * (i % 3); ++k)
      result.back().knots.push_back(pose(t + 0.005 * static_cast<double>(k)));
  }
  return result;
}

/// Both backends; skips without a GPU, or without OptiX if it is requested.
class OnGpu : public testing::TestWithParam<TracingBackend> {
 protected:
  void SetUp() override {
    const GpuSearch search = find_gpus();
    if (search.devices.empty()) GTEST_SKIP() << search.reason;
    disks_ = room_of_disks(20'000);
    scene_ = make_gpu_scene(view(), kOrigin, GetParam(), {0});
    tracer_ = make_brute_force_tracer(view());
  }

  SceneView view() const { return {disks_, nullptr}; }
  std::vector<Hit> expected(const ScanMotion& motion, int depth = 1) const {
    const auto rays = scan_rays(sensor_, firings_, motion, kOrigin, executor_);
    std::vector<Hit> hits(rays.size() * static_cast<std::size_t>(depth));
    tracer_->nearest_hits(rays, depth, hits, executor_);
    return hits;
  }

  Executor executor_;
  std::vector<Disk> disks_;
  LidarModel sensor_ = small_lidar();
  std::vector<Firing> firings_ = firings_of(sensor_);
  std::unique_ptr<GpuScene> scene_;
  std::unique_ptr<Tracer> tracer_;
};

// Oracle of all tests: brute force on the CPU, bit by bit.

TEST_P(OnGpu, OneScan) {
  const auto scanner = scene_->scanner(sensor_, firings_);
  for (const ScanMotion& motion : motions(5)) {
    const auto hits = scanner->scan(motion);
    EXPECT_EQ(std::vector<Hit>(hits.begin(), hits.end()), expected(motion));
  }
}

TEST_P(OnGpu, ScansArriveInTheOrderOfTheirPoses) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
    const auto scans = motions(count);
    const int depth = count == 2 ? 4 : 1;
    std::size_t next = 0;
    const CastTimes times = scene_->scan_caster().cast(
        sensor_, firings_, scans, depth, [&](std::size_t i, std::span<const Hit> hits) {
          EXPECT_EQ(i, next++);
          EXPECT_EQ(std::vector<Hit>(hits.begin(), hits.end()), expected(scans[i], depth)) << i;
        });
    EXPECT_EQ(next, count);
    EXPECT_GE(times.traced_s, 0);
    EXPECT_GE(times.returned_s, 0);
  }
}

// The caster caches the rays of a sensor. Another sensor, other ranges, and a sink that casts must
// not get them.
TEST_P(OnGpu, EverySensorHasItsOwnRays) {
  const auto scans = motions(1);
  const auto cast = [&](auto&& also) {
    scene_->scan_caster().cast(sensor_, firings_, scans, 1,
                               [&](std::size_t, std::span<const Hit> hits) {
                                 const std::vector<Hit> taken(hits.begin(), hits.end());
                                 also();
                                 EXPECT_EQ(taken, expected(scans[0]));
                               });
  };
  const auto nothing = [] {};
  cast(nothing);
  cast(nothing);
  sensor_.max_range_m *= 0.5;
  cast(nothing);
  firings_.pop_back();
  cast(nothing);
  firings_.front().direction = firings_.back().direction;
  cast(nothing);
  cast([&] { cast(nothing); });
  cast(nothing);
}

TEST_P(OnGpu, PointsAreRangesAlongTheFirings) {
  const auto scanner = scene_->scanner(sensor_, firings_);
  const auto trajectory = motions(3);
  scanner->cast_points(trajectory, [&](std::size_t i, std::span<const PointHit> points) {
    const std::vector<Hit> hits = expected(trajectory[i]);
    for (std::size_t k = 0; k < hits.size(); ++k) {
      ASSERT_EQ(points[k].primitive, hits[k].primitive);
      const Vec3f point =
          hits[k].valid() ? firings_[k].origin + hits[k].t * firings_[k].direction : Vec3f{};
      ASSERT_EQ(points[k].position, point);
    }
  });
}

TEST_P(OnGpu, HitsCanStayOnTheDevice) {
  const auto scanner = scene_->scanner(sensor_, firings_);
  const auto trajectory = motions(4);
  const DeviceHits kept = scanner->cast_on_device(trajectory, 3);
  EXPECT_EQ(kept.scans, 4U);
  EXPECT_EQ(kept.rays_per_scan, firings_.size());
  const std::vector<Hit> hits = download(kept, 3);
  for (std::size_t scan = 0; scan < 4; ++scan) {
    const std::vector<Hit> three = expected(trajectory[scan], 3);
    const auto begin = hits.begin() + static_cast<std::ptrdiff_t>(scan * three.size());
    EXPECT_EQ(std::vector<Hit>(begin, begin + static_cast<std::ptrdiff_t>(three.size())), three);
  }
}

TEST_P(OnGpu, AnExceptionOfTheSinkOnlyEndsTheCast) {
  const auto scanner = scene_->scanner(sensor_, firings_);
  const auto trajectory = motions(9);
  const auto stop = [](std::size_t i, std::span<const Hit>) {
    if (i == 1) throw std::runtime_error("enough");
  };
  EXPECT_THROW(scanner->cast(trajectory, 1, stop), std::runtime_error);
  std::size_t scans = 0;
  scanner->cast(trajectory, 1, [&](std::size_t i, std::span<const Hit> hits) {
    EXPECT_EQ(std::vector<Hit>(hits.begin(), hits.end()), expected(trajectory[i]));
    ++scans;
  });
  EXPECT_EQ(scans, trajectory.size());
}

TEST_P(OnGpu, RaysOfTheCaller) {
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < 3001; ++i) {
    Random random(3, 1, i);
    rays.push_back({0.1F * random_direction(random), 0.2F, random_direction(random), 30});
  }
  std::vector<Hit> hits(rays.size()), wanted(rays.size());
  scene_->tracer().nearest(rays, hits, executor_);
  tracer_->nearest(rays, wanted, executor_);
  EXPECT_EQ(hits, wanted);
  std::vector<Hit> five(rays.size() * 5), wanted_five(rays.size() * 5);
  scene_->tracer().nearest_hits(rays, 5, five, executor_);
  tracer_->nearest_hits(rays, 5, wanted_five, executor_);
  EXPECT_EQ(five, wanted_five);
  EXPECT_THROW(scene_->tracer().nearest(rays, std::span(hits).first(1), executor_),
               std::logic_error);
}

// Oracle: render_image on the CPU.
TEST_P(OnGpu, PicturesMatchTheCpu) {
  std::vector<std::uint16_t> classes;
  std::vector<SemanticGroup> groups;
  std::vector<float> intensities;
  std::vector<ColorBytes> colors;
  for (std::size_t i = 0; i < disks_.size(); ++i) {
    colors.push_back({static_cast<std::uint8_t>(i % 251), static_cast<std::uint8_t>(i % 13), 77});
    classes.push_back(i % 3 == 0 ? 40 : 50);
    groups.push_back(static_cast<SemanticGroup>(i % 4));
    intensities.push_back(i % 7 == 0 ? NAN : 0.001F * static_cast<float>(i % 1000));
  }
  const LabelScheme labels = semantickitti_labels();
  ImageScene scene;
  scene.view = view();
  scene.attributes.classes = classes;
  scene.attributes.intensities = intensities;
  scene.groups = groups;
  scene.colors = colors;
  scene.labels = &labels;
  scene.origin = kOrigin;
  Camera camera = look_at(kOrigin, kOrigin + Vec3d{3, 1, 0.3});
  camera.width = 93;  // no multiples of a tile
  camera.height = 61;
  for (const ImageColor color : {ImageColor::shading, ImageColor::semantic, ImageColor::normal,
                                 ImageColor::intensity, ImageColor::range, ImageColor::rgb}) {
    for (const int samples : {1, 2, 3}) {
      ImageOptions options;
      options.color = color;
      options.samples_per_axis = samples;
      const Image image = scene_->renderer(scene, options)->render(camera);
      const Image wanted = render_image(*tracer_, scene, camera, options, executor_);
      EXPECT_EQ(image.pixels, wanted.pixels) << static_cast<int>(color) << " " << samples;
    }
  }
}

// Oracle: render_image on the CPU.
TEST_P(OnGpu, PicturesThroughALensMatchTheCpu) {
  ImageScene scene;
  scene.view = view();
  scene.origin = kOrigin;
  Lens plain;
  plain.width = 93;
  plain.height = 61;
  plain.fx = 50;
  plain.fy = 51;
  plain.cx = 45.2;
  plain.cy = 31.7;
  Lens strong = plain;  // its corners are empty
  strong.k[0] = -0.4;
  strong.p1 = 0.01;
  strong.p2 = -0.02;
  Lens rational = plain;
  rational.k[0] = 0.3;
  rational.k[3] = 0.5;
  Lens fisheye = plain;
  fisheye.is_fisheye = true;
  fisheye.fx = fisheye.fy = 20;
  fisheye.k[0] = -0.01;
  for (const Lens& lens : {plain, strong, rational, fisheye}) {
    Camera camera = look_at(kOrigin, kOrigin + Vec3d{3, 1, 0.3});
    camera.lens = complete_lens(lens, "the test's");
    camera.width = lens.width;
    camera.height = lens.height;
    for (const int samples : {1, 3}) {
      ImageOptions options;
      options.color = ImageColor::normal;
      options.samples_per_axis = samples;
      const Image image = scene_->renderer(scene, options)->render(camera);
      const Image wanted = render_image(*tracer_, scene, camera, options, executor_);
      EXPECT_EQ(image.pixels, wanted.pixels) << lens.k[0] << " " << samples;
    }
  }
}

TEST_P(OnGpu, PicturesOfSeveralCamerasArriveInOrder) {
  ImageScene scene;
  scene.view = view();
  scene.origin = kOrigin;
  ImageOptions options;
  options.color = ImageColor::normal;
  std::vector<Camera> cameras;
  for (const double x : {3.0, 0.1, -3.0, -0.2, 1.0}) {
    cameras.push_back(look_at(kOrigin, kOrigin + Vec3d{x, 1, 0}));
    cameras.back().width = 40;
    cameras.back().height = 24;
  }
  const auto renderer = scene_->renderer(scene, options);
  std::size_t next = 0;
  renderer->render_all(cameras, [&](std::size_t i, std::span<const std::uint8_t> pixels) {
    EXPECT_EQ(i, next++);
    const Image alone = scene_->renderer(scene, options)->render(cameras[i]);
    EXPECT_TRUE(std::ranges::equal(pixels, alone.pixels)) << i;
  });
  EXPECT_EQ(next, cameras.size());
  cameras.back().width = 41;
  EXPECT_THROW(renderer->render_all(cameras, [](std::size_t, std::span<const std::uint8_t>) {}),
               Error);
}

INSTANTIATE_TEST_SUITE_P(Backends, OnGpu,
                         testing::Values(TracingBackend::cuda, TracingBackend::optix),
                         [](const auto& backend) {
                           return backend.param == TracingBackend::cuda ? "cuda" : "optix";
                         });

TEST(GpuScene, ReportsUnsupportedRequests) {
  const std::vector<Disk> disks = {{{0, 0, 0}, 1, {0, 0, 1}}};
  const auto attempt = [&](const std::vector<int>& devices) {
    make_gpu_scene({disks, nullptr}, {}, TracingBackend::cuda, devices);
  };
  EXPECT_THROW(attempt({1000}), Error);  // here or anywhere
  if (find_gpus().devices.empty()) {
    EXPECT_THROW(attempt({0}), Error);
    GTEST_SKIP() << find_gpus().reason;
  }
  EXPECT_THROW(attempt({}), Error);
}

TEST(GpuSearch, ReportsWhyThereIsNone) {
  const GpuSearch search = find_gpus();
  EXPECT_EQ(search.devices.empty(), !search.reason.empty());
}

}  // namespace
}  // namespace adasplats
