// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/resimulate.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <fstream>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/kitti_classes_test.h"

namespace adasplats {
namespace {

/// A sequence folder of one scan with its sensor at `position`, turned by 90 degrees to the
/// left: its +x is +y in the world.
class Resimulate : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("adasplats_resimulate_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_ / "velodyne");
    std::filesystem::create_directories(folder_ / "labels");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  KittiSequence sequence(const std::vector<Vec3f>& points,
                         const std::vector<std::uint32_t>& labels = {}) {
    KittiSequence result;
    result.folder = folder_;
    result.scans = {folder_ / "velodyne" / "000000.bin"};
    std::ofstream scan(result.scans[0], std::ios::binary);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3f p = points[i];
      const std::array<float, 4> record = {p.x, p.y, p.z, 0.1F * static_cast<float>(i + 1)};
      scan.write(reinterpret_cast<const char*>(record.data()), sizeof record);
    }
    if (!labels.empty()) {
      result.labels = {folder_ / "labels" / "000000.label"};
      std::ofstream label(result.labels[0], std::ios::binary);
      label.write(reinterpret_cast<const char*>(labels.data()),
                  static_cast<std::streamsize>(labels.size() * sizeof(std::uint32_t)));
    }
    result.trajectory.resize(1);
    result.trajectory[0].world_from_sensor.rotation = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
    result.trajectory[0].world_from_sensor.translation = position_;
    return result;
  }

  /// A wall 10 m ahead of the sensor: a disk of 1 km in the plane y = 110 of the world.
  ResimulateResult run(const KittiSequence& held_out, const ResimulateOptions& options = {},
                       KeepBeams keep = KeepBeams::no) {
    const std::vector<Disk> disks = {
        {vec_cast<float>(position_ + Vec3d{0, 10, 0} - origin_), 1000.0F, {0, 1, 0}}};
    const SceneView scene{disks, nullptr};
    const auto tracer = make_brute_force_tracer(scene);
    ProgressSink quiet;
    return resimulate({*tracer, {.view = scene}, origin_}, held_out, semantickitti_labels(),
                      options, Executor(2), quiet, keep);
  }

  std::filesystem::path folder_;
  Vec3d position_ = {7000, 100, 2};
  Vec3d origin_ = {7000, 0, 0};
};

// Analytic: a beam that measured 10 m + d along the sensor's axis is predicted -d off.
TEST_F(Resimulate, KnownOffsetsGiveExactShares) {
  const ResimulateResult r = run(sequence({{10, 0, 0},
                                           {10.0625F, 0, 0},  // 6 cm too early
                                           {9.75F, 0, 0},     // 25 cm too late
                                           {11, 0, 0},        // 1 m too early
                                           {8, 0, 0},         // 2 m too late
                                           {-10, 0, 0},       // nothing behind the sensor
                                           {0, 10, 0},        // parallel to the wall
                                           {10, 10, 0}}));    // 45 degrees, exact
  EXPECT_EQ(r.all.rays, 8U);
  EXPECT_DOUBLE_EQ(r.all.no_hit, 2.0 / 8);
  EXPECT_DOUBLE_EQ(r.all.early_50cm, 1.0 / 8);
  EXPECT_DOUBLE_EQ(r.all.late_50cm, 1.0 / 8);
  EXPECT_DOUBLE_EQ(r.all.within.at(0.02), 2.0 / 8);
  EXPECT_DOUBLE_EQ(r.all.within.at(0.10), 3.0 / 8);
  EXPECT_DOUBLE_EQ(r.all.within.at(0.50), 4.0 / 8);
  EXPECT_NEAR(r.all.median_m, 0.5 * (0.0625 + 0.25), 1e-5);
  EXPECT_NEAR(r.all.mae_m, (0.0625 + 0.25 + 1 + 2) / 6, 1e-5);
  EXPECT_TRUE(r.by_class.empty());
}

TEST_F(Resimulate, SingleBeamsAreKeptOnRequest) {
  const KittiSequence held_out = sequence({{10, 0, 0}, {0.5F, 0, 0}, {9.75F, 0, 0}, {-10, 0, 0}});
  EXPECT_TRUE(run(held_out).errors.empty());
  const ResimulateResult kept = run(held_out, {}, KeepBeams::yes);
  ASSERT_EQ(kept.errors.size(), 1U);
  const ScanErrors& scan = kept.errors[0];
  ASSERT_EQ(scan.measured.size(), 3U);  // the second is nearer than 2.5 m
  EXPECT_EQ(scan.measured[1].x, 9.75F);
  ASSERT_EQ(scan.errors_m.size(), 3U);
  EXPECT_NEAR(scan.errors_m[0], 0.0F, 1e-5F);
  EXPECT_NEAR(scan.errors_m[1], 0.25F, 1e-5F);
  EXPECT_TRUE(std::isnan(scan.errors_m[2]));
  EXPECT_EQ(scan.primitives, (std::vector<std::uint32_t>{0, 0, Hit::kNone}));
}

TEST_F(Resimulate, IncidenceIsOnlyCountedForHits) {
  const ResimulateResult r = run(sequence({{10, 0, 0}, {10, 10, 0}, {10, -17, 0}, {-10, 0, 0}}));
  ASSERT_EQ(r.by_incidence.size(), 5U);
  EXPECT_EQ(r.by_incidence[0].first, "0-30 deg");
  EXPECT_EQ(r.by_incidence[0].second.rays, 1U);
  EXPECT_EQ(r.by_incidence[1].second.rays, 2U);  // 45.0 and 59.5 degrees
  EXPECT_EQ(r.by_incidence[2].second.rays, 0U);
}

TEST_F(Resimulate, RangesOutsideAndPointsNotFiniteAreLeftOut) {
  ResimulateOptions options;
  options.min_range_m = 2.5;
  options.max_range_m = 25;
  const ResimulateResult r = run(sequence({{2.4F, 0, 0},
                                           {2.5F, 0, 0},
                                           {10, 0, 0},
                                           {25, 0, 0},
                                           {25.1F, 0, 0},
                                           {kNaN, 0, 0},
                                           {0, 0, 0}}),
                                 options);
  EXPECT_EQ(r.all.rays, 3U);
  ASSERT_EQ(r.by_range.size(), 3U);
  EXPECT_EQ(r.by_range[0].first, "2.5-10 m");
  EXPECT_EQ(r.by_range[2].first, "20-25 m");
  EXPECT_EQ(r.by_range[0].second.rays, 1U);
  EXPECT_EQ(r.by_range[1].second.rays, 1U);
  EXPECT_EQ(r.by_range[2].second.rays, 1U);
}

TEST_F(Resimulate, ClassesAreKeptApartAndDropped) {
  const std::vector<Vec3f> points = {{10, 0, 0}, {10, 1, 0}, {11, 0, 0}, {12, 0, 0}};
  // The high 16 bits are the instance and must not matter.
  const std::vector<std::uint32_t> labels = {kRoad, kRoad, kCar | (7U << 16), kMovingCar};
  ResimulateOptions options;
  ResimulateResult r = run(sequence(points, labels), options);
  EXPECT_EQ(r.all.rays, 3U);
  ASSERT_EQ(r.by_class.size(), 2U);
  EXPECT_EQ(r.by_class[0].first, "car");
  EXPECT_DOUBLE_EQ(r.by_class[0].second.early_50cm, 1.0);
  EXPECT_EQ(r.by_class[1].first, "road");
  EXPECT_DOUBLE_EQ(r.by_class[1].second.within.at(0.02), 1.0);
  options.drop_moving = false;
  EXPECT_EQ(run(sequence(points, labels), options).all.rays, 4U);
  options.drop_moving = options.drop_movable = true;
  r = run(sequence(points, labels), options);
  EXPECT_EQ(r.all.rays, 2U);
}

// Analytic: all points predicted 25 cm farther along x; the clouds are parallel lines of points.
TEST_F(Resimulate, CloudsAreComparedInTheSensorFrame) {
  const ResimulateResult r = run(sequence({{9.75F, 0, 0}}));
  EXPECT_NEAR(r.clouds.c2c_m, 0.25, 1e-5);
  EXPECT_NEAR(r.clouds.completeness_m, 0.25, 1e-5);
  EXPECT_NEAR(r.clouds.chamfer_m2, 2 * 0.0625, 1e-5);
  EXPECT_EQ(r.clouds.simulated_points, 1U);
}

// Analytic: three of ten beams on a wall hit a hole of the model, which has one disk per beam.
TEST_F(Resimulate, HoleOfKnownShare) {
  std::vector<Vec3f> points;
  std::vector<Disk> disks;
  for (int i = 0; i < 10; ++i) {
    const Vec3f point = {10, static_cast<float>(i) - 4.5F, 0};
    points.push_back(point);
    // The sensor's +y is the world's -x.
    const Vec3d world = position_ + Vec3d{-static_cast<double>(point.y), 10, 0};
    if (i < 7) disks.push_back({vec_cast<float>(world - origin_), 0.25F, {0, 1, 0}});
  }
  const SceneView scene{disks, nullptr};
  const auto tracer = make_brute_force_tracer(scene);
  ProgressSink quiet;
  const std::vector<float> intensities = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F};
  const ResimulateResult r =
      resimulate({*tracer, {.intensities = intensities, .view = scene}, origin_}, sequence(points),
                 semantickitti_labels(), {}, Executor(1), quiet);
  EXPECT_DOUBLE_EQ(r.all.no_hit, 0.3);
  ASSERT_TRUE(r.intensities);
  EXPECT_EQ(r.intensities->beams, 7U);
  EXPECT_NEAR(r.intensities->rmse_after_fit, 0, 1e-6);
  EXPECT_DOUBLE_EQ(r.intensities->rank_correlation, 1);
  EXPECT_DOUBLE_EQ(r.all.within.at(0.02), 0.7);
  EXPECT_EQ(r.clouds.simulated_points, 7U);
  EXPECT_NEAR(r.clouds.c2c_m, 0.0, 1e-5);
  EXPECT_NEAR(r.clouds.completeness_m, (1 + 2 + 3) / 10.0, 1e-5);
}

// Analytic: sines of 0.04 and 0.06 are on either side of 0.05; a sensor that nods by 0.1 rad lifts
// beams that are level in its frame.
TEST_F(Resimulate, UpwardIsInTheWorld) {
  const auto at_sine = [](float sine) {
    return Vec3f{10 * std::sqrt(1 - sine * sine), 0, 10 * sine};
  };
  KittiSequence held_out = sequence({at_sine(0.04F), at_sine(0.06F), {-10, 0, 1}});
  const ResimulateResult level = run(held_out);
  EXPECT_EQ(level.upward.rays, 2U);
  EXPECT_DOUBLE_EQ(level.upward.no_hit, 1.0 / 2);  // nothing behind the sensor
  held_out.trajectory[0].world_from_sensor.rotation =
      held_out.trajectory[0].world_from_sensor.rotation * rotation_from_yaw_pitch_roll(0, -0.1, 0);
  const ResimulateResult nodding = run(held_out);
  EXPECT_EQ(nodding.upward.rays, 2U);
  EXPECT_DOUBLE_EQ(nodding.upward.no_hit, 0.0);  // beams to the rear point down
}

// Oracle: beams of each elevation and incidence, counted by hand; what falls into none is in none.
TEST_F(Resimulate, BreakdownsAddUp) {
  const ResimulateResult r =
      run(sequence({{10, 0, 0.1F}, {10, 0, 0.2F}, {10, 0, -0.1F}, {-10, 0, 0.1F}}));
  ASSERT_EQ(r.by_elevation.size(), 3U);
  EXPECT_EQ(r.by_elevation[0].first, "-1 deg");
  EXPECT_EQ(r.by_elevation[0].second.rays, 1U);
  EXPECT_EQ(r.by_elevation[1].first, "0 deg");
  EXPECT_EQ(r.by_elevation[1].second.rays, 2U);
  EXPECT_DOUBLE_EQ(r.by_elevation[1].second.no_hit, 0.5);
  EXPECT_EQ(r.by_elevation[2].first, "1 deg");
  EXPECT_EQ(r.by_elevation[2].second.rays, 1U);
  EXPECT_EQ(r.by_incidence[0].second.rays, 3U) << "the beam without a hit has no incidence";
}

TEST_F(Resimulate, NothingHitGivesNoDistances) {
  const ResimulateResult r = run(sequence({{-10, 0, 0}}));
  EXPECT_DOUBLE_EQ(r.all.no_hit, 1.0);
  EXPECT_TRUE(std::isnan(r.clouds.c2c_m));
  EXPECT_EQ(r.clouds.simulated_points, 0U);
}

TEST_F(Resimulate, Errors) {
  EXPECT_THROW(run(sequence({{1, 0, 0}})), Error);             // no beam in range
  EXPECT_THROW(run(sequence({{10, 0, 0}}, {12345U})), Error);  // unknown class
  ResimulateOptions options;
  options.min_range_m = 60;
  EXPECT_THROW(run(sequence({{10, 0, 0}}), options), Error);
  options.min_range_m = std::nan("");
  EXPECT_THROW(run(sequence({{10, 0, 0}}), options), Error);
}

}  // namespace
}  // namespace adasplats
