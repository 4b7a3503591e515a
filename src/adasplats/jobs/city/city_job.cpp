// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_job.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <variant>

#include "adasplats/core/error.h"
#include "adasplats/jobs/session/settings_json.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Puts how points are read into JSON, whatever the types of its settings.
struct PutLoadSetting {
  Json& json;

  template <class T>
  void operator()(const Setting& setting, const T& value) const {
    json[setting.name] = json_of_value(value);
  }

  static Json json_of_value(const fs::path& value) { return value.string(); }
  static Json json_of_value(const Vec3d& value) { return {value.x, value.y, value.z}; }
  static Json json_of_value(const Extent& value) {
    return {json_of_value(value.low), json_of_value(value.high)};
  }
  template <class T>
  static Json json_of_value(const std::optional<T>& value) {
    return value ? json_of_value(*value) : Json();
  }
  template <class T>
  requires std::is_enum_v<T>
  static Json json_of_value(T value) { return static_cast<int>(value); }
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_same_v<T, std::string>
  static Json json_of_value(const T& value) { return value; }
};

}  // namespace

ConsistentOptions consistent_options_of(const CityJob& job) {
  const auto* ours = std::get_if<ConsistentOptions>(&job.build.recipe);
  if (ours == nullptr)
    throw Error(ErrorKind::usage, "tiles are modelled by the method consistent alone");
  ConsistentOptions options = *ours;
  options.refine = false;
  return options;
}

Json content_of(const CityJob& job) {
  Json json = {{"inputs", Json::array()}, {"input_bytes", Json::array()}};
  for (const fs::path& input : job.inputs) {
    std::error_code is_folder;
    const auto bytes = fs::file_size(input, is_folder);
    json["inputs"].push_back(input.string());
    json["input_bytes"].push_back(is_folder ? Json() : Json(bytes));
  }
  LoadOptions load = job.load;
  visit_settings(load, PutLoadSetting{json["load"]});
  json["load"]["sensor_fields"] = {load.sensor_x_field, load.sensor_y_field, load.sensor_z_field};
  put_settings(job.tiles, json);
  put_settings(consistent_options_of(job), json);
  put_settings(job.calibration, json);
  json["remove"] = name_of(job.build.remove);
  json["labels"] = job.labels;
  json["segment"] = job.segment.on;
  json["network"] = job.segment.network.string();
  json["reflectances"] = job.build.reflectances;
  json["keep_points"] = job.keep_points;
  if (!job.add_to.empty()) {
    json["add_to"] = job.add_to.string();
    put_settings(job.addition, json);
  }
  json["scans"] = {job.load.first_scan, job.load.scan_count, job.load.scan_stride};
  return json;
}

}  // namespace adasplats
