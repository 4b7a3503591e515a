// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/driver_order.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/dataset/scan_writer.h"

namespace adasplats {
namespace {

constexpr std::size_t kTreeScans = 6;

void write_data_tree(const std::filesystem::path& folder, ScanFormat format) {
  ScanWriterOptions options;
  options.labels = &semantickitti_labels();
  options.image_size = {64, 2};
  options.drive = {kTreeScans, [](std::size_t i) { return scan_number(i, 0).time_s; }};
  const auto writer = make_scan_writer(folder, format, options);
  for (std::size_t k = 0; k < kTreeScans; ++k) {
    Scan scan = scan_number(k, 70);
    for (std::uint16_t& id : scan.classes) id = 40;
    writer->write(k, scan);
  }
  writer->finish();
}

std::pair<PointCloud, LoadReport> load_tree(const std::filesystem::path& folder) {
  LoadOptions options;
  options.own_body_m = 0;
  options.driven_path_m = 0;
  ProgressSink quiet;
  return load_cloud(std::span(&folder, 1), options, Executor(2), quiet);
}

/// Where a point as measured is, while the sensor moved by a metre along x during a tenth of a
/// second.
Vec3d place_at_its_time(const Scan& scan, std::uint32_t i) {
  const double share = std::min(1.0, 10 * double{scan.times_s[i]});
  return scan.world_from_sensor * vec_cast<double>(scan.positions[i]) + Vec3d{share - 0.5, 0, 0};
}

Vec3d place_in_scan(const Scan& scan, std::uint32_t i) {
  return scan.world_from_sensor * vec_cast<double>(scan.positions[i]);
}

/// Oracle: the scans that were written, in the order of their files.
void expect_scans(const PointCloud& cloud, FirstRing first, double within_m,
                  Vec3d (*place_of)(const Scan&, std::uint32_t), double intensity_step = 0) {
  ASSERT_EQ(cloud.size(), kTreeScans * 70);
  ASSERT_EQ(cloud.scan_poses.size(), kTreeScans);
  for (std::size_t k = 0; k < kTreeScans; ++k) {
    const Scan scan = scan_number(k, 70);
    const auto order = driver_order(scan, first);
    for (std::size_t i = 0; i < order.size(); ++i) {
      EXPECT_LT(length(cloud.world(70 * k + i) - place_of(scan, order[i])), within_m);
      EXPECT_NEAR(cloud.intensities[70 * k + i], scan.intensities[order[i]], intensity_step / 2);
    }
  }
}

TEST(DataTreeRoundTrip, PandaSet) {
  const TemporaryFolder folder;
  write_data_tree(folder.path(), ScanFormat::pandaset);
  const auto [cloud, report] = load_tree(folder.path() / "001");
  expect_scans(cloud, FirstRing::top, 1e-4, place_at_its_time);
  EXPECT_TRUE(std::ranges::all_of(cloud.classes, [](std::uint16_t id) { return id == 40; }));
  EXPECT_EQ(report.drives[0].facts.intensities, "as in the files");
}

TEST(DataTreeRoundTrip, Nuscenes) {
  const TemporaryFolder folder;
  write_data_tree(folder.path(), ScanFormat::nuscenes);
  const auto [cloud, report] = load_tree(folder.path());
  expect_scans(cloud, FirstRing::bottom, 1e-4, place_in_scan);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    EXPECT_EQ(cloud.classes[i], cloud.scan_indices[i] % 5 == 0 ? 24 : kNuscenesUnlabeled);
  for (std::size_t k = 0; k < kTreeScans; ++k) {
    const RigidTransform expected = scan_number(k, 0).world_from_sensor;
    const RigidTransform& pose = cloud.scan_poses[k].world_from_sensor;
    EXPECT_LT(length(pose.translation - expected.translation), 1e-6);
    EXPECT_LT(angle_between(pose.rotation, expected.rotation), 1e-7);
  }
}

TEST(DataTreeRoundTrip, Argoverse2) {
  const TemporaryFolder folder;
  write_data_tree(folder.path(), ScanFormat::argoverse2);
  const auto [cloud, report] =
      load_tree(folder.path() / "train/00000000-0000-0000-0000-000000000001");
  expect_scans(cloud, FirstRing::top, 1e-4, place_at_its_time, 1.0001 / 255);
  ASSERT_EQ(cloud.lasers.size(), cloud.size());
  for (std::size_t k = 0; k < kTreeScans; ++k) {
    const Scan scan = scan_number(k, 70);
    const TimedPose& pose = cloud.scan_poses[k];
    EXPECT_NEAR(pose.time_s, scan.time_s, 1e-9);
    EXPECT_LT(length(pose.world_from_sensor.translation - scan.world_from_sensor.translation),
              1e-8);
    EXPECT_LT(angle_between(pose.world_from_sensor.rotation, scan.world_from_sensor.rotation),
              1e-7);
    const auto order = driver_order(scan, FirstRing::top);
    for (std::size_t i = 0; i < order.size(); ++i)
      EXPECT_EQ(cloud.lasers[70 * k + i], scan.rings[order[i]]);
  }
}

}  // namespace
}  // namespace adasplats
