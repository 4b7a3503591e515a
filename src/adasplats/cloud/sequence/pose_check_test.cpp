// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/pose_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

constexpr RigidTransform kCamera = {{{{0, -1, 0}, {0, 0, -1}, {1, 0, 0}}}, {}};

/// Points of a street of 120 m: ground, and things of 3 m that stand at random places, not alike.
std::vector<Vec3d> street() {
  std::vector<Vec3d> points;
  auto draw = [n = std::uint64_t{0}](double low, double high) mutable {
    return Random(7, 0, n++).uniform(low, high);
  };
  for (int i = 0; i < 30'000; ++i) points.push_back({draw(-60, 60), draw(-15, 15), -1.7});
  for (int thing = 0; thing < 90; ++thing) {
    const Vec3d foot = {draw(-60, 60), draw(-15, 15), -1.7};
    for (int i = 0; i < 200; ++i)
      points.push_back(foot + Vec3d{draw(0, 0.6), draw(0, 0.6), draw(0, 3)});
  }
  return points;
}

/// A tunnel: walls, ground and ceiling, the same all along.
std::vector<Vec3d> tunnel() {
  std::vector<Vec3d> points;
  for (int i = -400; i < 400; ++i)
    for (int k = 0; k < 40; ++k) {
      const double z = -1.7 + 0.1 * k;
      points.push_back({0.1 * i, -4, z});
      points.push_back({0.1 * i, 4, z});
    }
  return points;
}

using Way = std::function<RigidTransform(const RigidTransform&)>;

/// Writes `scans` scans of a world, 1 m apart along x; the poses are as `written` has them, and the
/// points are in the sensor's frame, or with `in_world` in the world's.
KittiSequence drive(const TemporaryFolder& folder, const std::vector<Vec3d>& world, int scans,
                    const Way& written, double apart_m = 1, bool in_world = false) {
  KittiSequence sequence;
  sequence.folder = folder.path();
  for (int k = 0; k < scans; ++k) {
    const RigidTransform pose = {rotation_from_yaw_pitch_roll(0.01 * k, 0, 0),
                                 {apart_m * k, 0, 0.01 * k}};
    std::vector<float> values;
    for (const Vec3d p : world) {
      const Vec3d seen = pose.inverse() * p;
      if (!(length(seen) < 35)) continue;
      const Vec3d point = in_world ? p : seen;
      values.insert(values.end(), {static_cast<float>(point.x), static_cast<float>(point.y),
                                   static_cast<float>(point.z), 0.5F});
    }
    sequence.scans.push_back(folder.write("velodyne/" + std::to_string(k) + ".bin", values));
    sequence.trajectory.push_back({0.1 * k, written(pose)});
  }
  return sequence;
}

const Way kHonest = [](const RigidTransform& pose) { return pose; };

TEST(PoseCheck, TrueMotionIsBelieved) {
  const TemporaryFolder folder;
  const KittiSequence sequence = drive(folder, street(), 12, kHonest);
  const PoseEvidence evidence = weigh_poses(sequence, Executor(2));
  EXPECT_EQ(evidence.pairs, 3U);  // none 3 m ahead of scan 9
  EXPECT_GT(evidence.share(0), 0.95);
  EXPECT_FALSE(evidence.contradicts());
  verify_poses(sequence, Executor(2));
}

TEST(PoseCheck, FaultsAreNamedWithFigures) {
  const TemporaryFolder folder;
  const auto reject = [&](const Way& written, const std::string& what, bool in_world = false) {
    const KittiSequence wrong = drive(folder, street(), 12, written, 1, in_world);
    expect_error(ErrorKind::data, {folder.path().string(), "contradict", " % meet", what},
                 [&] { verify_poses(wrong, Executor(2)); });
  };
  reject([](const RigidTransform& p) { return kCamera * p * kCamera.inverse(); }, "the camera's");
  reject([](const RigidTransform& p) { return kCamera.inverse() * p * kCamera; }, "the LiDAR's");
  reject([](const RigidTransform& p) { return p.inverse(); }, "inverted");
  reject(kHonest, "in world coordinates already", true);
}

TEST(PoseCheck, MirroredTranslationsAreNamed) {
  const TemporaryFolder folder;
  // Along a diagonal, where a mirrored way is another one.
  const Mat3d turn = rotation_from_yaw_pitch_roll(0.3, 0, 0);
  const auto reject = [&](const Way& mirrored, const std::string& what) {
    KittiSequence wrong = drive(folder, street(), 12, kHonest);
    for (TimedPose& pose : wrong.trajectory) {
      const RigidTransform turned = RigidTransform{turn, {}} * pose.world_from_sensor;
      pose.world_from_sensor = mirrored(turned);
    }
    expect_error(ErrorKind::data, {folder.path().string(), "contradict", what},
                 [&] { verify_poses(wrong, Executor(2)); });
  };
  reject(
      [](const RigidTransform& p) {
        const Vec3d t = p.translation;
        return RigidTransform{p.rotation, {t.x, -t.y, t.z}};
      },
      "y of their translations negated");
  reject(
      [](const RigidTransform& p) {
        const Vec3d t = p.translation;
        return RigidTransform{p.rotation, {t.y, t.x, t.z}};
      },
      "x and y of their translations exchanged");
}

// Poses shifted by three scans, the last three wrapped around.
TEST(PoseCheck, JumpsBetweenScansAreNamed) {
  const TemporaryFolder folder;
  KittiSequence wrapped = drive(folder, street(), 20, kHonest);
  for (std::size_t k = 0; k < wrapped.scans.size(); ++k)
    wrapped.trajectory[k].world_from_sensor.translation.x =
        static_cast<double>((k + 3) % wrapped.scans.size());
  expect_error(ErrorKind::data,
               {folder.path().string(), "16.bin and 17.bin", "19.0 m within 0.1 s (190 m/s"},
               [&] { require_no_jump(wrapped); });
  expect_error(ErrorKind::data, {"16.bin and 17.bin"}, [&] { verify_poses(wrapped, Executor(2)); });
}

TEST(PoseCheck, DroppedScansAreNoJump) {
  const TemporaryFolder folder;
  KittiSequence sequence = drive(folder, {}, 20, kHonest);
  const auto later = [&](double by_s) {
    KittiSequence gap = sequence;
    for (std::size_t k = 10; k < gap.scans.size(); ++k) {
      gap.trajectory[k].time_s += by_s;
      gap.trajectory[k].world_from_sensor.translation.x += 60;
    }
    return gap;
  };
  EXPECT_NO_THROW(require_no_jump(later(6)));
  EXPECT_ANY_THROW(require_no_jump(later(0)));
  // Numbers show dropped scans of poses without times.
  KittiSequence numbered = later(0);
  numbered.has_times = false;
  EXPECT_ANY_THROW(require_no_jump(numbered));
  for (std::size_t k = 10; k < numbered.scans.size(); ++k)
    numbered.scans[k].replace_filename(std::to_string(k + 60) + ".bin");
  EXPECT_NO_THROW(require_no_jump(numbered));
  // Stations of a survey, and an aircraft.
  KittiSequence stations = sequence;
  stations.has_times = false;
  for (TimedPose& pose : stations.trajectory) pose.world_from_sensor.translation.x *= 15;
  EXPECT_NO_THROW(require_no_jump(stations));
  stations.trajectory.back().world_from_sensor.translation.x += 100;
  EXPECT_NO_THROW(require_no_jump(stations));
}

TEST(PoseCheck, PosesThatStandWhileTheScansMoveAreRejected) {
  const TemporaryFolder folder;
  const auto stands = [](const RigidTransform&) { return RigidTransform{}; };
  KittiSequence wrong = drive(folder, street(), 12, stands, 0.4);
  expect_error(ErrorKind::data, {folder.path().string(), "span only 0.00 m", "the sensor moved"},
               [&] { verify_poses(wrong, Executor(2)); });
  const KittiSequence right = drive(folder, street(), 12, kHonest, 0);
  EXPECT_EQ(verify_poses(right, Executor(2)).find("the sensor moved"), std::string::npos);
}

Way scaled_by(double factor) {
  return [factor](const RigidTransform& pose) {
    return RigidTransform{pose.rotation, factor * pose.translation};
  };
}

TEST(PoseCheck, OtherUnitsThanMetresAreNamed) {
  const TemporaryFolder folder;
  const auto reject = [&](double factor, const std::string& times) {
    const KittiSequence wrong = drive(folder, street(), 12, scaled_by(factor));
    expect_error(ErrorKind::data,
                 {folder.path().string(), "contradict", "translations times " + times + " ("},
                 [&] { verify_poses(wrong, Executor(2)); });
  };
  reject(1000, "0.001");
  reject(100, "0.01");
  reject(10, "0.1");
  reject(1 / 0.3048, "0.3048");
  reject(0.3048, "3.281");
  reject(0.1, "10");
  reject(0.01, "100");
  reject(0.001, "1000");
}

TEST(PoseCheck, ScalesSayNothingAgainstTruePoses) {
  const TemporaryFolder folder;
  EXPECT_TRUE(weigh_poses(drive(folder, street(), 12, kHonest), Executor(2)).confirms());
  const auto believed = [](const KittiSequence& sequence) {
    for (const ScaleEvidence& scale : weigh_scales(sequence, Executor(2)))
      EXPECT_FALSE(scale.contradicts()) << scale.factor;
    verify_poses(sequence, Executor(2));
  };
  for (const double apart_m : {0.0, 0.1, 0.3, 1.0, 3.0, 8.0})  // 0: it stands
    believed(drive(folder, street(), 12, kHonest, apart_m));
  believed(drive(folder, street(), 12, scaled_by(1.05)));  // drift
  believed(drive(folder, tunnel(), 12, kHonest));
  EXPECT_TRUE(weigh_scales(KittiSequence{}, Executor(2)).empty());
}

TEST(PoseCheck, TunnelsDoNotTellScales) {
  const TemporaryFolder folder;
  const KittiSequence sequence = drive(folder, tunnel(), 12, scaled_by(10));
  EXPECT_FALSE(weigh_poses(sequence, Executor(2)).confirms());
  for (const ScaleEvidence& scale : weigh_scales(sequence, Executor(2)))
    EXPECT_FALSE(scale.contradicts());
}

TEST(PoseCheck, WhatTellsNothingIsBelieved) {
  const TemporaryFolder folder;
  EXPECT_FALSE(weigh_poses(drive(folder, tunnel(), 12, kHonest), Executor(2)).contradicts());
  EXPECT_EQ(weigh_poses(drive(folder, street(), 12, kHonest, 0), Executor(2)).pairs,
            0U);  // it stands
  EXPECT_EQ(weigh_poses(drive(folder, street(), 4, kHonest, 50), Executor(2)).pairs,
            0U);  // far apart
  EXPECT_FALSE(weigh_poses(drive(folder, street(), 2, kHonest, 5), Executor(2)).contradicts());
  EXPECT_EQ(weigh_poses(drive(folder, street(), 2, kHonest, 5), Executor(2)).pairs, 1U);
  EXPECT_EQ(weigh_poses(drive(folder, {}, 12, kHonest), Executor(2)).pairs, 0U);  // empty scans
  EXPECT_EQ(weigh_poses(drive(folder, {{1, 2, 3}}, 1, kHonest), Executor(2)).pairs, 0U);
  EXPECT_EQ(weigh_poses(KittiSequence{}, Executor(2)).pairs, 0U);
}

// A scan that nobody chose must not stop what reads others; labels say nothing of poses.
TEST(PoseCheck, ScansThatCannotBeReadAreSkipped) {
  const TemporaryFolder folder;
  KittiSequence sequence = drive(folder, street(), 12, kHonest);
  for (std::size_t k = 0; k < sequence.scans.size(); ++k)
    sequence.labels.push_back(folder.path() / "labels/none.label");
  EXPECT_EQ(weigh_poses(sequence, Executor(2)).pairs, 3U);
  folder.write("velodyne/0.bin", std::string(17, 'x'));  // earlier of the first pair
  EXPECT_EQ(weigh_poses(sequence, Executor(2)).pairs, 2U);
  std::filesystem::remove(sequence.scans[9]);  // later of the last one
  EXPECT_EQ(weigh_poses(sequence, Executor(2)).pairs, 1U);
}

// Cars around drive as fast: they stand still for the sensor, and are most of what it sees.
TEST(PoseCheck, TrafficAtOnesOwnSpeedIsNoContradiction) {
  const TemporaryFolder folder;
  KittiSequence sequence = drive(folder, street(), 12, kHonest);
  for (std::size_t k = 0; k < sequence.trajectory.size(); ++k)
    sequence.scans[k] = sequence.scans.front();
  const PoseEvidence evidence = weigh_poses(sequence, Executor(2));
  EXPECT_GT(evidence.pairs, 0U);
  EXPECT_FALSE(evidence.contradicts());
  EXPECT_FALSE(evidence.confirms());
  for (const double apart_m : {0.3, 3.0, 30.0})
    for (std::size_t k = 0; k < sequence.trajectory.size(); ++k) {
      sequence.trajectory[k].world_from_sensor.translation.x = apart_m * static_cast<double>(k);
      for (const ScaleEvidence& scale : weigh_scales(sequence, Executor(2)))
        EXPECT_FALSE(scale.contradicts()) << scale.factor;
    }
}

}  // namespace
}  // namespace adasplats
