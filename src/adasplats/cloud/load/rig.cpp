// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/rig.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/load/drive_boxes.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/words.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/sensors/toml_table.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxOffset_m = 100, kMaxTime_s = 1e12;

/// The keys of DriveSettings in a rig file.
template <class Visit>
void visit_rig_settings(DriveSettings& drive, const Visit& visit) {
  visit("trajectory", drive.trajectory);
  visit("boxes", drive.boxes);
  visit("mount", drive.mount);
  visit("mount_rotation_deg", drive.mount_rotation_deg);
  visit("time_offset_s", drive.time_offset_s);
  visit("points_in", drive.points_in);
  visit("sweep_points", drive.sweep_points);
  visit("scan_times", drive.scan_times);
  visit("topic", drive.topic);
  visit("poses_topic", drive.poses_topic);
  visit("scene", drive.scene);
  visit("sensor", drive.packet_sensor);
}

TomlKeys sensor_keys() {
  TomlKeys keys = {"name", "input", "in_model", "body"};
  DriveSettings drive;
  visit_rig_settings(drive, [&](const char* key, const auto&) { keys.emplace_back(key); });
  return keys;
}

/// Reads one value; the default stays if the key is missing.
class RigValue {
 public:
  RigValue(const TomlTable& table, const fs::path& folder) : table_(table), folder_(folder) {}

  void operator()(const char* key, std::string& value) const { value = table_.text(key, value); }
  void operator()(const char* key, fs::path& value) const {
    if (table_.has(key)) value = path_of(key);
  }
  void operator()(const char* key, Vec3d& value) const {
    if (!table_.has(key)) return;
    const std::vector<double> numbers = table_.numbers(key, -360, 360);
    if (numbers.size() != 3) throw table_.error(key, "is not a list of three numbers");
    value = {numbers[0], numbers[1], numbers[2]};
  }
  void operator()(const char* key, std::optional<Vec3d>& value) const {
    if (!table_.has(key)) return;
    const std::vector<double> numbers = table_.numbers(key, -kMaxOffset_m, kMaxOffset_m);
    if (numbers.size() != 3) throw table_.error(key, "is not a list of three numbers");
    value = Vec3d{numbers[0], numbers[1], numbers[2]};
  }
  void operator()(const char* key, std::optional<double>& value) const {
    if (table_.has(key)) value = table_.number(key, 0, -kMaxTime_s, kMaxTime_s);
  }
  template <class Word>
  requires std::is_enum_v<Word>
  void operator()(const char* key, Word& value) const {
    if (!table_.has(key)) return;
    const std::string text = table_.text(key, "");
    for (const auto& [word, each] : words_of(Word{}))
      if (word == text) {
        value = each;
        return;
      }
    std::string expected;
    for (const std::string& word : list_of(words_of(Word{})))
      expected += (expected.empty() ? "" : ", ") + word;
    throw table_.error(key, "is '" + text + "', expected one of " + expected);
  }
  fs::path path_of(const char* key) const {
    const std::string text = table_.text(key, "");
    if (text.empty()) throw table_.error(key, "is empty");
    const fs::path path = folder_ / text;
    return path.has_filename() ? path : path.parent_path();
  }

 private:
  const TomlTable& table_;
  const fs::path& folder_;
};

std::vector<RigBox> read_boxes(const TomlTable& table) {
  std::size_t columns = 6;
  const std::vector<double> values =
      table.number_rows("body", -kMaxOffset_m, kMaxOffset_m, columns);
  std::vector<RigBox> boxes;
  for (auto v = values.begin(); v != values.end(); v += 6) {
    boxes.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
    if (!(v[3] > 0 && v[4] > 0 && v[5] > 0))
      throw table.error("body", "has a box whose length, width or height is not positive");
  }
  return boxes;
}

/// `path` as seen from a folder. Relative paths of the working directory have no relation to an
/// absolute folder.
std::string relative_path(const fs::path& path, const fs::path& folder) {
  const fs::path from_root = folder.is_absolute() ? fs::absolute(path) : path;
  return from_root.lexically_normal()
      .lexically_proximate(folder.lexically_normal())
      .generic_string();
}

/// Writes "key = value" for values that differ from the default.
class RigText {
 public:
  RigText(std::string& text, const fs::path& folder) : text_(text), folder_(folder) {}

  void operator()(const char* key, const std::string& value) const {
    if (value.empty()) return;
    put(key, toml_string(value));
  }
  void operator()(const char* key, const fs::path& value) const {
    if (!value.empty()) (*this)(key, relative_path(value, folder_));
  }
  void operator()(const char* key, const Vec3d& value) const {
    if (value != Vec3d{}) put(key, "[" + numbers(value) + "]");
  }
  void operator()(const char* key, const std::optional<Vec3d>& value) const {
    if (value) put(key, "[" + numbers(*value) + "]");
  }
  void operator()(const char* key, const std::optional<double>& value) const {
    if (value) put(key, exact_text(*value));
  }
  template <class Word>
  requires std::is_enum_v<Word>
  void operator()(const char* key, const Word& value) const {
    if (value != Word{}) (*this)(key, std::string(word_of(value, words_of(value))));
  }
  void operator()(const char* key, const std::vector<RigBox>& boxes) const {
    std::string list;
    for (const RigBox& box : boxes)
      list +=
          (list.empty() ? "[" : ", [") + numbers(box.center_m) + ", " + numbers(box.size_m) + "]";
    if (!boxes.empty()) put(key, "[" + list + "]");
  }

 private:
  static std::string numbers(Vec3d v) {
    return exact_text(v.x) + ", " + exact_text(v.y) + ", " + exact_text(v.z);
  }
  void put(const char* key, const std::string& value) const {
    text_ += std::string(key) + " = " + value + "\n";
  }

  std::string& text_;
  const fs::path& folder_;
};

Error no_sensors_error(std::string_view text, const fs::path& file) {
  const bool has_cameras = text.find("[[camera]]") != std::string_view::npos;
  return {ErrorKind::config, file.string() +
                                 ": describes no rig: it has no [[sensors]] "
                                 "(docs/formats.md, \"Rigs\"); " +
                                 (has_cameras ? "it is a camera file, for `camera` of render"
                                              : "a file of one sensor is for `sensor`")};
}

}  // namespace

std::size_t Rig::index_of(std::string_view name) const {
  const auto found = std::ranges::find(sensors, name, &RigSensor::name);
  if (found != sensors.end()) return static_cast<std::size_t>(found - sensors.begin());
  std::string names;
  for (const RigSensor& sensor : sensors) names += (names.empty() ? "" : ", ") + sensor.name;
  throw Error(ErrorKind::usage,
              file.string() + ": has no sensor '" + std::string(name) + "'; it has " + names);
}

bool is_rig(const fs::path& path) { return path.extension() == ".toml"; }

Rig parse_rig(std::string_view text, const fs::path& file) {
  const fs::path folder = file.parent_path();
  if (text.find("sensors") == std::string_view::npos) throw no_sensors_error(text, file);
  TomlKeys keys = {"camera"};
  keys.insert(keys.end(), kRigKeys.begin(), kRigKeys.end());
  const TomlTable whole = parse_toml(text, file, keys, "rig");
  DriveSettings shared;
  const RigValue read_shared(whole, folder);
  read_shared("trajectory", shared.trajectory);
  read_shared("boxes", shared.boxes);
  if (!whole.has("sensors")) throw no_sensors_error(text, file);
  Rig rig{file, {}, read_boxes(whole), cameras_of(whole, file)};
  for (const TomlTable& table : whole.tables("sensors", sensor_keys())) {
    RigSensor sensor;
    sensor.is_rig_sensor = true;
    static_cast<DriveSettings&>(sensor) = shared;
    const RigValue read(table, folder);
    table.require("name");
    sensor.name = table.text("name", "");
    if (sensor.name.empty() || sensor.name.find_first_of(" \t\n/\\") != std::string::npos)
      throw table.error("name", "is '" + sensor.name + "', expected a word without / and spaces");
    if (std::ranges::find(rig.sensors, sensor.name, &RigSensor::name) != rig.sensors.end())
      throw table.error("name", "'" + sensor.name + "' is used twice");
    if (table.has("input")) sensor.folder = read.path_of("input");
    sensor.is_in_model = table.flag("in_model", true);
    sensor.body = read_boxes(table);
    visit_rig_settings(sensor, read);
    // A file of a sensor is beside the rig file; other words are names of the library.
    std::error_code ignored;
    if (!sensor.packet_sensor.empty() &&
        fs::is_regular_file(folder / sensor.packet_sensor, ignored))
      sensor.packet_sensor = (folder / sensor.packet_sensor).string();
    rig.sensors.push_back(std::move(sensor));
  }
  if (rig.sensors.empty()) throw whole.error("sensors", "has no sensor");
  if (std::ranges::none_of(rig.sensors, &RigSensor::is_in_model))
    throw whole.error("sensors", "has no sensor that is part of models (in_model)");
  return rig;
}

Rig read_rig_to_simulate(const fs::path& file) { return parse_rig(read_file(file), file); }

Rig read_rig(const fs::path& file) {
  Rig rig = read_rig_to_simulate(file);
  for (const RigSensor& sensor : rig.sensors) {
    const std::string of = file.string() + ": sensor '" + sensor.name + "': ";
    if (sensor.folder.empty()) throw Error(ErrorKind::config, of + "its input is missing");
    std::error_code ignored;  // an input that cannot be looked up is missing
    if (!fs::exists(sensor.folder, ignored))
      throw Error(ErrorKind::no_input, of + "its input " + sensor.folder.string() + " is missing");
  }
  return rig;
}

std::string rig_toml(const Rig& rig) {
  std::string text;
  const fs::path folder = rig.file.parent_path();
  const RigText put(text, folder);
  put("body", rig.body);
  for (RigSensor sensor : rig.sensors) {
    text += "\n[[sensors]]\n";
    put("name", sensor.name);
    put("input", sensor.folder);
    if (!sensor.is_in_model) text += "in_model = false\n";
    put("body", sensor.body);
    std::error_code ignored;
    if (fs::is_regular_file(sensor.packet_sensor, ignored))
      sensor.packet_sensor = relative_path(sensor.packet_sensor, folder);
    visit_rig_settings(sensor, put);
  }
  for (const MountedCamera& camera : rig.cameras) text += "\n" + camera_toml(camera);
  return text;
}

bool move_to_frame_of(const RigidTransform& vehicle_from_sensor, Rig& rig) {
  const RigidTransform sensor_from_vehicle = vehicle_from_sensor.inverse();
  for (MountedCamera& camera : rig.cameras)
    camera.vehicle_from_camera =
        camera.lidar_from_camera.value_or(sensor_from_vehicle * camera.vehicle_from_camera);
  constexpr double kMaxTurn_rad = kDegree;  // 4 cm at the end of a car
  const bool is_turned = angle_between(sensor_from_vehicle.rotation, {}) > kMaxTurn_rad;
  bool are_complete = true;
  const auto move = [&](std::vector<RigBox>& boxes) {
    if (is_turned && !boxes.empty()) are_complete = false;
    if (is_turned) boxes.clear();
    for (RigBox& box : boxes) box.center_m = sensor_from_vehicle * box.center_m;
  };
  move(rig.body);
  for (RigSensor& sensor : rig.sensors) move(sensor.body);
  return are_complete;
}

KittiSequence open_rig_sensor(const RigSensor& sensor, const Executor& executor,
                              ProgressSink& progress) {
  try {
    std::optional<KittiSequence> drive;
    if (!sensor.trajectory.empty() || is_self_contained_drive(sensor.folder)) {
      drive = open_drive(sensor, executor, progress);
    } else if (is_kitti_sequence(sensor.folder)) {
      LoadOptions options;
      static_cast<DriveSettings&>(options) = sensor;
      drive = open_sequence(sensor.folder, options, executor);
      add_boxes(options, {}, *drive, executor, progress);
    }
    if (!drive)
      throw Error(ErrorKind::data, sensor.folder.string() +
                                       ": is not a drive: scans need poses, by the key trajectory");
    drive->rig_sensor = sensor.name;
    return std::move(*drive);
  } catch (const Error& error) {
    throw Error(error.kind(), "sensor '" + sensor.name + "': " + error.what());
  }
}

void require_no_settings(const Rig& rig, const DriveSettings& settings) {
  DriveSettings defaults;
  defaults.topic = settings.topic;
  if (settings == defaults) return;
  throw Error(ErrorKind::usage,
              rig.file.string() +
                  ": trajectory, mounts, clocks and other settings of drives belong in the rig "
                  "file, by sensor; only the topic applies here and chooses a sensor");
}

}  // namespace adasplats
