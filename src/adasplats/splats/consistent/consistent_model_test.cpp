// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/consistent_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/splats/build_model.h"
#include "adasplats/splats/consistent/consistent_state.h"
#include "adasplats/splats/consistent/consistent_steps.h"
#include "adasplats/splats/consistent/scanned_room_test.h"
#include "adasplats/splats/model/canonical_order.h"
#include "adasplats/splats/model/same_bytes_test.h"
#include "adasplats/surface/adaptive_planes.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {
namespace {

using namespace room;  // NOLINT(google-build-using-namespace)

struct Warnings : ProgressSink {
  std::vector<std::string> texts;
  void warn(std::string_view text) override { texts.emplace_back(text); }
};

BuildOptions consistent_options() {
  BuildOptions options;
  options.remove = DynamicRemoval::none;
  options.reflectances = false;
  return options;
}

struct Built {
  SplatModel model;
  BuildReport report;
  Warnings warnings;
};

Built build_consistent(PointCloud cloud, int threads = 2,
                       const BuildOptions& options = consistent_options()) {
  Built built;
  std::tie(built.model, built.report) = build_model(std::move(cloud), &semantickitti_labels(),
                                                    options, Executor(threads), built.warnings);
  return built;
}

/// The room's model, made once: tests only look at it.
const Built& room_model() {
  static const Built built = build_consistent(scanned_room());
  return built;
}

std::size_t splats_in(const SplatModel& model, const Box& box, double margin_m) {
  return static_cast<std::size_t>(
      std::count_if(model.disks.begin(), model.disks.end(),
                    [&](const Disk& disk) { return box.contains(disk.center, margin_m); }));
}

void expect_sound(const Built& built) {
  for (const Disk& disk : built.model.disks) {
    EXPECT_TRUE(is_finite(disk.center));
    EXPECT_NEAR(length(disk.normal), 1.0F, 1e-5F);
    EXPECT_GT(disk.radius, 0.0F);
    EXPECT_TRUE(std::isfinite(disk.radius));
  }
  EXPECT_EQ(built.report.primitives, built.model.size());
}

float distance_to_points_m(Vec3f place, const std::vector<Vec3f>& points) {
  float nearest_m = std::numeric_limits<float>::max();
  for (const Vec3f point : points) nearest_m = std::min(nearest_m, length(point - place));
  return nearest_m;
}

/// Centres that are the maximum shift of planes beside the points.
std::size_t count_at_limit(const SplatModel& model, const std::vector<Vec3f>& points) {
  return static_cast<std::size_t>(std::ranges::count_if(model.disks, [&](const Disk& disk) {
    return std::fabs(distance_to_points_m(disk.center, points) - 0.1F) < 2e-4F;
  }));
}

TEST(ConsistentModel, CellsOfSmallDenseObjectsFollowTheSpacing) {
  constexpr float kRadius_m = 0.07F;
  PointCloud cloud;
  for (std::size_t i = 0; i < 20'000; ++i) {
    Random random(3, 0, i);
    const Vec3d direction =
        direction_of(random.uniform(0, 6.2831853), std::asin(random.uniform(-1, 1)));
    cloud.positions.push_back(kRadius_m * vec_cast<float>(direction));
  }
  const Built ball = build_consistent(cloud);
  EXPECT_LT(ball.report.consistent->scale, 0.25);
  EXPECT_GT(ball.model.size(), 500U);
  for (const Disk& disk : ball.model.disks) ASSERT_NEAR(length(disk.center), kRadius_m, 0.002F);
  EXPECT_TRUE(std::ranges::any_of(ball.warnings.texts, [](const std::string& text) {
    return text.find("points are 1.8 mm apart") != std::string::npos;
  }));
  BuildOptions chosen = consistent_options();
  std::get<ConsistentOptions>(chosen.recipe).cell_m = 0.04;
  EXPECT_EQ(build_consistent(cloud, 2, chosen).report.consistent->scale, 1);
  // Noise of half a cell: smaller cells would show the noise.
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.positions[i] =
        (1 + static_cast<float>(Random(4, 0, i).uniform(-0.4, 0.4))) * cloud.positions[i];
  EXPECT_GE(build_consistent(cloud).report.consistent->scale, 0.25);
}

TEST(ConsistentModel, PointsFromTheAirStayInPlace) {
  PointCloud cloud;
  for (std::size_t i = 0; i < 2400; ++i) {
    Random random(5, 0, i);
    const double x = random.uniform(0, 40), y = random.uniform(0, 40);
    const bool is_tree = i % 3 != 0;
    cloud.positions.push_back(vec_cast<float>(
        Vec3d{x, y, is_tree ? random.uniform(1, 15) : random.uniform(-0.03, 0.03)}));
  }
  const Built forest = build_consistent(cloud);
  EXPECT_TRUE(forest.report.consistent->sparse);
  EXPECT_EQ(forest.report.consistent->splats_limited, 0U);
  EXPECT_GT(forest.model.size(), 1500U);
  EXPECT_EQ(count_at_limit(forest.model, cloud.positions), 0U);
}

TEST(ConsistentModel, CountsCentresMovedByTheMaximum) {
  PointCloud cloud;
  for (int x = 0; x < 60; ++x)
    for (int y = 0; y < 60; ++y)
      cloud.positions.push_back({0.1F * static_cast<float>(x), 0.1F * static_cast<float>(y), 0});
  for (std::size_t i = 0; i < 400; ++i) {
    Random random(6, 0, i);
    cloud.positions.push_back(
        vec_cast<float>(Vec3d{random.uniform(0, 6), random.uniform(0, 6), random.uniform(1, 5)}));
  }
  BuildOptions options = consistent_options();
  std::get<ConsistentOptions>(options.recipe).isolated = 100;
  const Built built = build_consistent(cloud, 2, options);
  EXPECT_FALSE(built.report.consistent->sparse);
  EXPECT_GT(built.report.consistent->splats_limited, 50U);
  // A few centres are nearer to another point than to their own.
  EXPECT_NEAR(static_cast<double>(built.report.consistent->splats_limited),
              static_cast<double>(count_at_limit(built.model, cloud.positions)), 5);
}

TEST(ConsistentModel, PredictsBeamsItNeverSaw) {
  const SplatModel& model = room_model().model;
  expect_sound(room_model());
  const Executor executor(2);
  const auto tracer = make_cpu_tracer(model.view(), executor);
  std::vector<Ray> rays;
  std::vector<double> expected_m;
  std::vector<bool> at_pillar, at_edge;
  for (std::size_t i = 0; i < 8000; ++i) {
    Random random(2, 0, i);
    const Vec3d sensor = {random.uniform(1, 4), random.uniform(0.9, 1.4), random.uniform(1, 1.4)};
    const double azimuth_rad = random.uniform(0, 6.2831853);
    const Vec3d direction = direction_of(azimuth_rad, random.uniform(-0.6, 0.6));
    Ray ray;
    ray.origin = vec_cast<float>(sensor);
    ray.direction = vec_cast<float>(direction);
    rays.push_back(ray);
    const Measured truth = measure(sensor, direction, false);
    expected_m.push_back(truth.range_m);
    at_pillar.push_back(truth.label == kPole);
    at_edge.push_back(is_at_edge(sensor, direction));
  }
  std::vector<Hit> hits(rays.size());
  tracer->nearest(rays, hits, executor);
  int all_good = 0, faces = 0, faces_good = 0, pillar = 0, pillar_good = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const int good = hits[i].valid() && std::fabs(hits[i].t - expected_m[i]) < 0.02 ? 1 : 0;
    all_good += good;
    if (at_edge[i]) continue;
    ++faces;
    faces_good += good;
    if (!at_pillar[i]) continue;
    ++pillar;
    pillar_good += good;
  }
  EXPECT_GT(all_good, 0.96 * 8000);
  EXPECT_GT(faces, 6000);
  EXPECT_GT(faces_good, 0.99 * faces);
  EXPECT_GT(pillar, 100);
  EXPECT_GT(pillar_good, 0.9 * pillar);
}

TEST(ConsistentModel, FlatRoomTakesFewSplats) {
  const PointCloud cloud = scanned_room();
  const FusedPoints fused = fuse_points(cloud.positions, 0.05, Executor(2));
  EXPECT_LT(room_model().model.size(), fused.size() / 4);
}

TEST(ConsistentModel, SurfacesThatLaterRaysPassThroughLeaveAlmostNoSplats) {
  // The floor under the passer-by is none of it.
  const Box above_floor = {{kPasserby.low.x, kPasserby.low.y, 0.2}, kPasserby.high};
  const PointCloud cloud = scanned_room();
  const auto points = std::count_if(cloud.positions.begin(), cloud.positions.end(),
                                    [&](Vec3f p) { return above_floor.contains(p, 0.05); });
  EXPECT_GT(points, 300);
  // Specks of the smallest size that three of their own points bear out.
  const auto in_passerby = [&](const Disk& disk) {
    return above_floor.contains(disk.center, 0.05);
  };
  double area_m2 = 0;
  for (const Disk& disk : opaque_disks(room_model().model))
    if (in_passerby(disk)) area_m2 += static_cast<double>(disk.radius * disk.radius);
  EXPECT_LT(area_m2 * 3.1416, 0.04);
  EXPECT_GT(splats_in(room_model().model, kPillar, 0.05), 10U);
  EXPECT_TRUE(room_model().report.ray_checked);
  // Without the rays it stays: that is what the check is for.
  BuildOptions unchecked = consistent_options();
  std::get<ConsistentOptions>(unchecked.recipe).balance_rounds = 0;
  const Built built = build_consistent(cloud, 2, unchecked);
  EXPECT_GE(splats_in(built.model, above_floor, 0.05), 5U);
  EXPECT_FALSE(built.report.ray_checked);
  EXPECT_TRUE(built.warnings.texts.empty());
}

/// A wall, seen up to its upper edge every 10 cm from 8 m away, by 12 scans from different
/// positions.
PointCloud scanned_wall(bool with_empty_beams) {
  PointCloud cloud;
  for (int scan = 0; scan < 12; ++scan) {
    const Vec3f sensor{8, 0.31F * static_cast<float>(scan), 0};
    for (int column = -20; column <= 20; ++column) {
      for (int row = 0; row < 40; ++row) {
        const auto phase = 0.1F * static_cast<float>(scan % 4) / 4;
        const Vec3f end{0, 0.1F * static_cast<float>(column) + phase,
                        0.1F * static_cast<float>(row) + phase};
        if (end.z < 2) {
          cloud.positions.push_back(end);
          cloud.sensor_positions.push_back(sensor);
          cloud.scan_indices.push_back(static_cast<std::uint32_t>(scan));
        } else if (with_empty_beams) {
          cloud.empty_beams.push_back(
              {sensor, normalized(end - sensor), static_cast<std::uint32_t>(scan)});
        }
      }
    }
  }
  return cloud;
}

// Nothing was measured above the edge, so only empty beams limit the disks.
TEST(ConsistentModel, BeamsWithoutReturnEndDisksAtEdges) {
  const auto overhang_m2 = [](bool with_empty_beams) {
    const Built built = build_consistent(scanned_wall(with_empty_beams));
    EXPECT_EQ(built.report.consistent->empty_beams > 0, with_empty_beams);
    const std::unique_ptr<Tracer> tracer = make_cpu_tracer(built.model.view(), Executor(2));
    // Of a grid of rays from the front.
    std::vector<Ray> rays;
    for (int i = 0; i < 100; ++i)
      for (int k = 0; k < 100; ++k)
        rays.push_back(
            {{5, -1.5F + 0.03F * static_cast<float>(i), 2.01F + 0.01F * static_cast<float>(k)},
             0,
             {-1, 0, 0},
             10});
    std::vector<Hit> hits(rays.size());
    tracer->nearest_hits(rays, 1, hits, Executor(2));
    return 0.0003 * static_cast<double>(
                        std::ranges::count_if(hits, [](const Hit& hit) { return hit.valid(); }));
  };
  const double without = overhang_m2(false), with = overhang_m2(true);
  EXPECT_GT(without, 0.05);
  EXPECT_LT(with, 0.4 * without);
}

TEST(ConsistentModel, SplatsFaceTheSensor) {
  // All sensors are inside the room, outside the pillar. Exact for the walls; at edges normals lie
  // between those of two faces.
  const SplatModel& model = room_model().model;
  EXPECT_TRUE(room_model().report.oriented);
  std::size_t turned_away = 0;
  for (const Disk& disk : model.disks)
    if (dot(disk.normal, Vec3f{2.5F, 1, 1.2F} - disk.center) < 0) ++turned_away;
  EXPECT_LT(turned_away, model.size() / 50);
}

TEST(ConsistentModel, ClassesAndIntensitiesAreThoseOfTheCells) {
  const SplatModel& model = room_model().model;
  EXPECT_EQ(model.method, "consistent");
  EXPECT_EQ(model.label_scheme, semantickitti_labels().name());
  EXPECT_TRUE(model.groups.empty());
  ASSERT_EQ(model.classes.size(), model.size());
  ASSERT_EQ(model.intensities.size(), model.size());
  int floor = 0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Vec3f c = model.disks[i].center;
    const bool at_wall = std::min({c.x, c.y, 5 - c.x, 4 - c.y}) < 0.1F;
    if (at_wall || kPillar.contains(c, 0.1) || kPasserby.contains(c, 0.1)) continue;
    EXPECT_EQ(model.classes[i], c.z < 1.2F ? kGround : kBuilding);
    EXPECT_FLOAT_EQ(model.intensities[i], c.z < 1.2F ? 0.25F : 0.75F);
    floor += c.z < 1.2F ? 1 : 0;
  }
  EXPECT_GT(floor, 50);
}

TEST(ConsistentModel, MajorityOfACellAndTheSmallestOfEquals) {
  // Five points a cell, all at one place: classes 50 50 40 40 80 give 40, intensities their mean.
  PointCloud cloud;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      const Vec3f p = {0.05F * static_cast<float>(x) + 0.02F, 0.05F * static_cast<float>(y) + 0.02F,
                       0.02F};
      for (const std::uint16_t label : {kBuilding, kBuilding, kGround, kGround, kPole}) {
        cloud.positions.push_back(p);
        cloud.classes.push_back(label);
        cloud.intensities.push_back(label);
      }
    }
  }
  const Built built = build_consistent(cloud);
  ASSERT_GT(built.model.size(), 0U);
  for (std::size_t i = 0; i < built.model.size(); ++i) {
    EXPECT_EQ(built.model.classes[i], 40);
    EXPECT_EQ(built.model.intensities[i], 52.0F);
    EXPECT_LT(std::fabs(built.model.disks[i].center.z - 0.02F), 1e-6F);
  }
  for (std::uint16_t& label : cloud.classes)
    if (label == 40) label = 10;  // cars can move
  BuildOptions options = consistent_options();
  options.remove = DynamicRemoval::movable;
  const Built removed = build_consistent(cloud, 2, options);
  EXPECT_EQ(removed.report.points_dynamic, 800U);
  EXPECT_EQ(removed.report.points_used, 1200U);
  ASSERT_GT(removed.model.size(), 0U);
  EXPECT_EQ(removed.model.classes[0], 50);
}

/// Small neighbourhoods: enough for the bytes.
ConsistentOptions quick_recipe() {
  ConsistentOptions recipe;
  recipe.planes.scales = {10, 20, 40, 40, 40};
  recipe.cover.neighbors = 40;
  return recipe;
}

BuildOptions quick_options() {
  BuildOptions options = consistent_options();
  options.recipe = quick_recipe();
  return options;
}

PointCloud thin_room() {
  const PointCloud cloud = scanned_room();
  std::vector<std::uint32_t> some;
  for (std::uint32_t i = 0; i < cloud.size(); i += 2) some.push_back(i);
  return gather(cloud, some);
}

TEST(ConsistentModel, OrderOfPointsAndThreadsDoNotChangeTheBytes) {
  PointCloud cloud = thin_room();
  // Equal positions with other attributes must not make the order matter either.
  for (std::size_t i = 0; i < 300; ++i) cloud.positions[i + 1000] = cloud.positions[i];
  const SplatModel one = build_consistent(cloud, 1, quick_options()).model;
  EXPECT_GT(one.size(), 500U);
  std::vector<std::uint32_t> order(cloud.size());
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t i = order.size(); i-- > 1;)
    std::swap(order[i], order[Random(5, 0, i).next_bits() % (i + 1)]);
  EXPECT_TRUE(same_bytes(one, build_consistent(gather(cloud, order), 3, quick_options()).model));
}

TEST(ConsistentModel, WarnsOnceAboutMissingSensorPositions) {
  PointCloud cloud = thin_room();
  cloud.sensor_positions.clear();
  const Built built = build_consistent(cloud, 2, quick_options());
  expect_sound(built);
  EXPECT_GT(built.model.size(), 500U);
  EXPECT_FALSE(built.report.ray_checked);
  EXPECT_FALSE(built.report.oriented);
  ASSERT_EQ(built.warnings.texts.size(), 1U);
  EXPECT_NE(built.warnings.texts[0].find("no sensor positions"), std::string::npos);
  EXPECT_TRUE(room_model().warnings.texts.empty());
  std::vector<std::uint32_t> backward(cloud.size());
  std::iota(backward.rbegin(), backward.rend(), 0U);
  EXPECT_TRUE(
      same_bytes(built.model, build_consistent(gather(cloud, backward), 3, quick_options()).model));
}

/// With sensor positions that are off by 5 m, as the nearest pose of a trajectory may be.
PointCloud with_false_origins(PointCloud cloud, OriginKind kind) {
  for (Vec3f& sensor : cloud.sensor_positions) sensor = sensor + Vec3f{4, 3, 0};
  cloud.origin_kinds.assign(cloud.size(), kind);
  return cloud;
}

TEST(ConsistentModel, GuessedOriginsMakeNoRays) {
  const PointCloud cloud = thin_room();
  const Built guessed =
      build_consistent(with_false_origins(cloud, OriginKind::guessed), 2, quick_options());
  BuildOptions trusting = quick_options();
  trusting.trust_origins = true;  // else it is an error
  const Built believed =
      build_consistent(with_false_origins(cloud, OriginKind::measured), 2, trusting);
  EXPECT_FALSE(guessed.report.ray_checked);
  EXPECT_TRUE(guessed.report.oriented);
  EXPECT_TRUE(believed.report.ray_checked);
  ASSERT_EQ(guessed.warnings.texts.size(), 1U);
  EXPECT_NE(guessed.warnings.texts[0].find("guessed"), std::string::npos);
  // The same disks as without any origin, but for the side that they face.
  PointCloud bare = cloud;
  bare.sensor_positions.clear();
  const SplatModel plain = build_consistent(bare, 2, quick_options()).model;
  ASSERT_EQ(guessed.model.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_TRUE(guessed.model.disks[i].center == plain.disks[i].center);
    EXPECT_EQ(guessed.model.disks[i].radius, plain.disks[i].radius);
  }
}

TEST(ConsistentModel, SomePointsMayLackAnOrigin) {
  PointCloud cloud = thin_room();
  const std::size_t all = build_consistent(cloud, 2, quick_options()).model.size();
  cloud.origin_kinds.assign(cloud.size(), OriginKind::measured);
  EXPECT_TRUE(same_bytes(build_consistent(cloud, 1, quick_options()).model,
                         build_consistent(thin_room(), 2, quick_options()).model));
  double middle_m = 0;
  for (const Vec3f p : cloud.positions)
    middle_m += static_cast<double>(p.x) / static_cast<double>(cloud.size());
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!(static_cast<double>(cloud.positions[i].x) > middle_m)) continue;
    cloud.origin_kinds[i] = OriginKind::none;
    cloud.sensor_positions[i] = cloud.positions[i];
    ++unknown;
  }
  ASSERT_GT(unknown, cloud.size() / 10);
  ASSERT_LT(unknown, cloud.size() - cloud.size() / 10);
  const Built mixed = build_consistent(cloud, 2, quick_options());
  expect_sound(mixed);
  EXPECT_TRUE(mixed.report.ray_checked);
  EXPECT_FALSE(mixed.report.oriented);
  EXPECT_EQ(mixed.report.origins[static_cast<std::size_t>(OriginKind::none)], unknown);
  ASSERT_EQ(mixed.warnings.texts.size(), 1U);
  EXPECT_NE(mixed.warnings.texts[0].find(std::to_string(unknown)), std::string::npos);
  EXPECT_GT(mixed.model.size(), all / 2);
  std::vector<std::uint32_t> backward(cloud.size());
  std::iota(backward.rbegin(), backward.rend(), 0U);
  EXPECT_TRUE(
      same_bytes(mixed.model, build_consistent(gather(cloud, backward), 3, quick_options()).model));
}

std::optional<ErrorKind> kind_of_error(PointCloud cloud, const BuildOptions& options) {
  try {
    build_consistent(std::move(cloud), 1, options);
  } catch (const Error& error) {
    return error.kind();
  }
  return std::nullopt;
}

TEST(ConsistentModel, NoPointsAreAnError) {
  EXPECT_EQ(kind_of_error({}, consistent_options()), ErrorKind::data);
  PointCloud cars;  // all removed
  cars.positions.resize(5);
  cars.classes.resize(5, 10);
  BuildOptions options = consistent_options();
  options.remove = DynamicRemoval::movable;
  EXPECT_EQ(kind_of_error(cars, options), ErrorKind::data);
}

TEST(ConsistentModel, OptionsOutOfRangeAreAnError) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  const auto kind_with = [&](auto change) {
    BuildOptions options = consistent_options();
    change(std::get<ConsistentOptions>(options.recipe));
    return kind_of_error(cloud, options);
  };
  EXPECT_EQ(kind_with([](ConsistentOptions&) {}), std::nullopt);
  for (const double cell_m : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(kind_with([&](ConsistentOptions& o) { o.cell_m = cell_m; }), ErrorKind::usage);
  EXPECT_EQ(kind_with([](ConsistentOptions& o) { o.evidence_rays = 0; }), ErrorKind::usage);
  EXPECT_EQ(kind_with([](ConsistentOptions& o) { o.evidence.parts = 3; }), ErrorKind::usage);
}

TEST(ConsistentModel, DegenerateCloudsFinish) {
  for (const bool with_sensor : {false, true}) {
    const auto cloud_of = [&](std::vector<Vec3f> points) {
      PointCloud cloud;
      cloud.positions = std::move(points);
      if (with_sensor) cloud.sensor_positions.resize(cloud.size(), {0, 0, 1.7F});
      return cloud;
    };
    // No extent, no radius, no splat.
    EXPECT_EQ(build_consistent(cloud_of({{3, 1, 1}})).model.size(), 0U);
    EXPECT_EQ(build_consistent(cloud_of(std::vector<Vec3f>(5000, {3, 1, 1}))).model.size(), 0U);
    // Points at the sensor itself have no direction.
    EXPECT_EQ(build_consistent(cloud_of(std::vector<Vec3f>(50, {0, 0, 1.7F}))).model.size(), 0U);
    for (const int n : {2, 7, 9, 500}) {
      std::vector<Vec3f> line, plane;
      for (int i = 0; i < n; ++i) {
        line.push_back({0.05F * static_cast<float>(i), 0, 0});
        plane.push_back({0.1F * static_cast<float>(i % 20), 0.1F * static_cast<float>(i / 20), 0});
      }
      expect_sound(build_consistent(cloud_of(line)));
      expect_sound(build_consistent(cloud_of(plane)));
      // Outliers far beyond what floats can square.
      plane.insert(plane.end(), {{1e30F, 0, 0}, {0, -3e38F, 0}, {1e12F, 1e12F, 0}});
      if (n < 300) {  // most of the points
        EXPECT_THROW(build_consistent(cloud_of(plane)), Error);
      } else {
        expect_sound(build_consistent(cloud_of(plane)));
      }
    }
  }
}

TEST(ConsistentModel, AStationKeepsTheFloorAroundIt) {
  const Vec3f station = {0, 0, 1.5F};
  PointCloud cloud;
  for (int ring = 10; ring < 85; ++ring) {  // beams down to 10 degrees from the vertical
    for (int a = 0; a < 720; ++a) {
      const double azimuth = a * std::numbers::pi / 360;
      const double out = 1.5 * std::tan(ring * std::numbers::pi / 180);
      if (out > 5) continue;
      cloud.positions.push_back({static_cast<float>(out * std::cos(azimuth)),
                                 static_cast<float>(out * std::sin(azimuth)), 0});
    }
  }
  cloud.sensor_positions.assign(cloud.size(), station);
  cloud.origin_kinds.assign(cloud.size(), OriginKind::stated);
  const std::size_t points = cloud.size();
  const Built built = build_consistent(std::move(cloud));
  ASSERT_TRUE(built.report.consistent);
  EXPECT_EQ(built.report.consistent->rays, points);  // not only those from 2 m on
  std::vector<Ray> rays;
  for (const double out : {0.4, 0.6, 0.9, 1.2, 1.8}) {
    for (int a = 3; a < 360; a += 10) {
      const double azimuth = a * std::numbers::pi / 180;
      const Vec3d end = {out * std::cos(azimuth), out * std::sin(azimuth), -1.5};
      Ray& ray = rays.emplace_back();
      ray.origin = station;
      ray.direction = vec_cast<float>(end / length(end));
    }
  }
  const Executor executor(1);
  std::vector<Hit> hits(rays.size());
  make_cpu_tracer(built.model.view(), executor)->nearest(rays, hits, executor);
  for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_TRUE(hits[i].valid()) << "beam " << i;
}

/// Adds points of a second place 21 km away.
void add_far_points(int count, PointCloud& cloud) {
  for (int i = 0; i < count; ++i) {
    PointCloud far;
    const float along = 0.03F * static_cast<float>(i % 20);
    far.positions = {{21000.0F + along, 0.03F * static_cast<float>(i / 20), 1}};
    far.sensor_positions = {{20990, 0, 1}};
    far.classes.assign(cloud.classes.empty() ? 0 : 1, 40);
    far.intensities.assign(cloud.intensities.empty() ? 0 : 1, 0.5F);
    append(cloud, std::move(far));
  }
}

// Oracle: the model without them. Cells of 2 cm reach 21 km; beyond, points shared the last ones.
TEST(ConsistentModel, PointsOutOfRangeAreSkippedWithAWarning) {
  PointCloud cloud = scanned_room();
  const std::size_t points = cloud.size();
  const int few = static_cast<int>(points / 200);
  const Built expected = build_consistent(cloud);
  add_far_points(few, cloud);
  const Built built = build_consistent(cloud);
  EXPECT_EQ(built.report.points_noise, static_cast<std::size_t>(few));
  EXPECT_EQ(built.report.points_used, points);
  ASSERT_EQ(built.warnings.texts.size(), 1U);
  EXPECT_NE(
      built.warnings.texts[0].find(std::to_string(few) + " of " + std::to_string(cloud.size()) +
                                   " points are more than 21 km"),
      std::string::npos)
      << built.warnings.texts[0];
  EXPECT_EQ(built.model.size(), expected.model.size());
}

TEST(ConsistentModel, ManyPointsOutOfRangeAreAnError) {
  PointCloud cloud = scanned_room();
  add_far_points(static_cast<int>(cloud.size() / 50), cloud);
  EXPECT_THROW(build_consistent(cloud), Error);
}

/// What the recipe makes of a cloud in canonical order.
struct Made {
  std::vector<Disk> disks;
  std::vector<std::uint32_t> cells;  ///< of each disk, in `fused`
  FusedPoints fused;
  ConsistentReport report;
  bool checked = false;
  std::vector<std::string> steps;
};

Made disks_of(const PointCloud& cloud, const ConsistentOptions& options) {
  const Executor executor(2);
  const auto steps = make_cpu_consistent_steps(executor);
  EXPECT_EQ(steps->load(cloud, {}), cloud.size());
  Made made;
  const auto note_step = [&](std::string_view name, int) { made.steps.emplace_back(name); };
  made.report = consistent_disks(*steps, cloud.has_beams(), options, note_step);
  made.checked = made.report.checked;
  ConsistentState state = dynamic_cast<const ShowsConsistentState&>(*steps).state();
  for (std::uint32_t i = 0; i < state.chosen.size(); ++i) {
    if (!(state.chosen[i].radius > 0)) continue;
    made.disks.push_back(state.chosen[i]);
    made.cells.push_back(i);
  }
  made.fused = std::move(state.fused);
  EXPECT_TRUE(same_bytes(steps->take_splats().disks, made.disks));
  return made;
}

PointCloud ordered(const PointCloud& cloud) {
  return gather(cloud, canonical_order(cloud, Executor(2)));
}

TEST(ConsistentDisks, CellsBelongToTheirDisks) {
  // Every disk is at its cell: off its mean by at most the shifts to the plane and to the rays.
  const PointCloud cloud = ordered(thin_room());
  const ConsistentOptions options = quick_recipe();
  const Made made = disks_of(cloud, options);
  EXPECT_TRUE(made.checked);
  ASSERT_EQ(made.cells.size(), made.disks.size());
  const double max_m = options.planes.max_shift_m + options.settle.max_shift_m;
  for (std::size_t i = 0; i < made.disks.size(); ++i) {
    const Vec3f mean = made.fused.positions[made.cells[i]];
    EXPECT_LE(length(made.disks[i].center - mean), max_m + 1e-5);
  }
  const std::vector<std::string> expected = {"fusion",
                                             "planes",
                                             "check of sensor positions",
                                             "visibility check of seeds",
                                             "cover",
                                             "visibility check of splats",
                                             "settling",
                                             "filling",
                                             "refinement"};
  EXPECT_EQ(made.steps, expected);
  EXPECT_EQ(made.report.cells, made.fused.size());
  EXPECT_LE(made.report.seeds, made.report.cells);
  EXPECT_GT(made.report.seeds_removed, 0U);
  EXPECT_GE(made.report.seeds, made.report.seeds_removed + made.disks.size());
  EXPECT_GT(made.report.rays, cloud.size() / 2);
  EXPECT_LE(made.report.rays, cloud.size());
}

TEST(ConsistentDisks, StepsWithRaysAreLeftOutWithoutThem) {
  const std::vector<std::string> expected = {"fusion", "planes", "cover"};
  const PointCloud cloud = ordered(thin_room());
  ConsistentOptions options = quick_recipe();
  options.balance_rounds = 0;
  const Made without_rounds = disks_of(cloud, options);
  EXPECT_EQ(without_rounds.steps, expected);
  EXPECT_FALSE(without_rounds.checked);
  PointCloud without_sensors = cloud;
  without_sensors.sensor_positions.clear();
  const Made made = disks_of(without_sensors, quick_recipe());
  EXPECT_EQ(made.steps, expected);
  EXPECT_FALSE(made.checked);
}

/// Which points' rays meet no disk up to `beyond_m` behind their ends.
std::vector<bool> points_missed(const PointCloud& cloud, const Made& made, double min_range_m,
                                float beyond_m) {
  const Executor executor(2);
  const MeasuredRays rays(cloud, min_range_m, executor);
  const auto tracer = make_cpu_tracer({made.disks, nullptr}, executor);
  std::vector<Ray> cast;
  for (std::size_t i = 0; i < rays.size(); ++i) cast.push_back(rays.ray(i, beyond_m));
  std::vector<Hit> hits(cast.size());
  tracer->nearest(cast, hits, executor);
  std::vector<bool> missed(cloud.size());
  for (std::size_t i = 0; i < hits.size(); ++i) missed[rays.point(i)] = !hits[i].valid();
  return missed;
}

TEST(ConsistentDisks, FillingAddsSplatsWhereRaysFallBetweenAndChangesNoOther) {
  const PointCloud cloud = ordered(thin_room());
  ConsistentOptions options = quick_recipe();
  options.cover.overlap = 0.95;  // leaves gaps between disks
  options.refine = false;
  options.fill = false;
  const Made bare = disks_of(cloud, options);
  options.fill = true;
  const Made filled = disks_of(cloud, options);
  const auto missed = points_missed(cloud, bare, options.min_range_m, options.missed_m);
  std::size_t i = 0, added = 0;
  for (std::size_t k = 0; k < filled.disks.size(); ++k) {
    if (i < bare.disks.size() && bare.cells[i] == filled.cells[k]) {
      EXPECT_EQ(std::memcmp(&bare.disks[i], &filled.disks[k], sizeof(Disk)), 0);
      ++i;
      continue;
    }
    ++added;
    const auto points = filled.fused.points_of(filled.cells[k]);
    EXPECT_TRUE(std::any_of(points.begin(), points.end(), [&](auto p) { return missed[p]; }));
  }
  EXPECT_EQ(i, bare.disks.size());  // all are still there
  EXPECT_EQ(filled.report.splats_filled, added);
  EXPECT_EQ(bare.report.splats_filled, 0U);
  EXPECT_GT(added, 20U);
  const auto still = points_missed(cloud, filled, options.min_range_m, options.missed_m);
  EXPECT_LT(std::count(still.begin(), still.end(), true),
            std::count(missed.begin(), missed.end(), true) - 20);
}

TEST(ConsistentDisks, SmallCellsAreUsedWhereTheSurfaceIsNotFlat) {
  const PointCloud cloud = ordered(thin_room());
  ConsistentOptions options = quick_recipe();
  const FusedPoints large = fuse_points(cloud.positions, options.cell_m, Executor(1));
  options.small_cell_m = 0;
  const Made whole = disks_of(cloud, options);
  EXPECT_EQ(whole.fused.positions, large.positions);
  EXPECT_EQ(whole.fused.members, large.members);
  options.small_cell_m = 0.02;
  options.split_scale = 255;  // every cell
  const FusedPoints small = fuse_points(cloud.positions, 0.02, Executor(1));
  EXPECT_EQ(disks_of(cloud, options).fused.positions, small.positions);
  // Oracle: the cells' scales where all scales may be taken.
  const PointIndex index = PointIndex::from_sorted(large.positions, Executor(1));
  const auto planes = adaptive_planes(large, index, options.planes, Executor(1));
  std::size_t before = large.size();
  for (std::uint8_t scale = 0; scale < 2; ++scale) {
    std::vector<std::uint8_t> split;
    for (const LocalPlane& plane : planes) split.push_back(plane.scale <= scale ? 1 : 0);
    options.split_scale = scale;
    const FusedPoints some = disks_of(cloud, options).fused;
    const FusedPoints expected = split_cells(cloud.positions, large, split, 0.02, Executor(1));
    EXPECT_EQ(some.positions, expected.positions);
    EXPECT_EQ(some.members, expected.members);
    EXPECT_GT(some.size(), before);
    EXPECT_LT(some.size(), small.size());
    before = some.size();
  }
}

// Oracle: a seed in a sector of the angle w that a straight border cuts off d away stands no
// farther than d / cos(w); disks reach half a seed beyond it.
TEST(ConsistentDisks, WithoutSensorPositionsDisksEndWhereAFlatPatchEnds) {
  PointCloud cloud;
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 50; ++x)
      cloud.positions.push_back(
          {0.05F * static_cast<float>(x) + 0.02F, 0.05F * static_cast<float>(y) + 0.02F, 0.02F});
  constexpr float kEnd_m = 0.05F * 49 + 0.02F;
  ConsistentOptions options = ConsistentOptions();
  const auto farthest_over_border = [](const Made& made) {
    float farthest_m = 0;
    for (const Disk& disk : made.disks)
      for (const float c : {disk.center.x, disk.center.y})
        farthest_m = std::max({farthest_m, disk.radius - (c - 0.02F), disk.radius - (kEnd_m - c)});
    return farthest_m;
  };
  for (const int sectors : {8, 16}) {
    options.cover.unchecked_sectors = sectors;
    const Made made = disks_of(cloud, options);
    EXPECT_FALSE(made.checked);
    ASSERT_GT(made.disks.size(), 50U);
    float min_m = 1, largest_m = 0;
    for (const Disk& disk : made.disks) {
      min_m = std::min(min_m, disk.radius);
      largest_m = std::max(largest_m, disk.radius);
    }
    EXPECT_LT(min_m, 0.06F);  // a seed
    EXPECT_GT(largest_m, 0.3F);
    const float cosine = std::cos(6.2831853F / static_cast<float>(sectors));
    for (const Disk& disk : made.disks) {
      const Vec3f c = disk.center;
      const float inside_m = std::min({c.x - 0.02F, c.y - 0.02F, kEnd_m - c.x, kEnd_m - c.y});
      EXPECT_LE(disk.radius, std::max(min_m, inside_m / cosine + 0.5F * min_m) + 1e-4F);
    }
  }
  // With 16 that is no farther over the border than a seed, give or take.
  EXPECT_LT(farthest_over_border(disks_of(cloud, options)), 0.06F);
  options.cover.unchecked_sectors = 0;
  EXPECT_GT(farthest_over_border(disks_of(cloud, options)), 0.2F);
}

}  // namespace
}  // namespace adasplats
