// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/sensors/camera_file.h"

namespace adasplats::nuscenes_cameras {
namespace {

using Rows = nlohmann::json;

/// Tables of two scenes in two logs with the same calibrations.
class Tables {
 public:
  Tables() {
    const double half = std::sqrt(0.5);
    tables["sensor"] = {{{"token", "front"}, {"channel", "CAM_FRONT"}, {"modality", "camera"}},
                        {{"token", "back"}, {"channel", "CAM_BACK"}, {"modality", "camera"}},
                        {{"token", "radar"}, {"channel", "RADAR_FRONT"}, {"modality", "radar"}},
                        {{"token", "lidar"}, {"channel", "LIDAR_TOP"}, {"modality", "lidar"}}};
    for (const char* name : {"scene", "sample", "sample_data", "calibrated_sensor"})
      tables[name] = Rows::array();
    for (const std::string log : {"A", "B"}) {
      add_calibration("lidar", log, {0.94, 0.25, 1.84}, {half, 0, 0, -half}, Rows::array());
      add_calibration("front", log, {1.7, 0.1, 1.5}, {0.5, -0.5, 0.5, -0.5},
                      {{1266, 0, 816}, {0, 1260, 491}, {0, 0, 1}});
      add_calibration("back", log, {0.03, 0.2, 1.6}, {0.5, -0.5, -0.5, 0.5},
                      {{796, 0, 857}, {0, 790, 478}, {0, 0, 1}});
      add_calibration("radar", log, {3, 0, 0.5}, {1, 0, 0, 0}, Rows::array());
      tables["scene"].push_back({{"token", "s" + log}, {"name", "scene-" + log}});
      tables["sample"].push_back({{"token", "k" + log}, {"scene_token", "s" + log}});
      for (const std::string sensor : {"lidar", "front", "back", "radar"}) {
        const bool is_camera = sensor == "front" || sensor == "back";
        tables["sample_data"].push_back({{"sample_token", "k" + log},
                                         {"calibrated_sensor_token", sensor + log},
                                         {"width", is_camera ? 1600 : 0},
                                         {"height", is_camera ? 900 : 0}});
      }
    }
  }

  std::string write() const {
    for (const auto& [name, rows] : tables.items())
      folder.write("v1.0-mini/" + name + ".json", rows.dump());
    return (folder.path() / "v1.0-mini").string();
  }

  /// The row of calibrated_sensor.
  Rows& calibration(const std::string& token) {
    for (Rows& row : tables["calibrated_sensor"])
      if (row["token"] == token) return row;
    throw std::logic_error(token);
  }

  TemporaryFolder folder;
  Rows tables;

 private:
  void add_calibration(const std::string& sensor, const std::string& log,
                       const std::vector<double>& at, const std::vector<double>& wxyz,
                       const Rows& matrix) {
    tables["calibrated_sensor"].push_back({{"token", sensor + log},
                                           {"sensor_token", sensor},
                                           {"translation", at},
                                           {"rotation", wxyz},
                                           {"camera_intrinsic", matrix}});
  }
};

/// A point of the LiDAR in the axes of nuScenes.
struct LidarPoint {
  double right, forward, up;
};

void expect_pixel(const MountedCamera& camera, LidarPoint p, double u, double v, double depth) {
  const Vec3d in_camera =
      camera.vehicle_from_camera.inverse() * Vec3d{p.forward, -p.right, p.up};  // our axes
  const auto pixel = project(camera.lens, {-in_camera.y, -in_camera.z, in_camera.x});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x, u, 1e-9);
  EXPECT_NEAR(pixel->y, v, 1e-9);
  EXPECT_NEAR(in_camera.x, depth, 1e-12);
}

// Oracle: the projection worked out by hand from LiDAR to ego vehicle to camera to pixel. The
// LiDAR has x to the right of the car, the cameras look ahead and back.
TEST(NuscenesCamera, PointsOfTheLidarAreAtTheirPixels) {
  const Tables tables;
  const std::string path = tables.write();
  const MountedCamera front = load_camera(path + ":CAM_FRONT");
  EXPECT_EQ(front.name, "CAM_FRONT");
  EXPECT_EQ(front.lens.width, 1600);
  EXPECT_EQ(front.lens.height, 900);
  for (const LidarPoint p : {LidarPoint{1, 20, 0.5}, LidarPoint{-4, 12, -1.5}}) {
    const Vec3d ego = {p.forward + 0.94, -p.right + 0.25, p.up + 1.84};
    const double depth = ego.x - 1.7;
    expect_pixel(front, p, 816 - 1266 * (ego.y - 0.1) / depth, 491 - 1260 * (ego.z - 1.5) / depth,
                 depth);
  }
  const MountedCamera back = load_camera(path + "/calibrated_sensor.json:CAM_BACK");
  for (const LidarPoint p : {LidarPoint{1, -20, 0.5}, LidarPoint{-4, -12, -1.5}}) {
    const Vec3d ego = {p.forward + 0.94, -p.right + 0.25, p.up + 1.84};
    const double depth = 0.03 - ego.x;
    expect_pixel(back, p, 857 + 796 * (ego.y - 0.2) / depth, 478 - 790 * (ego.z - 1.6) / depth,
                 depth);
  }
}

// Oracle: the tables; a value of one log of two is changed.
TEST(NuscenesCamera, ASceneIsChosenIfCalibrationsDiffer) {
  for (const std::string changed : {"frontB", "lidarB"}) {
    Tables tables;
    tables.calibration(changed)["translation"][2] = 2;
    const std::string path = tables.write();
    const std::string channel = changed == "frontB" ? "CAM_FRONT" : "LIDAR_TOP";
    expect_error(
        ErrorKind::usage,
        {"different calibrations of " + channel, "v1.0-mini:SCENE/CAM_FRONT", "scene-A, scene-B"},
        [&] { load_camera(path + ":CAM_FRONT"); });
    const double height_a =
        load_camera(path + ":scene-A/CAM_FRONT").vehicle_from_camera.translation.z;
    const double height_b =
        load_camera(path + ":scene-B/CAM_FRONT").vehicle_from_camera.translation.z;
    EXPECT_NEAR(height_a, 1.5 - 1.84, 1e-12);
    EXPECT_NEAR(height_b, changed == "frontB" ? 2 - 1.84 : 1.5 - 2, 1e-12);
    expect_error(ErrorKind::usage, {"'scene-C'", "scene-A, scene-B"},
                 [&] { load_camera(path + ":scene-C/CAM_FRONT"); });
  }
  Tables tables;
  tables.calibration("frontB")["camera_intrinsic"][0][0] = 1267;
  const std::string path = tables.write();
  expect_error(ErrorKind::usage, {"different calibrations"},
               [&] { load_camera(path + ":CAM_FRONT"); });
  EXPECT_EQ(load_camera(path + ":scene-B/CAM_FRONT").lens.fx, 1267);
  // A scene that uses both.
  tables.tables["sample_data"][1]["sample_token"] = "kB";
  tables.write();
  expect_error(ErrorKind::data, {"different calibrations of CAM_FRONT in scene-B"},
               [&] { load_camera(path + ":scene-B/CAM_FRONT"); });
  expect_error(ErrorKind::data, {"no calibration of CAM_FRONT in scene-A"},
               [&] { load_camera(path + ":scene-A/CAM_FRONT"); });
}

// Oracle: the width and height given in the TOML file.
TEST(NuscenesCamera, ATomlCameraNamesAFolderAndTheSizeOfPictures) {
  const Tables tables;
  tables.write();
  const std::string text = "[[camera]]\nname = \"c\"\nfile = \"v1.0-mini:CAM_FRONT\"\n";
  const std::string file = tables.folder.write("car.toml", text).string();
  EXPECT_EQ(load_camera(file).lens.width, 1600);
  std::filesystem::remove(tables.folder.path() / "v1.0-mini" / "sample_data.json");
  expect_error(ErrorKind::config, {"car.toml:2: camera c", "states no size"},
               [&] { load_camera(file); });
  tables.folder.write("car.toml", text + "width = 800\nheight = 450\n");
  EXPECT_EQ(load_camera(file).lens.height, 450);
}

TEST(NuscenesCamera, EachFaultIsOneError) {
  const auto fault = [](ErrorKind kind, const std::vector<std::string>& parts, const auto& change) {
    Tables tables;
    change(tables);
    const std::string path = tables.write();
    expect_error(kind, parts, [&] { load_camera(path + ":CAM_FRONT"); });
  };
  const auto row = [](Tables& t) -> Rows& { return t.calibration("frontA"); };
  fault(ErrorKind::data, {"calibrated_sensor.json: element 1", "'rotation'", "expected 1"},
        [&](Tables& t) { row(t)["rotation"][0] = 2; });
  fault(ErrorKind::data, {"three rows of three numbers", "'camera_intrinsic'"},
        [&](Tables& t) { row(t)["camera_intrinsic"] = Rows::array(); });
  fault(ErrorKind::data, {"expected a number", "'camera_intrinsic'"},
        [&](Tables& t) { row(t)["camera_intrinsic"][2][2] = "1"; });
  fault(ErrorKind::config, {"camera_intrinsic of CAM_FRONT", "skew"}, [&](Tables& t) {
    for (const char* token : {"frontA", "frontB"})
      t.calibration(token)["camera_intrinsic"][0][1] = 1;
  });
  fault(ErrorKind::data, {"sample_data.json: element 5", "800 x 900", "1600 x 900"},
        [](Tables& t) { t.tables["sample_data"][5]["width"] = 800; });
  fault(ErrorKind::data, {"'width'", "1 to 32768"},
        [](Tables& t) { t.tables["sample_data"][1]["width"] = 0; });
  fault(ErrorKind::data, {"no calibration of LIDAR_TOP", "mounted"},
        [](Tables& t) { t.tables["sensor"][3]["channel"] = "LIDAR_FRONT"; });
  fault(ErrorKind::usage, {"no camera 'CAM_FRONT'", "CAM_BACK"},
        [](Tables& t) { t.tables["sensor"].erase(0); });
  fault(ErrorKind::config, {"sensor.json", "has no camera"},
        [](Tables& t) { t.tables["sensor"] = {t.tables["sensor"][3]}; });
  const Tables tables;
  const std::string path = tables.write();
  expect_error(ErrorKind::usage, {"CAM_FRONT, CAM_BACK", "v1.0-mini:NAME"},
               [&] { load_camera(path); });
  expect_error(ErrorKind::usage, {"no camera 'LIDAR_TOP'"},
               [&] { load_camera(path + ":LIDAR_TOP"); });
  expect_error(ErrorKind::no_input, {tables.folder.path().string()},
               [&] { load_camera(tables.folder.path().string() + ":CAM_FRONT"); });
}

}  // namespace
}  // namespace adasplats::nuscenes_cameras
