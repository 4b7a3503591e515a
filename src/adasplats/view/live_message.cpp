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
#include "adasplats/jobs/session/settings_json.h"
#include "adasplats/sensors/sensor_overrides.h"
#include "adasplats/view/message_values.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

/// Maximum rays of a scan with its sub-rays, so that one page does not delay the others.
constexpr std::size_t kMaxRays = 4'000'000;

std::string short_number(double value) {
  std::array<char, 32> text{};
  const auto [end, failure] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

double number_of(const Json& json, const Setting& setting) {
  const double value = json.is_number() ? json.get<double>() : std::nan("");
  if (is_in_range(setting, value)) return value;
  reject_message(std::string(setting.key) + ": expected " + range_text(setting) + ", found " +
                 message_excerpt(json));
}

/// Sets the setting of a key from JSON and appends the option of `simulate` for it.
class SettingFromJson {
 public:
  SettingFromJson(const std::string& key, const Json& json, std::vector<std::string>& options)
      : key_(key), json_(json), options_(options) {}

  bool found() const { return found_; }

  template <class T>
  void operator()(const Setting& setting, T& value) {
    if (key_ != setting.key) return;
    found_ = true;
    if constexpr (std::is_enum_v<T>) {
      set_word(setting, value);
    } else if constexpr (std::is_same_v<T, int>) {
      const double number = number_of(json_, setting);
      if (number != std::floor(number)) reject_message(key_ + ": expected a whole number");
      put(setting, static_cast<int>(number), value);
    } else if constexpr (std::is_same_v<T, double>) {
      // Settings that are infinite by default: 0 and null mean infinite.
      const bool none = json_.is_null() || json_ == 0;
      if (none && !std::isfinite(T(value))) return;
      put(setting, number_of(json_, setting), value);
    } else {
      put(setting, number_of(json_, setting), value);
    }
  }

 private:
  template <class T>
  void set_word(const Setting& setting, T& value) {
    const std::string word = message_text(json_, key_);
    for (const auto& [each, meaning] : words_of(value)) {
      if (each != word) continue;
      if (meaning != value) options_.insert(options_.end(), {option_of(setting), word});
      value = meaning;
      return;
    }
    std::string known;
    for (const auto& [each, meaning] : words_of(value))
      known += (known.empty() ? "" : ", ") + std::string(each);
    reject_message(key_ + ": expected one of " + known);
  }

  template <class T, class Given>
  void put(const Setting& setting, Given given, T& value) {
    if (value != given)
      options_.insert(options_.end(),
                      {option_of(setting), short_number(static_cast<double>(given))});
    value = given;
  }

  const std::string& key_;
  const Json& json_;
  std::vector<std::string>& options_;
  bool found_ = false;
};

/// The sensor's values as settings.
SensorOverrides overrides_of(const LidarModel& sensor) {
  return {sensor.range_noise_m, sensor.min_range_m, sensor.max_range_m, sensor.rotation_hz};
}

bool set_by_table(LiveSensor& sensor, const std::string& key, const Json& json) {
  SettingFromJson setter(key, json, sensor.options);
  SensorOverrides overrides = overrides_of(sensor.settings.sensor);
  visit_settings(overrides, setter);
  overrides.apply(sensor.settings.sensor);
  visit_settings(sensor.settings.beam, setter);
  visit_settings(sensor.settings.weather, setter);
  return setter.found();
}

void set(LiveSensor& sensor, const std::string& name, const Json& json) {
  if (set_by_table(sensor, name, json)) return;
  if (name == "noise") {
    sensor.settings.noise = message_bool(json, name);
    if (!sensor.settings.noise) sensor.options.emplace_back("--no-noise");
  } else if (name == "rolling_shutter") {
    sensor.rolling_shutter = message_bool(json, name);
    if (sensor.rolling_shutter) sensor.options.emplace_back("--rolling-shutter");
  } else {
    reject_message("unknown setting '" + name.substr(0, 60) + "'");
  }
}

LiveSensor parse_sensor(const Json& json) {
  LiveSensor sensor = live_sensor(message_text(message_member(json, "name"), "name"));
  const auto settings = json.find("settings");
  if (settings == json.end()) return sensor;
  if (!settings->is_object()) reject_message("settings: expected an object");
  for (const auto& [name, value] : settings->items()) set(sensor, name, value);
  if (!(sensor.settings.sensor.min_range_m < sensor.settings.sensor.max_range_m))
    reject_message("min_range_m: expected less than max_range_m");
  check(sensor.settings);
  const std::size_t firings = sensor.settings.sensor.rays_per_scan();
  const std::size_t hits = sensor.settings.beam.hits_per_firing();
  if (firings > kMaxRays / hits)
    reject_message(std::to_string(firings) + " firings of " + std::to_string(hits) +
                   " rays per scan; expected at most " + std::to_string(kMaxRays) + " rays");
  return sensor;
}

RigidTransform moved_by(RigidTransform pose, Vec3d shift) {
  pose.translation = pose.translation + shift;
  return pose;
}

LivePose parse_pose(const Json& json, Vec3d origin) {
  LivePose pose;
  pose.world_from_sensor =
      moved_by(message_transform(message_member(json, "pose"), "pose"), origin);
  if (json.contains("velocity_m_s"))
    pose.velocity_m_s = message_vector(json["velocity_m_s"], "velocity_m_s");
  if (json.contains("yaw_rate_rad_s"))
    pose.yaw_rate_rad_s = message_number(json["yaw_rate_rad_s"], "yaw_rate_rad_s", -100, 100);
  if (json.contains("time_s"))
    pose.time_s = message_number(json["time_s"], "time_s", -kMaxMessageTime_s, kMaxMessageTime_s);
  return pose;
}

ObjectMessage parse_object(const Json& json, Vec3d origin) {
  ObjectMessage object;
  object.id =
      static_cast<std::size_t>(message_whole_number(message_member(json, "id"), "id", 0, 1e9));
  const Json& pose = message_member(json, "pose");
  if (!pose.is_null()) object.world_from_object = moved_by(message_transform(pose, "pose"), origin);
  return object;
}

PickMessage parse_pick(const Json& json, Vec3d origin) {
  PickMessage pick;
  pick.id =
      static_cast<std::int64_t>(message_whole_number(message_member(json, "id"), "id", 0, 1e15));
  pick.origin = message_vector(message_member(json, "origin"), "origin") + origin;
  pick.direction = message_vector(message_member(json, "direction"), "direction");
  if (!(length(pick.direction) > 0)) reject_message("direction: expected a non-zero vector");
  return pick;
}

Json settings_json(const LiveSensor& sensor) {
  Json json = {{"noise", sensor.settings.noise}};
  put_settings(overrides_of(sensor.settings.sensor), json);
  put_settings(sensor.settings.beam, json);
  put_settings(sensor.settings.weather, json);
  if (!std::isfinite(sensor.settings.weather.fog_visibility_m)) json["fog_visibility_m"] = 0.0;
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
    reject_message(unknown_lidar_model(name.substr(0, 60)));
  LiveSensor sensor;
  sensor.name = name;
  sensor.settings.sensor = load_lidar_model(name);
  return sensor;
}

ScanMotion motion_of(const LivePose& pose, const LiveSensor& sensor) {
  const TimedPose reference = {pose.time_s, pose.world_from_sensor};
  const bool is_at_rest = length(pose.velocity_m_s) == 0 && pose.yaw_rate_rad_s == 0;
  if (!sensor.rolling_shutter || is_at_rest || fires_at_once(sensor.settings.sensor))
    return {reference, {}};
  const double duration_s = 1 / sensor.settings.sensor.rotation_hz;
  const auto at = [&](double time_s) {
    const Mat3d turn = rotation_from_yaw_pitch_roll(pose.yaw_rate_rad_s * time_s, 0, 0);
    return TimedPose{pose.time_s + time_s,
                     {pose.world_from_sensor.rotation * turn,
                      pose.world_from_sensor.translation + time_s * pose.velocity_m_s}};
  };
  const Trajectory motion = {at(-0.5 * duration_s), at(0), at(0.5 * duration_s)};
  return moving_scans(std::span(&reference, 1), motion, duration_s).front();
}

LiveMessage parse_live_message(std::string_view text, Vec3d origin) {
  const Json json = parse_message(text);
  const std::string type = message_text(message_member(json, "type"), "type");
  if (type == "pose") return parse_pose(json, origin);
  if (type == "ready") return ReadyMessage();
  if (type == "sensor") return parse_sensor(json);
  if (type == "run") return RunMessage{message_bool(message_member(json, "on"), "on")};
  if (type == "pick") return parse_pick(json, origin);
  if (type == "object") return parse_object(json, origin);
  reject_message("unknown type '" + type.substr(0, 60) + "'");
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
