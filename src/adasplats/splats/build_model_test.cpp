// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/build_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/core/recorded_progress_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/splats/model/same_bytes_test.h"
#include "adasplats/splats/paper/grow.h"

namespace adasplats {
namespace {

/// A floor (class 40, road) and a wall (50, building) that meet, with a pole (80) before it, seen
/// by a sensor at (0, 0, 1.7); noise along the normals.
PointCloud small_place(std::size_t points, double noise_m) {
  PointCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    Random random(11, 0, i);
    const double u = random.uniform(), v = random.uniform(), e = noise_m * random.normal();
    Vec3d p;
    std::uint16_t label = 40;
    if (i % 10 < 5) {
      p = {5 * u, 4 * v - 2, e};
    } else if (i % 10 < 9) {
      p = {5 + e, 4 * v - 2, 3 * u};
      label = 50;
    } else {
      p = {3 + 0.04 * std::cos(7 * v), 0.04 * std::sin(7 * v), 2.5 * u};
      label = 80;
    }
    cloud.positions.push_back(vec_cast<float>(p));
    cloud.sensor_positions.push_back({0, 0, 1.7F});
    cloud.classes.push_back(label);
    cloud.intensities.push_back(static_cast<float>(u));
  }
  return cloud;
}

std::pair<SplatModel, BuildReport> build(PointCloud cloud, const PaperOptions& options,
                                         int threads = 2,
                                         DynamicRemoval removal = DynamicRemoval::movable) {
  ProgressSink quiet;
  return build_model(std::move(cloud), &semantickitti_labels(), {options, removal},
                     Executor(threads), quiet);
}

class EveryMethod : public testing::TestWithParam<PaperVariant> {
 protected:
  PaperOptions options() const {
    PaperOptions result;
    result.variant = GetParam();
    return result;
  }
};

TEST_P(EveryMethod, SameBytesForEveryNumberOfThreads) {
  const SplatModel one = build(small_place(20000, 0.01), options(), 1).first;
  EXPECT_GT(one.size(), 100U);
  for (const int threads : {2, 3, 16})
    EXPECT_TRUE(same_bytes(one, build(small_place(20000, 0.01), options(), threads).first));
}

TEST_P(EveryMethod, EveryLongStepTellsHowFarItIs) {
  RecordedProgress sink;
  ProgressMeter meter(sink);
  const Executor executor(1, {}, &meter);
  build_model(small_place(100'000, 0.01), &semantickitti_labels(), {options()}, executor, meter);
  int long_steps = 0;
  for (const RecordedProgress::Step& step : sink.steps) {
    EXPECT_TRUE(step.is_ended) << step.name;
    EXPECT_TRUE(step.never_falls()) << step.name;
    if (step.total == 0) continue;
    ++long_steps;
    const auto passes = static_cast<int>(step.total / kPassUnits);
    EXPECT_GE(step.increases(), 5 * passes) << step.name;
    EXPECT_LE(step.done.back(), step.total) << step.name;
  }
  EXPECT_GE(long_steps, 3);
}

TEST_P(EveryMethod, SameBytesForShuffledInput) {
  PointCloud cloud = small_place(20000, 0.01);
  // Equal positions with other attributes must not make the order matter either.
  for (std::size_t i = 0; i < 500; ++i) cloud.positions[i + 1000] = cloud.positions[i];
  std::vector<std::uint32_t> order(cloud.size());
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t i = order.size(); i-- > 1;)
    std::swap(order[i], order[Random(5, 0, i).next_bits() % (i + 1)]);
  EXPECT_TRUE(
      same_bytes(build(cloud, options()).first, build(gather(cloud, order), options()).first));
}

TEST_P(EveryMethod, SplatsLieOnTheSurfacesAndFaceTheSensor) {
  const SplatModel model = build(small_place(40000, 0.002), options()).first;
  std::size_t far = 0;
  for (const Disk& disk : model.disks) {
    const Vec3f c = disk.center;
    const float pole = std::fabs(std::hypot(c.x - 3, c.y) - 0.04F);
    if (std::min({std::fabs(c.z), std::fabs(c.x - 5), pole}) > 0.02F) ++far;
    EXPECT_GE(dot(disk.normal, Vec3f{0, 0, 1.7F} - c), -0.05F);
    EXPECT_NEAR(length(disk.normal), 1, 1e-5);
  }
  EXPECT_LT(static_cast<double>(far), 0.01 * static_cast<double>(model.size()));
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod,
                         testing::Values(PaperVariant::basic, PaperVariant::descriptors,
                                         PaperVariant::semantic));

TEST(BuildModel, AdaptsTheNumberOfSplats) {
  // The paper's claim on a place of ground, surface and a pole: fewer splats with semantics.
  PaperOptions options;
  options.variant = PaperVariant::basic;
  options.resample = false;
  const std::size_t basic = build(small_place(60000, 0.005), options).first.size();
  options.variant = PaperVariant::semantic;
  EXPECT_LT(build(small_place(60000, 0.005), options).first.size(), basic);
}

TEST(BuildModel, RemovesDynamicObjectsByLabel) {
  PointCloud cloud = small_place(5000, 0.005);
  for (std::size_t i = 0; i < cloud.size(); i += 10) cloud.classes[i] = i % 20 == 0 ? 252 : 10;
  PaperOptions options;
  options.denoise = false;
  EXPECT_EQ(build(cloud, options, 2, DynamicRemoval::moving).second.points_dynamic, 250U);
  EXPECT_EQ(build(cloud, options, 2, DynamicRemoval::movable).second.points_dynamic, 500U);
  EXPECT_EQ(build(cloud, options, 2, DynamicRemoval::none).second.points_dynamic, 0U);
}

// Oracle: the colours that the classes were given. Points of removed classes give none.
TEST(BuildModel, KeepsTheColoursOfThePoints) {
  PointCloud cloud = small_place(5000, 0.005);
  std::vector<std::uint16_t> red(cloud.size()), green(cloud.size()), blue(cloud.size(), 256 * 9);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.classes[i] == 80) cloud.classes[i] = 10;  // a car
    red[i] = cloud.classes[i] == 40 ? 256 * 200 : 0;
    green[i] = cloud.classes[i] == 10 ? 256 * 255 : 0;
  }
  cloud.others.columns = {{"red", red}, {"green", green}, {"blue", blue}};
  PaperOptions paper;
  paper.variant = PaperVariant::semantic;
  ProgressSink quiet;
  for (const MethodOptions& method : {MethodOptions(paper), MethodOptions(ConsistentOptions())}) {
    const SplatModel model =
        build_model(cloud, &semantickitti_labels(), {method}, Executor(2), quiet).first;
    ASSERT_EQ(model.colors.size(), model.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
      EXPECT_EQ(model.colors[i][1], 0) << i;
      EXPECT_EQ(model.colors[i][2], 9) << i;
      wrong += model.colors[i][0] != (model.classes[i] == 40 ? 200 : 0) ? 1 : 0;
    }
    EXPECT_LT(wrong, model.size() / 5) << "only where floor and wall meet";
  }
  cloud.others.columns = {{"red", red}, {"green", green}};
  EXPECT_TRUE(build(cloud, paper).first.colors.empty());
  cloud.others.columns = {{"red", blue}, {"green", blue}, {"blue", blue}};
  EXPECT_TRUE(build(cloud, paper).first.colors.empty()) << "all points have the same";
}

TEST(BuildModel, DenoisingRemovesPlantedNoise) {
  PointCloud cloud = small_place(20000, 0.002);
  for (std::size_t i = 0; i < cloud.size(); i += 200)  // floor points 6 cm above the floor
    cloud.positions[i].z += 0.06F;
  PaperOptions options;
  options.variant = PaperVariant::basic;
  options.resample = false;
  const auto with = build(cloud, options);
  EXPECT_GE(with.second.points_noise, 90U);
  EXPECT_LT(with.second.points_noise, 2000U);
  options.denoise = false;
  EXPECT_EQ(build(cloud, options).second.points_noise, 0U);
}

TEST(BuildModel, ErrorsAreClear) {
  const auto kind_of_error = [](PointCloud cloud, const PaperOptions& options) {
    try {
      build(std::move(cloud), options);
    } catch (const Error& error) {
      return std::optional(error.kind());
    }
    return std::optional<ErrorKind>();
  };
  PaperOptions options;
  EXPECT_EQ(kind_of_error({}, options), ErrorKind::data);
  options.alpha = 2;
  EXPECT_EQ(kind_of_error(small_place(100, 0), options), ErrorKind::usage);
  options = {};
  options.alpha = std::nan("");
  EXPECT_EQ(kind_of_error(small_place(100, 0), options), ErrorKind::usage);
  options = {};
  options.variant = PaperVariant::semantic;
  PointCloud unlabeled = small_place(100, 0);
  unlabeled.classes.clear();
  EXPECT_EQ(kind_of_error(unlabeled, options), ErrorKind::data);
  PointCloud strange = small_place(100, 0);
  strange.classes[3] = 999;
  EXPECT_EQ(kind_of_error(strange, options), ErrorKind::data);
}

TEST(BuildModel, DegenerateCloudsFinish) {
  PaperOptions options;
  for (const PaperVariant variant :
       {PaperVariant::basic, PaperVariant::descriptors, PaperVariant::semantic}) {
    options.variant = variant;
    for (const std::size_t n : {1, 2, 39, 5000}) {
      PointCloud cloud = small_place(n, 0);
      for (Vec3f& p : cloud.positions) p = {1, 1, 1};
      EXPECT_EQ(build(cloud, options).first.size(), 0U);  // no extent, no radius, no splat
      for (std::size_t i = 0; i < n; ++i)
        cloud.positions[i] = {0.01F * static_cast<float>(i), 0, 0};
      build(cloud, options);
    }
  }
}

TEST(GrowSplat, StopsAtTheFirstNeighborThatFails) {
  // Seeds and neighbours on a line, by distance; the 4th is off the plane, the 5th on it again.
  std::vector<SurfacePoint> points(6, {{0, 0, 0}, 1, {0, 0, 1}, 0});
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].position = {0.1F * static_cast<float>(i), 0, 0.001F * static_cast<float>(i)};
  points[4].position.z = 0.06F;
  const std::uint32_t ranks[6] = {5, 3, 0, 1, 4, 2};  // no order
  float distances[6];
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec3f d = points[ranks[k]].position;
    distances[k] = dot(d, d);
  }
  const NeighborList neighbors{distances, ranks, 6};
  const GrowRules rules{0.05F, 0.6F, true, true};
  const GrownSplat splat = grow_splat(points[0], neighbors, points.data(), rules);
  EXPECT_FLOAT_EQ(splat.radius_m, 0.3F);                               // eq. splat radius: point 3
  EXPECT_FLOAT_EQ(splat.shift_m, (0 + 0.001F + 0.002F + 0.003F) / 4);  // eq. center position
  points[2].label = 7;  // another class stops it earlier
  EXPECT_FLOAT_EQ(grow_splat(points[0], neighbors, points.data(), rules).radius_m, 0.1F);
  points[2].label = 1;
  points[1].normal = {0, 1, 0};  // so does a sharp edge
  EXPECT_FLOAT_EQ(grow_splat(points[0], neighbors, points.data(), rules).radius_m, 0.0F);
}

TEST(SelectGreedily, EqualsTheSequentialDefinition) {
  constexpr std::uint32_t kCount = 10000;
  std::vector<float> radii(kCount);
  DiscardLists discards;
  discards.chunk_size = 64;
  discards.chunks.resize(kCount / 64 + 1);
  discards.begins.resize(kCount);
  std::vector<std::vector<std::uint32_t>> lists(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    Random random(1, 2, i);
    radii[i] = i % 17 == 0 ? 0.0F : std::floor(8 * static_cast<float>(random.uniform()));
    discards.begins[i] = static_cast<std::uint32_t>(discards.chunks[i / 64].size());
    for (std::uint64_t d = random.next_bits() % 4; d-- > 0;)
      lists[i].push_back(static_cast<std::uint32_t>(random.next_bits() % kCount));
    for (const std::uint32_t j : lists[i]) discards.chunks[i / 64].push_back(j);
  }
  std::vector<std::uint32_t> order(kCount);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return radii[a] > radii[b]; });
  std::vector<bool> gone(kCount), chosen(kCount);
  for (const std::uint32_t i : order) {
    if (gone[i] || radii[i] <= 0) continue;
    chosen[i] = true;
    for (const std::uint32_t j : lists[i])
      if (!chosen[j]) gone[j] = true;
  }
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < kCount; ++i)
    if (chosen[i]) expected.push_back(i);
  EXPECT_EQ(select_greedily(radii, discards, SelectionOrder::largest_first, Executor(3)), expected);
}

TEST(SelectGreedily, MostDiscardsFirstTakesTheWidestCandidate) {
  // 0 discards 1; 1 discards 0, 2 and 3; 3 discards 2. Largest first takes 0, which discards 1.
  const std::vector<float> radii = {3, 2, 1, 1};
  DiscardLists discards{{{1, 0, 2, 3, 2}}, {0, 1, 4, 4}, 4};
  const Executor executor(1);
  EXPECT_EQ(select_greedily(radii, discards, SelectionOrder::most_discards_first, executor),
            (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(select_greedily(radii, discards, SelectionOrder::largest_first, executor),
            (std::vector<std::uint32_t>{0, 2, 3}));
}

TEST(SplatModelFile, KeepsTheCalibration) {
  const auto path = std::filesystem::temp_directory_path() / "adasplats_calibration_test.ply";
  SplatModel model;
  model.disks = {{{1, 2, 3}, 0.5F, {0, 0, 1}}};
  model.calibration.lasers = {{0.01, -0.01}, {1e-4, -1e-4}};
  model.calibration.poses = {{1.5, {448000.1, 2, 3}, {1e-3, 0, 0}, {0.01, 0, 1.0 / 3}},
                             {1.6, {448001.1, 2, 3}, {2e-3, 0, 0}, {0.02, 0, 0}}};
  model.calibration.smooth_s = 0.4;
  model.calibration.mount = {{0.08, 0, -1.0 / 3}, {0.5, -0.25, 0}};
  save_model(path, model);
  const Calibration read = load_model(path).calibration;
  EXPECT_EQ(read.lasers.range_m, model.calibration.lasers.range_m);
  EXPECT_EQ(read.lasers.elevation_rad, model.calibration.lasers.elevation_rad);
  EXPECT_EQ(read.smooth_s, 0.4);
  EXPECT_EQ(read.mount.rotation_rad, model.calibration.mount.rotation_rad);
  EXPECT_EQ(read.mount.shift_m, model.calibration.mount.shift_m);
  ASSERT_EQ(read.poses.size(), 2U);
  EXPECT_EQ(read.poses[0].time_s, 1.5);
  EXPECT_EQ(read.poses[0].position, model.calibration.poses[0].position);
  EXPECT_EQ(read.poses[0].shift_m, model.calibration.poses[0].shift_m);
  EXPECT_EQ(read.poses[1].rotation_rad, model.calibration.poses[1].rotation_rad);

  const std::string text = read_file(path);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    std::ofstream(path, std::ios::binary) << changed;
  };
  with("calibration_range_offsets_m 0.01 -0.01", "calibration_range_offsets_m 0.01");
  EXPECT_THROW(load_model(path), Error);
  with("calibration_pose 1.5 ", "calibration_pose ");
  EXPECT_THROW(load_model(path), Error);
  with("calibration_pose 1.5 ", "calibration_pose nan ");
  EXPECT_THROW(load_model(path), Error);
  with("calibration_mount 0.08 ", "calibration_mount ");
  EXPECT_THROW(load_model(path), Error);
  with("calibration_mount ", "calibration_of_old_mounts ");
  EXPECT_TRUE(load_model(path).calibration.mount.empty());
  std::filesystem::remove(path);
}

TEST(SplatModelFile, RoundTrip) {
  const auto path = std::filesystem::temp_directory_path() / "adasplats_model_test.ply";
  PaperOptions options;
  options.variant = PaperVariant::semantic;
  SplatModel model = build(small_place(3000, 0.005), options).first;
  EXPECT_EQ(model.network_sha256, "");
  model.network_sha256 = "0123abcd";
  for (std::size_t i = 0; i < model.size(); ++i)
    model.colors.push_back({static_cast<std::uint8_t>(i), 255, static_cast<std::uint8_t>(i / 7)});
  save_model(path, model);
  const SplatModel near = load_model(path);
  EXPECT_TRUE(same_bytes(model, near));
  EXPECT_EQ(near.colors, model.colors);
  EXPECT_EQ(near.network_sha256, "0123abcd");
  EXPECT_EQ(near.label_scheme, "semantickitti");
  EXPECT_EQ(near.method, "semantic");
  EXPECT_TRUE(near.calibration.empty());
  model.origin = {448000, 5411000, 0};  // UTM: doubles in the file, millimetres kept
  save_model(path, model);
  const SplatModel far = load_model(path);
  ASSERT_EQ(far.size(), model.size());
  for (std::size_t i = 0; i < far.size(); ++i)
    EXPECT_LT(length(far.origin + vec_cast<double>(far.disks[i].center) - model.origin -
                     vec_cast<double>(model.disks[i].center)),
              1e-4);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace adasplats
