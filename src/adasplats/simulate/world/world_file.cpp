// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/world_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <limits>
#include <locale>
#include <numbers>
#include <sstream>
#include <string_view>
#include <utility>

#include "adasplats/cloud/poses/openscenario.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

using KeyNames = std::vector<std::string>;

constexpr double kFarthest_m = 1e9;
constexpr double kMaxScale = 1e6;
constexpr double kMaxAngle_deg = 360;

Error line_error(const std::filesystem::path& path, std::uint64_t line, const std::string& message,
                 ErrorKind kind = ErrorKind::config) {
  return Error(kind, path.string() + ":" + std::to_string(line) + ": " + message);
}

std::string suggestion(const std::string& word, const KeyNames& known) {
  const std::optional<std::string> nearest = nearest_word(word, known);
  return nearest ? ", did you mean '" + *nearest + "'?" : std::string();
}

/// One table of the file; every error has the line of what is wrong.
class WorldTable {
 public:
  WorldTable(const std::filesystem::path& path, const toml::table& table, const KeyNames& known)
      : path_(path), table_(table) {
    for (const auto& [key, value] : table) {
      const std::string word(key.str());
      if (std::ranges::find(known, word) == known.end())
        throw line_error(path_, key.source().begin.line,
                         "unknown key '" + word + "'" + suggestion(word, known));
    }
  }

  std::uint64_t line() const { return table_.source().begin.line; }
  const toml::node* find(std::string_view key) const { return table_.get(key); }

  Error error(std::string_view key, const std::string& message,
              ErrorKind kind = ErrorKind::config) const {
    const toml::node* const node = find(key);
    return line_error(path_, node == nullptr ? line() : node->source().begin.line,
                      std::string(key) + " " + message, kind);
  }

  std::string text(std::string_view key) const {
    const toml::node* const node = find(key);
    if (node == nullptr) return {};
    const auto value = node->value_exact<std::string>();
    if (!value || value->empty()) throw error(key, "is not a text in quotes");
    return *value;
  }

  double number(std::string_view key, double otherwise, double low, double high) const {
    const toml::node* const node = find(key);
    return node == nullptr ? otherwise : number_of(*node, key, low, high);
  }

  Vec3d point(std::string_view key) const {
    const toml::node* const node = find(key);
    if (node == nullptr) return {};
    const toml::array* const values = node->as_array();
    if (values == nullptr || values->size() != 3)
      throw error(key, "is not a list of three numbers, [x, y, z] in metres");
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] =
          number_of((*values)[static_cast<std::size_t>(axis)], key, -kFarthest_m, kFarthest_m);
    return p;
  }

  /// Two ascending times, where the key is a list.
  std::optional<std::array<double, 2>> times(std::string_view key) const {
    const toml::node* const node = find(key);
    const toml::array* const values = node == nullptr ? nullptr : node->as_array();
    if (values == nullptr) return std::nullopt;
    if (values->size() != 2) throw error(key, "is not a list of two times, [begin, end] in s");
    constexpr double kLatest_s = 1e10;
    const std::array<double, 2> times = {number_of((*values)[0], key, -kLatest_s, kLatest_s),
                                         number_of((*values)[1], key, -kLatest_s, kLatest_s)};
    if (times[0] >= times[1]) throw error(key, "ends before it begins");
    return times;
  }

  std::optional<std::uint64_t> whole_number(std::string_view key, std::int64_t high) const {
    const toml::node* const node = find(key);
    if (node == nullptr) return std::nullopt;
    const auto value = node->value_exact<std::int64_t>();
    if (!value || *value < 0 || *value > high)
      throw error(key, "is not a whole number from 0 to " + std::to_string(high));
    return static_cast<std::uint64_t>(*value);
  }

  /// A file that is there, relative to this one; empty where the key is not.
  std::filesystem::path file(std::string_view key) const {
    const std::string name = text(key);
    if (name.empty()) return {};
    std::filesystem::path file = (path_.parent_path() / name).lexically_normal();
    std::error_code ignored;
    const std::optional<ScenarioPath> scenario = scenario_path(file);
    if (!std::filesystem::exists(scenario ? scenario->file : file, ignored))
      throw error(key, "is " + file.string() + ", which does not exist", ErrorKind::no_input);
    return file;
  }

 private:
  double number_of(const toml::node& node, std::string_view key, double low, double high) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (value && *value >= low && *value <= high) return *value;
    std::ostringstream message;
    message.imbue(std::locale::classic());
    message << "is not a number from " << low << " to " << high;
    throw error(key, message.str());
  }

  const std::filesystem::path& path_;
  const toml::table& table_;
};

/// The parser recurses over dotted keys without a limit of its own (over brackets it has one).
void refuse_deep_keys(const std::filesystem::path& path, std::string_view text) {
  constexpr int kMaxDots = 64;
  std::uint64_t line = 1;
  int dots = 0;
  for (const char c : text) {
    if (c == '.' && ++dots > kMaxDots)
      throw line_error(path, line, "more than " + std::to_string(kMaxDots) + " dots in a line");
    if (c != '\n') continue;
    ++line;
    dots = 0;
  }
}

toml::table parse(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  refuse_deep_keys(path, text);
  try {
    return toml::parse(std::string_view(text));
  } catch (const toml::parse_error& problem) {
    throw line_error(path, problem.source().begin.line, std::string(problem.description()));
  }
}

RigidTransform read_placement(const WorldTable& table) {
  const auto angle_rad = [&](const char* key) {
    return table.number(key, 0, -kMaxAngle_deg, kMaxAngle_deg) * std::numbers::pi / 180;
  };
  return {rotation_from_yaw_pitch_roll(angle_rad("yaw_deg"), angle_rad("pitch_deg"),
                                       angle_rad("roll_deg")),
          table.point("position")};
}

std::optional<std::variant<std::uint16_t, std::string>> read_class(const WorldTable& table) {
  const toml::node* const node = table.find("class");
  if (node == nullptr) return std::nullopt;
  if (node->is_string()) return table.text("class");
  if (!node->is_integer()) throw table.error("class", "is neither a name in quotes nor a number");
  return static_cast<std::uint16_t>(*table.whole_number("class", 0xffff));
}

bool read_only_during(const WorldTable& table) {
  static const KeyNames choices = {"always", "during"};
  const toml::node* const node = table.find("present");
  if (node != nullptr && node->is_array()) return true;
  const std::string word = table.text("present");
  if (word.empty() || word == "always") return false;
  if (word == "during") return true;
  const std::string nearest = suggestion(word, choices);
  throw table.error(
      "present",
      "is '" + word + "'" +
          (nearest.empty() ? ", expected 'always', 'during' or two times, [begin, end]" : nearest));
}

WorldFileObject read_object(const WorldTable& table, std::size_t number) {
  WorldFileObject object;
  object.line = table.line();
  object.geometry = table.file("geometry");
  if (object.geometry.empty()) throw table.error("geometry", "is missing: an object needs a file");
  object.name = table.text("name");
  if (object.name.empty()) object.name = object.geometry.filename().string();
  object.class_id = read_class(table);
  const std::optional<std::uint64_t> instance = table.whole_number("instance", 0xffff);
  if (!instance && number > 0xffff)
    throw table.error("instance", "is missing: it is the object's number, but this is object " +
                                      std::to_string(number) + " and instances end at 65535");
  object.instance = static_cast<std::uint16_t>(instance.value_or(number));
  object.placement = read_placement(table);
  object.trajectory = table.file("trajectory");
  object.only_during = read_only_during(table);
  object.only_between_s = table.times("present");
  if (object.only_during && object.trajectory.empty())
    throw table.error("present", "needs a trajectory, unless it is 'always'");
  for (const char* const key : {"delay_s", "speed_factor"})
    if (table.find(key) != nullptr && object.trajectory.empty())
      throw table.error(key, "needs a trajectory");
  object.delay_s = table.number("delay_s", 0, -kFarthest_m, kFarthest_m);
  object.speed_factor = table.number("speed_factor", 1, 0.01, 100);
  object.only_scan = table.whole_number("scan", std::numeric_limits<std::int64_t>::max());
  object.scale = table.number("scale", 1, 1 / kMaxScale, kMaxScale);
  return object;
}

}  // namespace

WorldFile read_world_file(const std::filesystem::path& path) {
  static const KeyNames file_keys = {"model", "object"};
  static const KeyNames object_keys = {
      "geometry", "class", "instance", "position",   "yaw_deg", "pitch_deg", "roll_deg",
      "scale",    "name",  "present",  "trajectory", "scan",    "delay_s",   "speed_factor"};
  const toml::table content = parse(path);
  const WorldTable table(path, content, file_keys);
  WorldFile file;
  file.path = path;
  file.model = table.file("model");
  const toml::node* const objects = table.find("object");
  if (objects == nullptr) return file;
  if (!objects->is_array_of_tables())
    throw table.error("object", "is not a list of tables, each headed [[object]]");
  for (const toml::node& object : *objects->as_array())
    file.objects.push_back(
        read_object(WorldTable(path, *object.as_table(), object_keys), file.objects.size() + 1));
  return file;
}

}  // namespace adasplats
