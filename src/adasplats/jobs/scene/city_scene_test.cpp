// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/city_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/recorded_progress_test.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"

namespace adasplats::streamed {
namespace {

namespace fs = std::filesystem;

constexpr int kTiles = 14;
constexpr float kSide_m = 25;

/// A street along x: a floor and walls on both sides, cut into tiles. Some splats of neighbouring
/// tiles are the same.
void write_street(const fs::path& folder) {
  fs::create_directories(folder / "tiles");
  SplatModel common;
  common.origin = {7000, 300, 5};
  common.method = "consistent";
  common.label_scheme = "semantickitti";
  save_model(folder / kCityCommonFile, common);
  CityManifest city;
  city.grid = {25};
  city.origin = common.origin;
  for (int k = 0; k < kTiles; ++k) {
    SplatModel tile = common;
    const auto add = [&](Vec3f center, Vec3f normal, std::uint16_t class_id) {
      Random random(3, static_cast<std::uint64_t>(k), tile.size());
      tile.disks.push_back({center, 0.4F, normal});
      tile.classes.push_back(class_id);
      tile.intensities.push_back(static_cast<float>(random.uniform()));
    };
    for (int i = 0; i <= 50; ++i) {
      const float x = kSide_m * static_cast<float>(k) + 0.5F * static_cast<float>(i);
      for (int j = -16; j <= 16; ++j) add({x, 0.5F * static_cast<float>(j), 0}, {0, 0, 1}, 40);
      for (int j = 0; j < 12; ++j)
        for (const float side : {-8.0F, 8.0F})
          add({x, side, 0.5F * static_cast<float>(j)}, {0, 1, 0}, 50);
    }
    const TileKey key = {280 + k, 12};
    save_model(folder / model_file_of(key), tile);
    const auto [low, high] = bounds(tile);
    city.tiles.push_back({key, 1, tile.size(), "", tile.origin + vec_cast<double>(low),
                          tile.origin + vec_cast<double>(high)});
  }
  write_file(folder / kCityFile, city_text(city));
}

/// A ball of splats that somebody put into the street.
void write_world(const fs::path& file) {
  SplatModel ball;
  for (int i = 0; i < 300; ++i) {
    Random random(8, 0, static_cast<std::uint64_t>(i));
    const Vec3d n = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    ball.disks.push_back({vec_cast<float>(n), 0.25F, vec_cast<float>(n)});
  }
  save_model(file.parent_path() / "ball.ply", ball);
  write_file(file,
             "model = \"city\"\n"
             "[[object]]\ngeometry = \"ball.ply\"\nclass = \"car\"\nposition = [7100, 302, 6]\n");
}

std::vector<ScanMotion> drive(std::size_t count, bool moves) {
  Trajectory poses(count);
  for (std::size_t i = 0; i < count; ++i) {
    poses[i].time_s = 0.1 * static_cast<double>(i);
    poses[i].world_from_sensor.translation = {7002 + 4.0 * static_cast<double>(i), 300, 6.8};
  }
  return moves ? moving_scans(poses, poses, 0.1) : still_scans(poses);
}

void expect_same(const Scan& a, const Scan& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.ranges_m, b.ranges_m);
  EXPECT_EQ(a.rings, b.rings);
  for_each_scan_attribute([&](const auto& attribute) {
    EXPECT_EQ(attribute.of(a), attribute.of(b)) << attribute.name;
  });
}

class CitySceneTest : public testing::TestWithParam<DeviceKind> {
 protected:
  CitySceneTest() {
    write_street(folder_.path() / "city");
    write_world(folder_.path() / "world.toml");
    settings_.sensor = load_lidar_model("velodyne-vlp-16");
    settings_.sensor.max_range_m = 40;
    settings_.seed = 7;
    choice_.kind = GetParam();
  }
  void SetUp() override {
    if (GetParam() == DeviceKind::cpu) return;
    const GpuSearch search = find_gpus();
    if (search.devices.empty()) GTEST_SKIP() << "no GPU: " << search.reason;
    choice_.gpus = {search.devices.front()};
  }

  std::vector<Scan> scans_in(const ScanScene& scene, std::span<const ScanMotion> motions) {
    ScanSimulator simulator(scene, settings_, executor_);
    std::vector<Scan> taken;
    simulator.run_held(motions, 3, [&](std::size_t i, HeldScan&& held) {
      EXPECT_EQ(i, taken.size());
      held.scan.copy_to(taken.emplace_back());
    });
    return taken;
  }

  void expect_streamed_as_whole(const fs::path& model, bool moves) {
    const std::vector<ScanMotion> motions = drive(80, moves);
    const ModelScene whole(model, "", session_, WorldFiles::taken);
    const std::vector<Scan> expected = scans_in(whole, motions);
    ASSERT_EQ(expected.size(), 80U);
    ASSERT_GT(expected[40].size(), 5000U);
    // What three tiles take, of the five or six that a scan may reach; and all.
    for (const std::size_t bytes : {std::size_t{900'000}, std::size_t{1} << 30U}) {
      const CityScene city(model, "", session_, bytes);
      const std::vector<Scan> scans = scans_in(city, motions);
      ASSERT_EQ(scans.size(), expected.size());
      for (std::size_t i = 0; i < scans.size(); ++i) expect_same(scans[i], expected[i]);
      EXPECT_EQ(city.counts().loaded, 14U);
    }
  }

  TemporaryFolder folder_;
  Executor executor_{2};
  ProgressSink progress_;
  DeviceChoice choice_;
  Session session_{executor_, progress_, 1, choice_};
  ScanSettings settings_;
};

TEST_P(CitySceneTest, ScansAreThoseOfTheWholeCity) {
  expect_streamed_as_whole(folder_.path() / "city", false);
}

TEST_P(CitySceneTest, SoTheyAreOfASensorThatMovesWithSeveralReturns) {
  settings_.beam.sub_rays = 3;
  settings_.beam.depth = 2;
  settings_.beam.returns = 2;
  expect_streamed_as_whole(folder_.path() / "city", true);
}

TEST_P(CitySceneTest, ObjectsStandInIt) {
  expect_streamed_as_whole(folder_.path() / "world.toml", false);
  const CityScene city(folder_.path() / "world.toml", "", session_, 1U << 30U);
  std::size_t cars = 0;
  for (const Scan& scan : scans_in(city, drive(30, false)))
    for (const std::uint16_t id : scan.classes) cars += id == 10 ? 1 : 0;
  EXPECT_GT(cars, 100U);
}

TEST_P(CitySceneTest, AnyScanCanBeAskedFor) {
  const ModelScene whole(folder_.path() / "city", "", session_);
  const CityScene city(folder_.path() / "city", "", session_, 1);
  ScanSimulator in_whole(whole, settings_, executor_), in_city(city, settings_, executor_);
  const std::vector<ScanMotion> motions = drive(80, false);
  for (const std::size_t i : {70, 3, 71, 40, 0})
    expect_same(in_city.scan(motions[i], i), in_whole.scan(motions[i], i));
}

INSTANTIATE_TEST_SUITE_P(Devices, CitySceneTest, testing::Values(DeviceKind::cpu, DeviceKind::cuda),
                         [](const auto& kind) { return device_word(kind.param); });

TEST(CityScene, KnowsWhatCanBeStreamed) {
  const TemporaryFolder folder;
  write_street(folder.path() / "city");
  write_world(folder.path() / "world.toml");
  EXPECT_TRUE(is_streamable(folder.path() / "city"));
  EXPECT_TRUE(is_streamable(folder.path() / "world.toml"));
  EXPECT_FALSE(is_streamable(folder.path() / "ball.ply"));
  EXPECT_FALSE(is_streamable(folder.path() / "city" / "tiles"));
  EXPECT_FALSE(is_streamable(folder.path() / "nothing"));
}

TEST(CityScene, TilesThatCarryDifferentThingsAreAnError) {
  const TemporaryFolder folder;
  write_street(folder.path() / "city");
  const fs::path file = folder.path() / "city" / model_file_of({285, 12});
  SplatModel tile = load_model(file);
  tile.classes.clear();
  save_model(file, tile);
  const Executor executor(1);
  ProgressSink progress;
  DeviceChoice choice;
  Session session{executor, progress, 1, choice};
  const CityScene city(folder.path() / "city", "", session, 1U << 30U);
  ScanSettings settings;
  settings.sensor = load_lidar_model("velodyne-vlp-16");
  ScanSimulator simulator(city, settings, executor);
  EXPECT_THROW(simulator.scan(drive(40, false).back(), 0), Error);
}

}  // namespace
}  // namespace adasplats::streamed
