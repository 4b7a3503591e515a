// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/simulate/gpu_scene.h"
#include "adasplats/simulate/scan/scan_rules.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {
namespace {

constexpr Vec3d kPlaceOrigin = {1000, 2000, 30};

Vec3f any_direction(Random& random) {
  const Vec3d v = {random.normal(), random.normal(), random.normal()};
  return vec_cast<float>(normalized(v));
}

/// All inputs of a report.
struct ReportCase {
  LidarModel sensor;
  SimulateOptions options;
  RayDropModel ray_drop;
  bool drops = false;
  bool moves = false;
  bool has_classes = false;
  bool has_intensities = false;
  bool has_response = false;
  bool has_objects = false;
  std::shared_ptr<World> world;  ///< of `has_objects`
};

SensorIntensity some_unit(std::size_t rings) {
  SensorIntensity unit;
  unit.step = 0.01;
  unit.highest = 0.99;
  unit.ring_nodes = 3;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const float gain = 0.8F + 0.1F * static_cast<float>(ring);
    for (const float node : {0.1F, 0.5F, 0.9F}) {
      unit.ring_expected.push_back(node);
      unit.ring_level.push_back(gain * node);
    }
  }
  unit.levels = {0.1F, 0.4F, 0.8F};
  unit.zero_share = {0.4F, 0.1F, 0.01F};
  for (const float level : unit.levels)
    for (std::size_t k = 0; k < kTextureNodes; ++k)
      unit.reported.push_back(level * (0.4F + 0.08F * static_cast<float>(k)));
  return unit;
}

SensorFields some_fields(std::uint32_t rings) {
  SensorFields fields{2, rings, 37, {}};
  for (std::uint64_t i = 0; i < std::uint64_t{2} * rings * 37 * kSensorFields; ++i)
    fields.bytes.push_back(static_cast<std::uint8_t>(Random(4, 0, i).next_bits()));
  return fields;
}

/// A named option and the function that sets it.
struct Option {
  const char* name;
  std::function<void(ReportCase&)> of;
};

std::vector<Option> options() {
  return {
      {"noise", [](ReportCase& s) { s.sensor.range_noise_m = 0.02; }},
      {"angles", [](ReportCase& s) { s.sensor.angular_noise_rad = 1e-3; }},
      {"resolution", [](ReportCase& s) { s.sensor.range_resolution_m = 0.004; }},
      {"offsets",
       [](ReportCase& s) {
         s.sensor.range_offsets_m = {0.03, -0.02, 0.1, 0, -0.05};
         s.options.sensor_offsets = true;
       }},
      {"depth", [](ReportCase& s) { s.options.beam.depth = 5; }},
      {"sub-rays", [](ReportCase& s) { s.options.beam.sub_rays = 7; }},
      {"many sub-rays", [](ReportCase& s) { s.options.beam.sub_rays = 19; }},
      {"two returns", [](ReportCase& s) { s.options.beam.returns = 2; }},
      {"last", [](ReportCase& s) { s.options.beam.mode = ReturnMode::last; }},
      {"drop", [](ReportCase& s) { s.drops = true; }},
      {"drop at edges",
       [](ReportCase& s) {
         s.drops = true;
         s.ray_drop.edge_runs = {0.2, 0.1, 0.05, 0, 0.1};
       }},
      {"unit's fields",
       [](ReportCase& s) {
         s.sensor.ring_noise_m = {0.01, 0.02, 0, 0.005, 0.03};
         s.sensor.fields = some_fields(5);
       }},
      {"vehicle's body",
       [](ReportCase& s) {
         s.sensor.ring_noise_m = {0.01, 0.02, 0, 0.005, 0.03};
         VehicleBody body;
         for (std::uint16_t column = 100; column < 300; ++column)
           body.cells.push_back({3, column, 0.6F, 1 + 0.01F * column, 0.3F});
         s.sensor.body = body;
       }},
      {"vehicle's boxes",
       [](ReportCase& s) {
         s.sensor.body = VehicleBody{{{3, 5, 1, 2, 0.3F}}, {{{{}, {2, 1, -1}}, {1, 0.5, 0.4}}}};
       }},
      {"noise of rings",
       [](ReportCase& s) {
         s.sensor.ring_noise_m = {0.01, 0.02, 0, 0.005, 0.03};
       }},
      {"unit's intensities",
       [](ReportCase& s) {
         s.has_intensities = true;
         s.sensor.intensity = some_unit(5);
       }},
      {"rain", [](ReportCase& s) { s.options.weather.rain_mm_h = 60; }},
      {"fog", [](ReportCase& s) { s.options.weather.fog_visibility_m = 40; }},
      {"snow", [](ReportCase& s) { s.options.weather.snow_mm_h = 10; }},
      {"motion", [](ReportCase& s) { s.moves = true; }},
      {"deskewed",
       [](ReportCase& s) {
         s.moves = true;
         s.options.frame = PointFrame::deskewed;
       }},
      {"classes", [](ReportCase& s) { s.has_classes = true; }},
      {"objects", [](ReportCase& s) { s.has_objects = true; }},
      {"intensities", [](ReportCase& s) { s.has_intensities = true; }},
      {"response", [](ReportCase& s) { s.has_intensities = s.has_response = true; }},
      {"few fields",
       [](ReportCase& s) { s.options.fields.rings = s.options.fields.times = false; }},
  };
}

class ReportsOnGpu : public testing::TestWithParam<TracingBackend> {
 protected:
  void SetUp() override {
    const GpuSearch search = find_gpus();
    if (search.devices.empty()) GTEST_SKIP() << search.reason;
    for (std::uint64_t i = 0; i < 8000; ++i) {
      Random random(11, 0, i);
      const Vec3f outward = any_direction(random);
      const auto distance = static_cast<float>(random.uniform(3, 20));
      disks_.push_back({distance * outward, static_cast<float>(random.uniform(0.1, 0.6)),
                        any_direction(random)});
      classes_.push_back(static_cast<std::uint16_t>(i % 5));
      instances_.push_back(static_cast<std::uint16_t>(i % 300));
      intensities_.push_back(i % 17 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                         : static_cast<float>(random.uniform(0, 1)));
    }
    response_.ranges_m = {5, 10, 15};
    response_.range_gains = {1.3F, 1.0F, 0.6F};
    response_.cos_incidences = {0, 0.5F, 1};
    response_.incidence_gains = {0.1F, 0.7F, 1};
    scene_ = make_gpu_scene({disks_, nullptr}, kPlaceOrigin, GetParam(), {0});
    tracer_ = make_cpu_tracer({disks_, nullptr}, executor_);
    caster_ = make_cpu_scene_caster(*tracer_, kPlaceOrigin, executor_);
  }

  static ReportCase plain() {
    ReportCase setup;
    setup.sensor.elevations_rad = {0.3, 0.2, 0.1, 0, -0.1};
    setup.sensor.columns = 181;  // no multiple of a block
    for (int i = 0; i < 5; ++i) {
      setup.sensor.beam_origins_m.push_back({0.05, 0.01 * i, 0.1});
      setup.sensor.firing_times_s.push_back(2e-6 * i);
    }
    setup.sensor.min_range_m = 0.5;
    setup.sensor.max_range_m = 18;
    setup.sensor.divergence_rad[0] = 0.02;
    setup.sensor.divergence_rad[1] = 0.01;
    setup.options.seed = 5;
    setup.ray_drop.weights = {-2, 0.5, 0.1, 0, 1, 0.5, -0.2, 0};
    setup.ray_drop.blocked = {{0.1F, -1.0F, 1.0F}};
    return setup;
  }

  std::unique_ptr<ScanRules> rules_of(ReportCase& setup) {
    if (setup.has_objects) setup.world = world();
    return rules_of_world(setup);
  }

  std::unique_ptr<ScanRules> rules_of_world(ReportCase& setup) {
    if (setup.drops) setup.options.ray_drop = setup.ray_drop;
    PrimitiveAttributes attributes;
    attributes.view = {disks_, nullptr};
    if (setup.has_classes) {
      attributes.classes = classes_;
      attributes.instances = instances_;
    }
    if (setup.has_intensities) attributes.intensities = intensities_;
    if (setup.has_response) attributes.response = &response_;
    if (setup.world) attributes = setup.world->attributes(attributes);
    return std::make_unique<ScanRules>(
        setup.sensor, firings_of(setup.sensor), setup.options,
        std::make_shared<PrimitiveTable>(primitive_table(attributes, executor_)));
  }

  static TimedPose object_pose(double time_s, Vec3d local, double yaw_rad) {
    return {time_s, {rotation_from_yaw_pitch_roll(yaw_rad, 0.05, 0), kPlaceOrigin + local}};
  }

  /// Meshes and splats near the sensor that turn, pass by, appear and disappear, or exist in only
  /// one scan.
  std::shared_ptr<World> world() const {
    auto world = std::make_shared<World>(static_cast<std::uint32_t>(disks_.size()), kPlaceOrigin);
    MeshModel wall;
    wall.mesh.vertices = {{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}};
    wall.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    SplatModel bush;
    for (std::uint64_t i = 0; i < 300; ++i) {
      Random random(12, 1, i);
      bush.disks.push_back({static_cast<float>(random.uniform(0, 900)) * any_direction(random),
                            static_cast<float>(random.uniform(50, 200)), any_direction(random)});
      bush.classes.push_back(static_cast<std::uint16_t>(i % 3));
      bush.intensities.push_back(static_cast<float>(random.uniform(0, 1)));
    }
    const std::size_t walls = world->add_geometry(wall);
    const std::size_t bushes = world->add_geometry(bush);
    const std::size_t once = world->add_geometry(wall);
    const auto add = [&](std::size_t geometry, Trajectory poses, bool only_during) {
      WorldObject object;
      object.geometry = geometry;
      object.trajectory = std::move(poses);
      object.only_during = only_during;
      object.instance = static_cast<std::uint16_t>(40 + world->object_count());
      if (geometry == bushes) object.scale = 1e-3;  // it is in millimetres
      if (geometry == once) object.only_scan = 9;   // of the scans 7 to 11
      world->add_object(std::move(object));
    };
    add(walls, {object_pose(0, {2, 0, 0}, 0), object_pose(0.5, {2, 2, 0}, 2)}, false);
    add(walls, {object_pose(0.13, {-2, -1, 0}, 0), object_pose(0.31, {-3, 1, 0}, -1)}, true);
    add(bushes, {object_pose(0, {0, 3, 0}, 0), object_pose(0.2, {-2, 3, 0.5}, 9)}, false);
    add(bushes, {object_pose(0, {0, -4, 0}, 1)}, false);
    add(once, {object_pose(0, {1.5, 1.5, 0}, 0.7)}, false);
    return world;
  }

  /// On the CPU; `by_gpu`: on the GPU.
  std::vector<Scan> reported(const ReportCase& setup, const ScanRules& rules,
                             std::span<const ScanMotion> motions, bool by_gpu) const {
    const SceneCaster& caster = by_gpu ? scene_->scan_caster() : *caster_;
    std::vector<Scan> scans;
    caster.report_world(rules, motions, 7, setup.world.get(), executor_,
                        [&](std::size_t i, Scan&& scan) {
                          EXPECT_EQ(i, scans.size());
                          scans.push_back(std::move(scan));
                        });
    return scans;
  }

  /// Some sensors are at rest; with `moves`, others move.
  static std::vector<ScanMotion> scans_of(bool moves) {
    const auto pose = [](double t) {
      return RigidTransform{rotation_from_yaw_pitch_roll(t, 0.1, -0.05),
                            kPlaceOrigin + Vec3d{t, -0.5 * t, 0.1}};
    };
    std::vector<ScanMotion> scans;
    for (std::size_t i = 0; i < 5; ++i) {
      const double t = 0.1 * static_cast<double>(i);
      scans.push_back({{t, pose(t)}, {}});
      for (std::size_t k = 0; moves && k < 2 * (i % 3); ++k)
        scans.back().knots.push_back(pose(t + 0.005 * static_cast<double>(k)));
    }
    return scans;
  }

  static std::vector<Scan> reported_by(const ScanCaster& caster, const ScanRules& rules,
                                       std::span<const ScanMotion> motions,
                                       const Executor& executor) {
    std::vector<Scan> scans;
    caster.report(rules, motions, 7, executor, [&](std::size_t i, Scan&& scan) {
      EXPECT_EQ(i, scans.size());
      scans.push_back(std::move(scan));
    });
    return scans;
  }

  static void expect_same(const std::vector<Scan>& found, const std::vector<Scan>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].rays, expected[i].rays);
      EXPECT_EQ(found[i].time_s, expected[i].time_s);
      EXPECT_EQ(found[i].knots.size(), expected[i].knots.size());
      EXPECT_EQ(found[i].duration_s, expected[i].duration_s);
      EXPECT_EQ(found[i].frame, expected[i].frame);
      EXPECT_TRUE(found[i].positions == expected[i].positions) << "positions of scan " << i;
      for_each_scan_attribute([&](const auto& attribute) {
        EXPECT_TRUE(attribute.of(found[i]) == attribute.of(expected[i]))
            << attribute.name << " of scan " << i;
      });
    }
  }

  Executor executor_{2};
  std::vector<Disk> disks_;
  std::vector<std::uint16_t> classes_, instances_;
  std::vector<float> intensities_;
  IntensityResponse response_;
  std::unique_ptr<GpuScene> scene_;
  std::unique_ptr<Tracer> tracer_;
  std::unique_ptr<SceneCaster> caster_;
};

// The documented guarantee: the same bytes as the CPU for every option. Oracle: the CPU.
TEST_P(ReportsOnGpu, AnyTwoOptionsMatchTheCpu) {
  const std::vector<Option> all = options();
  std::size_t returns = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i; j < all.size(); ++j) {
      SCOPED_TRACE(std::string(all[i].name) + " and " + all[j].name);
      ReportCase setup = plain();
      all[i].of(setup);
      all[j].of(setup);
      const auto rules = rules_of(setup);
      const std::vector<ScanMotion> motions = scans_of(setup.moves);
      const std::vector<Scan> expected = reported(setup, *rules, motions, false);
      expect_same(reported(setup, *rules, motions, true), expected);
      for (const Scan& scan : expected) returns += scan.size();
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(returns, 100'000U) << "the scene is hardly visible";
}

TEST_P(ReportsOnGpu, AllOptionsAtOnce) {
  ReportCase setup = plain();
  for (const Option& option : options()) option.of(setup);
  const auto rules = rules_of(setup);
  const std::vector<ScanMotion> motions = scans_of(true);
  expect_same(reported(setup, *rules, motions, true), reported(setup, *rules, motions, false));
}

// Oracle: the CPU, which counts them first.
TEST_P(ReportsOnGpu, ManyScansSeeObjects) {
  ReportCase setup = plain();
  setup.has_objects = setup.has_classes = true;
  const auto rules = rules_of(setup);
  std::vector<ScanMotion> motions;
  for (int i = 0; i < 30; ++i)
    for (const ScanMotion& motion : scans_of(true)) motions.push_back(motion);
  const std::vector<Scan> expected = reported(setup, *rules, motions, false);
  std::size_t of_objects = 0, of_the_one_scan = 0;
  for (const Scan& scan : expected)
    for (const std::uint16_t instance : scan.instances) {
      of_objects += instance >= 40 && instance < 45 ? 1 : 0;
      of_the_one_scan += instance == 44 ? 1 : 0;
    }
  EXPECT_GT(of_objects, 10'000U);
  EXPECT_GT(of_the_one_scan, 0U);
  expect_same(reported(setup, *rules, motions, true), expected);
  // The world grows, so cached geometries are invalid.
  WorldObject more;
  more.trajectory = {object_pose(0, {1, 0, 0}, 0)};
  setup.world->add_object(more);
  const auto more_rules = rules_of_world(setup);
  const auto with_more = reported(setup, *more_rules, motions, true);
  expect_same(with_more, reported(setup, *more_rules, motions, false));
  EXPECT_FALSE(with_more.front().positions == expected.front().positions);
}

TEST_P(ReportsOnGpu, BatchesContainTheScans) {
  ReportCase setup = plain();
  setup.has_classes = setup.has_intensities = true;
  setup.sensor.range_noise_m = 0.02;
  const auto rules = rules_of(setup);
  std::vector<ScanMotion> motions;
  for (int i = 0; i < 40; ++i)
    for (const ScanMotion& motion : scans_of(false)) motions.push_back(motion);
  const std::vector<Scan> expected = reported_by(*caster_, *rules, motions, executor_);
  std::vector<ScanBatch> kept;  // as Python may: batches own their memory
  std::size_t next = 0;
  scene_->scan_caster().report_batches(*rules, motions, 7, nullptr, executor_, BatchMemory::host,
                                       [&](ScanBatch&& batch) {
                                         EXPECT_EQ(batch.first, next);
                                         EXPECT_EQ(batch.device, -1);
                                         next += batch.scans();
                                         kept.push_back(std::move(batch));
                                       });
  ASSERT_EQ(next, motions.size());
  EXPECT_GT(kept.size(), 1U);
  std::vector<Scan> found;
  for (const ScanBatch& batch : kept) {
    for (std::size_t i = 0; i < batch.scans(); ++i) {
      found.emplace_back();
      ScanView(batch, i, motions[batch.first + i], *rules).copy_to(found.back());
    }
  }
  expect_same(found, expected);
}

TEST_P(ReportsOnGpu, BatchesOnTheDeviceAreCounted) {
  ReportCase setup = plain();
  const auto rules = rules_of(setup);
  const std::vector<ScanMotion> motions = scans_of(false);
  const std::vector<Scan> expected = reported_by(*caster_, *rules, motions, executor_);
  std::vector<ScanBatch> kept;
  scene_->scan_caster().report_batches(
      *rules, motions, 7, nullptr, executor_, BatchMemory::device,
      [&](ScanBatch&& batch) { kept.push_back(std::move(batch)); });
  std::size_t scan = 0;
  for (const ScanBatch& batch : kept) {
    EXPECT_EQ(batch.device, 0);
    EXPECT_NE(batch.arrays.positions, nullptr);
    EXPECT_EQ(batch.arrays.classes, nullptr);
    for (std::size_t i = 0; i < batch.scans(); ++i)
      EXPECT_EQ(batch.offsets[i + 1] - batch.offsets[i], expected[scan++].size());
  }
  EXPECT_EQ(scan, motions.size());
}

TEST_P(ReportsOnGpu, NoScansAndOtherRules) {
  ReportCase setup = plain();
  const auto rules = rules_of(setup);
  EXPECT_TRUE(reported_by(scene_->scan_caster(), *rules, {}, executor_).empty());
  const std::vector<ScanMotion> motions = scans_of(false);
  const auto first = reported_by(scene_->scan_caster(), *rules, motions, executor_);
  auto fewer = firings_of(setup.sensor);
  fewer.resize(100);
  rules->set_firings(fewer);
  expect_same(reported_by(scene_->scan_caster(), *rules, motions, executor_),
              reported_by(*caster_, *rules, motions, executor_));
}

INSTANTIATE_TEST_SUITE_P(Backends, ReportsOnGpu,
                         testing::Values(TracingBackend::cuda, TracingBackend::optix),
                         [](const auto& backend) {
                           return std::string(backend.param == TracingBackend::cuda ? "Cuda"
                                                                                    : "Optix");
                         });

}  // namespace
}  // namespace adasplats
