// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/live_message.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

/// Positions and speeds beyond it are nobody's.
constexpr double kFarthest_m = 1e7;
/// Of one scan with its sub-rays: one page must not keep the others waiting.
constexpr std::size_t kMostRays = 4'000'000;
/// A rotation whose quaternion is of this much other length is a mistake.
constexpr double kNormTolerance = 1e-2;

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::usage, message); }

double number_of(const Json& json, const std::string& name, double least, double most) {
  const double value = json.is_number() ? json.get<double>() : std::nan("");
  if (value >= least && value <= most) return value;
  refuse(name + ": expected a number from " + Json(least).dump() + " to " + Json(most).dump() +
         ", found " + json.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 60));
}

bool truth_of(const Json& json, const std::string& name) {
  if (!json.is_boolean()) refuse(name + ": expected true or false");
  return json.get<bool>();
}

std::string text_of(const Json& json, const std::string& name) {
  if (!json.is_string()) refuse(name + ": expected a text");
  return json.get<std::string>();
}

const Json& member(const Json& json, const std::string& name) {
  const auto found = json.find(name);
  if (found == json.end()) refuse("'" + name + "' is missing");
  return *found;
}

template <std::size_t N>
std::array<double, N> numbers_of(const Json& json, const std::string& name) {
  if (!json.is_array() || json.size() != N)
    refuse(name + ": expected " + std::to_string(N) + " numbers");
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i)
    numbers[i] = number_of(json[i], name, -kFarthest_m, kFarthest_m);
  return numbers;
}

Vec3d vector_of(const Json& json, const std::string& name) {
  const auto [x, y, z] = numbers_of<3>(json, name);
  return {x, y, z};
}

RigidTransform transform_of(const Json& json, Vec3d origin) {
  const auto [x, y, z, qx, qy, qz, qw] = numbers_of<7>(json, "pose");
  const double norm = std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
  if (!(std::fabs(norm - 1) <= kNormTolerance)) refuse("pose: the quaternion is not of length 1");
  return {rotation_from_quaternion(qw / norm, qx / norm, qy / norm, qz / norm),
          Vec3d{x, y, z} + origin};
}

std::string short_number(double value) {
  std::array<char, 32> text{};
  const auto [end, failure] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

/// One setting that is a number: its bounds, where it goes, and the option of `simulate` for it.
struct NumberSetting {
  const char* name;
  double least, most;
  const char* option;
  double& (*value)(ScanSettings&);
};

std::span<const NumberSetting> number_settings() {
  static constexpr NumberSetting kSettings[] = {
      {"range_noise_m", 0, 10, "--range-noise",
       [](ScanSettings& s) -> double& { return s.sensor.range_noise_m; }},
      {"rotation_hz", 0.1, 100, "--rotation-rate",
       [](ScanSettings& s) -> double& { return s.sensor.rotation_hz; }},
      {"min_range_m", 0, 1e4, "--min-range",
       [](ScanSettings& s) -> double& { return s.sensor.min_range_m; }},
      {"max_range_m", 0.1, 1e4, "--max-range",
       [](ScanSettings& s) -> double& { return s.sensor.max_range_m; }},
      {"rain_mm_h", 0, 500, "--rain",
       [](ScanSettings& s) -> double& { return s.weather.rain_mm_h; }},
      {"snow_mm_h", 0, 100, "--snow",
       [](ScanSettings& s) -> double& { return s.weather.snow_mm_h; }},
  };
  return kSettings;
}

struct CountSetting {
  const char* name;
  int most;
  const char* option;
  int& (*value)(ScanSettings&);
};

std::span<const CountSetting> count_settings() {
  static constexpr CountSetting kSettings[] = {
      {"sub_rays", 19, "--sub-rays", [](ScanSettings& s) -> int& { return s.beam.sub_rays; }},
      {"returns", 3, "--returns", [](ScanSettings& s) -> int& { return s.beam.returns; }},
  };
  return kSettings;
}

/// Fog has no greatest visibility: 0 and null are clear air.
void set_fog(LiveSensor& sensor, const Json& json) {
  const double visibility_m = json.is_null() ? 0 : number_of(json, "fog_visibility_m", 0, 1e6);
  if (visibility_m == 0) return;
  sensor.settings.weather.fog_visibility_m = visibility_m;
  sensor.options.insert(sensor.options.end(), {"--fog", short_number(visibility_m)});
}

bool set_number(LiveSensor& sensor, const std::string& name, const Json& json) {
  for (const NumberSetting& setting : number_settings()) {
    if (name != setting.name) continue;
    double& value = setting.value(sensor.settings);
    const double given = number_of(json, name, setting.least, setting.most);
    if (given != value)
      sensor.options.insert(sensor.options.end(), {setting.option, short_number(given)});
    value = given;
    return true;
  }
  return false;
}

bool set_count(LiveSensor& sensor, const std::string& name, const Json& json) {
  for (const CountSetting& setting : count_settings()) {
    if (name != setting.name) continue;
    int& value = setting.value(sensor.settings);
    const double given = number_of(json, name, 1, setting.most);
    if (given != std::floor(given)) refuse(name + ": expected a whole number");
    if (static_cast<int>(given) != value)
      sensor.options.insert(sensor.options.end(), {setting.option, short_number(given)});
    value = static_cast<int>(given);
    return true;
  }
  return false;
}

void set(LiveSensor& sensor, const std::string& name, const Json& json) {
  if (set_number(sensor, name, json) || set_count(sensor, name, json)) return;
  if (name == "fog_visibility_m") return set_fog(sensor, json);
  if (name == "noise") {
    sensor.settings.noise = truth_of(json, name);
    if (!sensor.settings.noise) sensor.options.emplace_back("--no-noise");
  } else if (name == "rolling_shutter") {
    sensor.rolling_shutter = truth_of(json, name);
    if (sensor.rolling_shutter) sensor.options.emplace_back("--rolling-shutter");
  } else {
    refuse("unknown setting '" + name.substr(0, 60) + "'");
  }
}

LiveSensor parse_sensor(const Json& json) {
  LiveSensor sensor = live_sensor(text_of(member(json, "name"), "name"));
  const auto settings = json.find("settings");
  if (settings == json.end()) return sensor;
  if (!settings->is_object()) refuse("settings: expected an object");
  for (const auto& [name, value] : settings->items()) set(sensor, name, value);
  if (!(sensor.settings.sensor.min_range_m < sensor.settings.sensor.max_range_m))
    refuse("min_range_m: expected less than max_range_m");
  check(sensor.settings);
  const std::size_t rays = sensor.settings.sensor.rays_per_scan() *
                           static_cast<std::size_t>(sensor.settings.beam.sub_rays);
  if (rays > kMostRays)
    refuse(std::to_string(rays) + " rays a scan, expected at most " + std::to_string(kMostRays));
  return sensor;
}

LivePose parse_pose(const Json& json, Vec3d origin) {
  LivePose pose;
  pose.world_from_sensor = transform_of(member(json, "pose"), origin);
  if (json.contains("velocity_m_s"))
    pose.velocity_m_s = vector_of(json["velocity_m_s"], "velocity_m_s");
  if (json.contains("yaw_rate_rad_s"))
    pose.yaw_rate_rad_s = number_of(json["yaw_rate_rad_s"], "yaw_rate_rad_s", -100, 100);
  return pose;
}

PickMessage parse_pick(const Json& json, Vec3d origin) {
  PickMessage pick;
  pick.id = static_cast<std::int64_t>(number_of(member(json, "id"), "id", 0, 1e15));
  pick.origin = vector_of(member(json, "origin"), "origin") + origin;
  pick.direction = vector_of(member(json, "direction"), "direction");
  if (!(length(pick.direction) > 0)) refuse("direction: expected one that is not zero");
  return pick;
}

Json settings_json(const LiveSensor& sensor) {
  ScanSettings settings = sensor.settings;
  Json json = {{"noise", settings.noise}};
  for (const NumberSetting& setting : number_settings())
    json[setting.name] = setting.value(settings);
  for (const CountSetting& setting : count_settings()) json[setting.name] = setting.value(settings);
  const double fog_m = settings.weather.fog_visibility_m;
  json["fog_visibility_m"] = std::isfinite(fog_m) ? fog_m : 0.0;
  json["rolling_shutter"] = sensor.rolling_shutter;
  return json;
}

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string LiveSensor::key() const { return name + dump(settings_json(*this)); }

LiveSensor live_sensor(const std::string& name) {
  const std::vector<std::string> names = lidar_model_names();
  if (std::find(names.begin(), names.end(), name) == names.end())
    refuse(unknown_lidar_model(name.substr(0, 60)));
  LiveSensor sensor;
  sensor.name = name;
  sensor.settings.sensor = load_lidar_model(name);
  return sensor;
}

ScanMotion motion_of(const LivePose& pose, const LiveSensor& sensor) {
  const TimedPose reference = {0, pose.world_from_sensor};
  const bool stands = length(pose.velocity_m_s) == 0 && pose.yaw_rate_rad_s == 0;
  if (!sensor.rolling_shutter || stands) return {reference, {}};
  const double duration_s = 1 / sensor.settings.sensor.rotation_hz;
  const auto at = [&](double time_s) {
    const Mat3d turn = rotation_from_yaw_pitch_roll(pose.yaw_rate_rad_s * time_s, 0, 0);
    return TimedPose{time_s,
                     {pose.world_from_sensor.rotation * turn,
                      pose.world_from_sensor.translation + time_s * pose.velocity_m_s}};
  };
  const Trajectory motion = {at(-0.5 * duration_s), at(0), at(0.5 * duration_s)};
  return moving_scans(std::span(&reference, 1), motion, duration_s).front();
}

LiveMessage parse_live_message(std::string_view text, Vec3d origin) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) throw Error(ErrorKind::data, "expected a JSON object");
  const std::string type = text_of(member(json, "type"), "type");
  if (type == "pose") return parse_pose(json, origin);
  if (type == "ready") return ReadyMessage();
  if (type == "sensor") return parse_sensor(json);
  if (type == "run") return RunMessage{truth_of(member(json, "on"), "on")};
  if (type == "pick") return parse_pick(json, origin);
  refuse("unknown type '" + type.substr(0, 60) + "'");
}

std::string error_message(std::string_view what) {
  return dump({{"type", "error"}, {"message", what}});
}

std::string sensor_message(const LiveSensor& sensor, std::size_t rings, std::size_t columns,
                           std::size_t rays) {
  return dump({{"type", "sensor"},
               {"name", sensor.name},
               {"rings", rings},
               {"columns", columns},
               {"rays", rays},
               {"settings", settings_json(sensor)},
               {"options", sensor.options}});
}

}  // namespace adasplats
