// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/scene_files.h"

#include <gtest/gtest.h>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

TEST(SceneFiles, TrajectoriesWithWhatIsReadBesideThem) {
  const TemporaryFolder folder;
  folder.write("street.ply", "ply");
  folder.write("car.obj", "v 0 0 0");
  folder.write("a/poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  folder.write("b/way.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n");
  for (const char* name : {"a/calib.txt", "a/times.txt", "b/calib.txt", "b/times.txt"})
    folder.write(name, "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  std::string world = "model = \"street.ply\"\n";
  for (const char* way : {"a/poses.txt", "b/way.csv", "a/poses.txt"})
    world += std::string("[[object]]\ngeometry = \"car.obj\"\ntrajectory = \"") + way + "\"\n";
  std::vector<std::string> names;
  for (const auto& file : files_of_scene(folder.write("world.toml", world)))
    names.push_back(file.lexically_relative(folder.path()).string());
  EXPECT_EQ(names, (std::vector<std::string>{"world.toml", "street.ply", "car.obj", "a/poses.txt",
                                             "a/calib.txt", "a/times.txt", "b/way.csv"}));
  std::filesystem::remove(folder.path() / "a/times.txt");
  EXPECT_EQ(files_of_scene(folder.path() / "world.toml").size(), 6U);
}

}  // namespace
}  // namespace adasplats
