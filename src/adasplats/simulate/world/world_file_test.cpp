// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/world_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

constexpr const char* kTriangle = "v 1 0 0\nv 1 1 0\nv 1 0 1\nf 1 2 3\n";

class WorldFileTest : public testing::Test {
 protected:
  WorldFileTest() {
    folder_.write("parts/car.obj", kTriangle);
    folder_.write("street.ply", "not read here");
    folder_.write("way.csv", "time,x,y,z,qw,qx,qy,qz\n0,10,0,0,1,0,0,0\n2,30,0,0,1,0,0,0\n");
    folder_.write("turned.csv",
                  "time,x,y,z,qw,qx,qy,qz\n0,10,0,0,0.70710678118654752,0,0,0.70710678118654752\n"
                  "2,30,0,0,0.70710678118654752,0,0,0.70710678118654752\n");
    SplatModel splats;
    splats.disks = {{{0, 0, 0}, 1, {1, 0, 0}}, {{0, 3, 0}, 1, {1, 0, 0}}};
    splats.classes = {252, 254};
    save_model(folder_.path() / "splats.ply", splats);
  }

  WorldFile read(const std::string& content) const {
    return read_world_file(folder_.write("world.toml", content));
  }
  World filled(const std::string& content) const {
    World world(0, {});
    add_objects(world, read(content), semantickitti_labels());
    return world;
  }
  void expect_refused(const std::string& content, const std::vector<std::string>& parts,
                      ErrorKind kind = ErrorKind::config) const {
    expect_error(kind, parts, [&] { filled(content); });
  }

  TemporaryFolder folder_;
  Executor executor_{1};
};

TEST_F(WorldFileTest, ObjectsWithoutAFreeNumberNeedAnInstance) {
  std::string content;
  for (int i = 0; i < 65536; ++i) content += "[[object]]\ngeometry = \"parts/car.obj\"\n";
  expect_error(ErrorKind::config, {"instance", "65536"}, [&] { read(content); });
  EXPECT_EQ(read(content + "instance = 65535\n").objects.back().instance, 65535);
}

// Oracle: the numbers in the file.
TEST_F(WorldFileTest, EveryKey) {
  const WorldFile file = read(R"(model = "street.ply"
[[object]]
geometry = "parts/car.obj"
class = "car"
instance = 7
position = [12.0, -3.5, 1]
yaw_deg = 90
pitch_deg = 0.0
roll_deg = 0
scale = 2.5
trajectory = "way.csv"
present = "during"
scan = 12
name = "taxi"

[[object]]
geometry = "splats.ply"
)");
  EXPECT_EQ(file.model, folder_.path() / "street.ply");
  ASSERT_EQ(file.objects.size(), 2U);
  const WorldFileObject& taxi = file.objects[0];
  EXPECT_EQ(taxi.line, 2U);
  EXPECT_EQ(taxi.name, "taxi");
  EXPECT_EQ(taxi.geometry, folder_.path() / "parts/car.obj");
  EXPECT_EQ(std::get<std::string>(*taxi.class_id), "car");
  EXPECT_EQ(taxi.instance, 7);
  EXPECT_EQ(taxi.placement.translation, (Vec3d{12, -3.5, 1}));
  EXPECT_NEAR(length(taxi.placement.rotation * Vec3d{1, 0, 0} - Vec3d{0, 1, 0}), 0, 1e-15);
  EXPECT_EQ(taxi.scale, 2.5);
  EXPECT_EQ(taxi.trajectory, folder_.path() / "way.csv");
  EXPECT_TRUE(taxi.only_during);
  EXPECT_EQ(taxi.only_scan, 12U);
  const WorldFileObject& plain = file.objects[1];
  EXPECT_EQ(plain.name, "splats.ply");
  EXPECT_FALSE(plain.class_id);
  EXPECT_EQ(plain.instance, 2) << "its place in the file";
  EXPECT_TRUE(plain.trajectory.empty());
  EXPECT_FALSE(plain.only_during);
  EXPECT_FALSE(plain.only_scan);
  EXPECT_EQ(plain.scale, 1);
}

TEST_F(WorldFileTest, AnEmptyFileIsAWorld) {
  EXPECT_TRUE(read("").model.empty());
  EXPECT_TRUE(read("# a comment\n").objects.empty());
  EXPECT_TRUE(filled("model = \"street.ply\"").empty());
}

// Oracle: the corners of the triangle, turned, scaled and moved by hand.
TEST_F(WorldFileTest, ObjectsHaveThePositionsInTheFile) {
  const World world = filled(R"(
[[object]]
geometry = "parts/car.obj"
class = 18
position = [5, 6, 7]
yaw_deg = 90
scale = 2
[[object]]
geometry = "parts/car.obj"
class = "moving-car"
instance = 0
position = [0, 2, 1]
trajectory = "turned.csv"
)");
  EXPECT_EQ(world.object_count(), 2U);
  const std::vector<ObjectBox> boxes = world.boxes(0, 1.0);
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_EQ(boxes[0].class_id, 18);
  EXPECT_EQ(boxes[0].instance, 1);
  // The middle (1, 0.5, 0.5) is twice that and turned to (-1, 2, 1).
  EXPECT_NEAR(length(boxes[0].world_from_box.translation - Vec3d{4, 8, 8}), 0, 1e-12);
  EXPECT_NEAR(length(boxes[0].size_m - Vec3d{0, 2, 2}), 0, 1e-12);
  EXPECT_EQ(boxes[1].class_id, 252);
  EXPECT_EQ(boxes[1].instance, 0);
  // The middle in the frame that moves is (1, 2.5, 1.5), turned to (-2.5, 1, 1.5).
  EXPECT_NEAR(length(boxes[1].world_from_box.translation - Vec3d{17.5, 1, 1.5}), 0, 1e-9);
}

TEST_F(WorldFileTest, SplatsKeepTheirClassesUnlessTheFileHasOne) {
  const auto classes_of = [](World world) {
    const auto classes = world.attributes({}).classes;
    return std::vector<std::uint16_t>(classes.begin(), classes.end());
  };
  EXPECT_EQ(classes_of(filled("[[object]]\ngeometry = \"splats.ply\"\n")),
            (std::vector<std::uint16_t>{252, 254}));
  EXPECT_EQ(classes_of(filled("[[object]]\ngeometry = \"splats.ply\"\nclass = \"bus\"\n")),
            (std::vector<std::uint16_t>{13, 13}));
}

TEST_F(WorldFileTest, UnknownKeysAndWords) {
  const std::string object = "[[object]]\ngeometry = \"parts/car.obj\"\n";
  expect_refused("modle = 1", {"world.toml:1:", "'modle'", "did you mean 'model'?"});
  expect_refused(object + "yaw = 3", {"world.toml:3:", "'yaw'"});
  expect_refused(object + "positon = [0, 0, 0]", {":3:", "did you mean 'position'?"});
  expect_refused(object + "class = \"caar\"", {":1:", "semantickitti", "did you mean 'car'?"});
  expect_refused(object + "present = \"durin\"", {":3:", "did you mean 'during'?"});
  expect_refused(object + "present = \"x\"", {":3:", "expected 'always', 'during' or two times"});
  expect_refused("[[object", {"world.toml:1:"});
}

TEST_F(WorldFileTest, ValuesOfAnotherKind) {
  const std::string object = "[[object]]\ngeometry = \"parts/car.obj\"\n";
  expect_refused("[[object]]\nname = \"x\"", {":1:", "geometry", "missing"});
  expect_refused("object = 3", {":1:", "[[object]]"});
  expect_refused("[object]\ngeometry = \"parts/car.obj\"", {":1:", "[[object]]"});
  for (const char* line :
       {"class = -1", "class = 65536", "class = 1.5", "instance = -1", "instance = \"a\"",
        "position = 3", "position = [1, 2]", "position = [1, nan, 2]", "position = [1, \"2\", 3]",
        "yaw_deg = 361", "roll_deg = inf", "pitch_deg = true", "scale = 0", "scale = -1",
        "scale = nan", "trajectory = 3", "name = \"\"", "scan = -1", "present = true"}) {
    const std::string key(line, std::string(line).find(' '));
    expect_refused(object + line, {"world.toml:3:", key});
  }
  expect_refused(object + "present = \"during\"", {":3:", "trajectory"});
  folder_.write("one.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n");
  expect_refused(object + "trajectory = \"one.csv\"\npresent = \"during\"", {":1:", "one pose"});
}

TEST_F(WorldFileTest, MissingFilesAreNamed) {
  expect_refused("model = \"none.ply\"", {"world.toml:1:", "model", "none.ply"},
                 ErrorKind::no_input);
  expect_refused("[[object]]\ngeometry = \"none.obj\"", {":2:", "geometry", "none.obj"},
                 ErrorKind::no_input);
  expect_refused("[[object]]\ngeometry = \"splats.ply\"\ntrajectory = \"none.csv\"",
                 {":3:", "trajectory", "none.csv"}, ErrorKind::no_input);
  expect_refused("[[object]]\ngeometry = \"way.csv\"", {"way.csv"}, ErrorKind::data);
  expect_error(ErrorKind::no_input, {"nowhere.toml"},
               [&] { read_world_file(folder_.path() / "nowhere.toml"); });
}

TEST_F(WorldFileTest, BrokenFilesNeverCrash) {
  std::mt19937_64 random(3);
  const std::string seed =
      "model = \"street.ply\"\n[[object]]\ngeometry = \"splats.ply\"\nclass = 3\nposition = [1, 2, "
      "3]\nscale = 1.5\ntrajectory = \"way.csv\"\npresent = \"during\"\n";
  for (int round = 0; round < 500; ++round) {
    std::string content = seed;
    for (std::size_t step = 0; step <= random() % 3; ++step)
      content[random() % content.size()] = static_cast<char>(random());
    std::filesystem::remove(folder_.path() / "world.toml");
    try {
      filled(content);
    } catch (const Error&) {
    }
  }
  expect_refused(std::string(100'000, '['), {":1:"});
  std::string dots = "a";
  for (int i = 0; i < 1000; ++i) dots += ".a";
  expect_refused(dots + " = 1", {":1:", "dots"});
}

// way.csv goes from x = 10 at 0 s to 30 at 2 s.
TEST_F(WorldFileTest, TrajectoriesCanBeDelayedAndChangedInSpeed) {
  const std::string object = "[[object]]\ngeometry = \"parts/car.obj\"\ntrajectory = \"way.csv\"\n";
  const World world = filled(object + "delay_s = 3\nspeed_factor = 2\n" + object +
                             "present = [0.5, 1]\nspeed_factor = 2\n");
  const Trajectory& late = world.object(0).trajectory;
  EXPECT_EQ(late.front().time_s, 3);
  EXPECT_EQ(late.back().time_s, 4);
  EXPECT_EQ(late.back().world_from_sensor.translation.x, 30);
  const WorldObject& part = world.object(1);
  EXPECT_TRUE(part.only_during);
  EXPECT_EQ(part.trajectory.front().time_s, 0.25);
  EXPECT_EQ(part.trajectory.front().world_from_sensor.translation.x, 15);
  EXPECT_EQ(part.trajectory.back().time_s, 0.5);
  EXPECT_EQ(part.trajectory.back().world_from_sensor.translation.x, 20);
  expect_refused("[[object]]\ngeometry = \"parts/car.obj\"\ndelay_s = 3\n",
                 {":3:", "delay_s needs a trajectory"});
  expect_refused(object + "speed_factor = 0\n", {":4:", "speed_factor is not a number from 0.01"});
  expect_refused(object + "present = [3, 4]\n", {"present is outside the times of"});
  expect_refused(object + "present = [1, 1]\n", {":4:", "present ends before it begins"});
  expect_refused(object + "present = [1]\n", {":4:", "present is not a list of two times"});
}

TEST_F(WorldFileTest, TrajectoriesOfOpenScenario) {
  folder_.write(
      "a.xosc",
      "<OpenSCENARIO><Trajectory name=\"t\"><Shape><Polyline><Vertex time=\"1\"><Position>"
      "<WorldPosition x=\"7\" y=\"0\"/></Position></Vertex></Polyline></Shape>"
      "</Trajectory></OpenSCENARIO>");
  const World world =
      filled("[[object]]\ngeometry = \"parts/car.obj\"\ntrajectory = \"a.xosc:t\"\n");
  EXPECT_EQ(world.object(0).trajectory.front().world_from_sensor.translation.x, 7);
  expect_refused("[[object]]\ngeometry = \"parts/car.obj\"\ntrajectory = \"b.xosc:t\"\n",
                 {"b.xosc:t, which does not exist"}, ErrorKind::no_input);
}

}  // namespace
}  // namespace adasplats
