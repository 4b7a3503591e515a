// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A sensor in a TOML file.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <string_view>

#include "adasplats/core/error.h"
#include "adasplats/core/words.h"
#include "adasplats/io/base/base64.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/toml_table.h"

namespace adasplats {

namespace {

constexpr double kMicrosecond_s = 1e-6;

const TomlKeys& sensor_keys() {
  static const TomlKeys keys = {"name",
                                "source",
                                "like",
                                "beams",
                                "elevations_deg",
                                "elevation_top_deg",
                                "columns",
                                "rotation_hz",
                                "elevation_bottom_deg",
                                "clockwise",
                                "min_range_m",
                                "azimuth_offsets_deg",
                                "max_range_m",
                                "range_noise_m",
                                "range_resolution_m",
                                "max_returns",
                                "divergence_deg",
                                "divergence_kind",
                                "angular_noise_deg",
                                "column_steps",
                                "column_phases",
                                "first_azimuth_deg",
                                "rosette",
                                "firing_times_us",
                                "beam_origins_m",
                                "range_offsets_m",
                                "ring_noise_m",
                                "packets",
                                "laser_ids",
                                "intensity",
                                "fields",
                                "drop",
                                "body"};
  return keys;
}

const TomlKeys& rosette_keys() {
  static const TomlKeys keys = {"prism_turns_per_minute", "deflection_deg", "points_per_s",
                                "laser_tilts_deg"};
  return keys;
}

const TomlKeys& intensity_keys() {
  static const TomlKeys keys = {"step",   "highest",    "ring_expected", "ring_level",
                                "levels", "zero_share", "reported"};
  return keys;
}

const TomlKeys& body_keys() {
  static const TomlKeys keys = {"cells"};
  return keys;
}

const TomlKeys& field_keys() {
  static const TomlKeys keys = {"turns", "columns", "bytes"};
  return keys;
}

bool has_fan(const TomlTable& table) {
  return table.has("beams") || table.has("elevation_top_deg") || table.has("elevation_bottom_deg");
}

std::vector<double> read_elevations_rad(const TomlTable& table) {
  if (table.has("elevations_deg")) {
    if (has_fan(table))
      throw table.error("elevations_deg", "cannot be combined with beams and elevation_*_deg");
    return table.angles_rad("elevations_deg", -90, 90);
  }
  if (!has_fan(table))
    throw table.error("elevations_deg", "is missing (or beams and elevation_*_deg, or like)");
  for (const char* key : {"beams", "elevation_top_deg", "elevation_bottom_deg"}) table.require(key);
  const auto beams = static_cast<int>(table.whole_number("beams", 1, kMaxBeams));
  return even_fan_rad(beams, table.number("elevation_top_deg", 0, -90, 90),
                      table.number("elevation_bottom_deg", 0, -90, 90));
}

/// Replaces `values` if the key exists.
template <class T>
void read_one_a_beam(const TomlTable& table, std::string_view key, std::size_t beams,
                     std::vector<T> read, std::vector<T>& values) {
  if (!table.has(key)) return;
  if (read.size() != beams)
    throw table.error(key, "has " + std::to_string(read.size()) + " values, expected " +
                               std::to_string(beams) + ", one a beam");
  values = std::move(read);
}

constexpr double kMaxIntensity = 1e9;  // beyond any unit of intensity

void require_ascending(const TomlTable& table, const char* key, std::span<const float> values,
                       std::size_t columns) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (i % columns != 0 && !(values[i] > values[i - 1]))
      throw table.error(key, "is not ascending");
}

std::vector<float> floats_of(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

SensorIntensity read_intensity(const TomlTable& sensor, std::size_t rings) {
  const TomlTable table = sensor.table("intensity", intensity_keys());
  for (const char* key : {"highest", "levels", "zero_share", "reported"}) table.require(key);
  SensorIntensity unit;
  unit.step = table.number("step", 0, 0, kMaxIntensity);
  unit.highest = table.number("highest", 0, 0, kMaxIntensity);
  if (table.has("ring_expected") != table.has("ring_level"))
    throw table.error("ring_expected", "and ring_level require each other");
  unit.ring_expected = table.rows("ring_expected", -kMaxIntensity, kMaxIntensity, unit.ring_nodes);
  unit.ring_level = table.rows("ring_level", -kMaxIntensity, kMaxIntensity, unit.ring_nodes);
  if (unit.ring_nodes > 0) {
    require_ascending(table, "ring_expected", unit.ring_expected, unit.ring_nodes);
    for (const std::size_t values : {unit.ring_expected.size(), unit.ring_level.size()})
      if (values != rings * unit.ring_nodes)
        throw table.error("ring_level",
                          "and ring_expected need one list a ring, of " + std::to_string(rings));
  }
  unit.levels = floats_of(table.numbers("levels", -kMaxIntensity, kMaxIntensity));
  require_ascending(table, "levels", unit.levels, unit.levels.size());
  unit.zero_share = floats_of(table.numbers("zero_share", 0, 1));
  std::size_t nodes = kTextureNodes;
  unit.reported = table.rows("reported", 0, kMaxIntensity, nodes);
  if (unit.zero_share.size() != unit.levels.size() ||
      unit.reported.size() != unit.levels.size() * kTextureNodes)
    throw table.error("levels", "needs as many values in zero_share and lists in reported");
  return unit;
}

SensorFields read_fields(const TomlTable& sensor, std::size_t rings) {
  constexpr std::int64_t kMaxTurns = 64, kMaxFieldColumns = 1 << 16;
  const TomlTable table = sensor.table("fields", field_keys());
  SensorFields fields;
  fields.rings = static_cast<std::uint32_t>(rings);
  fields.turns = static_cast<std::uint32_t>(table.whole_number("turns", 1, kMaxTurns));
  fields.columns = static_cast<std::uint32_t>(table.whole_number("columns", 1, kMaxFieldColumns));
  const std::optional<std::string> bytes = from_base64(table.text("bytes", ""));
  if (!bytes) throw table.error("bytes", "is not base64");
  const std::size_t expected = std::size_t{fields.turns} * rings * fields.columns * kSensorFields;
  if (bytes->size() != expected)
    throw table.error("bytes", "has " + std::to_string(bytes->size()) + " bytes, expected " +
                                   std::to_string(expected) + ", four per beam");
  fields.bytes.assign(bytes->begin(), bytes->end());
  return fields;
}

VehicleBody read_body(const TomlTable& sensor, std::size_t rings) {
  constexpr std::size_t kMaxCells = 65534;  // cells have 16-bit indices
  constexpr double kFarthest_mm = 1e5;
  const TomlTable table = sensor.table("body", body_keys());
  std::size_t columns = 5;
  const std::vector<float> rows = table.rows("cells", -1e9, kMaxIntensity, columns);
  VehicleBody body;
  for (std::size_t i = 0; i < rows.size(); i += columns) {
    const double ring = rows[i], share = rows[i + 2] / 100, range_mm = rows[i + 3];
    const double column = (static_cast<double>(rows[i + 1]) + 180) * (kBodyColumns / 360.0);
    const auto is_below = [](double value, double most) {
      return value >= 0 && value < most && value == std::floor(value);
    };
    if (!is_below(ring, static_cast<double>(rings)) || !is_below(column, kBodyColumns) ||
        !(share >= 0 && share <= 1) || !(range_mm > 0 && range_mm < kFarthest_mm))
      throw table.error("cells", "has a row " + std::to_string(i / columns + 1) +
                                     " that is not [ring, azimuth in steps of 0.5 degrees, "
                                     "percent, range in mm, intensity]");
    body.cells.push_back({static_cast<std::uint16_t>(ring), static_cast<std::uint16_t>(column),
                          static_cast<float>(share), static_cast<float>(range_mm / 1000),
                          rows[i + 4]});
  }
  const auto by_column = [](const BodyCell& cell) { return std::pair(cell.ring, cell.column); };
  std::ranges::sort(body.cells, {}, by_column);
  if (std::ranges::adjacent_find(body.cells, {}, by_column) != body.cells.end())
    throw table.error("cells", "has two rows for one ring and azimuth");
  if (body.cells.size() > kMaxCells) throw table.error("cells", "has more than 65534 rows");
  return body;
}

/// The packet format and the laser id of each beam, a permutation of 0 to beams - 1.
void read_packets(const TomlTable& table, std::size_t beams, LidarModel& model) {
  if (table.has("packets")) {
    const std::string word = table.text("packets", "");
    const std::vector<std::string> words = list_of<PacketFormat>(kPacketFormats);
    if (std::ranges::find(words, word) == words.end())
      throw table.error("packets", "have an " + unknown_word("format", word, words));
    if (!model.packets) model.packets.emplace();
    model.packets->format = value_of(word, kPacketFormats);
    // Hesai's channels, in the order of its angle correction files.
    if (is_hesai(model.packets->format)) {
      model.packets->laser_ids.resize(beams);
      std::iota(model.packets->laser_ids.begin(), model.packets->laser_ids.end(), 0U);
    }
  }
  if (!table.has("laser_ids")) return;
  if (!model.packets)
    throw table.error("laser_ids", "needs packets, the format that they belong to");
  std::vector<std::uint32_t> ids = table.whole_numbers("laser_ids", 0);
  std::vector<std::uint32_t> sorted = ids;
  std::ranges::sort(sorted);
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (sorted[i] != i)
      throw table.error("laser_ids", "does not contain each number from 0 on exactly once");
  read_one_a_beam(table, "laser_ids", beams, std::move(ids), model.packets->laser_ids);
}

void read_beams(const TomlTable& table, LidarFile& file) {
  LidarModel& model = file.model;
  if (table.has("elevations_deg") || has_fan(table) || !file.has_beams()) {
    file.clear_pattern();
    model.elevations_rad = read_elevations_rad(table);
  }
  const std::size_t beams = model.elevations_rad.size();
  if (beams > kMaxBeams) throw table.error("elevations_deg", "has more than 65536 beams");
  read_one_a_beam(table, "azimuth_offsets_deg", beams,
                  table.angles_rad("azimuth_offsets_deg", -360, 360), model.azimuth_offsets_rad);
  read_one_a_beam(table, "beam_origins_m", beams, table.points("beam_origins_m", beams),
                  model.beam_origins_m);
  std::vector<double> times_s = table.numbers("firing_times_us", 0, 1e9);
  for (double& time_s : times_s) time_s *= kMicrosecond_s;
  read_one_a_beam(table, "firing_times_us", beams, std::move(times_s), model.firing_times_s);
  read_one_a_beam(table, "range_offsets_m", beams,
                  table.numbers("range_offsets_m", -kFar_m, kFar_m), model.range_offsets_m);
  read_one_a_beam(table, "ring_noise_m", beams, table.numbers("ring_noise_m", 0, kFar_m),
                  model.ring_noise_m);
  read_packets(table, beams, model);
  if (table.has("intensity")) model.intensity = read_intensity(table, beams);
  if (table.has("fields")) model.fields = read_fields(table, beams);
  if (table.has("drop")) model.drop = read_ray_drop_table(table, "drop");
  if (table.has("body")) model.body = read_body(table, beams);
  read_one_a_beam(table, "column_steps", beams, table.whole_numbers("column_steps", 1),
                  file.column_steps);
  read_one_a_beam(table, "column_phases", beams, table.whole_numbers("column_phases", 0),
                  file.column_phases);
  if (!file.column_phases.empty() && file.column_steps.empty())
    throw table.error("column_phases", "needs column_steps");
  for (std::size_t beam = 0; beam < file.column_phases.size(); ++beam)
    if (file.column_phases[beam] >= file.column_steps[beam])
      throw table.error("column_phases", "has a phase that is not below its step");
}

void read_turning(const TomlTable& table, LidarModel& model) {
  if (table.has("columns") || model.columns == 0)
    model.columns = static_cast<std::uint32_t>(table.whole_number("columns", 1, kMaxColumns));
  if (table.has("first_azimuth_deg"))
    model.first_azimuth_rad = radians(table.number("first_azimuth_deg", 0, -360, 360));
  model.clockwise = table.flag("clockwise", model.clockwise);
  if (const auto fault = column_fault(model))
    throw table.error(table.has("columns") ? "columns" : "rotation_hz", *fault);
}

void read_rosette(const TomlTable& sensor, LidarFile& file) {
  for (const char* key : {"columns", "beams", "elevations_deg"})
    if (sensor.has(key)) throw sensor.error(key, "cannot be combined with a rosette");
  const TomlTable table = sensor.table("rosette", rosette_keys());
  file.clear_pattern();
  RosettePattern rosette;
  for (const char* key : {"prism_turns_per_minute", "deflection_deg", "points_per_s"})
    table.require(key);
  const auto turns = table.numbers("prism_turns_per_minute", -1e9, 1e9);
  const auto deflections_rad = table.angles_rad("deflection_deg", 0, 90);
  if (turns.size() != 2) throw table.error("prism_turns_per_minute", "is not one number a prism");
  if (deflections_rad.size() != 2) throw table.error("deflection_deg", "is not one number a prism");
  for (int prism = 0; prism < 2; ++prism) {
    rosette.prism_hz[prism] = turns[static_cast<std::size_t>(prism)] / 60.0;
    rosette.deflection_rad[prism] = deflections_rad[static_cast<std::size_t>(prism)];
  }
  rosette.points_per_s = table.number("points_per_s", 0, 1, 1e9);
  rosette.laser_tilts_rad = table.angles_rad("laser_tilts_deg", -90, 90);
  if (rosette.laser_tilts_rad.size() > kMaxBeams)
    throw table.error("laser_tilts_deg", "has more than 65536 lasers");
  file.model.rosette = std::move(rosette);
}

void read_measuring(const TomlTable& table, LidarModel& model) {
  model.min_range_m = table.number("min_range_m", model.min_range_m, 0, kFar_m);
  model.max_range_m = table.number("max_range_m", model.max_range_m, 0, kFar_m);
  if (!(model.max_range_m > model.min_range_m))
    throw table.error(table.has("max_range_m") ? "max_range_m" : "min_range_m",
                      "leaves no range between min_range_m and max_range_m");
  model.range_noise_m = table.number("range_noise_m", model.range_noise_m, 0, kFar_m);
  if (table.has("range_noise_m")) model.ring_noise_m.clear();  // inherited through like
  model.range_resolution_m =
      table.number("range_resolution_m", model.range_resolution_m, 0, kFar_m);
  if (table.has("angular_noise_deg"))
    model.angular_noise_rad = radians(table.number("angular_noise_deg", 0, 0, 90));
  if (table.has("max_returns"))
    model.max_returns = static_cast<int>(table.whole_number("max_returns", 1, 255));
}

/// "'fwhm', '1/e2', ...": the values of divergence_kind.
std::string divergence_kind_list() {
  std::string all;
  for (const std::string& word : list_of<DivergenceKind>(kDivergenceKinds))
    all += (all.empty() ? "'" : ", '") + word + "'";
  return all;
}

DivergenceKind read_divergence_kind(const TomlTable& table) {
  if (!table.has("divergence_kind"))
    throw table.error("divergence_deg",
                      "needs divergence_kind, the kind of angle: " + divergence_kind_list());
  const std::string word = table.text("divergence_kind", "");
  for (const auto& [known, kind] : kDivergenceKinds)
    if (known == word) return kind;
  throw table.error("divergence_kind",
                    "is '" + word + "', expected one of " + divergence_kind_list());
}

void read_divergence(const TomlTable& table, LidarModel& model) {
  if (!table.has("divergence_deg")) {
    if (table.has("divergence_kind"))
      throw table.error("divergence_kind", "needs divergence_deg, the angles that it describes");
    return;
  }
  const auto stated_rad = table.angles_rad("divergence_deg", 0, 90);
  if (stated_rad.size() != 2) throw table.error("divergence_deg", "is not [horizontal, vertical]");
  model.divergence_kind = read_divergence_kind(table);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    model.divergence_rad[axis] = full_e2_angle_rad(stated_rad[axis], model.divergence_kind);
    if (model.divergence_rad[axis] > radians(90))
      throw table.error("divergence_deg", "is wider than 90 degrees at 1/e2");
  }
}

/// Rejects keys of rotating beams for a rosette or a list of rays.
void reject_beam_keys(const TomlTable& table, const LidarModel& model) {
  for (const char* key :
       {"azimuth_offsets_deg", "beam_origins_m", "firing_times_us", "column_steps", "column_phases",
        "columns", "first_azimuth_deg", "clockwise", "range_offsets_m", "ring_noise_m", "packets",
        "laser_ids", "intensity", "fields", "drop", "body"})
    if (table.has(key))
      throw table.error(key, "does not fit a sensor that is a rosette or a list of rays");
  for (const Firing& firing : model.free_pattern)
    if (model.pattern_s == 0 && static_cast<double>(firing.time_s) * model.rotation_hz > 1.0 + 1e-6)
      throw table.error("rotation_hz", "ends a scan before the last ray, which fires at " +
                                           std::to_string(firing.time_s) + " s");
}

/// The sensor under the key `like`: a name of the library, or a file in the folder of `path`.
LidarFile read_base(const TomlTable& table, const std::filesystem::path& path, int nesting) {
  if (!table.has("like")) return {};
  constexpr int kMaxNesting = 8;
  if (nesting >= kMaxNesting) throw table.error("like", "leads through more than 8 files");
  const std::string base = table.text("like", "");
  if (base.empty()) throw table.error("like", "is neither a sensor nor a file");
  if (auto library = read_library_lidar(base)) return std::move(*library);
  const std::filesystem::path file = path.parent_path() / base;
  std::error_code ignored;  // of names that are too long for a file
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw table.error("like", "is '" + base +
                                  "', which is neither a sensor nor a file next to this one" +
                                  did_you_mean(base, lidar_model_names()));
  }
  return read_lidar(file.string(), nesting + 1);
}

}  // namespace

LidarFile read_lidar_toml(std::string_view text, const std::filesystem::path& path, int nesting) {
  const TomlTable table = parse_toml(text, path, sensor_keys(), "sensor");
  LidarFile file = read_base(table, path, nesting);
  LidarModel& model = file.model;
  model.name = table.text("name", path.stem().string());
  model.source =
      table.text("source", model.source.empty() ? path.filename().string() : model.source);
  model.rotation_hz = table.number("rotation_hz", model.rotation_hz, 1e-3, 1e6);
  read_measuring(table, model);
  read_divergence(table, model);
  if (table.has("rosette")) read_rosette(table, file);
  const bool new_beams = table.has("elevations_deg") || has_fan(table);
  if (!new_beams && (model.rosette || !model.free_pattern.empty())) {
    reject_beam_keys(table, model);
  } else {
    read_beams(table, file);
    read_turning(table, model);
  }
  return file;
}

}  // namespace adasplats
