// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/consistent_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/base/engines.h"
#include "adasplats/splats/build_model.h"
#include "adasplats/splats/consistent/consistent_state.h"
#include "adasplats/splats/consistent/origin_check.h"
#include "adasplats/splats/consistent/scanned_room_test.h"
#include "adasplats/splats/model_engine.h"

// The oracle of all tests is the CPU steps on the same cloud.
namespace adasplats {
namespace {

using namespace room;  // NOLINT(google-build-using-namespace)

class ConsistentOnGpu : public testing::Test {
 protected:
  void SetUp() override {
    if (find_gpus().devices.empty()) GTEST_SKIP() << find_gpus().reason;
  }
};

using Steps = std::unique_ptr<ConsistentSteps>;

ConsistentState state_of(const Steps& steps) {
  return dynamic_cast<const ShowsConsistentState&>(*steps).state();
}

/// Number of bytes of a value without padding, which is undefined.
template <class T>
constexpr std::size_t kBytesOf = sizeof(T);
template <>
constexpr std::size_t kBytesOf<LocalPlane> = offsetof(LocalPlane, scale) + 1;

/// Number of values that differ in any bit, including surplus values of either side.
template <class T>
std::size_t count_different_unpadded(const std::vector<T>& a, const std::vector<T>& b) {
  const std::size_t common = std::min(a.size(), b.size());
  std::size_t different = std::max(a.size(), b.size()) - common;
  for (std::size_t i = 0; i < common; ++i) {
    different += std::memcmp(&a[i], &b[i], kBytesOf<T>) == 0 ? 0 : 1;
  }
  return different;
}

void expect_same(const ConsistentState& a, const ConsistentState& b) {
  EXPECT_EQ(count_different_unpadded(a.fused.positions, b.fused.positions), 0U) << "cells";
  EXPECT_EQ(count_different_unpadded(a.fused.begins, b.fused.begins), 0U) << "where cells begin";
  EXPECT_EQ(count_different_unpadded(a.fused.members, b.fused.members), 0U) << "points of cells";
  EXPECT_EQ(count_different_unpadded(a.planes, b.planes), 0U) << "planes";
  EXPECT_EQ(count_different_unpadded(a.seeds, b.seeds), 0U) << "seeds";
  EXPECT_EQ(count_different_unpadded(a.rays, b.rays), 0U) << "rays";
  EXPECT_EQ(count_different_unpadded(a.radii_m, b.radii_m), 0U) << "radii";
  EXPECT_EQ(count_different_unpadded(a.chosen, b.chosen), 0U) << "chosen disks";
}

void expect_same(const ConsistentSplats& a, const ConsistentSplats& b) {
  EXPECT_EQ(count_different_unpadded(a.disks, b.disks), 0U);
  EXPECT_EQ(count_different_unpadded(a.opacities, b.opacities), 0U);
  EXPECT_EQ(count_different_unpadded(a.classes, b.classes), 0U);
  EXPECT_EQ(count_different_unpadded(a.intensities, b.intensities), 0U);
}

void expect_same(const Reflectances& a, const Reflectances& b) {
  EXPECT_EQ(count_different_unpadded(a.values, b.values), 0U) << "reflectances";
  EXPECT_EQ(count_different_unpadded(a.drop_log_odds, b.drop_log_odds), 0U) << "lost beams";
  EXPECT_EQ(count_different_unpadded(a.response.range_gains, b.response.range_gains), 0U);
  EXPECT_EQ(count_different_unpadded(a.response.incidence_gains, b.response.incidence_gains), 0U);
  EXPECT_EQ(a.response.empty(), b.response.empty());
}

/// Runs CPU and GPU in parallel: all bits must agree after every step.
class SideBySide {
 public:
  explicit SideBySide(const PointCloud& cloud, const ClassTables& tables = {}) {
    const std::size_t points = cpu_->load(cloud, tables);
    EXPECT_EQ(gpu_->load(cloud, tables), points);
  }

  template <class F>
  void step(const std::string& name, const F& verb) {
    SCOPED_TRACE("after " + name);
    verb(*cpu_);
    verb(*gpu_);
    expect_same(state_of(cpu_), state_of(gpu_));
  }

  void evidence(const ConsistentOptions& options) {
    const std::vector<Disk> seeds = state_of(cpu_).seeds;
    const auto of = [&](const Steps& steps) {
      return dynamic_cast<const ShowsConsistentState&>(*steps).evidence(seeds, options.evidence);
    };
    const RayEvidence cpu = of(cpu_), gpu = of(gpu_);
    EXPECT_EQ(count_different_unpadded(cpu.confirmed, gpu.confirmed), 0U);
    EXPECT_EQ(count_different_unpadded(cpu.contradicted, gpu.contradicted), 0U);
  }

  /// Returns the number of processed seeds.
  std::uint64_t origins(const ConsistentOptions& options) {
    const OriginCheck cpu = origin_check(cpu_->check_origins(options));
    const OriginCheck gpu = origin_check(gpu_->check_origins(options));
    EXPECT_EQ(cpu.seeds, gpu.seeds);
    EXPECT_EQ(cpu.contradicted, gpu.contradicted);
    EXPECT_EQ(cpu.near_rise, gpu.near_rise);
    EXPECT_EQ(cpu.far_rise, gpu.far_rise);
    return gpu.seeds;
  }

  /// Returns the number of splats.
  std::size_t finish() {
    const ConsistentSplats cpu = cpu_->take_splats(), gpu = gpu_->take_splats();
    expect_same(cpu, gpu);
    return gpu.disks.size();
  }

  /// Runs all steps and compares the splats; returns whether enough rays have reflectances.
  bool reflectances(const ConsistentOptions& options) {
    const auto finish = [&](const Steps& steps) {
      consistent_disks(*steps, true, options, [](std::string_view, int) {});
      const ConsistentSplats splats = steps->take_splats();
      return steps->measure_reflectances(splats.disks, splats.intensities, options);
    };
    const Reflectances cpu = finish(cpu_), gpu = finish(gpu_);
    expect_same(cpu, gpu);
    return !gpu.response.empty();
  }

 private:
  Executor executor_{2};
  Steps cpu_ = make_cpu_consistent_steps(executor_);
  Steps gpu_ = make_cuda_model_engine(0)->consistent_steps();
};

/// Runs all steps and compares after each; returns the number of splats.
std::size_t compare(const PointCloud& cloud, const ConsistentOptions& options,
                    const ClassTables& tables = {}) {
  SideBySide both(cloud, tables);
  const bool checked = !cloud.sensor_positions.empty() && options.balance_rounds > 0;
  std::uint64_t looked_at = 0;
  both.step("fuse", [&](auto& steps) { steps.fuse(options); });
  both.step("fit_seeds", [&](auto& steps) { steps.fit_seeds(options); });
  if (checked) {
    looked_at = both.origins(options);
    both.step("order_rays", [&](auto& steps) { steps.order_rays(options); });
    both.evidence(options);
    for (int i = 0; i < options.balance_rounds; ++i) {
      both.step("balance", [&](auto& steps) { steps.balance_seeds(i, options); });
    }
  }
  both.step("cover", [&](auto& steps) { steps.cover(checked, options); });
  for (int i = 0; checked && i < options.strict_rounds; ++i) {
    both.step("limit_overhangs", [&](auto& steps) { steps.limit_overhangs(i, options); });
  }
  if (checked) both.step("limit_unchosen", [&](auto& steps) { steps.limit_unchosen(); });
  both.step("choose", [&](auto& steps) { steps.choose(); });
  if (checked) {
    for (int i = 0; i < options.settle_rounds; ++i) {
      both.step("settle", [&](auto& steps) { steps.settle(options); });
    }
    both.step("fill_gaps", [&](auto& steps) { steps.fill_gaps(options); });
    for (int i = 0; i < 3; ++i)
      both.step("refine_extents", [&](auto& steps) { steps.refine_extents(i, options); });
    both.step("soften", [&](auto& steps) { steps.soften(options); });
  }
  const std::size_t splats = both.finish();
  EXPECT_TRUE(looked_at > 0 || !checked || splats == 0);
  return splats;
}

/// Points at random heights on a lattice, seen from two positions above it.
PointCloud lattice(int n, double step_m, double noise_m) {
  PointCloud cloud;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      Random random(3, static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x));
      cloud.positions.push_back(
          vec_cast<float>(Vec3d{step_m * x + 0.02, step_m * y + 0.02, noise_m * random.normal()}));
      cloud.sensor_positions.push_back(x % 2 == 0 ? Vec3f{1, 2, 3} : Vec3f{4, 1, 5});
    }
  }
  return cloud;
}

PointCloud without_sensors(PointCloud cloud) {
  cloud.sensor_positions.clear();
  return cloud;
}

TEST_F(ConsistentOnGpu, ScannedRoomMatchesTheCpuAfterEveryStep) {
  EXPECT_GT(compare(scanned_room(), {}), 1000U);
}

TEST_F(ConsistentOnGpu, EveryRayAndAllItsDisksCount) {
  ConsistentOptions options;
  options.evidence.parts = 1;
  options.cover.overlap = 0.95;  // leaves gaps to fill
  EXPECT_GT(compare(scanned_room(), options), 1000U);
}

// Every third beam is marked as without return: some of them contradict the evidence of others.
TEST_F(ConsistentOnGpu, BeamsWithoutReturnMatchTheCpu) {
  PointCloud cloud = scanned_room();
  const std::size_t without = compare(cloud, {});
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    const Vec3f sensor = cloud.sensor_positions[i];
    cloud.empty_beams.push_back({sensor, normalized(cloud.positions[i] - sensor), 0});
  }
  EXPECT_NE(compare(cloud, {}), without);
}

TEST_F(ConsistentOnGpu, DuplicatesAndOtherCellsMatchTheCpu) {
  PointCloud cloud = scanned_room();
  for (std::size_t i = 0; i < 3000; ++i) cloud.positions[i + 1000] = cloud.positions[i % 7];
  ConsistentOptions options;
  for (const double small_cell_m : {0.0, 0.01}) {
    options.small_cell_m = small_cell_m;
    options.split_scale = 255;  // every cell
    EXPECT_GT(compare(cloud, options), 1000U);
  }
}

TEST_F(ConsistentOnGpu, EqualPrioritiesKeepTheirOrder) {
  // Nearly all disks of a flat lattice cover the same number, so the order decides one by one.
  const ConsistentOptions options;
  EXPECT_GT(compare(lattice(150, 0.05, 0), options), 100U);
  EXPECT_GT(compare(lattice(150, 0.05, 0.01), options), 100U);
}

TEST_F(ConsistentOnGpu, CloudsWithoutSensorPositionsMatchTheCpu) {
  EXPECT_GT(compare(without_sensors(scanned_room()), {}), 1000U);
  for (const double noise_m : {0.0, 0.01}) {  // without noise, seeds are on sector borders
    EXPECT_GT(compare(without_sensors(lattice(150, 0.05, noise_m)), {}), 100U);
  }
}

TEST_F(ConsistentOnGpu, OriginsOfSeveralKindsMatchTheCpu) {
  PointCloud cloud = scanned_room();
  cloud.origin_kinds.assign(cloud.size(), OriginKind::measured);
  EXPECT_GT(compare(cloud, {}), 1000U);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.positions[i].x > 0) cloud.origin_kinds[i] = OriginKind::guessed;
    if (cloud.positions[i].y > 0) cloud.origin_kinds[i] = OriginKind::stated;
    if (cloud.positions[i].x > 2) cloud.origin_kinds[i] = OriginKind::none;
  }
  EXPECT_GT(compare(cloud, {}), 1000U);
}

TEST_F(ConsistentOnGpu, NoRayIsCastWithoutRounds) {
  ConsistentOptions options;
  options.balance_rounds = 0;
  options.cover.unchecked_sectors = 0;
  EXPECT_GT(compare(scanned_room(), options), 1000U);
}

TEST_F(ConsistentOnGpu, RemovedClassesAreSkipped) {
  ClassTables tables;
  tables.removed.resize(1 << 16);
  tables.removed[kPerson] = 1;
  EXPECT_GT(compare(scanned_room(), {}, tables), 1000U);
}

/// Intensities of several sensors that decrease with range; some are unknown.
PointCloud room_with_intensities(float unit) {
  PointCloud cloud = scanned_room();
  cloud.intensities.clear();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float range_m = length(cloud.positions[i] - cloud.sensor_positions[i]);
    const float noise = static_cast<float>(i % 13) / 26;
    cloud.intensities.push_back(unit * (0.25F + noise) / (1 + range_m));
    if (i % 100 == 7) cloud.intensities[i] = std::numeric_limits<float>::quiet_NaN();
  }
  return cloud;
}

TEST_F(ConsistentOnGpu, LostBeamsMatchTheCpu) {
  PointCloud cloud = room_with_intensities(1);
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    const Vec3f sensor = cloud.sensor_positions[i];
    cloud.empty_beams.push_back({sensor, normalized(cloud.positions[i] - sensor), 0, true});
  }
  EXPECT_TRUE(SideBySide(cloud).reflectances({}));
}

TEST_F(ConsistentOnGpu, ReflectancesMatchTheCpu) {
  ClassTables tables;
  tables.removed.resize(1 << 16);
  for (const bool removes : {false, true}) {
    tables.removed[kPerson] = removes ? 1 : 0;
    for (const float unit : {1.0F, 255.0F, 1e-20F})
      EXPECT_TRUE(SideBySide(room_with_intensities(unit), tables).reflectances({}));
  }
  ConsistentOptions unchecked;
  unchecked.balance_rounds = 0;
  EXPECT_TRUE(SideBySide(room_with_intensities(1)).reflectances(unchecked));
  PointCloud dark = room_with_intensities(0);
  EXPECT_TRUE(SideBySide(dark).reflectances({}));
  dark.intensities.assign(dark.size(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(SideBySide(dark).reflectances({}));
}

// Oracle: the CPU engine. The last step of the methods of the paper.
TEST_F(ConsistentOnGpu, ReflectancesOfGivenDisksMatchTheCpu) {
  const Executor executor(2);
  const PointCloud cloud = room_with_intensities(1);
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < cloud.size(); i += 20)
    disks.push_back(
        {cloud.positions[i], 0.1F, normalized(cloud.sensor_positions[i] - cloud.positions[i])});
  const std::vector<float> fallback(disks.size(), 0.5F);
  const Reflectances cpu =
      make_cpu_model_engine(executor)->measure_reflectances(disks, fallback, cloud);
  EXPECT_FALSE(cpu.response.empty());
  const auto engine = make_cuda_model_engine(0);
  expect_same(cpu, engine->measure_reflectances(disks, fallback, cloud));
  EXPECT_EQ(engine->measure_reflectances(disks, fallback, without_sensors(cloud)).values, fallback);
  EXPECT_TRUE(engine->measure_reflectances({}, {}, cloud).values.empty());
}

// Oracle: the CPU engine. Half of the room, with the rays that pass it, as a tile of a city.
TEST_F(ConsistentOnGpu, CityTilesMatchTheCpu) {
  const Executor executor(2);
  const PointCloud room = room_with_intensities(1);
  std::vector<std::uint32_t> near, far;
  for (std::uint32_t i = 0; i < room.size(); ++i)
    (room.positions[i].x < 2.5F ? near : far).push_back(i);
  GlobalContext whole;
  whole.box = curve_box_of(room.positions, executor);
  whole.typical = {0.01, 0.05};
  whole.rays = 5'000'000;
  whole.passing = gather(room, far);
  whole.empty = ends_of({{{1, 1, 1}, {0, 0, 1}, 0}, {{1, 1, 1}, {1, 0, 0}, 0}}, 3);
  const PointCloud piece = gather(room, near);
  BuildOptions options;
  options.whole = &whole;
  ProgressSink quiet;
  const auto engine = make_cuda_model_engine(0);
  const auto spacings = [&](const ModelEngine& on) {
    const auto steps = on.consistent_steps();
    steps->load(piece, {}, &whole);
    steps->fuse({});
    std::vector<float> found;
    for (const CellSpacing& cell : steps->spacings({})) found.push_back(cell.spacing);
    return found;
  };
  EXPECT_EQ(spacings(*make_cpu_model_engine(executor)), spacings(*engine));
  for (int turn = 0; turn < 2; ++turn) {
    const SplatModel cpu = build_model(piece, nullptr, options, executor, quiet).first;
    const SplatModel cuda =
        build_model(piece, nullptr, options, executor, quiet, engine.get()).first;
    ASSERT_EQ(cpu.size(), cuda.size());
    EXPECT_GT(cpu.size(), 300U);
    EXPECT_EQ(std::memcmp(cpu.disks.data(), cuda.disks.data(), cpu.size() * sizeof(Disk)), 0);
    EXPECT_EQ(cpu.intensities, cuda.intensities);
    whole.response = cpu.response;  // given the second time
    ASSERT_FALSE(whole.response->empty());
  }
}

TEST_F(ConsistentOnGpu, SmallAndDegenerateClouds) {
  const auto cloud_of = [](std::vector<Vec3f> points) {
    PointCloud cloud;
    cloud.positions = std::move(points);
    cloud.sensor_positions.resize(cloud.size(), {0, 0, 1.7F});
    return cloud;
  };
  EXPECT_EQ(compare(cloud_of({{3, 1, 1}}), {}), 0U);
  EXPECT_EQ(compare(cloud_of(std::vector<Vec3f>(5000, {3, 1, 1})), {}), 0U);
  EXPECT_EQ(compare(cloud_of(std::vector<Vec3f>(50, {0, 0, 1.7F})), {}), 0U);
  for (const int n : {2, 7, 9, 31, 32, 33, 159, 160, 161, 1025}) {
    std::vector<Vec3f> line, plane;
    for (int i = 0; i < n; ++i) {
      line.push_back({0.05F * static_cast<float>(i), 0, 0});
      plane.push_back({0.1F * static_cast<float>(i % 20), 0.1F * static_cast<float>(i / 20), 0});
    }
    compare(cloud_of(line), {});
    compare(cloud_of(plane), {});
    plane.insert(plane.end(), {{1e12F, 0, 0}, {0, -1e9F, 0}});
    compare(cloud_of(plane), {});
    compare(without_sensors(cloud_of(plane)), {});
  }
}

ConsistentSplats model_of(const PointCloud& cloud) {
  const Steps steps = make_cuda_model_engine(0)->consistent_steps();
  steps->load(cloud, {});
  EXPECT_TRUE(consistent_disks(*steps, true, {}, [](std::string_view, int) {}).checked);
  return steps->take_splats();
}

TEST_F(ConsistentOnGpu, TwoRunsGiveTheSameBytes) {
  const PointCloud cloud = scanned_room();
  const ConsistentSplats one = model_of(cloud);
  EXPECT_GT(one.disks.size(), 1000U);
  for (int run = 0; run < 3; ++run) expect_same(one, model_of(cloud));
}

TEST_F(ConsistentOnGpu, ErrorsNameARemedyAndLeaveTheStepsDestructible) {
  const auto error_of = [&](const ConsistentOptions& options) -> std::string {
    try {
      const Steps steps = make_cuda_model_engine(0)->consistent_steps();
      steps->load(lattice(50, 0.05, 0), {});
      consistent_disks(*steps, true, options, [](std::string_view, int) {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  ConsistentOptions options;
  EXPECT_EQ(error_of(options), "");
  options.cover.neighbors = 600;
  EXPECT_NE(error_of(options).find("`device` cpu"), std::string::npos);
  options = {};
  options.planes.scales.back() = 600;
  EXPECT_NE(error_of(options).find("`device` cpu"), std::string::npos);
  EXPECT_THROW(make_cuda_model_engine(1000), Error);
}

}  // namespace
}  // namespace adasplats
