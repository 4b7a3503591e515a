// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/labels/label_agreement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/semantickitti_writer.h"

namespace adasplats {
namespace {

struct LabelledPoint {
  Vec3f position;
  std::uint16_t id;
};

Scan scan_of(double time_s, Vec3d place, const std::vector<LabelledPoint>& points) {
  Scan scan;
  scan.time_s = time_s;
  scan.world_from_sensor.translation = place;
  for (const LabelledPoint& point : points) {
    scan.positions.push_back(point.position);
    scan.classes.push_back(point.id);
  }
  return scan;
}

KittiSequence sequence_of(const std::filesystem::path& folder, const std::vector<Scan>& scans) {
  SemanticKittiWriter writer(folder);
  for (std::size_t i = 0; i < scans.size(); ++i) writer.write_scan(i, scans[i]);
  writer.finish();
  return open_kitti_sequence(folder);
}

LabelAgreementResult compared(const KittiSequence& simulated, const KittiSequence& original,
                              std::size_t window) {
  const Executor executor(1);
  ProgressSink progress;
  return compare_labels(simulated, original, semantickitti_labels(), {window, 1}, executor,
                        progress);
}

// Oracle: by hand. Large coordinates show that frames are local.
TEST(LabelAgreement, NearestPointOfTheWindow) {
  const TemporaryFolder folder;
  const Vec3d place = {5e5, 4e6, 0};
  const KittiSequence original = sequence_of(
      folder.path() / "o", {scan_of(0, place, {{{10, 0, 0}, 50}}),
                            scan_of(1, place + Vec3d{1, 0, 0}, {{{10, 5, 0}, 40}, {{20, 0, 0}, 0}}),
                            scan_of(2, place + Vec3d{2, 0, 0}, {{{8, 0.5F, 0}, 70}})});
  // In the world: 0.1 m from the building, 0.4 m from it and 0.1 m from the vegetation, on
  // the road, on what has no label.
  const KittiSequence simulated =
      sequence_of(folder.path() / "s", {scan_of(1.2, place + Vec3d{1, 0, -0.5},
                                                {{{9, -0.1F, 0.5F}, 50},
                                                 {{9, 0.4F, 0.5F}, 50},
                                                 {{10, 5, 0.5F}, 40},
                                                 {{20, 0, 0.5F}, 40}})});
  const LabelAgreementResult result = compared(simulated, original, 1);
  EXPECT_EQ(result.all.points, 4U);
  EXPECT_EQ(result.all.agree, 2U);
  EXPECT_EQ(result.labelled.points, 3U);
  EXPECT_DOUBLE_EQ(result.labelled.share(), 2.0 / 3);
  EXPECT_NEAR(result.all.distance_m, 0.2 / 4, 1e-6);
  EXPECT_EQ(result.by_class.at(50).agree, 1U);
  EXPECT_EQ(result.confusions.at({50, 70}), 1U);
  EXPECT_EQ(result.confusions.at({40, 0}), 1U);
  // Without neighbours the scan of time 1 alone counts.
  EXPECT_EQ(compared(simulated, original, 0).all.agree, 1U);
}

// Oracle: by hand: a car of another scan is no neighbour.
TEST(LabelAgreement, MovingPointsCountInTheirOwnScan) {
  const TemporaryFolder folder;
  const KittiSequence original = sequence_of(
      folder.path() / "o",
      {scan_of(0, {}, {{{10, 0, 0}, 252}}), scan_of(1, {}, {{{12, 0, 0}, 252}, {{9, 0, 0}, 40}})});
  const KittiSequence simulated =
      sequence_of(folder.path() / "s", {scan_of(1, {}, {{{10, 0, 0}, 40}, {{12, 0, 0}, 252}})});
  EXPECT_EQ(compared(simulated, original, 5).all.agree, 2U);
}

TEST(LabelAgreement, NothingToCompare) {
  const TemporaryFolder folder;
  const KittiSequence empty = sequence_of(folder.path() / "e", {scan_of(0, {}, {})});
  const KittiSequence one = sequence_of(folder.path() / "o", {scan_of(0, {}, {{{1, 0, 0}, 40}})});
  expect_error(ErrorKind::data, {"labels"}, [&] { compared(empty, one, 1); });
  const KittiSequence half =
      sequence_of(folder.path() / "h", {scan_of(0, {}, {}), scan_of(1, {}, {{{1, 0, 0}, 40}})});
  // Nobody has points near the first scan; the second one is compared.
  EXPECT_EQ(compared(half, one, 0).all.points, 1U);
  EXPECT_TRUE(std::isnan(compared(one, half, 0).all.share()));
}

}  // namespace
}  // namespace adasplats
