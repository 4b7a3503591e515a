// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A sensor as a TOML table.

// toml++ 3 asserts what broken files do not hold ("a = [}") before it says what is wrong with them.
#define TOML_ASSERT(expression) static_cast<void>(0)
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

#include "adasplats/core/error.h"
#include "adasplats/core/words.h"
#include "adasplats/io/base/base64.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/ray_drop_toml.h"

namespace adasplats {

namespace {

constexpr double kMicrosecond_s = 1e-6;

using Keys = std::vector<std::string>;

const Keys& sensor_keys() {
  static const Keys keys = {"name",
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
                            "most_returns",
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

const Keys& rosette_keys() {
  static const Keys keys = {"prism_turns_per_minute", "deflection_deg", "points_per_s",
                            "laser_tilts_deg"};
  return keys;
}

const Keys& intensity_keys() {
  static const Keys keys = {"step",   "highest",    "ring_expected", "ring_level",
                            "levels", "zero_share", "reported"};
  return keys;
}

const Keys& body_keys() {
  static const Keys keys = {"cells"};
  return keys;
}

const Keys& field_keys() {
  static const Keys keys = {"turns", "columns", "bytes"};
  return keys;
}

Error config_error(const std::filesystem::path& path, std::uint64_t line,
                   const std::string& message) {
  return Error(ErrorKind::config, path.string() + ":" + std::to_string(line) + ": " + message);
}

toml::table parse_table(std::string_view text, const std::filesystem::path& path) {
  // toml++ bounds the depth of brackets but not of dotted keys, and frees nested tables by
  // recursion. No sensor has this many numbers, let alone keys.
  constexpr std::ptrdiff_t kMaxDots = 8192;
  if (std::ranges::count(text, '.') > kMaxDots)
    throw Error(ErrorKind::config, path.string() + ": more than " + std::to_string(kMaxDots) +
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
  SensorTable(toml::table table, const std::filesystem::path& path, const Keys& known)
      : SensorTable(std::make_shared<const toml::table>(std::move(table)), path, known) {}

  /// Copies of a table do not know their lines.
  SensorTable(std::shared_ptr<const toml::table> table, const std::filesystem::path& path,
              const Keys& known)
      : path_(path), table_(std::move(table)) {
    for (const auto& [key, value] : *table_) {
      const std::string name(key.str());
      if (std::ranges::find(known, name) != known.end()) continue;
      const auto nearest = nearest_word(name, known);
      throw error_at(key.source(), "unknown key '" + name + "'" +
                                       (nearest ? ", did you mean '" + *nearest + "'?" : ""));
    }
  }

  bool has(std::string_view key) const { return table_->contains(key); }

  Error error(std::string_view key, const std::string& message) const {
    const toml::node* node = table_->get(key);
    if (node == nullptr)
      return Error(ErrorKind::config, path_.string() + ": " + std::string(key) + " " + message);
    return error_at(node->source(), std::string(key) + " " + message);
  }

  /// The table under a key, which is there.
  SensorTable table(std::string_view key, const Keys& known) const {
    return {std::shared_ptr<const toml::table>(table_, &raw_table(key)), path_, known};
  }

  /// The same, for who reads it himself.
  const toml::table& raw_table(std::string_view key) const {
    const toml::table* inner = table_->get(key)->as_table();
    if (inner == nullptr) throw error(key, "is not a table");
    return *inner;
  }
  const std::filesystem::path& path() const { return path_; }

  double number(std::string_view key, double otherwise, double low, double high) const {
    const toml::node* node = table_->get(key);
    return node == nullptr ? otherwise : number_of(*node, key, low, high);
  }

  std::int64_t whole_number(std::string_view key, std::int64_t low, std::int64_t high) const {
    const toml::node* node = table_->get(key);
    if (node == nullptr) throw error(key, "is missing");
    return whole_number_of(*node, key, low, high);
  }

  bool flag(std::string_view key, bool otherwise) const {
    const toml::node* node = table_->get(key);
    if (node == nullptr) return otherwise;
    if (!node->is_boolean()) throw error(key, "is neither true nor false");
    return node->value_or(otherwise);
  }

  std::string text(std::string_view key, const std::string& otherwise) const {
    const toml::node* node = table_->get(key);
    if (node == nullptr) return otherwise;
    if (!node->is_string()) throw error(key, "is not a string");
    return node->value_or(otherwise);
  }

  /// Empty where the key is not there.
  std::vector<double> numbers(std::string_view key, double low, double high) const {
    std::vector<double> numbers;
    for (const toml::node* element : elements(key))
      numbers.push_back(number_of(*element, key, low, high));
    return numbers;
  }

  std::vector<double> angles_rad(std::string_view key, double low_deg, double high_deg) const {
    std::vector<double> angles = numbers(key, low_deg, high_deg);
    for (double& angle : angles) angle = radians(angle);
    return angles;
  }

  std::vector<std::uint32_t> whole_numbers(std::string_view key, std::int64_t low) const {
    std::vector<std::uint32_t> numbers;
    for (const toml::node* element : elements(key))
      numbers.push_back(
          static_cast<std::uint32_t>(whole_number_of(*element, key, low, kMaxColumns)));
    return numbers;
  }

  /// Lists of equally many numbers, one behind the other; `columns`: how many, 0: as the first has.
  std::vector<float> rows(std::string_view key, double low, double high,
                          std::size_t& columns) const {
    std::vector<float> values;
    for (const toml::node* row : elements(key)) {
      const toml::array* list = row->as_array();
      if (list == nullptr || list->empty())
        throw error_at(row->source(), std::string(key) + " is not a list of lists of numbers");
      if (columns == 0) columns = list->size();
      if (list->size() != columns)
        throw error_at(row->source(), std::string(key) + " has a list of " +
                                          std::to_string(list->size()) + " numbers, expected " +
                                          std::to_string(columns));
      for (const toml::node& number : *list)
        values.push_back(static_cast<float>(number_of(number, key, low, high)));
    }
    return values;
  }

  /// Points, or one that stands for all of `count`.
  std::vector<Vec3d> points(std::string_view key, std::size_t count) const {
    const std::vector<const toml::node*> rows = elements(key);
    if (rows.empty()) return {};
    if (rows.front()->is_number()) return std::vector<Vec3d>(count, point_of(rows, key));
    std::vector<Vec3d> points;
    for (const toml::node* row : rows) {
      if (!row->is_array())
        throw error_at(row->source(), std::string(key) + " is not a list [x, y, z]");
      std::vector<const toml::node*> numbers;
      for (const toml::node& number : *row->as_array()) numbers.push_back(&number);
      points.push_back(point_of(numbers, key));
    }
    return points;
  }

 private:
  /// Of a list, which may not be empty.
  std::vector<const toml::node*> elements(std::string_view key) const {
    const toml::node* node = table_->get(key);
    if (node == nullptr) return {};
    if (!node->is_array() || node->as_array()->empty())
      throw error(key, "is not a list of numbers");
    std::vector<const toml::node*> elements;
    for (const toml::node& element : *node->as_array()) elements.push_back(&element);
    return elements;
  }

  Vec3d point_of(const std::vector<const toml::node*>& row, std::string_view key) const {
    if (row.size() != 3) throw error(key, "has a point that is not [x, y, z]");
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] = number_of(*row[static_cast<std::size_t>(axis)], key, -kFar_m, kFar_m);
    return point;
  }

  Error error_at(const toml::source_region& place, const std::string& message) const {
    return config_error(path_, place.begin.line, message);
  }

  std::int64_t whole_number_of(const toml::node& node, std::string_view key, std::int64_t low,
                               std::int64_t high) const {
    const auto value = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
    if (!value || *value < low || *value > high)
      throw error_at(node.source(), std::string(key) + " is not a whole number from " +
                                        std::to_string(low) + " to " + std::to_string(high));
    return *value;
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
  std::shared_ptr<const toml::table> table_;
};

bool has_fan(const SensorTable& table) {
  return table.has("beams") || table.has("elevation_top_deg") || table.has("elevation_bottom_deg");
}

/// `beams` from top to bottom, or the list.
std::vector<double> read_elevations_rad(const SensorTable& table) {
  if (table.has("elevations_deg")) {
    if (has_fan(table))
      throw table.error("elevations_deg", "cannot stand together with beams and elevation_*_deg");
    return table.angles_rad("elevations_deg", -90, 90);
  }
  if (!has_fan(table))
    throw table.error("elevations_deg", "is missing (or beams and elevation_*_deg, or like)");
  for (const char* key : {"beams", "elevation_top_deg", "elevation_bottom_deg"})
    if (!table.has(key)) throw table.error(key, "is missing");
  const auto beams = static_cast<int>(table.whole_number("beams", 1, kMaxBeams));
  return even_fan_rad(beams, table.number("elevation_top_deg", 0, -90, 90),
                      table.number("elevation_bottom_deg", 0, -90, 90));
}

/// Replaces `values` where the key is there.
template <class T>
void read_one_a_beam(const SensorTable& table, std::string_view key, std::size_t beams,
                     std::vector<T> read, std::vector<T>& values) {
  if (!table.has(key)) return;
  if (read.size() != beams)
    throw table.error(key, "has " + std::to_string(read.size()) + " values, expected " +
                               std::to_string(beams) + ", one a beam");
  values = std::move(read);
}

constexpr double kBright = 1e9;  // no unit of intensities goes so far

void require_ascending(const SensorTable& table, const char* key, std::span<const float> values,
                       std::size_t columns) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (i % columns != 0 && !(values[i] > values[i - 1]))
      throw table.error(key, "is not ascending");
}

std::vector<float> floats_of(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

UnitIntensity read_intensity(const SensorTable& sensor, std::size_t rings) {
  const SensorTable table = sensor.table("intensity", intensity_keys());
  for (const char* key : {"highest", "levels", "zero_share", "reported"})
    if (!table.has(key)) throw table.error(key, "is missing");
  UnitIntensity unit;
  unit.step = table.number("step", 0, 0, kBright);
  unit.highest = table.number("highest", 0, 0, kBright);
  if (table.has("ring_expected") != table.has("ring_level"))
    throw table.error("ring_expected", "and ring_level stand together");
  unit.ring_expected = table.rows("ring_expected", -kBright, kBright, unit.ring_nodes);
  unit.ring_level = table.rows("ring_level", -kBright, kBright, unit.ring_nodes);
  if (unit.ring_nodes > 0) {
    require_ascending(table, "ring_expected", unit.ring_expected, unit.ring_nodes);
    for (const std::size_t values : {unit.ring_expected.size(), unit.ring_level.size()})
      if (values != rings * unit.ring_nodes)
        throw table.error("ring_level",
                          "and ring_expected need one list a ring, of " + std::to_string(rings));
  }
  unit.levels = floats_of(table.numbers("levels", -kBright, kBright));
  require_ascending(table, "levels", unit.levels, unit.levels.size());
  unit.zero_share = floats_of(table.numbers("zero_share", 0, 1));
  std::size_t nodes = kTextureNodes;
  unit.reported = table.rows("reported", 0, kBright, nodes);
  if (unit.zero_share.size() != unit.levels.size() ||
      unit.reported.size() != unit.levels.size() * kTextureNodes)
    throw table.error("levels", "needs as many values in zero_share and lists in reported");
  return unit;
}

UnitFields read_fields(const SensorTable& sensor, std::size_t rings) {
  constexpr std::int64_t kMaxTurns = 64, kMaxFieldColumns = 1 << 16;
  const SensorTable table = sensor.table("fields", field_keys());
  UnitFields fields;
  fields.rings = static_cast<std::uint32_t>(rings);
  fields.turns = static_cast<std::uint32_t>(table.whole_number("turns", 1, kMaxTurns));
  fields.columns = static_cast<std::uint32_t>(table.whole_number("columns", 1, kMaxFieldColumns));
  const std::optional<std::string> bytes = from_base64(table.text("bytes", ""));
  if (!bytes) throw table.error("bytes", "is not base64");
  const std::size_t expected = std::size_t{fields.turns} * rings * fields.columns * kUnitFields;
  if (bytes->size() != expected)
    throw table.error("bytes", "has " + std::to_string(bytes->size()) + " bytes, expected " +
                                   std::to_string(expected) + ", four of every beam");
  fields.bytes.assign(bytes->begin(), bytes->end());
  return fields;
}

VehicleBody read_body(const SensorTable& sensor, std::size_t rings) {
  constexpr std::size_t kMaxCells = 65534;  // cells are numbered by 16 bits
  constexpr double kFarthest_mm = 1e5;
  const SensorTable table = sensor.table("body", body_keys());
  std::size_t columns = 5;
  const std::vector<float> rows = table.rows("cells", -1e9, kBright, columns);
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
                                     " that is not [ring, azimuth of half degrees, percent, "
                                     "range in mm, intensity]");
    body.cells.push_back({static_cast<std::uint16_t>(ring), static_cast<std::uint16_t>(column),
                          static_cast<float>(share), static_cast<float>(range_mm / 1000),
                          rows[i + 4]});
  }
  const auto by_place = [](const BodyCell& cell) { return std::pair(cell.ring, cell.column); };
  std::ranges::sort(body.cells, {}, by_place);
  if (std::ranges::adjacent_find(body.cells, {}, by_place) != body.cells.end())
    throw table.error("cells", "has two rows of one ring and azimuth");
  if (body.cells.size() > kMaxCells) throw table.error("cells", "has more than 65534 rows");
  return body;
}

/// A word for the format, and each number below `beams` once.
void read_packets(const SensorTable& table, std::size_t beams, LidarModel& model) {
  if (table.has("packets")) {
    const std::string word = table.text("packets", "");
    const std::vector<std::string> words = list_of<PacketFormat>(kPacketFormats);
    if (std::ranges::find(words, word) == words.end())
      throw table.error("packets", "are of no known format: " + unknown_word("it", word, words));
    if (!model.packets) model.packets.emplace();
    model.packets->format = value_of(word, kPacketFormats);
  }
  if (!table.has("laser_ids")) return;
  if (!model.packets) throw table.error("laser_ids", "needs packets, their format");
  std::vector<std::uint32_t> ids = table.whole_numbers("laser_ids", 0);
  std::vector<std::uint32_t> sorted = ids;
  std::ranges::sort(sorted);
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (sorted[i] != i) throw table.error("laser_ids", "has not each number from 0 on once");
  read_one_a_beam(table, "laser_ids", beams, std::move(ids), model.packets->laser_ids);
}

void read_beams(const SensorTable& table, LidarFile& file) {
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
  if (table.has("drop")) model.drop = ray_drop_of_table(table.raw_table("drop"), table.path());
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

void read_turning(const SensorTable& table, LidarModel& model) {
  if (table.has("columns") || model.columns == 0)
    model.columns = static_cast<std::uint32_t>(table.whole_number("columns", 1, kMaxColumns));
  if (table.has("first_azimuth_deg"))
    model.first_azimuth_rad = radians(table.number("first_azimuth_deg", 0, -360, 360));
  model.clockwise = table.flag("clockwise", model.clockwise);
  if (const auto fault = column_fault(model))
    throw table.error(table.has("columns") ? "columns" : "rotation_hz", *fault);
}

void read_rosette(const SensorTable& sensor, LidarFile& file) {
  for (const char* key : {"columns", "beams", "elevations_deg"})
    if (sensor.has(key)) throw sensor.error(key, "cannot stand together with a rosette");
  const SensorTable table = sensor.table("rosette", rosette_keys());
  file.clear_pattern();
  RosettePattern rosette;
  for (const char* key : {"prism_turns_per_minute", "deflection_deg", "points_per_s"})
    if (!table.has(key)) throw table.error(key, "is missing");
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

void read_measuring(const SensorTable& table, LidarModel& model) {
  model.min_range_m = table.number("min_range_m", model.min_range_m, 0, kFar_m);
  model.max_range_m = table.number("max_range_m", model.max_range_m, 0, kFar_m);
  if (!(model.max_range_m > model.min_range_m))
    throw table.error(table.has("max_range_m") ? "max_range_m" : "min_range_m",
                      "leaves no range between min_range_m and max_range_m");
  model.range_noise_m = table.number("range_noise_m", model.range_noise_m, 0, kFar_m);
  if (table.has("range_noise_m")) model.ring_noise_m.clear();  // of what it is like
  model.range_resolution_m =
      table.number("range_resolution_m", model.range_resolution_m, 0, kFar_m);
  if (table.has("angular_noise_deg"))
    model.angular_noise_rad = radians(table.number("angular_noise_deg", 0, 0, 90));
  if (table.has("most_returns"))
    model.max_returns = static_cast<int>(table.whole_number("most_returns", 1, 255));
}

/// "'fwhm', '1/e2', ...": what divergence_kind may say.
std::string kinds_of_divergence() {
  std::string all;
  for (const std::string& word : list_of<DivergenceKind>(kDivergenceKinds))
    all += (all.empty() ? "'" : ", '") + word + "'";
  return all;
}

DivergenceKind read_divergence_kind(const SensorTable& table) {
  if (!table.has("divergence_kind"))
    throw table.error("divergence_deg",
                      "needs divergence_kind, what the angles measure: " + kinds_of_divergence());
  const std::string word = table.text("divergence_kind", "");
  for (const auto& [known, kind] : kDivergenceKinds)
    if (known == word) return kind;
  throw table.error("divergence_kind",
                    "is '" + word + "', expected one of " + kinds_of_divergence());
}

/// The one place where files' divergences become those of the model.
void read_divergence(const SensorTable& table, LidarModel& model) {
  if (!table.has("divergence_deg")) {
    if (table.has("divergence_kind"))
      throw table.error("divergence_kind", "needs divergence_deg, the angles that it speaks of");
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

/// A rosette or a list of rays has no beams that turn.
void check_untouched(const SensorTable& table, const LidarModel& model) {
  for (const char* key :
       {"azimuth_offsets_deg", "beam_origins_m", "firing_times_us", "column_steps", "column_phases",
        "columns", "first_azimuth_deg", "clockwise", "range_offsets_m", "ring_noise_m", "packets",
        "laser_ids", "intensity", "fields", "drop", "body"})
    if (table.has(key))
      throw table.error(key, "does not fit a sensor that is a rosette or a list of rays");
  for (const Firing& firing : model.free_pattern)
    if (static_cast<double>(firing.time_s) * model.rotation_hz > 1.0 + 1e-6)
      throw table.error("rotation_hz", "ends a scan before the last ray, which fires at " +
                                           std::to_string(firing.time_s) + " s");
}

/// What the table says that it is like: a name of the library, or a file, looked for beside `path`.
LidarFile read_base(const SensorTable& table, const std::filesystem::path& path, int nesting) {
  if (!table.has("like")) return {};
  constexpr int kMaxNesting = 8;
  if (nesting >= kMaxNesting) throw table.error("like", "leads through more than 8 files");
  const std::string base = table.text("like", "");
  if (base.empty()) throw table.error("like", "is neither a sensor nor a file");
  if (auto known = read_library_lidar(base)) return std::move(*known);
  const std::filesystem::path beside = path.parent_path() / base;
  std::error_code ignored;  // a name that is too long is no file's, either
  if (!std::filesystem::is_regular_file(beside, ignored)) {
    throw table.error("like", "is '" + base +
                                  "', which is neither a sensor nor a file beside this" +
                                  did_you_mean(base, lidar_model_names()));
  }
  return read_lidar(beside.string(), nesting + 1);
}

}  // namespace

LidarFile read_lidar_toml(std::string_view text, const std::filesystem::path& path, int nesting) {
  const SensorTable table(parse_table(text, path), path, sensor_keys());
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
    check_untouched(table, model);
  } else {
    read_beams(table, file);
    read_turning(table, model);
  }
  return file;
}

}  // namespace adasplats
