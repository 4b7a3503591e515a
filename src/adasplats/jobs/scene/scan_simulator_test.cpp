// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/scan_simulator.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/recorded_progress_test.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/jobs/scene/model_scene.h"

namespace adasplats {
namespace {

/// A floor of disks at height 0 and a wall at x = 6 m.
SplatModel floor_and_wall() {
  SplatModel model;
  model.origin = {3000, -2000, 10};
  for (int i = -40; i < 40; ++i) {
    for (int k = -40; k < 40; ++k) {
      const float a = 0.25F * static_cast<float>(i);
      const float b = 0.25F * static_cast<float>(k);
      model.disks.push_back({{a, b, 0}, 0.2F, {0, 0, 1}});
      model.classes.push_back(40);
      if (k < 0) continue;
      model.disks.push_back({{6, a, b}, 0.2F, {1, 0, 0}});
      model.classes.push_back(50);
    }
  }
  return model;
}

class ScanSimulatorTest : public testing::Test {
 protected:
  ScanSimulatorTest() {
    settings_.sensor = load_lidar_model("velodyne-vlp-16");
    settings_.seed = 7;
  }

  static std::vector<ScanMotion> drive(std::size_t count) {
    Trajectory poses(count);
    for (std::size_t i = 0; i < count; ++i) {
      poses[i].time_s = 0.1 * static_cast<double>(i);
      poses[i].world_from_sensor.translation = {3000 + 0.5 * static_cast<double>(i), -2000, 11.8};
    }
    return still_scans(poses);
  }

  std::vector<Scan> run(const ScanSettings& settings, std::span<const ScanMotion> scans,
                        std::uint64_t first_number) {
    ScanSimulator simulator(scene_, settings, executor_);
    std::vector<Scan> taken;
    const ReportTimes times = simulator.run(scans, first_number, [&](std::size_t i, Scan scan) {
      EXPECT_EQ(i, taken.size());
      taken.push_back(std::move(scan));
    });
    EXPECT_GT(times.traced_s, 0);
    EXPECT_GT(times.reported_s, 0);
    return taken;
  }

  static void expect_same(const Scan& a, const Scan& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_GT(a.size(), 0U);
    EXPECT_EQ(a.ranges_m, b.ranges_m);
    EXPECT_EQ(a.classes, b.classes);
    EXPECT_EQ(a.columns, b.columns);
  }

  Executor executor_{2};
  ProgressSink progress_;
  DeviceChoice device_;
  Session session_{executor_, progress_, 1, device_};
  ModelScene scene_{floor_and_wall(), std::nullopt, session_};
  ScanSettings settings_;
};

// Oracle: simulate_scan, scan by scan.
TEST_F(ScanSimulatorTest, ScansAreThoseOfTheStageBelow) {
  const std::vector<ScanMotion> motions = drive(3);
  const std::vector<Scan> scans = run(settings_, motions, 0);
  ASSERT_EQ(scans.size(), 3U);
  SimulateOptions options;
  options.seed = settings_.seed;
  const std::vector<Firing> firings = firings_of(settings_.sensor);
  for (std::size_t i = 0; i < scans.size(); ++i)
    expect_same(scans[i],
                simulate_scan(scene_.tracer(), scene_.attributes(), scene_.origin(),
                              settings_.sensor, firings, motions[i], i, options, executor_));
}

// So that a generator may take them one after the other.
TEST_F(ScanSimulatorTest, AScanIsTheSameInARunAndAlone) {
  for (const char* sensor : {"velodyne-vlp-16", "livox-mid-40"}) {
    settings_.sensor = load_lidar_model(sensor);
    const std::vector<ScanMotion> motions = drive(4);
    const std::vector<Scan> all = run(settings_, motions, 0);
    const std::vector<Scan> end = run(settings_, std::span(motions).subspan(2), 2);
    ScanSimulator simulator(scene_, settings_, executor_);
    for (std::size_t i = 0; i < 2; ++i) {
      expect_same(all[i + 2], end[i]);
      expect_same(all[i + 2], simulator.scan(motions[i + 2], i + 2));
    }
  }
}

TEST_F(ScanSimulatorTest, TheNumberNamesTheNoise) {
  ScanSimulator simulator(scene_, settings_, executor_);
  const std::vector<ScanMotion> motions = drive(1);
  EXPECT_NE(simulator.scan(motions[0], 0).ranges_m, simulator.scan(motions[0], 1).ranges_m);
  settings_.noise = false;
  ScanSimulator quiet(scene_, settings_, executor_);
  EXPECT_EQ(quiet.scan(motions[0], 0).ranges_m, quiet.scan(motions[0], 1).ranges_m);
}

TEST_F(ScanSimulatorTest, WeatherAndSubRaysReachTheScans) {
  const std::vector<ScanMotion> motions = drive(1);
  const std::size_t clear = run(settings_, motions, 0)[0].size();
  settings_.weather.fog_visibility_m = 10;
  EXPECT_NE(run(settings_, motions, 0)[0].size(), clear);
  settings_.weather = {};
  settings_.beam.sub_rays = 7;
  settings_.beam.returns = 2;
  EXPECT_FALSE(run(settings_, motions, 0)[0].return_indices.empty());
}

TEST_F(ScanSimulatorTest, WrongSettingsAreRefused) {
  settings_.beam.sub_rays = 2;
  EXPECT_THROW(ScanSimulator(scene_, settings_, executor_), Error);
  settings_.beam = {};
  settings_.weather.rain_mm_h = -1;
  EXPECT_THROW(ScanSimulator(scene_, settings_, executor_), Error);
}

TEST_F(ScanSimulatorTest, NoScansAreNoScans) {
  EXPECT_EQ(ScanSimulator(scene_, settings_, executor_)
                .run({}, 0, [](std::size_t, const Scan&) { FAIL(); })
                .traced_s,
            0);
}

TEST(ModelSceneTest, AModelWithoutSplatsIsRefused) {
  const Executor executor(1);
  ProgressSink progress;
  DeviceChoice device;
  Session session{executor, progress, 1, device};
  EXPECT_THROW(ModelScene(SplatModel(), std::nullopt, session), Error);
  EXPECT_THROW(ModelScene(MeshModel(), std::nullopt, session), Error);
}

TEST(ModelSceneFromAFile, EndsTheStepsThatItBegins) {
  const TemporaryFolder folder;
  save_model(folder.path() / "m.ply", floor_and_wall());
  const Executor executor(1);
  RecordedProgress progress;
  DeviceChoice device;
  Session session{executor, progress, 1, device};
  const ModelScene scene(folder.path() / "m.ply", "", session);
  ASSERT_FALSE(progress.steps.empty());
  EXPECT_TRUE(progress.steps.back().is_ended);
}

}  // namespace
}  // namespace adasplats
