// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A sensor as a TOML table of beams.

#include <toml++/toml.h>

#include <algorithm>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>

#include "adasplats/core/error.h"
#include "adasplats/io/atomic_file.h"
#include "adasplats/sensors/lidar_files.h"

namespace adasplats {

namespace {

constexpr std::int64_t kMostBeams = 65536;  // a ring is 16 bits
constexpr std::int64_t kMostColumns = 1 << 24;

const std::vector<std::string>& known_keys() {
  static const std::vector<std::string> keys = {
      "name",          "elevations_deg", "beams",       "elevation_top_deg", "elevation_bottom_deg",
      "columns",       "rotation_hz",    "min_range_m", "max_range_m",       "azimuth_offsets_deg",
      "range_noise_m", "clockwise"};
  return keys;
}

Error config_error(const std::filesystem::path& path, std::uint64_t line,
                   const std::string& message) {
  return Error(ErrorKind::config, path.string() + ":" + std::to_string(line) + ": " + message);
}

toml::table parse_table(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  // toml++ bounds the depth of brackets but not of dotted keys, and frees nested tables by
  // recursion. No sensor has this many numbers, let alone keys.
  constexpr std::ptrdiff_t kMostDots = 8192;
  if (std::ranges::count(text, '.') > kMostDots)
    throw Error(ErrorKind::config, path.string() + ": more than " + std::to_string(kMostDots) +
                                       " full stops: not a sensor");
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw config_error(path, error.source().begin.line, std::string(error.description()));
  }
}

/// Reads the keys of one table; each error has the line of what is wrong.
class SensorTable {
 public:
  explicit SensorTable(const std::filesystem::path& path) : path_(path), table_(parse_table(path)) {
    for (const auto& [key, value] : table_) {
      const std::string name(key.str());
      if (std::ranges::find(known_keys(), name) != known_keys().end()) continue;
      const auto nearest = nearest_word(name, known_keys());
      throw error_at(key.source(), "unknown key '" + name + "'" +
                                       (nearest ? ", did you mean '" + *nearest + "'?" : ""));
    }
  }

  bool has(std::string_view key) const { return table_.contains(key); }

  Error error(std::string_view key, const std::string& message) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr)
      return Error(ErrorKind::config, path_.string() + ": " + std::string(key) + " " + message);
    return error_at(node->source(), std::string(key) + " " + message);
  }

  double number(std::string_view key, double otherwise, double low, double high) const {
    const toml::node* node = table_.get(key);
    return node == nullptr ? otherwise : number_of(*node, key, low, high);
  }

  std::int64_t whole_number(std::string_view key, std::int64_t high) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) throw error(key, "is missing");
    const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
    if (!value || *value < 1 || *value > high)
      throw error(key, "is not a whole number from 1 to " + std::to_string(high));
    return *value;
  }

  bool flag(std::string_view key, bool otherwise) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return otherwise;
    if (!node->is_boolean()) throw error(key, "is neither true nor false");
    return node->value_or(otherwise);
  }

  std::string text(std::string_view key, const std::string& otherwise) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return otherwise;
    if (!node->is_string()) throw error(key, "is not a string");
    return node->value_or(otherwise);
  }

  std::vector<double> angles_rad(std::string_view key, double low_deg, double high_deg) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return {};
    if (!node->is_array() || node->as_array()->empty())
      throw error(key, "is not a list of numbers, one a beam");
    std::vector<double> angles_rad;
    for (const toml::node& element : *node->as_array())
      angles_rad.push_back(radians(number_of(element, key, low_deg, high_deg)));
    return angles_rad;
  }

 private:
  Error error_at(const toml::source_region& place, const std::string& message) const {
    return config_error(path_, place.begin.line, message);
  }

  double number_of(const toml::node& node, std::string_view key, double low, double high) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !(*value >= low && *value <= high)) {
      std::ostringstream message;
      message.imbue(std::locale::classic());
      message << key << " is not a number from " << low << " to " << high;
      throw error_at(node.source(), message.str());
    }
    return *value;
  }

  std::filesystem::path path_;
  toml::table table_;
};

/// `beams` from top to bottom, or the list.
std::vector<double> read_elevations_rad(const SensorTable& table) {
  const bool has_fan =
      table.has("beams") || table.has("elevation_top_deg") || table.has("elevation_bottom_deg");
  if (table.has("elevations_deg")) {
    if (has_fan)
      throw table.error("elevations_deg", "cannot stand together with beams and elevation_*_deg");
    return table.angles_rad("elevations_deg", -90, 90);
  }
  if (!has_fan) throw table.error("elevations_deg", "is missing (or beams and elevation_*_deg)");
  for (const char* key : {"beams", "elevation_top_deg", "elevation_bottom_deg"})
    if (!table.has(key)) throw table.error(key, "is missing");
  const auto beams = static_cast<int>(table.whole_number("beams", kMostBeams));
  return even_fan_rad(beams, table.number("elevation_top_deg", 0, -90, 90),
                      table.number("elevation_bottom_deg", 0, -90, 90));
}

}  // namespace

LidarModel read_lidar_toml(const std::filesystem::path& path) {
  const SensorTable table(path);
  constexpr double kFar_m = 1e6;
  LidarModel model;
  model.name = table.text("name", path.stem().string());
  model.elevations_rad = read_elevations_rad(table);
  if (model.elevations_rad.size() > static_cast<std::size_t>(kMostBeams))
    throw table.error("elevations_deg", "has more than 65536 beams");
  model.azimuth_offsets_rad = table.angles_rad("azimuth_offsets_deg", -360, 360);
  if (!model.azimuth_offsets_rad.empty() &&
      model.azimuth_offsets_rad.size() != model.elevations_rad.size())
    throw table.error("azimuth_offsets_deg",
                      "has " + std::to_string(model.azimuth_offsets_rad.size()) +
                          " values, expected " + std::to_string(model.elevations_rad.size()) +
                          ", one a beam");
  model.columns = static_cast<std::uint32_t>(table.whole_number("columns", kMostColumns));
  model.rotation_hz = table.number("rotation_hz", model.rotation_hz, 1e-3, 1e6);
  model.min_range_m = table.number("min_range_m", model.min_range_m, 0, kFar_m);
  model.max_range_m = table.number("max_range_m", model.max_range_m, 0, kFar_m);
  if (!(model.max_range_m > model.min_range_m))
    throw table.error(table.has("max_range_m") ? "max_range_m" : "min_range_m",
                      "leaves no range between min_range_m and max_range_m");
  model.range_noise_m = table.number("range_noise_m", model.range_noise_m, 0, kFar_m);
  model.clockwise = table.flag("clockwise", model.clockwise);
  return model;
}

}  // namespace adasplats
