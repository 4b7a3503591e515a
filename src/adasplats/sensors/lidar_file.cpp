// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Loading of sensors by name or from a file, and the parts that all formats share.

#include <algorithm>
#include <cmath>
#include <locale>
#include <map>
#include <numbers>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/lidar_library.h"

namespace adasplats {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxRays = 1U << 28;
constexpr std::uint64_t kMaxListedRays = 4'000'000;  // 40 bytes each

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::size_t>& order) {
  if (values.empty()) return;
  if (values.size() != order.size())
    throw std::logic_error("a LiDAR model needs one value a beam, or none");
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const std::size_t beam : order) sorted.push_back(values[beam]);
  values = std::move(sorted);
}

/// Sorts beams, topmost first; equal elevations keep the file's order.
void sort_beams(LidarFile& file) {
  std::vector<std::size_t> order(file.model.elevations_rad.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(),
                           [&](std::size_t beam) { return file.model.elevations_rad[beam]; });
  reorder(file.model.elevations_rad, order);
  reorder(file.model.azimuth_offsets_rad, order);
  reorder(file.model.beam_origins_m, order);
  reorder(file.model.firing_times_s, order);
  reorder(file.model.range_offsets_m, order);
  reorder(file.model.ring_noise_m, order);
  if (file.model.packets) {
    reorder(file.model.packets->laser_ids, order);
    reorder(file.model.packets->range_offsets_m, order);
  }
  reorder(file.column_steps, order);
  reorder(file.column_phases, order);
}

/// Turns beams that skip columns into a free pattern in the order of ring and column.
void list_firings(LidarFile& file) {
  if (std::ranges::all_of(file.column_steps, [](std::uint32_t step) { return step == 1; })) return;
  LidarModel& model = file.model;
  for (std::size_t ring = 0; ring < model.elevations_rad.size(); ++ring) {
    const std::uint32_t phase = file.column_phases.empty() ? 0 : file.column_phases[ring];
    for (std::uint32_t column = phase; column < model.columns; column += file.column_steps[ring])
      if (model.fires_in(column)) model.free_pattern.push_back(turned_firing(model, ring, column));
  }
}

/// Called before any allocation: a typing error must not exhaust the memory.
void check_size(const LidarFile& file) {
  const LidarModel& model = file.model;
  const bool skips =
      std::ranges::any_of(file.column_steps, [](std::uint32_t step) { return step != 1; });
  const std::uint64_t max_rays = skips ? kMaxListedRays : kMaxRays;
  const std::uint64_t rays = model.rosette
                                 ? rosette_rays_per_scan(model)
                                 : std::uint64_t{model.elevations_rad.size()} * model.columns;
  if (rays > max_rays)
    throw Error(ErrorKind::config, "sensor '" + model.name + "' has " + std::to_string(rays) +
                                       " rays a scan, expected at most " +
                                       std::to_string(max_rays));
}

enum class Format : std::uint8_t { toml, json, yaml, xml, csv, dat };

/// From the extension, else from the content.
Format format_of(const fs::path& path, std::string_view text) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  if (extension == ".dat" || text.starts_with("\xEE\xFF")) return Format::dat;
  if (extension == ".toml") return Format::toml;
  if (extension == ".json") return Format::json;
  if (extension == ".yaml" || extension == ".yml") return Format::yaml;
  if (extension == ".xml" || text.find("<boost_serialization") != std::string_view::npos)
    return Format::xml;
  if (extension == ".csv" || extension == ".txt") return Format::csv;
  if (text.substr(0, text.find_first_not_of(" \t\r\n") + 1).ends_with('{')) return Format::json;
  if (text.find("lasers:") != std::string_view::npos) return Format::yaml;
  return text.find('=') != std::string_view::npos ? Format::toml : Format::csv;
}

LidarModel library_model(std::string_view name) {
  auto file = read_library_lidar(name);
  if (!file) throw std::logic_error("the library has no sensor " + std::string(name));
  return finished_model(std::move(*file));
}

bool has_known_extension(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".toml" || extension == ".json" || extension == ".yaml" ||
         extension == ".yml" || extension == ".xml" || extension == ".csv" || extension == ".dat";
}

}  // namespace

void LidarFile::clear_pattern() {
  model.elevations_rad.clear();
  model.azimuth_offsets_rad.clear();
  model.beam_origins_m.clear();
  model.firing_times_s.clear();
  model.range_offsets_m.clear();
  model.ring_noise_m.clear();
  model.intensity.reset();
  model.fields.reset();
  model.drop.reset();
  model.body.reset();
  model.packets.reset();
  model.window_begin = 0;
  model.window_end = 1;
  model.packet_profile.clear();
  model.free_pattern.clear();
  model.pattern_s = 0;
  model.rosette.reset();
  column_steps.clear();
  column_phases.clear();
}

std::optional<std::string> column_fault(const LidarModel& model) {
  if (model.firing_times_s.empty()) return std::nullopt;
  const double column_s = 1.0 / (model.rotation_hz * model.columns);
  const double last_s = std::ranges::max(model.firing_times_s);
  if (last_s < column_s) return std::nullopt;
  std::ostringstream message;
  message.imbue(std::locale::classic());
  message << "leave " << column_s * 1e6 << " us a column, but the last beam fires at "
          << last_s * 1e6 << " us: expected at most "
          << std::floor(1.0 / (model.rotation_hz * last_s)) << " columns at " << model.rotation_hz
          << " Hz";
  return message.str();
}

LidarModel finished_model(LidarFile file) {
  check_size(file);
  sort_beams(file);
  list_firings(file);
  return std::move(file.model);
}

std::optional<std::string> angle_fault(const LidarModel& model) {
  const std::vector<double>& elevations_rad = model.elevations_rad;
  const std::vector<double>& azimuths_rad = model.azimuth_offsets_rad;
  const std::size_t beams = elevations_rad.size();
  if (beams < 2) return std::nullopt;
  const auto is_zero = [](double angle_rad) { return angle_rad == 0; };
  if (std::ranges::all_of(elevations_rad, is_zero))
    return "all " + std::to_string(beams) +
           " beams have the elevation 0; expected the angles of the sensor";
  std::map<std::pair<double, double>, std::size_t> seen;
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const auto [first, is_new] = seen.try_emplace({elevations_rad[beam], azimuths_rad[beam]}, beam);
    if (!is_new)
      return "beams " + std::to_string(first->second) + " and " + std::to_string(beam) +
             " (from 0) have the same angles; expected one direction a beam";
  }
  return std::nullopt;
}

std::optional<std::string> degrees_fault(const LidarModel& model) {
  constexpr std::size_t kMinBeams = 8;
  const auto [low, high] = std::ranges::minmax(model.elevations_rad);
  const double span_deg = (high - low) * (180 / std::numbers::pi);
  if (model.elevations_rad.size() < kMinBeams || span_deg > 2 || high == low) return std::nullopt;
  return "the elevations of its " + std::to_string(model.elevations_rad.size()) +
         " beams span only " + exact_text(std::round(1000 * span_deg) / 1000) +
         " degrees; expected degrees, are they in radians?";
}

LidarFile default_rotating_lidar() {
  LidarFile file;
  file.model.columns = 1800;
  file.model.clockwise = true;
  return file;
}

std::string unknown_lidar_model(const std::string& name, const std::string& or_else) {
  const std::vector<std::string> names = lidar_model_names();
  const std::string message = "unknown sensor '" + name + "'";
  if (const std::string nearest = did_you_mean(name, names); !nearest.empty())
    return message + nearest;
  std::string list;
  for (const std::string& each : names) list += (list.empty() ? "" : ", ") + each;
  return message + ": expected " + list + or_else;
}

LidarFile read_lidar(const std::string& name_or_path, int nesting) {
  if (auto library = read_library_lidar(name_or_path)) return std::move(*library);
  const fs::path path(name_or_path);
  std::error_code ignored;  // of names that are too long for a file
  if (!has_known_extension(path) && !fs::is_regular_file(path, ignored))
    throw Error(
        ErrorKind::usage,
        unknown_lidar_model(name_or_path,
                            " or a file: .toml, .json (Ouster), .yaml or .xml (Velodyne), .csv "
                            "(rays, or Hesai's angles), .dat (Hesai AT128)"));
  const std::string text = read_file(path);
  switch (format_of(path, text)) {
    case Format::toml: return read_lidar_toml(text, path, nesting);
    case Format::json: return read_ouster_json(text, path);
    case Format::yaml: return read_velodyne_yaml(text, path);
    case Format::xml: return read_velodyne_xml(text, path);
    case Format::dat: return read_hesai_dat(text, path);
    case Format::csv: break;
  }
  return read_lidar_csv(text, path);
}

std::optional<LidarFile> read_library_lidar(std::string_view name) {
  const auto library = lidar_library();
  const auto found = std::ranges::find(library, name, &LibraryLidar::name);
  if (found == library.end()) return std::nullopt;
  return read_lidar_toml(found->toml, std::string(name) + ".toml", 0);
}

std::vector<std::string> lidar_model_names() {
  std::vector<std::string> names;
  for (const LibraryLidar& lidar : lidar_library()) names.emplace_back(lidar.name);
  return names;
}

LidarModel hdl_64_paper() { return library_model("hdl-64-paper"); }

LidarModel hdl_32_paper() { return library_model("hdl-32-paper"); }

LidarModel load_lidar_model(const std::string& name_or_path) {
  return finished_model(read_lidar(name_or_path, 0));
}

LidarModel ouster_lidar_model(std::string_view metadata, const std::string& name) {
  LidarModel model = finished_model(read_ouster_json(metadata, name));
  model.name = name;
  return model;
}

}  // namespace adasplats
