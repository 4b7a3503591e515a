// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/beams/empty_beams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "adasplats/cloud/beams/spinning_sensor_test.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

SpinningSensor level() {
  SpinningSensor sensor = SpinningSensor::with(24, 26, -20);
  sensor.world_from_sensor = rotation_from_yaw_pitch_roll(0.4, 0.05, -0.03);
  return sensor;
}

SpinningSensor pitched() {
  SpinningSensor sensor = SpinningSensor::with(32, 10.67, -30.67);
  sensor.world_from_sensor = rotation_from_yaw_pitch_roll(0.15, 45 * kDegree, 0.02);
  return sensor;
}

std::vector<EmptyBeam> found_in(const std::vector<TestBeam>& beams, const SpinningSensor& sensor,
                                bool with_lasers, int threads = 2) {
  PointCloud cloud = cloud_of(beams);
  if (with_lasers) add_lasers_and_poses(cloud, beams, sensor.world_from_sensor);
  return find_empty_beams(cloud, {}, Executor(threads));
}

double distance_between(const EmptyBeam& found, const TestBeam& beam) {
  return length(vec_cast<double>(found.direction) - beam.direction);
}

/// Of the true beams that went upwards and returned nothing, the share that was found.
double recall(const std::vector<EmptyBeam>& found, const std::vector<TestBeam>& beams,
              const SpinningSensor& sensor) {
  double all = 0, known = 0;
  for (const TestBeam& beam : beams) {
    if (beam.returned() || beam.direction.z <= EmptyBeamOptions{}.min_up) continue;
    all += 1;
    for (const EmptyBeam& e : found) {
      if (e.scan != beam.scan || distance_between(e, beam) > 0.5 * sensor.step_rad()) continue;
      known += 1;
      break;
    }
  }
  return all > 0 ? known / all : 0;
}

/// Every beam found is one that was fired and returned nothing: the nearest true one is empty,
/// within half a step, and left where it says.
void expect_true(const std::vector<EmptyBeam>& found, const std::vector<TestBeam>& beams,
                 const SpinningSensor& sensor) {
  std::size_t returned = 0, unlike = 0, elsewhere = 0;
  for (const EmptyBeam& e : found) {
    const TestBeam* nearest = nullptr;
    double best = 10;
    for (const TestBeam& beam : beams) {
      if (beam.scan != e.scan || distance_between(e, beam) >= best) continue;
      best = distance_between(e, beam);
      nearest = &beam;
    }
    ASSERT_NE(nearest, nullptr);
    returned += nearest->returned() ? 1 : 0;
    unlike += best > 0.5 * sensor.step_rad() ? 1 : 0;
    // Ten degrees of a sweep or `max_moved_m`.
    elsewhere += length(vec_cast<double>(e.origin) - nearest->origin) > 0.1 ? 1 : 0;
  }
  EXPECT_EQ(returned, 0U);
  EXPECT_EQ(unlike, 0U);
  EXPECT_EQ(elsewhere, 0U);
}

TEST(EmptyBeams, OfASensorWithLasersAndPoses) {
  const SpinningSensor sensor = level();
  const auto beams = sensor.scans(2);
  const auto found = found_in(beams, sensor, true);
  EXPECT_GE(recall(found, beams, sensor), 0.95);
  expect_true(found, beams, sensor);
}

TEST(EmptyBeams, OfATiltedSensorFromDirectionsAlone) {
  const SpinningSensor sensor = pitched();
  const auto beams = sensor.scans(2);
  const auto found = found_in(beams, sensor, false);
  EXPECT_GE(recall(found, beams, sensor), 0.95);
  expect_true(found, beams, sensor);
}

// The nearest beams of a beam are then those of its column.
TEST(EmptyBeams, OfATiltedSensorWhoseStepsAreWiderThanTheGapsBetweenItsRings) {
  SpinningSensor sensor = pitched();
  sensor.columns = 200;
  sensor.phase_steps = 0;
  const auto beams = sensor.scans(2);
  const auto found = found_in(beams, sensor, false);
  EXPECT_GE(recall(found, beams, sensor), 0.95);
  expect_true(found, beams, sensor);
}

TEST(EmptyBeams, FarFromAllPointsOnlyWhereTheSensorHardlyMoved) {
  // Looks up along the street, so that a wide part of the sweep is sky; then across it, which shows
  // that the field of view holds that part.
  SpinningSensor sensor = pitched();
  sensor.world_from_sensor = rotation_from_yaw_pitch_roll(1.57, 45 * kDegree, 0.02);
  const auto recall_at = [&](double speed_m) {
    sensor.speed_m = speed_m;
    const auto along = sensor.scans(1);
    auto both = along;
    for (TestBeam beam : pitched().scans(1)) {
      beam.scan = 1;
      both.push_back(beam);
    }
    const auto found = found_in(both, sensor, false);
    expect_true(found, both, sensor);
    return recall(found, along, sensor);
  };
  EXPECT_GE(recall_at(0.05), 0.95);
  EXPECT_LE(recall_at(1), 0.8);
}

// ---- lost beams --------------------------------------------------------------------------------

std::vector<EmptyBeam> lost_in(const std::vector<TestBeam>& beams, const SpinningSensor& sensor,
                               int threads = 2) {
  PointCloud cloud = cloud_of(beams);
  add_lasers_and_poses(cloud, beams, sensor.world_from_sensor);
  std::vector<EmptyBeam> found = find_empty_beams(cloud, {.lost = true}, Executor(threads));
  std::erase_if(found, [](const EmptyBeam& beam) { return !beam.lost; });
  return found;
}

/// The share of `some` that lie within half a step of one of `others`, from the same place.
template <class A, class B>
double share_among(const std::vector<A>& some, const std::vector<B>& others, double step_rad) {
  double near = 0;
  for (const A& a : some) {
    near += std::ranges::any_of(others, [&](const B& b) {
      return a.scan == b.scan &&
             length(Vec3d(vec_cast<double>(a.direction)) - vec_cast<double>(b.direction)) <
                 0.5 * step_rad &&
             length(Vec3d(vec_cast<double>(a.origin)) - vec_cast<double>(b.origin)) < 0.1;
    });
  }
  return some.empty() ? 0 : near / static_cast<double>(some.size());
}

/// Beams that met the ground or a wall and returned nothing.
std::vector<TestBeam> lose_some(std::vector<TestBeam>& beams, double share) {
  std::vector<TestBeam> lost;
  for (std::size_t k = 0; k < beams.size(); ++k) {
    if (!beams[k].returned() || Random(2, 0, k).uniform() >= share) continue;
    lost.push_back(beams[k]);
    beams[k].range_m = TestBeam().range_m;
  }
  return lost;
}

// Oracle: the beams that were made empty, and those that met the sky.
TEST(LostBeams, AreBetweenTheReturnsOfARing) {
  const SpinningSensor sensor = level();
  auto beams = sensor.scans(2);
  const std::vector<TestBeam> lost = lose_some(beams, 0.05);
  const std::vector<EmptyBeam> found = lost_in(beams, sensor);
  std::vector<TestBeam> empty = beams;
  std::erase_if(empty, [](const TestBeam& beam) { return beam.returned(); });
  EXPECT_GE(share_among(lost, found, sensor.step_rad()), 0.98);
  EXPECT_GE(share_among(found, empty, sensor.step_rad()), 0.98);
  EXPECT_EQ(found.size(), lost_in(beams, sensor, 3).size());
}

// The vehicle blocks a sector of the lower rings in every scan.
TEST(LostBeams, SectorsThatTheVehicleBlocksAreLeftOut) {
  SpinningSensor sensor = level();
  const auto found_at = [&](double speed_m) {
    sensor.speed_m = speed_m;
    auto beams = sensor.scans(4);
    for (TestBeam& beam : beams)
      if (beam.ring > 18 && std::fabs(beam.azimuth_rad) < 4.6 * kDegree)
        beam.range_m = TestBeam().range_m;
    const std::vector<TestBeam> lost = lose_some(beams, 0.02);
    std::size_t blocked = 0;
    const std::vector<EmptyBeam> found = lost_in(beams, sensor);
    EXPECT_GE(share_among(lost, found, sensor.step_rad()), 0.95);
    for (const EmptyBeam& beam : found) {
      const Vec3d d = sensor.world_from_sensor.transposed() * vec_cast<double>(beam.direction);
      blocked += d.z < -0.2 && std::fabs(std::atan2(d.y, d.x)) < 4.2 * kDegree ? 1 : 0;
    }
    return blocked;
  };
  EXPECT_LE(found_at(3), 4U);
  // From one place the scene may be what blocks them.
  EXPECT_GE(found_at(0.5), 100U);
}

TEST(EmptyBeams, NoneOfScansThatWereThinnedAtRandom) {
  for (const bool with_lasers : {true, false}) {
    const SpinningSensor sensor = with_lasers ? level() : pitched();
    for (const double kept : {0.33, 0.5, 0.6}) {
      auto beams = sensor.scans(2);
      for (std::size_t k = 0; k < beams.size(); ++k)
        if (Random(1, 0, k).uniform() > kept) beams[k].range_m = TestBeam().range_m;
      EXPECT_TRUE(found_in(beams, sensor, with_lasers).empty()) << kept;
    }
  }
}

TEST(EmptyBeams, NoneOfScansPutTogether) {
  const SpinningSensor sensor = level();
  auto beams = sensor.scans(5, 0.37);
  for (TestBeam& beam : beams) beam.scan = 0;
  EXPECT_TRUE(found_in(beams, sensor, true).empty());
}

TEST(EmptyBeams, NoneBeyondTheFieldOfView) {
  for (const bool with_lasers : {true, false}) {
    const SpinningSensor sensor = with_lasers ? level() : pitched();
    std::vector<TestBeam> within;
    for (const TestBeam& beam : sensor.scans(2))
      if (std::fabs(beam.azimuth_rad - 2) < 60 * kDegree) within.push_back(beam);
    const auto found = found_in(within, sensor, with_lasers);
    EXPECT_GT(found.size(), 100U);
    expect_true(found, within, sensor);
  }
}

TEST(EmptyBeams, DropoutsAreNone) {
  const SpinningSensor sensor = level();
  auto beams = sensor.scans(2);
  std::size_t dropped = 0;
  std::vector<TestBeam> truth = beams;
  for (std::size_t k = 0; k < beams.size(); ++k) {
    if (!beams[k].returned() || beams[k].point().z < 2.1 || beams[k].point().z > 6) continue;
    if (Random(1, 0, k).uniform() > 0.05) continue;
    beams[k].range_m = TestBeam().range_m;
    ++dropped;
  }
  EXPECT_GT(dropped, 50U);
  expect_true(found_in(beams, sensor, true), truth, sensor);
}

TEST(EmptyBeams, SecondReturnsChangeNothing) {
  const SpinningSensor sensor = level();
  const auto beams = sensor.scans(1);
  auto twice = beams;
  for (TestBeam beam : beams) {
    if (!beam.returned() || beam.ring % 2 == 0) continue;
    beam.range_m += 1;
    twice.push_back(beam);
  }
  const auto once = found_in(beams, sensor, true), again = found_in(twice, sensor, true);
  ASSERT_EQ(once.size(), again.size());
  expect_true(again, beams, sensor);
}

TEST(EmptyBeams, TheSameOnAnyNumberOfThreads) {
  for (const bool with_lasers : {true, false}) {
    const SpinningSensor sensor = with_lasers ? level() : pitched();
    const auto beams = sensor.scans(4);
    const auto one = found_in(beams, sensor, with_lasers, 1);
    const auto three = found_in(beams, sensor, with_lasers, 3);
    ASSERT_EQ(one.size(), three.size());
    ASSERT_FALSE(one.empty());
    for (std::size_t k = 0; k < one.size(); ++k) {
      EXPECT_TRUE(one[k].origin == three[k].origin && one[k].direction == three[k].direction);
      EXPECT_EQ(one[k].scan, three[k].scan);
    }
  }
}

TEST(EmptyBeams, NoneWithoutPointsOrOrigins) {
  EXPECT_TRUE(find_empty_beams({}, {}, Executor(1)).empty());
  PointCloud cloud = cloud_of(pitched().scans(1));
  cloud.origin_kinds.assign(cloud.size(), OriginKind::guessed);
  EXPECT_TRUE(find_empty_beams(cloud, {}, Executor(1)).empty());
  cloud.origin_kinds.clear();
  cloud.positions.resize(500);
  cloud.sensor_positions.resize(500);
  cloud.scan_indices.resize(500);
  EXPECT_TRUE(find_empty_beams(cloud, {}, Executor(1)).empty());
}

}  // namespace
}  // namespace adasplats
