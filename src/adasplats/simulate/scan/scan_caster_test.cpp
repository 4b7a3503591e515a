// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan_caster.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {
namespace {

constexpr Vec3d kUtmOrigin = {650'000, 6'860'000, 35};

/// Disks of all sizes and directions around the origin.
std::vector<Disk> scattered_disks(std::size_t count) {
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(7, i, 0);
    const auto draw = [&random](double scale) {
      return static_cast<float>(random.normal() * scale);
    };
    const Vec3f center = {draw(15), draw(15), draw(2)};
    const Vec3f normal = normalized(Vec3f{draw(1), draw(1), draw(1)});
    disks.push_back({center, 0.1F + std::fabs(draw(0.5)), normal});
  }
  return disks;
}

/// Sensor, poses and scene of these tests.
class ScanCasterTest : public testing::Test {
 protected:
  ScanCasterTest() : tracer_(make_embree_tracer({disks_, nullptr}, executor_)) {
    sensor_.columns = 90;
    firings_ = firings_of(sensor_);
    for (int i = 0; i < 5; ++i) {
      TimedPose pose;
      pose.time_s = 0.1 * i;
      pose.world_from_sensor = {rotation_from_yaw_pitch_roll(0.4 * i, 0.05, -0.02),
                                kUtmOrigin + Vec3d{1.5 * i - 3, 0.25 * i, 1}};
      poses_.push_back({pose, {}});
    }
  }

  std::unique_ptr<ScanCaster> caster() const {
    return make_cpu_scan_caster(*tracer_, kUtmOrigin, executor_);
  }
  /// All hits that the sink was given, pose by pose.
  std::vector<std::vector<Hit>> cast(std::span<const ScanMotion> motions, int depth = 1) const {
    std::vector<std::vector<Hit>> scans;
    caster()->cast(sensor_, firings_, motions, depth,
                   [&](std::size_t pose, std::span<const Hit> hits) {
                     EXPECT_EQ(pose, scans.size()) << "not in the order of the poses";
                     scans.emplace_back(hits.begin(), hits.end());
                   });
    return scans;
  }

  Executor executor_{2};
  std::vector<Disk> disks_ = scattered_disks(3000);
  std::unique_ptr<Tracer> tracer_;
  LidarModel sensor_ = hdl_32_paper();
  std::vector<Firing> firings_;
  std::vector<ScanMotion> poses_;
};

// Oracle: brute force over the rays of scan_rays().
TEST_F(ScanCasterTest, HitsMatchBruteForce) {
  const auto brute_force = make_brute_force_tracer({disks_, nullptr});
  const std::vector<std::vector<Hit>> scans = cast(poses_);
  ASSERT_EQ(scans.size(), poses_.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const std::vector<Ray> rays = scan_rays(sensor_, firings_, poses_[i], kUtmOrigin, executor_);
    std::vector<Hit> expected(rays.size());
    brute_force->nearest(rays, expected, executor_);
    EXPECT_EQ(scans[i], expected) << "pose " << i;
  }
  EXPECT_NE(scans[0], scans[1]) << "the poses see different things";
}

// Oracle: simulate_scan, bit by bit, with noise.
TEST_F(ScanCasterTest, ScansMatchSimulateScan) {
  sensor_.range_noise_m = 0.02;
  std::vector<std::uint16_t> classes(disks_.size());
  for (std::size_t i = 0; i < classes.size(); ++i) classes[i] = static_cast<std::uint16_t>(i);
  PrimitiveAttributes attributes;
  attributes.classes = classes;
  SimulateOptions options;
  options.seed = 42;
  std::size_t points = 0;
  caster()->cast(sensor_, firings_, poses_, 1, [&](std::size_t i, std::span<const Hit> hits) {
    const Scan scan =
        scan_of_hits(hits, attributes, sensor_, firings_, poses_[i], i, options, executor_);
    const Scan expected = simulate_scan(*tracer_, attributes, kUtmOrigin, sensor_, firings_,
                                        poses_[i], i, options, executor_);
    EXPECT_EQ(scan.time_s, expected.time_s);
    EXPECT_EQ(scan.rays, expected.rays);
    EXPECT_EQ(scan.ranges_m, expected.ranges_m);
    EXPECT_EQ(scan.positions, expected.positions);
    EXPECT_EQ(scan.classes, expected.classes);
    EXPECT_EQ(scan.rings, expected.rings);
    EXPECT_EQ(scan.times_s, expected.times_s);
    points += scan.size();
  });
  EXPECT_GT(points, 1000U);
}

TEST_F(ScanCasterTest, NoPosesAndNoFirings) {
  EXPECT_TRUE(cast({}).empty());
  firings_.clear();
  const std::vector<std::vector<Hit>> scans = cast(poses_);
  ASSERT_EQ(scans.size(), poses_.size()) << "a scan without rays is a scan";
  for (const auto& hits : scans) EXPECT_TRUE(hits.empty());
}

TEST_F(ScanCasterTest, ANonFinitePoseHitsNothing) {
  poses_[1].reference.world_from_sensor.translation.x = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::vector<Hit>> scans = cast(poses_);
  ASSERT_EQ(scans.size(), poses_.size());
  EXPECT_EQ(scans[1], std::vector<Hit>(firings_.size()));
  EXPECT_NE(scans[2], std::vector<Hit>(firings_.size())) << "hits of one scan are not the next's";
}

TEST_F(ScanCasterTest, AnExceptionOfTheSinkEndsTheCasting) {
  std::size_t calls = 0;
  const auto refuse_second = [&](std::size_t pose, std::span<const Hit>) {
    ++calls;
    if (pose == 1) throw std::runtime_error("disk full");
  };
  EXPECT_THROW(caster()->cast(sensor_, firings_, poses_, 1, refuse_second), std::runtime_error);
  EXPECT_EQ(calls, 2U);
  EXPECT_EQ(cast(poses_).size(), poses_.size()) << "casts again afterwards";
}

TEST_F(ScanCasterTest, TimesAreNotNegativeAndExcludeTheSink) {
  constexpr std::chrono::milliseconds kSleep{10};
  const auto slow = [&](std::size_t, std::span<const Hit>) { std::this_thread::sleep_for(kSleep); };
  const CastTimes none = caster()->cast(sensor_, firings_, {}, 1, slow);
  EXPECT_EQ(none.traced_s, 0.0);
  EXPECT_EQ(none.returned_s, 0.0);

  const auto start = std::chrono::steady_clock::now();
  const CastTimes some = caster()->cast(sensor_, firings_, poses_, 1, slow);
  const std::chrono::duration<double> all = std::chrono::steady_clock::now() - start;
  const std::chrono::duration<double> slept = kSleep * poses_.size();
  EXPECT_GT(some.traced_s, 0.0);
  EXPECT_GE(some.returned_s, some.traced_s);
  EXPECT_LE(some.returned_s, (all - slept).count());
}

TEST_F(ScanCasterTest, AWrongNumberOfHitsIsALogicError) {
  const std::vector<Hit> hits(firings_.size() - 1);
  EXPECT_THROW(scan_of_hits(hits, {}, sensor_, firings_, poses_[0], 0, {}, executor_),
               std::logic_error);
}

}  // namespace
}  // namespace adasplats
