// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/cloud_inputs.h"

#include <gtest/gtest.h>

#include "adasplats/cloud/load/file_kind.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

constexpr const char* kPlyBegin = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
const std::string kCloud =
    std::string(kPlyBegin) + "property float y\nproperty float z\nend_header\n1 2 3\n";
const std::string kMesh = std::string(kPlyBegin) +
                          "property float y\nproperty float z\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n1 2 3\n3 0 0 0\n";
const std::string kModel =
    std::string(kPlyBegin) +
    "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
    "property float nz\nproperty float radius\nend_header\n1 2 3 0 0 1 0.5\n";
constexpr const char* kPoses = "time,x,y,z,qw,qx,qy,qz\n0,1,2,3,1,0,0,0\n";
constexpr const char* kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0\n";

void write_sequence(const TemporaryFolder& folder, const std::string& name, double x_m = 0) {
  folder.write(name + "/velodyne/000000.bin", std::vector<float>{1, 2, 3, 0});
  folder.write(name + "/poses.txt", "1 0 0 " + std::to_string(x_m) + " 0 1 0 0 0 0 1 0\n");
  folder.write(name + "/calib.txt", std::string("Tr: ") + kIdentity);
}

std::vector<std::string> names_of(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const CloudInput& input : cloud_inputs(folder))
    names.push_back(input.path.lexically_relative(folder).string() +
                    (input.is_sequence ? " (sequence)" : ""));
  return names;
}

TEST(FileKind, ByHeaderAndLines) {
  const TemporaryFolder folder;
  const auto kind = [&](const std::string& name, const std::string& content) {
    return kind_of_file(folder.write(name, content));
  };
  EXPECT_EQ(kind("a.ply", kCloud), FileKind::points);
  EXPECT_EQ(kind("a.ply", kMesh), FileKind::mesh);
  EXPECT_EQ(kind("a.ply", kModel), FileKind::splat_model);
  EXPECT_EQ(kind("a", kModel), FileKind::splat_model);
  EXPECT_EQ(kind("a", kCloud), FileKind::other);
  EXPECT_EQ(kind("a.obj", "v 1 2 3\n"), FileKind::mesh);
  EXPECT_EQ(kind("a.csv", kPoses), FileKind::trajectory);
  EXPECT_EQ(kind("a.txt", std::string(kIdentity) + kIdentity), FileKind::trajectory);
  EXPECT_EQ(kind("a.txt", "# a drive\n# timestamp tx ty tz qx qy qz qw\n0 1 2 3 0 0 0 1\n"),
            FileKind::trajectory);
  // Without a header the times must ascend: normals beside a curvature of 0 have unit length, too.
  const std::string unit = ",1,2,3,0.6,0,0.8,0\n";
  EXPECT_EQ(kind("a.csv", "0" + unit + "1" + unit + "2" + unit), FileKind::trajectory);
  EXPECT_EQ(kind("a.csv", "0" + unit + "1" + unit + "0.5" + unit), FileKind::points);
  EXPECT_EQ(kind("a.xyz", "1 2 3\n4 5 6\n"), FileKind::points);
  EXPECT_EQ(kind("a.xyz", ""), FileKind::points);  // an error when it is read
  EXPECT_EQ(kind("a.md", "x"), FileKind::other);
  EXPECT_EQ(kind_of_file(folder.path() / "absent.ply"), FileKind::points);
}

TEST(FileKind, TextIsPointsWhereALineIsOne) {
  const TemporaryFolder folder;
  const auto kind = [&](const std::string& content) {
    return kind_of_file(folder.write("a.txt", content));
  };
  for (const char* points :
       {"1 2 3", "# a\n// b\n1 2 3\n", "2\n1 2 3 0.5\n4 5 6 0.5\n", "X;Y;Z\n1;2;3\n",
        "\xef\xbb\xbf"
        "1,2,3\n",
        "x y z\r1 2 3\r", "\"x\",\"y\",\"z\"\n\"1\",\"2\",\"3\"\n",
        "x\ty\tz\tname\n1\t2\tnan\t4\n"})
    EXPECT_EQ(kind(points), FileKind::points) << points;
  for (const char* prose :
       {"Tiles of the survey.\n\n40 tiles of 500 m.\n", "40 tiles of 500 m\n", "1 2\n", "2024\n",
        "MIT License\n\nCopyright 2024\n1 2 3\nx\n", "tile,min_x,min_y,min_z\na.las,1,2,3\n",
        "x,y,z\n", "0.1\n0.2\n", "\n \n"})
    EXPECT_EQ(kind(prose), FileKind::other) << prose;
}

TEST(CloudInputs, FilesAndSequencesAreThemselves) {
  const TemporaryFolder folder;
  write_sequence(folder, "s");
  EXPECT_EQ(names_of(folder.path() / "s"), std::vector<std::string>{". (sequence)"});
  EXPECT_FALSE(cloud_inputs(folder.path() / "absent.ply").front().is_sequence);
}

TEST(CloudInputs, TreesAreTheirSequences) {
  const TemporaryFolder folder;
  write_sequence(folder, "sequences/01", 5);
  write_sequence(folder, "sequences/00");
  folder.write("adasplats.json", "{}");
  const std::vector<std::string> all = {"sequences/00 (sequence)", "sequences/01 (sequence)"};
  EXPECT_EQ(names_of(folder.path()), all);
  EXPECT_EQ(names_of(folder.path() / "sequences"),
            (std::vector<std::string>{"00 (sequence)", "01 (sequence)"}));
  require_distinct_starts(cloud_inputs(folder.path()));
  folder.write("model.ply", kModel);  // no points: nothing is ambiguous_folder
  EXPECT_EQ(names_of(folder.path()), all);
  folder.write("mapping.ply", kCloud);
  expect_error(ErrorKind::usage,
               {"sequences/00, sequences/01", "points (mapping.ply)", "splat models (model.ply)"},
               [&] { cloud_inputs(folder.path()); });
}

// The sequences of SemanticKITTI begin at 0 each: one on the other they are no place.
TEST(CloudInputs, SequencesThatBeginAtOnePoseAreNoPlace) {
  const TemporaryFolder folder;
  for (const char* name : {"sequences/00", "sequences/01"}) write_sequence(folder, name);
  expect_error(ErrorKind::usage, {"sequences/00", "sequences/01", "only one of them"},
               [&] { require_distinct_starts(cloud_inputs(folder.path())); });
}

TEST(CloudInputs, TilesOfOneExtension) {
  const TemporaryFolder folder;
  folder.write("b.xyz", "1 2 3\n");
  folder.write("a.XYZ", "1 2 3\n");
  folder.write("a.prj", "PROJCS");
  EXPECT_EQ(names_of(folder.path()), (std::vector<std::string>{"a.XYZ", "b.xyz"}));
  folder.write("c.csv", "x,y,z\n1,2,3\n");
  expect_error(ErrorKind::usage, {"c.csv beside a.XYZ, b.xyz; move it out of the folder"},
               [&] { cloud_inputs(folder.path()); });
}

TEST(CloudInputs, ProseBesideTilesAndSequencesDoesNotCount) {
  const TemporaryFolder folder;
  for (const char* of : {"tiles/", "drives/"}) {
    folder.write(std::string(of) + "readme.txt", "What this is.\nLook at 3 tiles.\n");
    folder.write(std::string(of) + "LICENSE.txt", "MIT License\n\nCopyright (c) 2024\n");
    folder.write(std::string(of) + "index.csv", "file,points,date\na.las,1,2024-01-01\n");
  }
  folder.write("tiles/a.las", "LASF");
  write_sequence(folder, "drives/sequences/00");
  EXPECT_EQ(names_of(folder.path() / "tiles"), std::vector<std::string>{"a.las"});
  EXPECT_EQ(names_of(folder.path() / "drives"),
            std::vector<std::string>{"sequences/00 (sequence)"});
  // Whoever names a file means it.
  EXPECT_EQ(cloud_inputs(folder.path() / "tiles/readme.txt").size(), 1U);
  require_points(folder.path() / "tiles/readme.txt");
}

// Beside files of another format it must not be left out without a word.
TEST(CloudInputs, E57Counts) {
  const TemporaryFolder folder;
  folder.write("a.e57", "ASTM-E57");
  EXPECT_EQ(names_of(folder.path()), std::vector<std::string>{"a.e57"});
  folder.write("b.las", "LASF");
  expect_error(ErrorKind::usage, {"points (a.e57, b.las)"}, [&] { cloud_inputs(folder.path()); });
}

TEST(CloudInputs, MeshesModelsAndTrajectoriesAmongPoints) {
  const TemporaryFolder folder;
  folder.write("a/mapping.ply", kCloud);
  folder.write("a/mesh.ply", kMesh);
  folder.write("a/way.csv", kPoses);
  expect_error(
      ErrorKind::usage,
      {"points (mapping.ply)", "meshes (mesh.ply)", "trajectories (way.csv)", "for example"},
      [&] { cloud_inputs(folder.path() / "a"); });
  folder.write("b/mesh.ply", kMesh);
  expect_error(ErrorKind::no_input, {"velodyne", "meshes (mesh.ply)"},
               [&] { cloud_inputs(folder.path() / "b"); });
}

TEST(CloudInputs, ScansOfASensorThatMovesHaveNoPlace) {
  const TemporaryFolder folder;
  folder.write("a/000000.ply", kCloud);
  folder.write("a/poses.csv", kPoses);
  expect_error(ErrorKind::data, {"poses.csv", "trajectory"},
               [&] { cloud_inputs(folder.path() / "a"); });
  folder.write("velodyne/000000.bin", std::vector<float>{1, 2, 3, 0});
  EXPECT_EQ(names_of(folder.path() / "velodyne"), std::vector<std::string>{"000000.bin"});
  folder.write("velodyne/000001.bin", std::vector<float>{1, 2, 3, 0});
  expect_error(ErrorKind::data, {"2 .bin files", "poses.txt"},
               [&] { cloud_inputs(folder.path() / "velodyne"); });
}

TEST(CloudInputs, FoldersOfOtherProgramsSayWhatToDo) {
  const TemporaryFolder folder;
  folder.write("ept/ept.json", "{\"dataType\": \"entwine\", \"points\": 1}");
  expect_error(ErrorKind::data, {"EPT", "'entwine'", "pdal translate"},
               [&] { cloud_inputs(folder.path() / "ept"); });
  folder.write("lost/ept.json", "{\"dataType\": \"laszip\", \"points\": 5}");
  expect_error(ErrorKind::data, {"0 tiles", "expected 5"},
               [&] { cloud_inputs(folder.path() / "lost"); });
  folder.write("potree/metadata.json", "{}");
  folder.write("potree/octree.bin", "x");
  EXPECT_EQ(names_of(folder.path() / "potree"), std::vector<std::string>{"octree.bin"});
  folder.write("potree1/cloud.js", "{}");
  expect_error(ErrorKind::data, {"Potree 1", "LAZ"},
               [&] { cloud_inputs(folder.path() / "potree1"); });
  folder.write("split/log/city_SE3_egovehicle.feather", "ARROW1");
  EXPECT_EQ(names_of(folder.path() / "split/log"), std::vector<std::string>{"."});
  expect_error(ErrorKind::no_input, {"give a drive in it", "split/log"},
               [&] { cloud_inputs(folder.path() / "split"); });
  // Not every folder named sensors/lidar is an Argoverse 2 log.
  folder.write("rig/sensors/lidar/a.ply", kCloud);
  expect_error(ErrorKind::no_input, {"neither a folder 'velodyne' nor point files"},
               [&] { cloud_inputs(folder.path() / "rig"); });
}

TEST(CloudInputs, WhatIsNoPoints) {
  const TemporaryFolder folder;
  require_points(folder.write("cloud.ply", kCloud));
  expect_error(ErrorKind::data, {"m.ply", "triangle mesh"},
               [&] { require_points(folder.write("m.ply", kMesh)); });
  expect_error(ErrorKind::data, {"s.ply", "splat model"},
               [&] { require_points(folder.write("s.ply", kModel)); });
  expect_error(ErrorKind::data, {"t.csv", "trajectory", "`trajectory`"},
               [&] { require_points(folder.write("t.csv", kPoses)); });
}

TEST(CloudInputs, AFileOfAnotherFormatAmongScansIsNamed) {
  const TemporaryFolder folder;
  for (const char* name : {"a.ply", "b.ply", "c.ply"}) folder.write(name, kCloud);
  folder.write("keyframes.txt", "1 2 3 4 5 6 7 8 9\n");
  expect_error(ErrorKind::usage,
               {"several formats: keyframes.txt beside a.ply, b.ply, c.ply; move it out"},
               [&] { cloud_inputs(folder.path()); });
}

}  // namespace
}  // namespace adasplats
