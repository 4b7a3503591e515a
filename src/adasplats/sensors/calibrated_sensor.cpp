// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/calibrated_sensor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <locale>
#include <numbers>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/base64.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/lidar_library.h"
#include "adasplats/sensors/toml_nodes.h"
#include "adasplats/sensors/toml_table.h"

namespace adasplats {
namespace {

constexpr std::size_t kLineWidth = 100;
constexpr const char* kFoundBy = "; elevations_deg and range_offsets_m of this unit by calibration";

/// One key of a file and its value as text.
struct SensorEntry {
  std::string key, value;
};

std::string toml_text(const toml::node& scalar) {
  if (const toml::value<double>* number = scalar.as_floating_point())
    return exact_text(number->get());  // toml++ writes 9.68 as 9.6799999999999997
  std::ostringstream text;
  text.imbue(std::locale::classic());
  scalar.visit([&](const auto& value) { text << value; });
  return text.str();
}

/// A scalar or a (nested) list on one line.
std::string text_of_node(const toml::node& node) {
  const toml::array* list = node.as_array();
  if (list == nullptr) return toml_text(node);
  std::string text;
  for (const toml::node& element : *list)
    text += (text.empty() ? "" : ", ") + text_of_node(element);
  return "[" + text + "]";
}

std::string text_of_numbers(const std::vector<double>& numbers) {
  constexpr double kStepsPerUnit = 1e5;
  toml::array list;
  for (const double number : numbers)
    list.push_back(std::round(number * kStepsPerUnit) / kStepsPerUnit + 0.0);  // never -0
  return text_of_node(list);
}

/// `key = value`; lists that are too long for a line are wrapped after commas.
std::string lines_of(const std::string& key, const std::string& value) {
  const std::string line = key + " = " + value;
  if (line.size() <= kLineWidth || value.front() != '[') return line + "\n";
  std::string text = key + " = [\n", part = " ";
  std::size_t depth = 0, word = 1;
  for (std::size_t i = 1; i + 1 < value.size(); ++i) {
    if (value[i] == '[') ++depth;
    if (value[i] == ']') --depth;
    const bool is_last = i + 2 == value.size();
    if (!is_last && !(value[i] == ',' && depth == 0)) continue;
    const std::size_t first = value.find_first_not_of(' ', word);
    const std::string next = " " + value.substr(first, i + 1 - first);
    if (part.size() + next.size() > kLineWidth) {
      text += part + "\n";
      part = " ";
    }
    part += next;
    word = i + 1;
  }
  return text + part + "\n]\n";
}

/// The ring (topmost 0) of each beam of a file, sorted as load_lidar_model sorts them.
std::vector<std::size_t> rings_of_beams(const std::vector<double>& elevations_rad) {
  std::vector<std::size_t> beams(elevations_rad.size()), rings(elevations_rad.size());
  std::iota(beams.begin(), beams.end(), std::size_t{0});
  std::ranges::stable_sort(beams, std::greater<>(),
                           [&](std::size_t beam) { return elevations_rad[beam]; });
  for (std::size_t ring = 0; ring < beams.size(); ++ring) rings[beams[ring]] = ring;
  return rings;
}

double offset_at(std::span<const double> offsets, std::size_t ring) {
  return ring < offsets.size() ? offsets[ring] : 0.0;
}

/// Numbers with six significant digits.
template <class Number>
std::string rounded_list(std::span<const Number> numbers) {
  std::string text;
  for (const Number number : numbers) {
    std::ostringstream one;
    one.imbue(std::locale::classic());
    one << std::setprecision(6) << static_cast<double>(number);
    text += (text.empty() ? "" : ", ") + one.str();
  }
  return "[" + text + "]";
}

std::string rows_text(const char* key, std::span<const float> values, std::size_t columns) {
  std::string text = std::string(key) + " = [\n";
  for (std::size_t i = 0; i < values.size(); i += columns)
    text += "  " + rounded_list(values.subspan(i, columns)) + ",\n";
  return text + "]\n";
}

/// The table [intensity], which must follow all keys.
std::string intensity_text(const SensorIntensity& unit) {
  std::string text = "\n[intensity]\n";
  text += "step = " + exact_text(unit.step) + "\nhighest = " + exact_text(unit.highest) + "\n";
  if (unit.ring_nodes > 0) {
    text += "# What the model expects, and the level that a laser makes of it, topmost first.\n";
    text += rows_text("ring_expected", unit.ring_expected, unit.ring_nodes);
    text += rows_text("ring_level", unit.ring_level, unit.ring_nodes);
  }
  text +=
      "# Of each level: the share of returns with intensity zero; what 0, 1, 3, 7, 15, 25, 35, 50, "
      "65,\n# 75, 85, 93, 97, 99 and 100 % of the others report at most.\n";
  text += lines_of("levels", rounded_list(std::span<const float>(unit.levels)));
  text += lines_of("zero_share", rounded_list(std::span<const float>(unit.zero_share)));
  return text + rows_text("reported", unit.reported, kTextureNodes);
}

/// The table [fields], which must follow all keys.
std::string fields_text(const SensorFields& fields) {
  const std::string_view bytes(reinterpret_cast<const char*>(fields.bytes.data()),
                               fields.bytes.size());
  return "\n# Turns of this unit: of every beam four bytes, how early its echo is lost, how much "
         "it\n"
         "# reports among such surfaces, the noise of its range, and how early it reports zero\n"
         "# (base64).\n[fields]\nturns = " +
         std::to_string(fields.turns) + "\ncolumns = " + std::to_string(fields.columns) +
         "\nbytes = \"" + to_base64(bytes) + "\"\n";
}

/// The keys of a library file in its order, except those of elevations and range offsets.
std::vector<SensorEntry> entries_of(std::string_view library_toml) {
  const toml::table table = toml::parse(library_toml);
  if (table.contains("like")) throw std::logic_error("a sensor of the library uses the key like");
  std::vector<std::pair<std::uint32_t, SensorEntry>> found;
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const bool is_replaced = name == "elevations_deg" || name == "beams" ||
                             name.starts_with("elevation_") || name == "range_offsets_m";
    if (is_replaced) continue;
    found.push_back({node.source().begin.line, {name, text_of_node(node)}});
  }
  std::ranges::stable_sort(found, {}, &std::pair<std::uint32_t, SensorEntry>::first);
  std::vector<SensorEntry> entries;
  entries.reserve(found.size());
  for (auto& [line, entry] : found) entries.push_back(std::move(entry));
  return entries;
}

}  // namespace

std::string calibrated_sensor_toml(const std::string& library_name, const SensorOffsets& offsets,
                                   const SensorTraits& traits) {
  const auto library = lidar_library();
  const auto found = std::ranges::find(library, library_name, &LibraryLidar::name);
  if (found == library.end()) throw Error(ErrorKind::usage, unknown_lidar_model(library_name));
  const LidarFile file = *read_library_lidar(library_name);
  const std::size_t beams = file.model.elevations_rad.size();
  if (beams == 0 || offsets.range_m.size() > beams || offsets.elevation_rad.size() > beams)
    throw std::logic_error("more offsets than beams of " + library_name);
  const std::vector<std::size_t> rings = rings_of_beams(file.model.elevations_rad);
  std::vector<double> elevations_deg, ranges_m;
  for (std::size_t beam = 0; beam < beams; ++beam) {
    elevations_deg.push_back(
        (file.model.elevations_rad[beam] + offset_at(offsets.elevation_rad, rings[beam])) *
        (180 / std::numbers::pi));
    ranges_m.push_back(offset_at(offsets.range_m, rings[beam]));
  }
  std::string text =
      "# One unit of " + library_name +
      ":\n# elevations_deg are corrected; range_offsets_m is to be added to what each laser "
      "reports\n# (simulated where --sensor-offsets asks for it).\n";
  for (SensorEntry& entry : entries_of(found->toml)) {
    if (entry.key == "name") entry.value = toml_text(toml::value(library_name + "-unit"));
    if (entry.key == "source")
      entry.value = toml_text(toml::value(
          file.model.source + kFoundBy +
          (traits.fitted_to.empty() ? "" : "; the rest fitted to " + traits.fitted_to)));
    if (entry.key == "max_range_m" && traits.max_range_m)
      entry.value = exact_text(*traits.max_range_m);
    text += lines_of(entry.key, entry.value);
  }
  text += lines_of("elevations_deg", text_of_numbers(elevations_deg)) +
          lines_of("range_offsets_m", text_of_numbers(ranges_m));
  if (!traits.ring_noise_m.empty()) {
    std::vector<double> noise_m;
    noise_m.reserve(rings.size());
    for (const std::size_t ring : rings) noise_m.push_back(offset_at(traits.ring_noise_m, ring));
    text += lines_of("ring_noise_m", text_of_numbers(noise_m));
  }
  if (traits.intensity != nullptr) text += intensity_text(*traits.intensity);
  if (traits.drop != nullptr) text += "\n[drop]\n" + ray_drop_toml(*traits.drop, "drop.");
  if (traits.body != nullptr && !traits.body->cells.empty())
    text += "\n[body]\n" + vehicle_body_toml(*traits.body);
  if (traits.fields != nullptr) text += fields_text(*traits.fields);
  return text;
}

}  // namespace adasplats
