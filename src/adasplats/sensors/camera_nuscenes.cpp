// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Cameras of the tables of nuScenes (docs/schema_nuscenes.md of its devkit): calibrated_sensor has
// a row per sensor and log with the pose on the ego vehicle; pictures are rectified, and
// sample_data has their size.

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <system_error>
#include <unordered_set>
#include <utility>
#include <vector>

#include "adasplats/core/maths/right_forward.h"
#include "adasplats/io/base/json_table.h"
#include "adasplats/sensors/camera_files.h"

namespace adasplats {

namespace {

namespace fs = std::filesystem;

constexpr const char* kCalibrations = "calibrated_sensor.json";
constexpr const char* kLidarOfMount = "LIDAR_TOP";

/// A row of calibrated_sensor.
struct NuscenesCalibration {
  RigidTransform ego_from_sensor;
  std::array<double, 9> matrix{};  ///< of a camera

  bool is_same(const NuscenesCalibration& other) const {
    for (std::size_t row = 0; row < 3; ++row)
      if (ego_from_sensor.rotation.rows[row] != other.ego_from_sensor.rotation.rows[row])
        return false;
    return ego_from_sensor.translation == other.ego_from_sensor.translation &&
           matrix == other.matrix;
  }
};

using CalibrationsByToken = std::map<std::string, NuscenesCalibration>;

/// Reads one camera and LIDAR_TOP, of one scene or of all.
class NuscenesCameras {
 public:
  NuscenesCameras(const fs::path& path, const std::string& wanted)
      : path_(path),
        folder_(path.filename() == kCalibrations ? path.parent_path() : path),
        channel_(wanted) {
    const std::size_t slash = wanted.rfind('/');
    if (slash == std::string::npos) return;
    scene_ = wanted.substr(0, slash);
    channel_ = wanted.substr(slash + 1);
  }

  FileCamera read() {
    read_sensors();
    read_calibrations();
    if (!scene_.empty()) read_samples();
    FileCamera result;
    read_pictures(result.camera.lens);
    const NuscenesCalibration camera = only(cameras_, channel_);
    const NuscenesCalibration lidar = only(lidars_, kLidarOfMount);
    const Lens size = result.camera.lens;
    result.camera.name = channel_;
    result.camera.lens =
        pinhole_lens({camera.matrix.begin(), camera.matrix.end()},
                     table(kCalibrations).string() + ": camera_intrinsic of " + channel_);
    result.camera.lens.width = size.width;
    result.camera.lens.height = size.height;
    const RigidTransform optical_from_camera{kCameraFromOptical.transposed(), {}};
    result.camera.vehicle_from_camera = kSensorFromRightForward * lidar.ego_from_sensor.inverse() *
                                        camera.ego_from_sensor * optical_from_camera;
    result.camera.lidar_from_camera = result.camera.vehicle_from_camera;
    return result;
  }

 private:
  fs::path table(const char* name) const { return folder_ / name; }

  void read_sensors() {
    std::vector<std::string> names;
    std::vector<std::pair<std::string, std::string>> tokens;  // with their channels
    for_each_json_row(table("sensor.json"), [&](const JsonRow& row) {
      const std::string name = row.text("channel");
      if (name == kLidarOfMount) lidar_tokens_.insert(row.text("token"));
      if (row.text("modality") != "camera") return;
      tokens.emplace_back(row.text("token"), name);
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    });
    if (names.empty()) throw camera_fault(table("sensor.json"), "has no camera");
    channel_ = names[choose_camera(names, channel_, path_)];
    for (const auto& [token, name] : tokens)
      if (name == channel_) camera_tokens_.insert(token);
  }

  void read_calibrations() {
    for_each_json_row(table(kCalibrations), [&](const JsonRow& row) {
      const std::string sensor = row.text("sensor_token");
      const bool is_camera = camera_tokens_.contains(sensor);
      if (!is_camera && !lidar_tokens_.contains(sensor)) return;
      NuscenesCalibration calibration{row.pose("translation", "rotation")};
      if (is_camera) calibration.matrix = row.matrix("camera_intrinsic");
      (is_camera ? cameras_ : lidars_)[row.text("token")] = calibration;
    });
  }

  void read_samples() {
    std::string scene_token;
    for_each_json_row(table("scene.json"), [&](const JsonRow& row) {
      if (row.text("name") == scene_) scene_token = row.text("token");
    });
    if (scene_token.empty())
      throw Error(ErrorKind::usage, table("scene.json").string() + ": has no scene '" + scene_ +
                                        "'; it has " + some_scenes());
    for_each_json_row(table("sample.json"), [&](const JsonRow& row) {
      if (row.text("scene_token") == scene_token) samples_.insert(row.text("token"));
    });
  }

  /// The size of the pictures; keeps only the calibrations that are used. The table can be missing
  /// if no scene is chosen.
  void read_pictures(Lens& lens) {
    const fs::path file = table("sample_data.json");
    std::error_code ignored;
    if (scene_.empty() && !fs::exists(file, ignored)) return;
    CalibrationsByToken cameras, lidars;
    for_each_json_row(file, [&](const JsonRow& row) {
      const std::string token = row.text("calibrated_sensor_token");
      const auto camera = cameras_.find(token), lidar = lidars_.find(token);
      if (camera == cameras_.end() && lidar == lidars_.end()) return;
      if (!scene_.empty() && !samples_.contains(row.text("sample_token"))) return;
      if (lidar != lidars_.end()) lidars.insert(*lidar);
      if (camera == cameras_.end()) return;
      cameras.insert(*camera);
      const int width = side(row, "width"), height = side(row, "height");
      if (lens.width != 0 && (lens.width != width || lens.height != height))
        throw row.fault("is a picture of " + std::to_string(width) + " x " +
                        std::to_string(height) + " pixels; another one of " + channel_ + " has " +
                        std::to_string(lens.width) + " x " + std::to_string(lens.height));
      lens.width = width;
      lens.height = height;
    });
    if (!scene_.empty() || !cameras.empty()) cameras_ = std::move(cameras);
    if (!scene_.empty() || !lidars.empty()) lidars_ = std::move(lidars);
  }

  static int side(const JsonRow& row, const char* key) {
    constexpr std::int64_t kMaxSide = 1 << 15;
    const std::int64_t pixels = row.integer(key);
    if (pixels < 1 || pixels > kMaxSide)
      throw row.fault(std::string("'") + key + "' is not a size from 1 to 32768");
    return static_cast<int>(pixels);
  }

  /// The calibration that all of `found` state. Errors: data (none), usage or data (several).
  NuscenesCalibration only(const CalibrationsByToken& found, const std::string& channel) const {
    const std::string of_scene = scene_.empty() ? "" : " in " + scene_;
    if (found.empty())
      throw Error(ErrorKind::data,
                  table(kCalibrations).string() + ": has no calibration of " + channel + of_scene +
                      (channel == kLidarOfMount ? ", the LiDAR that cameras are mounted on" : ""));
    const NuscenesCalibration& first = found.begin()->second;
    if (std::ranges::all_of(found, [&](const auto& each) { return first.is_same(each.second); }))
      return first;
    const std::string several =
        table(kCalibrations).string() + ": has different calibrations of " + channel + of_scene;
    if (!scene_.empty()) throw Error(ErrorKind::data, several);
    throw Error(ErrorKind::usage, several + "; choose a scene as " + path_.string() + ":SCENE/" +
                                      channel_ + ": " + some_scenes());
  }

  std::string some_scenes() const {
    constexpr std::size_t kMaxListed = 10;
    std::string list;
    std::size_t count = 0;
    for_each_json_row(table("scene.json"), [&](const JsonRow& row) {
      if (++count <= kMaxListed) list += (list.empty() ? "" : ", ") + row.text("name");
    });
    return count <= kMaxListed ? list : list + ", ... (" + std::to_string(count) + ")";
  }

  const fs::path& path_;
  fs::path folder_;
  std::string scene_, channel_;
  std::unordered_set<std::string> camera_tokens_, lidar_tokens_, samples_;
  CalibrationsByToken cameras_, lidars_;
};

}  // namespace

bool is_nuscenes_calibration(const fs::path& path) {
  std::error_code ignored;  // what cannot be looked at is not there
  return path.filename() == kCalibrations || fs::exists(path / kCalibrations, ignored);
}

FileCamera read_nuscenes_camera(const fs::path& path, const std::string& wanted) {
  return NuscenesCameras(path, wanted).read();
}

}  // namespace adasplats
