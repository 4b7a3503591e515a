// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/nuscenes_drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "adasplats/cloud/load/court_test.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

using Rows = nlohmann::json;

const RigidTransform kEgoFromLidar = {rotation_from_yaw_pitch_roll(-1.57, 0, 0.01),
                                      {0.9, 0.1, 1.84}};

void put_pose(const RigidTransform& pose, Rows& row) {
  const Quaternion q = quaternion_from_rotation(pose.rotation);
  const Vec3d t = pose.translation;
  row["rotation"] = {q.w, q.x, q.y, q.z};
  row["translation"] = {t.x, t.y, t.z};
}

/// Two scenes of a car in the court; scans stand still, every other one is a keyframe.
class NuscenesCourt {
 public:
  explicit NuscenesCourt(int scans = 4) {
    tables_["scene"] = {{{"token", "A"}, {"name", "scene-0001"}},
                        {{"token", "B"}, {"name", "scene-0002"}}};
    tables_["sensor"] = {{{"token", "radar"}, {"channel", "RADAR_FRONT"}},
                         {{"token", "lidar"}, {"channel", "LIDAR_TOP"}}};
    Rows calibrated = Rows::object({{"token", "c"}, {"sensor_token", "lidar"}});
    put_pose(kEgoFromLidar, calibrated);
    tables_["calibrated_sensor"] = Rows::array({calibrated});
    tables_["category"] = {{{"name", "noise"}, {"index", 0}},
                           {{"name", "flat.driveable_surface"}, {"index", 24}}};
    for (const char* table : {"sample", "sample_data", "ego_pose", "lidarseg"})
      tables_[table] = Rows::array();
    for (int k = 0; k < scans; ++k) add_scan(k);
    // What is of the other scene and of another sensor is not read.
    tables_["sample"].push_back(Rows::object({{"token", "sB"}, {"scene_token", "B"}}));
    Rows other = tables_["sample_data"][0];
    other["sample_token"] = "sB";
    other["token"] = "dB";
    other["filename"] = "sweeps/LIDAR_TOP/none.pcd.bin";
    other["timestamp"] = 1;
    tables_["sample_data"].push_back(other);
    other["calibrated_sensor_token"] = "camera";
    other["sample_token"] = "s0";
    other["token"] = "dC";
    tables_["sample_data"].push_back(other);
    write();
  }

  Rows& operator[](const char* table) { return tables_[table]; }
  void write() const {
    for (const auto& [name, rows] : tables_.items())
      folder_.write("v1.0-mini/" + name + ".json", rows.dump(0));
  }
  const std::filesystem::path& path() const { return folder_.path(); }
  const TemporaryFolder& folder() const { return folder_; }

  std::pair<PointCloud, LoadReport> load(const std::string& scene = "scene-0001",
                                         LoadOptions options = {}) const {
    options.scene = scene;
    options.own_body_m = 0;
    options.driven_path_m = 0;
    ProgressSink quiet;
    return load_cloud(std::span(&folder_.path(), 1), options, Executor(2), quiet);
  }

  std::vector<Vec3d> world;          ///< in the order of the times
  std::vector<std::size_t> scan_of;  ///< of each point

 private:
  void add_scan(int k) {
    const bool is_key = k % 2 == 0;
    const std::string number = std::to_string(k);
    const std::string sample = "s" + std::to_string(k - k % 2);
    const std::string file =
        (is_key ? "samples/LIDAR_TOP/" : "sweeps/LIDAR_TOP/") + number + ".pcd.bin";
    const RigidTransform ego = sensor_at(0.3 * k);
    const RigidTransform lidar = ego * kEgoFromLidar;
    std::vector<float> values;
    std::string labels;
    for (int ring = 0; ring < 16; ++ring) {
      for (int column = 0; column < 360; ++column) {
        const double azimuth = 0.01745 * column, elevation = 0.03 * (ring - 12);
        const Vec3d way = {std::cos(elevation) * std::sin(azimuth),
                           std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
        const auto range_m = range_in_court(lidar.translation, lidar.rotation * way);
        if (!range_m) continue;
        const Vec3f p = vec_cast<float>(*range_m * way);
        world.push_back(lidar * vec_cast<double>(p));
        scan_of.push_back(static_cast<std::size_t>(k));
        for (const float v : {p.x, p.y, p.z, 17.0F, static_cast<float>(ring)}) values.push_back(v);
        labels += static_cast<char>(world.back().z < 0.05 ? 24 : 0);
      }
    }
    folder_.write(file, values);
    Rows pose = Rows::object({{"token", "e" + number}});
    put_pose(ego, pose);
    // In no order.
    tables_["ego_pose"].insert(tables_["ego_pose"].begin(), pose);
    tables_["sample_data"].insert(
        tables_["sample_data"].begin(),
        Rows::object({{"token", "d" + number},
                      {"sample_token", sample},
                      {"ego_pose_token", "e" + number},
                      {"calibrated_sensor_token", "c"},
                      {"timestamp", 1'500'000'000'000'000 + 300'000LL * k},
                      {"is_key_frame", is_key},
                      {"filename", file}}));
    if (!is_key) return;
    tables_["sample"].push_back(Rows::object({{"token", sample}, {"scene_token", "A"}}));
    const std::string label_file = "lidarseg/v1.0-mini/" + number + ".bin";
    folder_.write(label_file, labels);
    tables_["lidarseg"].push_back(
        Rows::object({{"sample_data_token", "d" + number}, {"filename", label_file}}));
  }

  TemporaryFolder folder_;
  Rows tables_;
};

// Oracle: ego_pose * calibrated_sensor of the points in the files, in the order of the times.
TEST(NuscenesDrive, PointsPosesClassesAndIntensities) {
  const NuscenesCourt court;
  const auto [cloud, report] = court.load();
  ASSERT_EQ(cloud.size(), court.world.size());
  ASSERT_EQ(cloud.scan_poses.size(), 4U);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_LT(length(cloud.world(i) - court.world[i]), 1e-5);
    EXPECT_EQ(cloud.intensities[i], 17.0F / 255);
    const bool is_key = cloud.scan_indices[i] % 2 == 0;
    const int expected = is_key ? (court.world[i].z < 0.05 ? 24 : 0) : 255;
    EXPECT_EQ(cloud.classes[i], expected);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const RigidTransform lidar = sensor_at(0.3 * static_cast<double>(k)) * kEgoFromLidar;
    const RigidTransform& pose = cloud.scan_poses[k].world_from_sensor;
    EXPECT_LT(length(pose.translation - lidar.translation), 1e-9);
    // Our x is the y of the files.
    EXPECT_LT(length(pose.rotation * Vec3d{1, 0, 0} - lidar.rotation * Vec3d{0, 1, 0}), 1e-9);
    EXPECT_NEAR(cloud.scan_poses[k].time_s, 1.5e9 + 0.3 * static_cast<double>(k), 1e-6);
  }
  EXPECT_NE(report.drives[0].facts.labels.find("2 of 4 scans"), std::string::npos);
  EXPECT_EQ(labels_of_tree(court.path())->name(), "nuscenes");
}

// A box along a wall at the times of the keyframes 0 and 2; scan 1 is half way. Oracle: the points
// in it.
TEST(NuscenesDrive, PointsInBoxesOfTheSceneAreLeftOut) {
  NuscenesCourt court;
  for (const int k : {0, 1}) court["category"][k]["token"] = "category " + std::to_string(k);
  court["category"].push_back({{"token", "bus"}, {"name", "vehicle.bus"}, {"index", 16}});
  court["instance"] = {{{"token", "i"}, {"category_token", "bus"}}};
  court["sample_annotation"] = Rows::array();
  court["sample"][0]["timestamp"] = 1'500'000'000'000'000;
  court["sample"][1]["timestamp"] = 1'500'000'000'600'000;
  for (const int k : {0, 2}) {
    Rows box = {{"sample_token", "s" + std::to_string(k)}, {"instance_token", "i"}};
    put_pose({{}, {3.0 * k, 12, 1.5}}, box);
    box["size"] = {1, 3, 3};  // width, length, height
    court["sample_annotation"].push_back(box);
  }
  court.write();
  LoadOptions options;
  options.scan_count = 3;
  const std::size_t all = court.load("scene-0001", options).first.size();
  std::size_t expected = 0;
  for (std::size_t i = 0; i < all; ++i) {
    const std::size_t scan = court.scan_of[i];
    const Vec3d away = court.world[i] - Vec3d{3.0 * static_cast<double>(scan), 12, 1.5};
    expected += std::fabs(away.x) <= 1.7 && std::fabs(away.y) <= 0.7 && std::fabs(away.z) <= 1.7;
  }
  options.boxes = court.path();
  const auto [cloud, report] = court.load("scene-0001", options);
  ASSERT_GT(expected, 20U);
  EXPECT_EQ(report.in_boxes, expected);
  EXPECT_EQ(cloud.size() + expected, all);
}

TEST(NuscenesDrive, ASingleScanIsADrive) {
  const NuscenesCourt court(1);
  const auto [cloud, report] = court.load();
  EXPECT_EQ(cloud.size(), court.world.size());
  EXPECT_TRUE(cloud.has_beams());
}

TEST(NuscenesDrive, ScenesByName) {
  const NuscenesCourt court;
  expect_error(ErrorKind::usage, {"`scene`", "scene-0001, scene-0002"}, [&] { court.load(""); });
  expect_error(ErrorKind::usage, {"no scene 'scene-3'", "scene-0001, scene-0002"},
               [&] { court.load("scene-3"); });
  LoadOptions options;
  options.mount = Vec3d{0, 0, 1};
  expect_error(ErrorKind::usage, {"`mount`"}, [&] { court.load("scene-0001", options); });
  NuscenesCourt one;
  one["scene"].erase(1);
  one.write();
  EXPECT_EQ(read_nuscenes_scene(one.path(), "").name, "scene-0001");
}

// Whoever fetched the keyframes alone has no file of any sweep.
TEST(NuscenesDrive, KeyframesAloneWhereNoSweepIsThere) {
  const NuscenesCourt court;
  std::filesystem::remove_all(court.path() / "sweeps");
  const auto [cloud, report] = court.load();
  EXPECT_EQ(cloud.scan_poses.size(), 2U);
  EXPECT_EQ(report.drives[0].facts.labels, "of all scans");
}

void expect_broken(const std::vector<std::string>& parts,
                   const std::function<void(NuscenesCourt&)>& damage,
                   ErrorKind kind = ErrorKind::data) {
  NuscenesCourt court;
  damage(court);
  expect_error(kind, parts, [&] { court.load(); });
}

TEST(NuscenesDrive, DamagedTreesNameTheFile) {
  namespace fs = std::filesystem;
  expect_broken({"sweeps/LIDAR_TOP/3.pcd.bin", "missing"},
                [](auto& c) { fs::remove(c.path() / "sweeps/LIDAR_TOP/3.pcd.bin"); });
  expect_broken({"samples/LIDAR_TOP/2.pcd.bin", "missing"},
                [](auto& c) { fs::remove(c.path() / "samples/LIDAR_TOP/2.pcd.bin"); });
  expect_broken({"lidarseg/v1.0-mini/2.bin", "1 labels"},
                [](auto& c) { c.folder().write("lidarseg/v1.0-mini/2.bin", std::string("a")); });
  expect_broken({"1.pcd.bin", "20 bytes a point"}, [](auto& c) {
    c.folder().write("sweeps/LIDAR_TOP/1.pcd.bin", std::string("abc"));
  });
  expect_broken(
      {"ego_pose.json", "no such file"},
      [](auto& c) { fs::remove(c.path() / "v1.0-mini/ego_pose.json"); }, ErrorKind::no_input);
  const auto with_row = [](const char* table, const char* key, const Rows& value) {
    return [=](NuscenesCourt& c) {
      c[table][0][key] = value;
      c.write();
    };
  };
  expect_broken({"ego_pose.json", "element 0", "length"},
                with_row("ego_pose", "rotation", {1, 1, 0, 0}));
  expect_broken({"ego_pose.json", "3 numbers"}, with_row("ego_pose", "translation", {1, 2}));
  expect_broken({"ego_pose.json", "has no pose with the token e3"},
                with_row("ego_pose", "token", "x"));
  expect_broken({"sample_data.json", "element 0", "'timestamp'"},
                with_row("sample_data", "timestamp", "noon"));
  expect_broken({"sample_data.json", "element 0", "whole number 'timestamp'"},
                with_row("sample_data", "timestamp", 18'446'744'073'709'551'615U));
  expect_broken({"sample_data.json", "same time"},
                with_row("sample_data", "timestamp", 1'500'000'000'000'000));
  expect_broken({"sample_data.json", "element 0", "data root"},
                with_row("sample_data", "filename", "../../secret.pcd.bin"));
  expect_broken({"sample_data.json", "no scan"}, [](auto& c) {
    c["sample_data"] = Rows::array();
    c.write();
  });
  expect_broken({"sample_data.json", "byte"}, [](auto& c) {
    const fs::path file = c.path() / "v1.0-mini/sample_data.json";
    fs::resize_file(file, fs::file_size(file) - 20);
  });
  expect_broken({"sample.json", "more than 100,000 values"}, [](auto& c) {
    c.folder().write("v1.0-mini/sample.json", "[" + std::string(100'000, '['));
  });
  // Most scans show that intensities are bytes.
  expect_broken({"1.pcd.bin", "intensity of 0.5", "0 to 255"}, [](auto& c) {
    c.folder().write("sweeps/LIDAR_TOP/1.pcd.bin", std::vector<float>{1, 2, 3, 0.5F, 4});
  });
}

}  // namespace
}  // namespace adasplats
