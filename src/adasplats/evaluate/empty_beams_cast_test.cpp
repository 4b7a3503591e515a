// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "adasplats/cloud/beams/empty_beams.h"
#include "adasplats/cloud/beams/spinning_sensor_test.h"
#include "adasplats/evaluate/beam_returns.h"

namespace adasplats {
namespace {

/// Scans of the test's sensor, in its frame, named by their numbers.
class SpinningReader : public ScanReader {
 public:
  SpinningReader(std::vector<TestBeam> beams, Trajectory poses)
      : beams_(std::move(beams)), poses_(std::move(poses)) {}

  KittiScan read(const std::filesystem::path& file) const override {
    const auto index = static_cast<std::size_t>(std::stoi(file.string()));
    const RigidTransform sensor_from_world = poses_[index].world_from_sensor.inverse();
    KittiScan scan;
    for (const TestBeam& beam : beams_) {
      if (beam.scan != index || !beam.returned()) continue;
      scan.positions.push_back(vec_cast<float>(sensor_from_world * beam.point()));
      scan.origins.push_back(vec_cast<float>(sensor_from_world * beam.origin));
      scan.lasers.push_back(beam.ring);
    }
    return scan;
  }

 private:
  std::vector<TestBeam> beams_;
  Trajectory poses_;
};

struct SpinningDrive {
  std::vector<TestBeam> beams;
  KittiSequence sequence;
};

SpinningDrive spinning_drive() {
  SpinningSensor sensor = SpinningSensor::with(24, 26, -20);
  sensor.world_from_sensor = rotation_from_yaw_pitch_roll(0.4, 0.05, -0.03);
  SpinningDrive drive{sensor.scans(2), {}};
  for (std::uint32_t scan = 0; scan < 2; ++scan) {
    const Vec3d place{0, sensor.speed_m * (scan + 0.5), 2};
    drive.sequence.trajectory.push_back({0.1 * scan, {sensor.world_from_sensor, place}});
    drive.sequence.scans.emplace_back(std::to_string(scan));
  }
  drive.sequence.reader = std::make_shared<SpinningReader>(drive.beams, drive.sequence.trajectory);
  return drive;
}

/// One disk in the sky over the street, one behind a wall, one beyond the reach.
std::vector<Disk> disks_in_the_sky() {
  return {{{0, 18, 9}, 5, {0, -1, 0}}, {{40, 0, 3}, 2, {-1, 0, 0}}, {{0, 50, 25}, 8, {0, -1, 0}}};
}

// Oracle: the beams that were cast to make the scans.
TEST(EmptyBeamsCast, GhostsAreBeamsWithoutReturnThatHitTheModel) {
  const SpinningDrive drive = spinning_drive();
  const std::vector<Disk> disks = disks_in_the_sky();
  const Executor executor(2);
  const auto tracer = make_cpu_tracer({disks, nullptr}, executor);
  const EmptyBeamHits hits = cast_empty_beams(*tracer, {}, drive.sequence, executor);
  double empty = 0, ghosts = 0;
  for (const TestBeam& beam : drive.beams) {
    if (beam.returned() || beam.direction.z <= EmptyBeamOptions{}.min_up) continue;
    ++empty;
    const double t = (18 - beam.origin.y) / beam.direction.y;
    const Vec3d at = beam.origin + t * beam.direction;
    if (t > 0 && t < hits.reach_m && std::hypot(at.x, at.z - 9) < 5) ++ghosts;
  }
  EXPECT_GT(hits.reach_m, 21);
  EXPECT_LT(hits.reach_m, 45);
  EXPECT_GT(ghosts, 50);
  EXPECT_NEAR(static_cast<double>(hits.beams), empty, 0.05 * empty);
  EXPECT_NEAR(hits.ghosts, ghosts / empty, 0.1 * ghosts / empty);
}

TEST(EmptyBeamsCast, ScansBecomeACloud) {
  const SpinningDrive drive = spinning_drive();
  const PointCloud cloud = cloud_of_scans(drive.sequence, {1, 2, 3}, Executor(2));
  std::size_t at = 0;
  for (const TestBeam& beam : drive.beams) {
    if (!beam.returned()) continue;
    ASSERT_LT(at, cloud.size());
    EXPECT_LT(length(cloud.world(at) - beam.point()), 1e-4);
    EXPECT_EQ(cloud.lasers[at], beam.ring);
    EXPECT_EQ(cloud.scan_indices[at], beam.scan);
    ++at;
  }
  EXPECT_EQ(at, cloud.size());
  EXPECT_EQ(cloud.scan_poses.size(), 2U);
}

}  // namespace
}  // namespace adasplats
