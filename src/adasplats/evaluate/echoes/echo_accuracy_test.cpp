// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/echoes/echo_accuracy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

TEST(DropAccuracy, CountsByHand) {
  BeamEchoes beams;
  const auto add = [&](bool hit, bool lost) {
    beams.echoes.push_back({10, 1, 0.3F});
    beams.hit.push_back(hit ? 1 : 0);
    beams.lost.push_back(lost ? 1 : 0);
    beams.places.push_back(0);
  };
  for (int i = 0; i < 3; ++i) add(false, true);  // right
  add(false, false);                             // predicted to be empty, but was not
  for (int i = 0; i < 2; ++i) add(true, true);   // missed
  for (int i = 0; i < 4; ++i) add(true, false);
  const DropAccuracy alone = drop_accuracy(beams, nullptr);
  EXPECT_EQ(alone.beams, 10U);
  EXPECT_EQ(alone.empty, 5U);
  EXPECT_DOUBLE_EQ(alone.precision(), 0.75);
  EXPECT_DOUBLE_EQ(alone.recall(), 0.6);
  EXPECT_DOUBLE_EQ(alone.f1(), 2 * 0.75 * 0.6 / (0.75 + 0.6));
  RayDropModel always;
  always.weights[0] = 1;
  EXPECT_DOUBLE_EQ(drop_accuracy(beams, &always).recall(), 1);
  EXPECT_DOUBLE_EQ(drop_accuracy(beams, &always).precision(), 0.5);
  RayDropModel never;
  never.weights[0] = -1;
  EXPECT_EQ(drop_accuracy(beams, &never).predicted, alone.predicted);
  const DropAccuracy none = drop_accuracy({}, nullptr);
  EXPECT_EQ(none.beams, 0U);
  EXPECT_TRUE(std::isnan(none.f1()));
}

/// Wide ground 1.7 m below the sensor, with reflectance 0.4 on the left and 0.8 on the right,
/// and what twelve beams measure of it in four scans, in files.
class MeasuredGround : public testing::Test {
 protected:
  static constexpr double kAboveGround_m = 1.9;  // the beams leave 0.2 m above the frame
  static constexpr std::size_t kFirings = 2150, kBeams = 12, kScans = 4;

  MeasuredGround()
      : folder(std::filesystem::temp_directory_path() /
               (std::string("adasplats_echo_") +
                testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder);
    // The left half is in the plane of the ground; the first of two hits counts.
    constexpr float kWide_m = 1e5F;
    disks = {{{5, 2 + kWide_m, 1.3F}, kWide_m, {0, 0, 1}}, {{5, 2, 1.3F}, 1000, {0, 0, 1}}};
    reflectances = {0.4F, 0.8F};
    response = {{2, 50}, {1.0F, 0.5F}, {0, 1}, {0.5F, 1}};
    sensor.rotation_hz = 10;
    sequence.folder = folder;
    sequence.beams.from_hdl64 = false;
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      sensor.elevations_rad.push_back(elevation_rad(beam));
      sensor.beam_origins_m.push_back({0, 0, 0.2});
    }
    for (std::size_t scan = 0; scan < kScans; ++scan) write_scan(scan);
  }
  ~MeasuredGround() override { std::filesystem::remove_all(folder); }

  static double elevation_rad(std::size_t beam) {
    return (-3 - 1.5 * static_cast<double>(beam)) * kDegree;
  }
  static double range_of(std::size_t beam) {
    return kAboveGround_m / -std::sin(elevation_rad(beam));
  }
  /// The four lowest beams see the vehicle to the left.
  static bool blocked(std::size_t beam, double azimuth_deg) {
    return beam >= 8 && azimuth_deg > 100 && azimuth_deg < 120;
  }

  void write_scan(std::size_t scan) {
    std::vector<float> values;
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      for (std::size_t k = 0; k < kFirings; ++k) {
        const double azimuth_deg =
            std::floor(static_cast<double>(k) * 4000.0 / kFirings) * 0.09 - 179.955;
        const double azimuth_rad = azimuth_deg * kDegree;
        Random random(9, scan, beam * kFirings + k);
        const double lost_of_far = range_of(beam) > 20 ? 0.3 : 0.05;
        if (blocked(beam, azimuth_deg) || random.uniform() < lost_of_far) {
          ++lost_beams;
          continue;
        }
        const double flat_m = range_of(beam) * std::cos(elevation_rad(beam));
        const float cosine = static_cast<float>(-std::sin(elevation_rad(beam)));
        const float reflectance = azimuth_deg > 0 ? 0.4F : 0.8F;
        values.insert(values.end(),
                      {static_cast<float>(flat_m * std::cos(azimuth_rad)),
                       static_cast<float>(flat_m * std::sin(azimuth_rad)), -1.7F,
                       reflectance * response.gain(static_cast<float>(range_of(beam)), cosine)});
      }
    }
    sequence.scans.push_back(folder / (std::to_string(scan) + ".bin"));
    std::ofstream(sequence.scans.back(), std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(float)));
    TimedPose pose;
    pose.time_s = static_cast<double>(scan);
    // Along the border of the two, so that all scans are alike.
    pose.world_from_sensor.translation = {105 + 3 * static_cast<double>(scan), 202, 3};
    sequence.trajectory.push_back(pose);
  }

  EchoScene scene(const Tracer& tracer) const {
    EchoScene scene{tracer, {}, {100, 200, 0}};
    scene.attributes.view = {disks, nullptr};
    scene.attributes.intensities = reflectances;
    scene.attributes.response = &response;
    return scene;
  }
  BeamEchoes collect(std::vector<std::size_t> indices, int threads = 2) const {
    const Executor executor(threads);
    const auto tracer = make_brute_force_tracer({disks, nullptr});
    ProgressSink progress;
    return collect_beam_echoes(scene(*tracer), sequence, indices, sensor,
                               still_scans(sequence.trajectory), executor, progress);
  }

  std::filesystem::path folder;
  std::vector<Disk> disks;
  std::vector<float> reflectances;
  IntensityResponse response;
  LidarModel sensor;
  KittiSequence sequence;
  std::size_t lost_beams = 0;
};

/// Oracle: geometry.
TEST_F(MeasuredGround, EveryBeamHasItsEcho) {
  const BeamEchoes beams = collect({0, 1, 2, 3});
  ASSERT_EQ(beams.size(), kScans * kBeams * kFirings);
  std::size_t lost = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::size_t beam = i / kFirings % kBeams;
    EXPECT_EQ(beams.hit[i], 1);
    EXPECT_NEAR(beams.echoes[i].range_m, range_of(beam), 2e-3);
    EXPECT_NEAR(beams.echoes[i].cos_incidence, -std::sin(elevation_rad(beam)), 1e-4);
    EXPECT_EQ(beams.places[i], i / (kBeams * kFirings));
    lost += beams.lost[i];
  }
  EXPECT_EQ(lost, lost_beams);
}

/// Oracle: what the scans were made with.
TEST_F(MeasuredGround, DropModelIsFoundAndForetellsOtherScans) {
  const RayDropModel model = fit_ray_drop(collect({0, 1, 2}));
  ASSERT_EQ(model.blocked.size(), 4U);
  for (const BlockedSector& sector : model.blocked) {
    EXPECT_NEAR(sector.azimuth_begin_rad / kDegree, 100, 1.01);
    EXPECT_NEAR(sector.azimuth_end_rad / kDegree, 120, 1.01);
  }
  EXPECT_NEAR(drop_probability(model, {static_cast<float>(range_of(0)),
                                       static_cast<float>(-std::sin(elevation_rad(0))), 0.4F}),
              0.3, 0.05);
  EXPECT_NEAR(drop_probability(model, {static_cast<float>(range_of(10)),
                                       static_cast<float>(-std::sin(elevation_rad(10))), 0.4F}),
              0.05, 0.02);
  const BeamEchoes other = collect({3});
  const DropAccuracy all = drop_accuracy(other, &model);
  EXPECT_GT(all.precision(), 0.9);  // blocked sectors; single drops are unpredictable
  EXPECT_NEAR(static_cast<double>(all.predicted), 4 * kFirings * 20.0 / 360, 60);
  const DropAccuracy free = drop_accuracy(other, &model, false);
  EXPECT_EQ(free.predicted, 0U);
  EXPECT_EQ(free.beams, all.beams - all.predicted);
}

// What blocks the beams of a standing vehicle may be part of the scene.
TEST_F(MeasuredGround, AStandingVehicleGivesNoBlockedSectors) {
  for (TimedPose& pose : sequence.trajectory) pose.world_from_sensor.translation = {105, 202, 3};
  EXPECT_TRUE(fit_ray_drop(collect({0, 1, 2})).blocked.empty());
}

TEST_F(MeasuredGround, SameBeamsForAnyNumberOfThreads) {
  const BeamEchoes one = collect({1}, 1), three = collect({1}, 3);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one.echoes[i].range_m, three.echoes[i].range_m);
    EXPECT_EQ(one.lost[i], three.lost[i]);
  }
}

/// Oracle: intensities made by the same response: the prediction is theirs, but for beams that
/// are taken to leave at the frame's origin, 0.2 m too low.
TEST_F(MeasuredGround, IntensitiesArePredicted) {
  const Executor executor(2);
  const auto tracer = make_brute_force_tracer({disks, nullptr});
  ProgressSink progress;
  const std::vector<std::size_t> indices = {0, 2};
  EchoScene with = scene(*tracer);
  const IntensityAccuracy good = intensity_accuracy(with, sequence, indices, executor, progress);
  EXPECT_GT(good.rank_correlation, 0.999);
  EXPECT_LT(good.mae, 0.01);
  EXPECT_GT(good.rays, kBeams * kFirings);
  with.attributes.response = nullptr;
  EXPECT_LT(intensity_accuracy(with, sequence, indices, executor, progress).rank_correlation, 0.98);
  with.attributes.intensities = {};
  EXPECT_THROW(intensity_accuracy(with, sequence, indices, executor, progress), Error);
  const std::vector<float> unknown(disks.size(), kNaN);
  with.attributes.intensities = unknown;
  EXPECT_THROW(intensity_accuracy(with, sequence, indices, executor, progress), Error);
}

TEST_F(MeasuredGround, ErrorsNameTheScan) {
  std::ofstream(sequence.scans[1], std::ios::binary | std::ios::trunc).close();
  try {
    collect({1});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("1.bin"), std::string::npos);
  }
}

}  // namespace
}  // namespace adasplats
