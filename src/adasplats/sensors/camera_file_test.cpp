// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/camera_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

// Oracle of these tests: the values written to the files.

void expect_near(Vec3d found, Vec3d expected) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[axis], expected[axis], 1e-9) << axis;
}

/// A valid file with `from` replaced by `to`.
std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const std::string kToml = R"(
[[camera]]
name = "front"
width = 1920
height = 1080
fx = 1000.5
fy = 1001.5
cx = 960.25
cy = 540.75
model = "brown_conrady"
coefficients = [-0.3, 0.1, 0.001, -0.002, -0.01]
mount = [1.5, 0.25, 1.75]
mount_rotation_deg = [90, 0, 0]

[[camera]]
name = "rear"
width = 640
height = 480
fx = 300
fy = 300
cx = 320
cy = 240
model = "fisheye"
coefficients = [0.1, 0.2, 0.3, 0.4]
mount_quaternion = [0.5, -0.5, 0.5, -0.5]
)";

TEST(CameraFile, ReadsOurToml) {
  const TemporaryFolder folder;
  const std::string file = folder.write("cameras.toml", kToml).string();
  const MountedCamera front = load_camera(file + ":front");
  EXPECT_EQ(front.name, "front");
  EXPECT_EQ(front.lens.width, 1920);
  EXPECT_EQ(front.lens.height, 1080);
  EXPECT_EQ(front.lens.fx, 1000.5);
  EXPECT_EQ(front.lens.fy, 1001.5);
  EXPECT_EQ(front.lens.cx, 960.25);
  EXPECT_EQ(front.lens.cy, 540.75);
  EXPECT_EQ(front.lens.k[0], -0.3);
  EXPECT_EQ(front.lens.k[1], 0.1);
  EXPECT_EQ(front.lens.k[2], -0.01);
  EXPECT_EQ(front.lens.p1, 0.001);
  EXPECT_EQ(front.lens.p2, -0.002);
  expect_near(front.vehicle_from_camera.translation, {1.5, 0.25, 1.75});
  expect_near(front.vehicle_from_camera.rotation * Vec3d{1, 0, 0}, {0, 1, 0});  // to the left
  const MountedCamera rear = load_camera(file + ":rear");
  EXPECT_TRUE(rear.lens.is_fisheye);
  EXPECT_EQ(rear.lens.k[3], 0.4);
  // The quaternion of ROS for a camera that looks forward.
  expect_near(rear.vehicle_from_camera.rotation * Vec3d{1, 2, 3}, {1, 2, 3});
  const Camera camera = front.at({{}, {100, 0, 0}});
  expect_near(camera.world_from_camera.translation, {101.5, 0.25, 1.75});
  EXPECT_EQ(camera.width, 1920);
}

TEST(CameraFile, ReadsTheCamerasOfARigFile) {
  const TemporaryFolder folder;
  const std::string rig = "trajectory = \"p.csv\"\nbody = []\n[[sensors]]\nname = \"top\"\n";
  const std::string file = folder.write("rig.toml", rig + kToml).string();
  EXPECT_EQ(load_camera(file + ":front").lens.fx, 1000.5);
  folder.write("rig.toml", rig);
  expect_error(ErrorKind::config, {"rig.toml", "describes no camera", "is a rig file", "`rig`"},
               [&] { load_camera(file); });
  folder.write("rig.toml", rig + changed(kToml, "fx = 1000.5", "fx = 0"));
  expect_error(ErrorKind::config, {"rig.toml:7: camera front", "fx is 0"},
               [&] { load_camera(file + ":front"); });
}

// Oracle: round trip; each model of distortion.
TEST(CameraFile, ItsTextIsReadBack) {
  const TemporaryFolder folder;
  const std::string ideal =
      "[[camera]]\nname = \"a\"\nwidth = 4\nheight = 3\nfx = 2\nfy = 2\n"
      "cx = 1.5\ncy = 1\n";
  for (const std::string& text :
       {kToml, ideal,
        ideal + "model = \"rational\"\ncoefficients = [0.1, 0, 0, 0, 0, 0, 0.2, 0]\n"}) {
    const std::string name = text.starts_with("[") ? "" : ":rear";
    const MountedCamera camera = load_camera(folder.write("a.toml", text).string() + name);
    const MountedCamera back = load_camera(folder.write("b.toml", camera_toml(camera)).string());
    EXPECT_EQ(back.name, camera.name);
    EXPECT_EQ(back.lens.is_fisheye, camera.lens.is_fisheye);
    EXPECT_EQ(back.lens.cx, camera.lens.cx);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(back.lens.k[i], camera.lens.k[i]) << i;
    expect_near(back.vehicle_from_camera * Vec3d{1, 2, 3},
                camera.vehicle_from_camera * Vec3d{1, 2, 3});
  }
}

TEST(CameraFile, EachFaultOfOurTomlIsOneError) {
  const TemporaryFolder folder;
  const auto fault = [&](const std::string& from, const std::string& to,
                         const std::vector<std::string>& parts) {
    const std::string file = folder.write("cameras.toml", changed(kToml, from, to)).string();
    expect_error(ErrorKind::config, parts, [&] { load_camera(file + ":front"); });
  };
  fault("width = 1920\n", "", {"cameras.toml:3: camera front", "width", "is missing"});
  fault("width = 1920", "width = 0", {"width", "1 to 32768"});
  fault("fx = 1000.5", "fx = 0", {"camera front", "fx is 0"});
  fault("fx = 1000.5", "fx = nan", {"fx is not a number"});
  fault("cx = 960.25\n", "", {"cx", "is missing"});
  fault("\"brown_conrady\"", "\"division\"", {"unknown distortion model 'division'"});
  fault("-0.002, -0.01]", "-0.002]  # 4 are fine\nfocal = 3", {"unknown key 'focal'"});
  fault("0.1, 0.001, -0.002, -0.01]", "0.1]", {"2 coefficients of brown_conrady", "expected 5"});
  fault("[1.5, 0.25, 1.75]", "[1.5, 0.25]", {"mount", "[x, y, z]"});
  fault("[90, 0, 0]", "[90, 0]", {"mount_rotation_deg", "yaw, pitch and roll"});
  fault("[90, 0, 0]", "[90, 0, 0]\nmount_quaternion = [1, 0, 0, 0]", {"expected one of them"});
  fault("mount_rotation_deg = [90, 0, 0]", "mount_quaternion = [1, 1, 0, 0]", {"length 1"});
  fault("\"rear\"", "\"front\"", {"name", "another camera"});
  fault("name = \"rear\"\n", "", {"name", "is missing"});
  fault("[[camera]]", "[camera]", {"cameras.toml"});
  const std::string file = folder.write("cameras.toml", kToml).string();
  expect_error(ErrorKind::usage, {"front, rear", "cameras.toml:NAME"}, [&] { load_camera(file); });
  expect_error(ErrorKind::usage, {"'left'", "front, rear"}, [&] { load_camera(file + ":left"); });
  expect_error(ErrorKind::no_input, {"none.toml"},
               [&] { load_camera((folder.path() / "none.toml").string()); });
  expect_error(ErrorKind::config, {"is no camera"},
               [&] { load_camera(folder.write("a.txt", "hello").string()); });
}

const std::string kCalibrationYaml = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [438.783367, 0.000000, 305.593336, 0.000000, 437.302876, 243.738352, 0.000000,
         0.000000, 1.000000]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.361976, 0.110510, 0.001014, 0.000505, 0.000000]  # k1 k2 p1 p2 k3
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
)";

const std::string kMessageYaml = R"(header:
  stamp:
    sec: 1
    nanosec: 2
  frame_id: camera
height: 480
width: 640
distortion_model: rational_polynomial
d:
- 0.1
- -0.2
- 0.001
- 0.002
- 0.03
- 0.4
- 0.05
- 0.006
k:
- 438.783367
- 0.0
- 305.593336
- 0.0
- 437.302876
- 243.738352
- 0.0
- 0.0
- 1.0
binning_x: 0
---
)";

const std::string kMessageJson = R"({"width": 640, "height": 480, "distortion_model": "equidistant",
"D": [0.1, 0.2, 0.3, 0.4], "K": [438.783367, 0, 305.593336, 0, 437.302876, 243.738352, 0, 0, 1]})";

const std::string kOpenCvYaml = R"(%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 438.783367, 0., 305.593336, 0., 437.302876, 243.738352, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -3.61976e-01, 1.10510e-01, 1.014e-03, 5.05e-04, 0. ]
)";

TEST(CameraFile, ReadsTheFilesOfRosAndOpenCv) {
  const TemporaryFolder folder;
  for (const auto& [name, text] :
       {std::pair{"a.yaml", kCalibrationYaml}, std::pair{"b.yml", kMessageYaml},
        std::pair{"c.json", kMessageJson}, std::pair{"d.yaml", kOpenCvYaml}}) {
    const MountedCamera camera = load_camera(folder.write(name, text).string());
    EXPECT_EQ(camera.lens.width, 640) << name;
    EXPECT_EQ(camera.lens.height, 480);
    EXPECT_EQ(camera.lens.fx, 438.783367);
    EXPECT_EQ(camera.lens.fy, 437.302876);
    EXPECT_EQ(camera.lens.cx, 305.593336);
    EXPECT_EQ(camera.lens.cy, 243.738352);
    EXPECT_EQ(camera.lens.is_fisheye, std::string(name) == "c.json");
    expect_near(camera.vehicle_from_camera.rotation * Vec3d{1, 2, 3}, {1, 2, 3});
  }
  const Lens plumb = load_camera((folder.path() / "a.yaml").string() + ":narrow_stereo").lens;
  EXPECT_EQ(plumb.k[0], -0.361976);
  EXPECT_EQ(plumb.p2, 0.000505);
  EXPECT_EQ(load_camera((folder.path() / "d.yaml").string()).lens.k[0], -0.361976);
  const Lens rational = load_camera((folder.path() / "b.yml").string()).lens;
  EXPECT_EQ(rational.k[1], -0.2);
  EXPECT_EQ(rational.k[5], 0.006);
  EXPECT_EQ(load_camera((folder.path() / "c.json").string()).lens.k[2], 0.3);
}

TEST(CameraFile, EachFaultOfCameraInfoIsOneError) {
  const TemporaryFolder folder;
  const auto fault = [&](const std::string& from, const std::string& to,
                         const std::vector<std::string>& parts) {
    const std::string file = folder.write("a.yaml", changed(kCalibrationYaml, from, to)).string();
    expect_error(ErrorKind::config, parts, [&] { load_camera(file); });
  };
  fault("image_width: 640\n", "", {"a.yaml", "states no size"});
  fault("image_width: 640", "image_width: 640.5", {"image_width", "whole number"});
  fault("camera_matrix:", "matrix:", {"no camera_matrix"});
  fault("[438.783367, 0.000000,", "[438.783367,", {"8 numbers, expected 9"});
  fault("[438.783367, 0.000000,", "[438.783367, 0.5,", {"skew"});
  fault("438.783367", ".nan", {"camera_matrix", "finite"});
  fault("438.783367", "0", {"fx is 0"});
  fault("plumb_bob", "plumb", {"unknown distortion model 'plumb'"});
  fault("0.000505, 0.000000]", "0.000505, 0.0, 0.0]", {"6 coefficients of plumb_bob"});
}

const std::string kOdometry =
    "P0: 718.856 0 607.1928 0 0 718.856 185.2157 0 0 0 1 0\n"
    "P2: 718.856 0 607.1928 45.38225 0 718.856 185.2157 -0.1130887 0 0 1 0.003779761\n"
    "Tr: 0 -1 0 0.1 0 0 -1 -0.2 1 0 0 -0.3\n";

/// A header of a PNG of 1241 x 376 pixels.
const std::string kPng = std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x04\xd9\0\0\x01\x78", 24);

// Oracle: the readme of the odometry: the pixel of a point of the LiDAR is P2 Tr x.
TEST(CameraFile, ReadsKittiOdometry) {
  const TemporaryFolder folder;
  const std::string file = folder.write("calib.txt", kOdometry).string();
  expect_error(ErrorKind::config, {"camera P2", "states no size", "TOML"},
               [&] { load_camera(file + ":P2"); });
  folder.write("kitti.toml",
               "[[camera]]\nname = \"left\"\nfile = \"calib.txt:P2\"\n"
               "width = 1242\nheight = 375\n");
  EXPECT_EQ(load_camera((folder.path() / "kitti.toml").string()).lens.width, 1242);
  folder.write("other.toml", "[[camera]]\nname = \"left\"\nfile = \"absent.txt\"\n");
  expect_error(ErrorKind::no_input, {"other.toml:2: camera left", "absent.txt"},
               [&] { load_camera((folder.path() / "other.toml").string()); });
  folder.write("image_2/000000.png", kPng);
  const MountedCamera camera = load_camera(file + ":P2");
  EXPECT_EQ(camera.lens.width, 1241);
  EXPECT_EQ(camera.lens.height, 376);
  expect_error(ErrorKind::config, {"kitti.toml", "width"},
               [&] { load_camera((folder.path() / "kitti.toml").string()); });
  expect_error(ErrorKind::usage, {"P0, P2"}, [&] { load_camera(file); });
  for (const Vec3d x : {Vec3d{10, 2, -1}, Vec3d{30, -8, 0.5}, Vec3d{5, 0.3, -1.6}}) {
    const Vec3d rectified = {-x.y + 0.1, -x.z - 0.2, x.x - 0.3};
    const double w = rectified.z + 0.003779761;
    const double u = (718.856 * rectified.x + 607.1928 * rectified.z + 45.38225) / w;
    const double v = (718.856 * rectified.y + 185.2157 * rectified.z - 0.1130887) / w;
    const Vec3d in_camera = camera.vehicle_from_camera.inverse() * x;
    const auto pixel = project(camera.lens, {-in_camera.y, -in_camera.z, in_camera.x});
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x, u, 1e-6);
    EXPECT_NEAR(pixel->y, v, 1e-6);
    EXPECT_NEAR(in_camera.x, w, 1e-9);
  }
}

TEST(CameraFile, KittisFilesMayHaveOneCameraOrNone) {
  const TemporaryFolder folder;
  folder.write("image_2/000000.png", kPng);
  const std::string without_first = kOdometry.substr(kOdometry.find("P2:"));
  const std::string file = folder.write("calib.txt", without_first).string();
  EXPECT_EQ(load_camera(file).name, "P2");
  folder.write("calib.txt", kOdometry.substr(kOdometry.find("Tr:")));
  expect_error(ErrorKind::config, {"calib.txt", "none of the lines P0 to P3"},
               [&] { load_camera(file); });
}

// Oracle: a point of the LiDAR is the same point of the camera in either frame: that of the LiDAR
// without a mount, of the vehicle with one.
TEST(CameraFile, KittisMountInARigIsOnItsFirstSensor) {
  const TemporaryFolder folder;
  folder.write("calib.txt", kOdometry);
  folder.write("image_2/000000.png", kPng);
  const std::string camera = "[[camera]]\nname = \"c\"\nfile = \"calib.txt:P2\"\n";
  const std::string second = "[[sensors]]\nname = \"b\"\nmount = [7, 7, 7]\n";
  const auto mount_of = [&](const std::string& sensors, const std::string& of_camera = "") {
    const std::string text = sensors + camera + of_camera;
    return load_camera(folder.write("rig.toml", text).string()).vehicle_from_camera;
  };
  const RigidTransform lidar_from_camera = mount_of("");
  const RigidTransform same = mount_of("[[sensors]]\nname = \"a\"\n" + second);
  const RigidTransform vehicle_from_camera = mount_of(
      "[[sensors]]\nname = \"a\"\nmount = [1, 2, 3]\nmount_rotation_deg = [90, 0, 0]\n" + second);
  for (const Vec3d in_camera : {Vec3d{10, 2, -1}, Vec3d{30, -8, 0.5}}) {
    const Vec3d x = lidar_from_camera * in_camera;
    expect_near(same * in_camera, x);
    expect_near(vehicle_from_camera * in_camera, {1 - x.y, 2 + x.x, 3 + x.z});
  }
  const RigidTransform own =
      mount_of("[[sensors]]\nname = \"a\"\nmount = [1, 2, 3]\n", "mount = [0.5, 0, 1]\n");
  expect_near(own * Vec3d{1, 0, 0}, {1.5, 0, 1});
}

// Oracle: the readme of the raw data: P_rect_02 R_rect_00 [R T] x.
TEST(CameraFile, ReadsKittiRaw) {
  const TemporaryFolder folder;
  const std::string text =
      "calib_time: 09-Jan-2012 13:57:47\n"
      "S_rect_02: 1.242000e+03 3.750000e+02\n"
      "R_rect_00: 0 -1 0 1 0 0 0 0 1\n"
      "P_rect_02: 700 0 600 35 0 710 170 7.1 0 0 1 0.01\n";
  const std::string file = folder.write("calib_cam_to_cam.txt", text).string();
  expect_error(ErrorKind::no_input, {"calib_velo_to_cam.txt"}, [&] { load_camera(file); });
  folder.write("calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0.1 -0.2 -0.3\n");
  const MountedCamera camera = load_camera(file);
  EXPECT_EQ(camera.lens.width, 1242);
  EXPECT_EQ(camera.lens.height, 375);
  const Vec3d x = {10, 2, -1}, first = {-2 + 0.1, 1 - 0.2, 10 - 0.3};
  const Vec3d rectified = {-first.y, first.x, first.z};
  const Vec3d in_camera = camera.vehicle_from_camera.inverse() * x;
  const auto pixel = project(camera.lens, {-in_camera.y, -in_camera.z, in_camera.x});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x, (700 * rectified.x + 600 * rectified.z + 35) / (rectified.z + 0.01), 1e-6);
  EXPECT_NEAR(pixel->y, (710 * rectified.y + 170 * rectified.z + 7.1) / (rectified.z + 0.01), 1e-6);
  const auto fault = [&](const std::string& from, const std::string& to,
                         const std::vector<std::string>& parts) {
    folder.write("calib_cam_to_cam.txt", changed(text, from, to));
    expect_error(ErrorKind::config, parts, [&] { load_camera(file); });
  };
  fault("R_rect_00: 0 -1", "R_rect_00: 0 -2", {"R_rect_00", "is not a rotation"});
  fault("35 0 710", "35 0 x", {"P_rect_02", "12 finite numbers"});
  fault("S_rect_02", "S_rect_03", {"no line S_rect_02"});
  fault("700 0 600", "700 1 600", {"P_rect_02", "skew"});
}

}  // namespace
}  // namespace adasplats
