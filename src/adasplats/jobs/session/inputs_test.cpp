// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/session/inputs.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/mcap/mcap_file.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

std::string scheme_of(const fs::path& input, const std::string& label_field = {}) {
  const auto scheme = label_scheme_for({}, std::span(&input, 1), label_field);
  return scheme ? scheme->name() : "none";
}

PointCloud two_points() {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}, {1, 1, 1}};
  return cloud;
}

TEST(LabelSchemeFor, LasOfOtherProgramsHasClassesOfTheSpecification) {
  const TemporaryFolder folder;
  const fs::path ours = folder.path() / "a.las";
  save_cloud_las(ours, two_points());
  EXPECT_EQ(scheme_of(ours), "none");
  std::string bytes = read_file(ours);
  constexpr std::size_t kSoftwareAt = 58;
  bytes.replace(kSoftwareAt, std::string_view("adasplats").size(), "TerraScan");
  const fs::path other = folder.write("b.las", bytes);
  EXPECT_EQ(scheme_of(other), "asprs");
  EXPECT_EQ(scheme_of(other, "user_data"), "none");
  EXPECT_EQ(scheme_of(other, "classification"), "asprs");
  // A folder of tiles as well.
  fs::create_directory(folder.path() / "tiles");
  fs::rename(other, folder.path() / "tiles" / "b.las");
  EXPECT_EQ(scheme_of(folder.path() / "tiles"), "asprs");
}

TEST(LabelSchemeFor, OctreesAreMadeFromLas) {
  const TemporaryFolder folder;
  folder.write("ept.json", R"({"dataType": "binary", "points": 1, "schema": [
      {"name": "X", "type": "signed", "size": 4}, {"name": "Y", "type": "signed", "size": 4},
      {"name": "Z", "type": "signed", "size": 4}]})");
  folder.write("ept-data/0-0-0-0.bin", std::vector<std::int32_t>{1, 2, 3});
  EXPECT_EQ(scheme_of(folder.path()), "asprs");
}

TEST(LabelSchemeFor, FilesMayBeNamedWithoutAFolder) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  save_cloud_ply("a.ply", two_points());
  EXPECT_EQ(scheme_of("a.ply"), "none");
  fs::current_path(before);
}

TEST(LabelSchemeFor, FilesOfThisProgramStateTheirs) {
  const TemporaryFolder folder;
  PointCloud cloud = two_points();
  cloud.classes = {0, 1};
  cloud.label_scheme = "nuscenes";
  const fs::path ply = folder.path() / "a.ply", las = folder.path() / "a.laz";
  save_cloud_ply(ply, cloud);
  save_cloud_las(las, cloud);
  EXPECT_EQ(scheme_of(ply), "nuscenes");
  EXPECT_EQ(scheme_of(las), "nuscenes");
  McapFile mcap(folder.path() / "a.mcap", "ros2");
  mcap.add_metadata(kMcapMetadataName, kMcapLabelsKey, "pandaset");
  mcap.finish();
  EXPECT_EQ(scheme_of(folder.path() / "a.mcap"), "pandaset");
}

TEST(LabelSchemeFor, TreesOfScansHaveTheSchemeOfTheirSimulation) {
  const TemporaryFolder folder;
  const fs::path tree = folder.path() / "sequences" / "00";
  for (const char* const part : {"velodyne", "labels"}) fs::create_directories(tree / part);
  EXPECT_EQ(scheme_of(tree), "semantickitti");
  folder.write("adasplats.json", R"({"program": "adasplats", "labels": {"name": "asprs"}})");
  EXPECT_EQ(scheme_of(tree), "asprs");
  folder.write("adasplats.json", R"({"labels": {"name": "lost.toml"}})");
  EXPECT_EQ(scheme_of(tree), "semantickitti");
  folder.write("adasplats.json", "no JSON");
  EXPECT_EQ(scheme_of(tree), "semantickitti");
}

}  // namespace
}  // namespace adasplats
