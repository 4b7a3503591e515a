// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/synth/world/world.h"

namespace adasplats {
namespace {

class WriteWorld : public testing::Test {
 protected:
  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path() / "world";
  ProgressSink progress_;
};

constexpr WorldOptions kSmall = {.seed = 6, .kind = WorldKind::residential, .length_m = 80};

WorldScanOptions few_scans(std::size_t scans) {
  return {.seed = 6, .scans = scans, .spacing_m = 2, .sensor = "velodyne-vlp-16"};
}

// Oracle: round trip through the readers.
TEST_F(WriteWorld, FilesRoundTrip) {
  const Executor executor(2);
  const WorldReport report = write_world(folder_, kSmall, few_scans(3), executor, progress_);
  EXPECT_EQ(report.scans, 3U);
  EXPECT_GT(report.points, 20'000U);
  const KittiSequence sequence = open_kitti_sequence(folder_ / "sequences" / "00");
  EXPECT_EQ(sequence.scans.size(), 3U);
  EXPECT_EQ(sequence.labels.size(), 3U);
  const MeshTable mesh = read_ply_mesh(folder_ / "mesh.ply");
  EXPECT_EQ(mesh.faces.rows, report.mesh_triangles);
  const Trajectory poses = read_trajectory(folder_ / "sequences" / "00" / "poses.txt");
  ASSERT_EQ(poses.size(), 3U);
  for (std::size_t k = 0; k + 1 < poses.size(); ++k)
    EXPECT_NEAR(
        length(poses[k + 1].world_from_sensor.translation - poses[k].world_from_sensor.translation),
        2, 0.05);
}

TEST_F(WriteWorld, RejectsAFolderWithAWorld) {
  const Executor executor(2);
  write_world(folder_, kSmall, few_scans(1), executor, progress_);
  expect_error(ErrorKind::cannot_create, {},
               [&] { write_world(folder_, kSmall, few_scans(1), executor, progress_); });
}

// Oracle: the same world with another number of threads.
TEST_F(WriteWorld, ScansDoNotDependOnThreads) {
  const SynthWorld world = make_world(kSmall);
  std::vector<Scan> scans;
  for (const int threads : {1, 3}) {
    const Executor executor(threads);
    scan_world(
        world, few_scans(1), [&](std::size_t, const Scan& scan) { scans.push_back(scan); },
        executor, progress_);
  }
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[0].positions, scans[1].positions);
  EXPECT_EQ(scans[0].classes, scans[1].classes);
  EXPECT_LT(scans[0].size(), scans[0].rays);
}

TEST_F(WriteWorld, RejectsMoreScansThanFitOnTheRoad) {
  const Executor executor(1);
  const SynthWorld world = make_world(kSmall);
  for (const WorldScanOptions& options :
       {few_scans(0), few_scans(60), WorldScanOptions{.spacing_m = std::nan("")}}) {
    expect_error(ErrorKind::usage, {}, [&] {
      scan_world(
          world, options, [](std::size_t, const Scan&) {}, executor, progress_);
    });
  }
}

}  // namespace
}  // namespace adasplats
