// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/synth/street.h"

namespace adasplats {
namespace {

class WriteStreet : public testing::Test {
 protected:
  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path() / "street";
};

// Oracle: round trip through the readers.
TEST_F(WriteStreet, FilesRoundTrip) {
  const Executor executor(2);
  ProgressSink progress;
  const StreetOptions street_options = {.seed = 5, .length_m = 0};
  StreetScanOptions scan_options;
  scan_options.points = 10'000;
  scan_options.driving_spacing_m = 20;
  const StreetReport report =
      write_street(folder_, street_options, scan_options, executor, progress);
  EXPECT_EQ(report.length_m, street_length_for(10'000));
  EXPECT_NEAR(static_cast<double>(report.mapping_points), 10'000, 1'000);

  const Street street = make_street({.seed = 5, .length_m = report.length_m});
  const MeshTable mesh = read_ply_mesh(folder_ / "mesh.ply");
  EXPECT_EQ(report.mesh_triangles, street.fixed.triangles.size());
  ASSERT_EQ(mesh.vertices.rows, street.fixed.vertices.size());
  ASSERT_EQ(mesh.faces.rows, street.fixed.triangles.size());
  const Column* classes = mesh.faces.find("class");
  const Column* instances = mesh.faces.find("instance");
  const Column* z = mesh.vertices.find("z");
  ASSERT_TRUE(classes != nullptr && instances != nullptr && z != nullptr);
  for (std::size_t i = 0; i < mesh.faces.rows; i += 13) {
    EXPECT_EQ(classes->as_double(i), street.fixed.classes[i]);
    EXPECT_EQ(instances->as_double(i), street.instances[i]);
    EXPECT_EQ(mesh.triangle_vertices[3 * i + 1], street.fixed.triangles[i][1]);
  }
  for (std::size_t v = 0; v < mesh.vertices.rows; v += 17)
    EXPECT_EQ(z->as_double(v), static_cast<double>(street.fixed.vertices[v].z));

  const Table cloud = read_ply(folder_ / "mapping.ply");
  EXPECT_EQ(cloud.rows, report.mapping_points);
  for (const char* name : {"x", "x_lidar_position", "intensity", "label", "instance"})
    EXPECT_NE(cloud.find(name), nullptr) << name;
  EXPECT_EQ(read_trajectory(folder_ / "mapping_trajectory.csv").size(), report.mapping_scans);
  EXPECT_EQ(read_trajectory(folder_ / "true_mapping_trajectory.csv").size(), report.mapping_scans);

  const KittiSequence sequence = open_kitti_sequence(folder_ / "sequences" / "00");
  EXPECT_EQ(sequence.scans.size(), report.driving_scans);
  EXPECT_EQ(sequence.labels.size(), report.driving_scans);
  EXPECT_EQ(read_trajectory(folder_ / "true_driving_trajectory.csv").size(), report.driving_scans);
}

TEST_F(WriteStreet, RejectsAFolderWithAStreet) {
  const Executor executor(2);
  ProgressSink progress;
  StreetScanOptions options;
  options.points = 2'000;
  options.driving_spacing_m = 40;
  write_street(folder_, {.seed = 1, .length_m = 0}, options, executor, progress);
  const auto before = std::filesystem::file_size(folder_ / "mesh.ply");
  expect_error(ErrorKind::cannot_create, {}, [&] {
    write_street(folder_, {.seed = 2, .length_m = 0}, options, executor, progress);
  });
  EXPECT_EQ(std::filesystem::file_size(folder_ / "mesh.ply"), before);
}

TEST_F(WriteStreet, RejectsAFolderThatCannotBeCreated) {
  std::ofstream(folder_) << "a file";
  const Executor executor(1);
  ProgressSink progress;
  expect_error(ErrorKind::cannot_create, {},
               [&] { write_street(folder_, {}, {.points = 2'000}, executor, progress); });
}

}  // namespace
}  // namespace adasplats
