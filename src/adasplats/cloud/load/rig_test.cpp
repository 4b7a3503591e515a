// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/rig.h"

#include <gtest/gtest.h>

#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

constexpr const char* kFull = R"(trajectory = "poses.csv"
body = [[1.5, 0, 0.75, 4.5, 1.8, 1.5]]
[[sensors]]
name = "top"
input = "drive.mcap"
topic = "/top/po\"in\\ts \u0007"
mount = [1.2, -0.5, 1.9]
mount_rotation_deg = [90, 5, 180]
time_offset_s = -0.02
body = [[1.2, -0.5, 1.9, 0.2, 0.1, 0.3], [1, 2, 3, 4, 5, 6]]
[[sensors]]
name = "front"
input = "front/"
sensor = "velodyne-vlp-16"
trajectory = "other/poses.csv"
points_in = "world"
sweep_points = "measured"
scan_times = "times.txt"
boxes = "boxes.csv"
poses_topic = "/odom"
scene = "scene-0061"
in_model = false
)";

Rig parsed(const std::string& text) { return parse_rig(text, "car/rig.toml"); }

std::string with(const std::string& line) { return "[[sensors]]\nname = \"top\"\n" + line + "\n"; }

// Oracle: the values in the text.
TEST(Rig, EveryKey) {
  const Rig rig = parsed(kFull);
  ASSERT_EQ(rig.sensors.size(), 2U);
  const RigSensor& top = rig.sensors[0];
  const RigSensor& front = rig.sensors[1];
  EXPECT_EQ(top.name + front.name, "topfront");
  EXPECT_EQ(top.folder, "car/drive.mcap");
  EXPECT_EQ(front.folder, "car/front");
  EXPECT_EQ(top.topic, "/top/po\"in\\ts \a");
  EXPECT_EQ(top.mount, (Vec3d{1.2, -0.5, 1.9}));
  EXPECT_EQ(top.mount_rotation_deg, (Vec3d{90, 5, 180}));
  EXPECT_EQ(top.time_offset_s, -0.02);
  EXPECT_EQ(front.time_offset_s, std::nullopt);
  EXPECT_EQ(front.given_mount(), std::nullopt);
  EXPECT_EQ(top.trajectory, "car/poses.csv");
  EXPECT_EQ(front.trajectory, "car/other/poses.csv");
  EXPECT_EQ(front.packet_sensor, "velodyne-vlp-16");
  EXPECT_EQ(front.points_in, PointsIn::world);
  EXPECT_EQ(front.sweep_points, SweepPoints::measured);
  EXPECT_EQ(front.scan_times, "car/times.txt");
  EXPECT_EQ(front.boxes, "car/boxes.csv");
  EXPECT_EQ(front.poses_topic + front.scene, "/odomscene-0061");
  EXPECT_TRUE(top.is_in_model && !front.is_in_model);
  ASSERT_EQ(rig.body.size(), 1U);
  EXPECT_EQ(rig.body[0].center_m, (Vec3d{1.5, 0, 0.75}));
  EXPECT_EQ(rig.body[0].size_m, (Vec3d{4.5, 1.8, 1.5}));
  ASSERT_EQ(top.body.size(), 2U);
  EXPECT_EQ(top.body[1].size_m, (Vec3d{4, 5, 6}));
  EXPECT_TRUE(front.body.empty());
  EXPECT_EQ(rig.index_of("front"), 1U);
  expect_error(ErrorKind::usage, {"car/rig.toml", "'left'", "top, front"},
               [&] { rig.index_of("left"); });
}

// Oracle: round trip.
TEST(Rig, ItsTextIsReadBack) {
  const Rig rig = parsed(kFull);
  const Rig back = parsed(rig_toml(rig));
  ASSERT_EQ(back.sensors.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const DriveSettings &one = rig.sensors[k], &other = back.sensors[k];
    EXPECT_TRUE(one == other) << rig_toml(back);
    EXPECT_EQ(rig.sensors[k].folder, back.sensors[k].folder);
    EXPECT_EQ(rig.sensors[k].is_in_model, back.sensors[k].is_in_model);
    EXPECT_EQ(rig.sensors[k].body.size(), back.sensors[k].body.size());
  }
  EXPECT_EQ(back.body.at(0).size_m, rig.body[0].size_m);
  EXPECT_EQ(rig_toml(back), rig_toml(rig));
}

// Sensors' files are next to the rig file; other words are names of the library.
TEST(Rig, FilesOfSensorsAreNextToIt) {
  const TemporaryFolder folder;
  folder.write("mine.toml", "");
  const auto file = folder.path() / "rig.toml";
  const Rig rig = parse_rig(with("sensor = \"mine.toml\""), file);
  EXPECT_EQ(rig.sensors[0].packet_sensor, (folder.path() / "mine.toml").string());
  EXPECT_NE(rig_toml(rig).find("sensor = \"mine.toml\""), std::string::npos) << rig_toml(rig);
}

constexpr const char* kCamera = R"([[camera]]
name = "wide \"1\""
width = 640
height = 480
fx = 300.5
fy = 301
cx = 320
cy = 240
model = "rational"
coefficients = [0.1, 0.2, 0.001, -0.002, 0.03, 0.04, 0.05, 0.06]
mount = [1.5, 0.25, 1.75]
mount_rotation_deg = [30, 90, 0]
)";

// Oracle: the values in the text, and round trip.
TEST(Rig, HasCameras) {
  const Rig rig = parsed(with("") + kCamera), back = parsed(rig_toml(rig));
  for (const Rig& each : {rig, back}) {
    ASSERT_EQ(each.cameras.size(), 1U);
    const MountedCamera& camera = each.cameras[0];
    const double k[] = {0.1, 0.2, 0.03, 0.04, 0.05, 0.06};
    EXPECT_EQ(camera.name, "wide \"1\"");
    EXPECT_EQ(camera.lens.width * 1000 + camera.lens.height, 640480);
    EXPECT_EQ(camera.lens.fx, 300.5);
    EXPECT_EQ(camera.lens.fy, 301);
    EXPECT_EQ(camera.lens.cx, 320);
    EXPECT_EQ(camera.lens.cy, 240);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(camera.lens.k[i], k[i]) << i;
    EXPECT_EQ(camera.lens.p1, 0.001);
    EXPECT_EQ(camera.lens.p2, -0.002);
    EXPECT_EQ(camera.vehicle_from_camera.translation, (Vec3d{1.5, 0.25, 1.75}));
    const Mat3d down = rotation_from_yaw_pitch_roll(kDegree * 30, kDegree * 90, 0);
    EXPECT_LT(angle_between(camera.vehicle_from_camera.rotation, down), 1e-9);
  }
}

// Oracle: where the camera and the boxes are in the world.
TEST(Rig, CamerasAndBoxesMoveToTheFrameOfASensor) {
  const Rig rig = parsed("body = [[1, 2, 3, 4, 5, 6]]\n" + with("") + kCamera);
  const RigidTransform turned{rotation_from_yaw_pitch_roll(0.4, 0.1, 3), {1, -2, 3}};
  const RigidTransform shifted{{}, {1, -2, 3}};
  Rig moved = rig;
  EXPECT_TRUE(move_to_frame_of(shifted, moved));
  EXPECT_EQ(moved.body.at(0).center_m, (Vec3d{0, 4, 0}));
  EXPECT_EQ(moved.body[0].size_m, (Vec3d{4, 5, 6}));
  moved = rig;
  EXPECT_FALSE(move_to_frame_of(turned, moved));
  EXPECT_TRUE(moved.body.empty());
  const Vec3d point{7, 8, 9};
  EXPECT_LT(length(turned * (moved.cameras[0].vehicle_from_camera * point) -
                   rig.cameras[0].vehicle_from_camera * point),
            1e-12);
}

// Oracle: the calibration of the camera with the LiDAR, whose mount was corrected meanwhile.
TEST(Rig, ACameraStaysOnTheLidarThatItWasCalibratedWith) {
  const RigidTransform lidar_from_camera{{}, {0.1, 0.2, -0.3}};
  Rig rig = parsed(with("mount = [0, 0, 2]") + kCamera);
  rig.cameras[0].lidar_from_camera = lidar_from_camera;
  move_to_frame_of({rotation_from_yaw_pitch_roll(0.1, 0, 0), {0, 0, 2.5}}, rig);
  EXPECT_EQ(rig.cameras[0].vehicle_from_camera.translation, lidar_from_camera.translation);
}

// A rig file by a relative path is written to an absolute folder, and the other way round.
TEST(Rig, PathsAreRelativeToItsFolder) {
  Rig rig = parse_rig(with("input = \"../scans/top\""), "car/rig.toml");
  rig.file = std::filesystem::absolute("found/rig.toml");
  EXPECT_NE(rig_toml(rig).find("input = \"../scans/top\""), std::string::npos) << rig_toml(rig);
  rig.file = "other/deep/rig.toml";
  EXPECT_NE(rig_toml(rig).find("input = \"../../scans/top\""), std::string::npos);
}

TEST(Rig, WrongFilesGiveOneClearError) {
  const auto expect_bad = [](const std::string& text, std::vector<std::string> parts) {
    parts.push_back("rig.toml");
    expect_error(ErrorKind::config, parts, [&] { parsed(text); });
  };
  expect_bad("", {"describes no rig"});
  expect_bad("clockwise = true\n", {"describes no rig", "`sensor`"});
  expect_bad(kCamera, {"describes no rig", "is a camera file", "`camera`"});
  expect_bad("# no sensors\n" + std::string(kCamera), {"describes no rig", "`camera`"});
  expect_bad("sensors = []", {"is not a list of tables"});
  expect_bad("sensors = 3", {"sensors is not a list of tables"});
  expect_bad(with("mout = [0, 0, 1]"), {":3:", "unknown key 'mout'", "did you mean 'mount'?"});
  expect_bad("[[sensors]]\ninput = \"a\"\n", {"name is missing"});
  for (const char* name : {"", "a b", "a/b"})
    expect_bad("[[sensors]]\nname = \"" + std::string(name) + "\"\n", {":2:", "expected a word"});
  expect_bad(with("") + with(""), {":5:", "'top' is used twice"});
  expect_bad(with("mount = [0, 1]"), {":3:", "mount is not a list of three numbers"});
  expect_bad(with("mount = \"roof\""), {":3:", "mount"});
  expect_bad(with("mount = [0, 0, 1900]"), {":3:", "mount", "100"});
  expect_bad(with("mount = [0, 0, nan]"), {":3:", "mount"});
  expect_bad(with("mount_rotation_deg = [400, 0, 0]"), {":3:", "mount_rotation_deg", "360"});
  expect_bad(with("time_offset_s = \"now\""), {":3:", "time_offset_s"});
  expect_bad(with("points_in = \"word\""), {":3:", "'word'", "auto, sensor, world"});
  expect_bad(with("in_model = false"), {"has no sensor that is part of models"});
  expect_bad(with("input = \"\""), {":3:", "input is empty"});
  expect_bad(with("body = 3"), {":3:", "body is not a list"});
  expect_bad(with("body = [[1, 2, 3]]"), {":3:", "list of 3 numbers, expected 6"});
  expect_bad(with("body = [[1, 2, 3, 4, 5, 0]]"), {":3:", "height is not positive"});
  expect_bad(with("body = [[1, 2, 300, 4, 5, 1]]"), {":3:", "body", "100"});
  expect_bad(with("mount = ["), {":"});
  expect_bad(with("[[camera]]\nwidth = 3"), {"name is missing"});
  expect_bad(with(std::string(kCamera) + kCamera), {"name is that of another camera"});
  expect_bad(with(std::string(kCamera) + "focal = 3"), {":15:", "unknown key 'focal'"});
  expect_bad(
      with("[[camera]]\nname = \"a\"\nwidth = 4\nheight = 3\nfx = 0\nfy = 1\ncx = 1\ncy = 1"),
      {":4: camera a", "fx is 0"});
}

TEST(Rig, InputsMustExist) {
  const TemporaryFolder folder;
  const auto file = folder.write("rig.toml", with("input = \"missing\""));
  expect_error(ErrorKind::no_input, {"'top'", "missing"}, [&] { read_rig(file); });
  folder.write("rig.toml", with(""));
  expect_error(ErrorKind::config, {"'top'", "input"}, [&] { read_rig(file); });
  folder.write("missing", "");
  folder.write("rig.toml", with("input = \"missing\""));
  EXPECT_EQ(read_rig(file).sensors.at(0).folder, folder.path() / "missing");
}

}  // namespace
}  // namespace adasplats
