// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/camera_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/maths/yaw_pitch_roll.h"
#include "adasplats/core/words.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/sensors/camera_files.h"
#include "adasplats/sensors/toml_table.h"

namespace adasplats {

namespace {

namespace fs = std::filesystem;

enum class Distortion : std::uint8_t { none, brown_conrady, rational, fisheye };

constexpr std::pair<std::string_view, Distortion> kDistortions[] = {
    {"none", Distortion::none},
    {"brown_conrady", Distortion::brown_conrady},
    {"plumb_bob", Distortion::brown_conrady},
    {"rational", Distortion::rational},
    {"rational_polynomial", Distortion::rational},
    {"fisheye", Distortion::fisheye},
    {"equidistant", Distortion::fisheye}};

const TomlKeys& camera_keys() {
  static const TomlKeys keys = {"name",
                                "file",
                                "width",
                                "height",
                                "fx",
                                "fy",
                                "cx",
                                "cy",
                                "model",
                                "coefficients",
                                "mount",
                                "mount_rotation_deg",
                                "mount_quaternion"};
  return keys;
}

constexpr double kMaxPixels = 1e9;

/// vehicle_from_camera
RigidTransform read_mount(const TomlTable& table) {
  RigidTransform mount;
  if (const std::vector<Vec3d> at = table.points("mount", 1); !at.empty())
    mount.translation = at.front();
  if (table.has("mount_rotation_deg") && table.has("mount_quaternion"))
    throw table.error("mount_rotation_deg", "and mount_quaternion are given, expected one of them");
  if (table.has("mount_rotation_deg")) {
    const std::vector<double> angles_rad = table.angles_rad("mount_rotation_deg", -360, 360);
    if (angles_rad.size() != 3)
      throw table.error("mount_rotation_deg", "is not a list of yaw, pitch and roll, degrees");
    mount.rotation = rotation_from_yaw_pitch_roll(angles_rad[0], angles_rad[1], angles_rad[2]);
  }
  if (table.has("mount_quaternion")) {
    constexpr double kMaxError = 1e-3;
    const std::vector<double> q = table.numbers("mount_quaternion", -2, 2);
    double square = 0;
    for (const double part : q) square += part * part;
    const double norm = std::sqrt(square);
    if (q.size() != 4 || !(std::fabs(norm - 1) < kMaxError))
      throw table.error("mount_quaternion", "is not a list of w, x, y and z with length 1");
    const Mat3d vehicle_from_optical =
        rotation_from_quaternion(q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm);
    mount.rotation = vehicle_from_optical * kCameraFromOptical.transposed();
  }
  return mount;
}

FileCamera read_camera(const fs::path& file, const std::string& wanted);

/// Splits "FILE:NAME"; a file may have colons in its name.
std::pair<fs::path, std::string> split(const std::string& file_and_name) {
  std::error_code ignored;  // of names that are too long for a file
  const std::size_t colon = file_and_name.rfind(':');
  if (colon == std::string::npos || colon == 0 || fs::exists(file_and_name, ignored))
    return {file_and_name, ""};
  return {file_and_name.substr(0, colon), file_and_name.substr(colon + 1)};
}

/// The lens that the keys of a table give.
void read_lens(const TomlTable& table, FileCamera& result) {
  Lens& lens = result.camera.lens;
  for (const char* key : {"width", "height", "fx", "fy", "cx", "cy"})
    if (!table.has(key))
      throw Error(ErrorKind::config,
                  result.place + ": camera " + table.text("name", "") + ": " + key + " is missing");
  lens.fx = table.number("fx", 0, -kMaxPixels, kMaxPixels);
  lens.fy = table.number("fy", 0, -kMaxPixels, kMaxPixels);
  lens.cx = table.number("cx", 0, -kMaxPixels, kMaxPixels);
  lens.cy = table.number("cy", 0, -kMaxPixels, kMaxPixels);
  result.model = table.text("model", "none");
  result.coefficients = table.numbers("coefficients", -kMaxPixels, kMaxPixels);
}

/// Their names, which must differ.
std::vector<std::string> names_of(const std::vector<TomlTable>& tables) {
  std::vector<std::string> names;
  for (const TomlTable& table : tables) {
    table.require("name");
    names.push_back(table.text("name", ""));
    if (std::ranges::count(names, names.back()) > 1)
      throw table.error("name", "is that of another camera, too");
  }
  return names;
}

/// Where the first sensor of a rig is in the frame of the mounts; at its origin without a mount.
RigidTransform first_sensor_mount(const TomlTable& whole) {
  const std::optional<TomlTable> sensor = whole.first_table("sensors");
  return sensor ? read_mount(*sensor) : RigidTransform{};
}

/// `whole`: the file that the table is of.
FileCamera read_camera_table(const TomlTable& table, const fs::path& file, const TomlTable& whole) {
  const std::string own_name = table.text("name", "");
  FileCamera result;
  result.place = table.place("name");
  if (table.has("file")) {
    for (const char* key : {"fx", "fy", "cx", "cy", "model", "coefficients"})
      if (table.has(key)) throw table.error(key, "is given, and file, which has it");
    const auto [other, name] = split((file.parent_path() / table.text("file", "")).string());
    if (other.extension() == ".toml") throw table.error("file", "is another TOML file");
    try {
      result = read_camera(other, name);
    } catch (const Error& error) {
      throw Error(error.kind(), result.place + ": camera " + own_name + ": " + error.what());
    }
    result.place = table.place("name");
  } else {
    read_lens(table, result);
  }
  Lens& lens = result.camera.lens;
  constexpr std::int64_t kMaxSide = 1 << 15;
  for (const auto& [key, side] : {std::pair{"width", &lens.width}, {"height", &lens.height}}) {
    if (!table.has(key)) continue;
    if (*side != 0) throw table.error(key, "is given, and file, which has it");
    *side = static_cast<int>(table.whole_number(key, 1, kMaxSide));
  }
  result.camera.name = own_name;
  if (!table.has("file") || table.has("mount") || table.has("mount_rotation_deg") ||
      table.has("mount_quaternion")) {
    result.camera.vehicle_from_camera = read_mount(table);
    result.camera.lidar_from_camera.reset();
  } else if (result.camera.lidar_from_camera) {
    result.camera.vehicle_from_camera =
        first_sensor_mount(whole) * *result.camera.lidar_from_camera;
  }
  return result;
}

FileCamera read_toml_camera(std::string_view text, const fs::path& file,
                            const std::string& wanted) {
  TomlKeys keys = {"camera"};
  // Of a rig the tables of its cameras alone are read.
  if (text.find("sensors") != std::string_view::npos)
    keys.insert(keys.end(), kRigKeys.begin(), kRigKeys.end());
  const TomlTable whole = parse_toml(text, file, keys, "camera");
  if (!whole.has("camera"))
    throw camera_fault(file, std::string("describes no camera: it has no [[camera]] "
                                         "(docs/pictures.md, \"Real cameras\")") +
                                 (whole.has("sensors") ? "; it is a rig file, an input or for "
                                                         "`rig` of simulate"
                                                       : ""));
  const std::vector<TomlTable> tables = whole.tables("camera", camera_keys());
  return read_camera_table(tables[choose_camera(names_of(tables), wanted, file)], file, whole);
}

/// The camera with a complete lens.
MountedCamera checked(FileCamera read, const fs::path& file) {
  const std::string where =
      (read.place.empty() ? file.string() : read.place) + ": camera " + read.camera.name;
  if (read.camera.lens.width == 0 || read.camera.lens.height == 0)
    throw Error(ErrorKind::config,
                where +
                    ": the file states no size of the picture; name it in a TOML camera: "
                    "[[camera]], name, file, width, height");
  read.camera.lens = distorted_lens(read.camera.lens, read.model, read.coefficients, where);
  return read.camera;
}

FileCamera read_camera(const fs::path& file, const std::string& wanted) {
  if (is_nuscenes_calibration(file)) return read_nuscenes_camera(file, wanted);
  const std::string text = read_file(file);
  const std::string extension = lower_case(file.extension().string());
  if (extension == ".toml") return read_toml_camera(text, file, wanted);
  if (is_kitti_calibration(text)) return read_kitti_camera(text, file, wanted);
  if (extension == ".yaml" || extension == ".yml" || extension == ".json")
    return read_ros_camera(text, file, wanted);
  throw camera_fault(file,
                     "is no camera: expected .toml, .yaml or .json (CameraInfo of ROS), calib.txt "
                     "or calib_cam_to_cam.txt of KITTI, or calibrated_sensor.json of nuScenes");
}

}  // namespace

Camera MountedCamera::at(const RigidTransform& world_from_vehicle) const {
  Camera camera;
  camera.world_from_camera = world_from_vehicle * vehicle_from_camera;
  camera.width = lens.width;
  camera.height = lens.height;
  camera.lens = lens;
  return camera;
}

std::size_t choose_camera(const std::vector<std::string>& names, const std::string& wanted,
                          const fs::path& file) {
  if (wanted.empty() && names.size() == 1) return 0;
  const auto found = std::ranges::find(names, wanted);
  if (found != names.end() && !wanted.empty())
    return static_cast<std::size_t>(found - names.begin());
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  if (wanted.empty())
    throw Error(ErrorKind::usage, file.string() + ": has the cameras " + list + "; choose one as " +
                                      file.string() + ":NAME");
  throw Error(ErrorKind::usage, file.string() + ": no camera '" + wanted + "': expected " + list);
}

Lens pinhole_lens(const std::vector<double>& matrix, const std::string& name) {
  if (matrix.size() != 9)
    throw Error(ErrorKind::config, name + " has " + std::to_string(matrix.size()) +
                                       " numbers, expected 9: fx 0 cx 0 fy cy 0 0 1");
  const bool is_upper = matrix[1] == 0 && matrix[3] == 0 && matrix[6] == 0 && matrix[7] == 0;
  if (!is_upper || matrix[8] != 1)
    throw Error(ErrorKind::config, name +
                                       " is not fx 0 cx 0 fy cy 0 0 1: cameras with skew are "
                                       "not supported");
  Lens lens;
  lens.fx = matrix[0];
  lens.cx = matrix[2];
  lens.fy = matrix[4];
  lens.cy = matrix[5];
  return lens;
}

Lens distorted_lens(Lens lens, const std::string& model, const std::vector<double>& coefficients,
                    const std::string& name) {
  const auto* const found =
      std::ranges::find(kDistortions, model, [](const auto& entry) { return entry.first; });
  if (found == std::end(kDistortions))
    throw Error(
        ErrorKind::config,
        name + ": " + unknown_word("distortion model", model, list_of<Distortion>(kDistortions)));
  const Distortion distortion = found->second;
  const std::size_t count = coefficients.size();
  const auto require_count = [&](bool is_right, const char* expected) {
    if (!is_right)
      throw Error(ErrorKind::config, name + ": " + std::to_string(count) + " coefficients of " +
                                         model + ", expected " + expected);
  };
  const auto at = [&](std::size_t i) { return i < count ? coefficients[i] : 0.0; };
  switch (distortion) {
    case Distortion::none: require_count(count == 0, "none"); break;
    case Distortion::fisheye:
      require_count(count == 4, "4: k1, k2, k3, k4");
      lens.is_fisheye = true;
      for (std::size_t i = 0; i < 4; ++i) lens.k[i] = at(i);
      break;
    case Distortion::brown_conrady:
    case Distortion::rational:
      if (distortion == Distortion::rational)
        require_count(count == 8, "8: k1, k2, p1, p2, k3, k4, k5, k6");
      else
        require_count(count == 4 || count == 5, "5: k1, k2, p1, p2, k3 (or 4 without k3)");
      lens.p1 = at(2);
      lens.p2 = at(3);
      lens.k[0] = at(0);
      lens.k[1] = at(1);
      for (std::size_t i = 2; i < 6; ++i) lens.k[i] = at(i + 2);
  }
  return complete_lens(lens, name);
}

MountedCamera load_camera(const std::string& file_and_name) {
  const auto [file, name] = split(file_and_name);
  return checked(read_camera(file, name), file);
}

std::vector<MountedCamera> cameras_of(const TomlTable& whole, const fs::path& file) {
  std::vector<MountedCamera> cameras;
  if (!whole.has("camera")) return cameras;
  const std::vector<TomlTable> tables = whole.tables("camera", camera_keys());
  names_of(tables);
  for (const TomlTable& table : tables)
    cameras.push_back(checked(read_camera_table(table, file, whole), file));
  return cameras;
}

std::string camera_toml(const MountedCamera& camera) {
  const auto list = [](std::initializer_list<double> values) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "[" : ", ") + exact_text(value);
    return text + "]\n";
  };
  const Lens& lens = camera.lens;
  const double* const k = lens.k;
  std::string text = "[[camera]]\nname = " + toml_string(camera.name) +
                     "\nwidth = " + std::to_string(lens.width) +
                     "\nheight = " + std::to_string(lens.height);
  for (const auto& [key, value] :
       {std::pair{"fx", lens.fx}, {"fy", lens.fy}, {"cx", lens.cx}, {"cy", lens.cy}})
    text += "\n" + std::string(key) + " = " + exact_text(value);
  text += "\n";
  if (lens.is_fisheye)
    text += "model = \"fisheye\"\ncoefficients = " + list({k[0], k[1], k[2], k[3]});
  else if (k[3] != 0 || k[4] != 0 || k[5] != 0)
    text += "model = \"rational\"\ncoefficients = " +
            list({k[0], k[1], lens.p1, lens.p2, k[2], k[3], k[4], k[5]});
  else if (k[0] != 0 || k[1] != 0 || k[2] != 0 || lens.p1 != 0 || lens.p2 != 0)
    text +=
        "model = \"brown_conrady\"\ncoefficients = " + list({k[0], k[1], lens.p1, lens.p2, k[2]});
  const Vec3d at = camera.vehicle_from_camera.translation;
  const Vec3d turn_deg = yaw_pitch_roll_deg(camera.vehicle_from_camera.rotation);
  return text + "mount = " + list({at.x, at.y, at.z}) +
         "mount_rotation_deg = " + list({turn_deg.x, turn_deg.y, turn_deg.z});
}

}  // namespace adasplats
