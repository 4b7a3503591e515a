// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/toml_table.h"

#include <algorithm>
#include <locale>
#include <sstream>

#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/toml_nodes.h"

namespace adasplats {

namespace {

std::string place_of(const std::filesystem::path& path, const toml::source_region& at) {
  return path.string() + ":" + std::to_string(at.begin.line);
}

Error config_error(const std::filesystem::path& path, const toml::source_region& at,
                   const std::string& message) {
  return {ErrorKind::config, place_of(path, at) + ": " + message};
}

}  // namespace

std::string toml_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f)
      quoted += std::string("\\u00") + kDigits[byte / 16] + kDigits[byte % 16];
    else
      (c == '"' || c == '\\' ? quoted += '\\' : quoted) += c;
  }
  return quoted + '"';
}

TomlTable parse_toml(std::string_view text, const std::filesystem::path& path,
                     const TomlKeys& known, const char* kind) {
  // toml++ limits the depth of brackets but not of dotted keys, and frees nested tables by
  // recursion. No valid file has this many numbers, let alone keys.
  constexpr std::ptrdiff_t kMaxDots = 8192;
  if (std::ranges::count(text, '.') > kMaxDots)
    throw Error(ErrorKind::config, path.string() + ": more than " + std::to_string(kMaxDots) +
                                       " dots: too large for a " + kind);
  try {
    return {std::make_shared<const toml::table>(toml::parse(text)), path, known};
  } catch (const toml::parse_error& error) {
    throw config_error(path, error.source(), std::string(error.description()));
  }
}

TomlTable::TomlTable(std::shared_ptr<const toml::table> table, const std::filesystem::path& path,
                     const TomlKeys& known)
    : path_(path), table_(std::move(table)) {
  for (const auto& [key, value] : *table_) {
    const std::string name(key.str());
    if (std::ranges::find(known, name) != known.end()) continue;
    const auto nearest = nearest_word(name, known);
    throw config_error(
        path_, key.source(),
        "unknown key '" + name + "'" + (nearest ? ", did you mean '" + *nearest + "'?" : ""));
  }
}

const toml::node* TomlTable::find(std::string_view key) const { return table_->get(key); }

void TomlTable::require(std::string_view key) const {
  if (!has(key)) throw error(key, "is missing");
}

Error TomlTable::error(std::string_view key, const std::string& message) const {
  const std::string text = std::string(key) + " " + message;
  if (const toml::node* node = find(key)) return error_at(*node, text);
  return {ErrorKind::config, path_.string() + ": " + text};
}

Error TomlTable::error_at(const toml::node& node, const std::string& message) const {
  return config_error(path_, node.source(), message);
}

std::string TomlTable::place(std::string_view key) const {
  return place_of(path_, find(key)->source());
}

TomlTable TomlTable::table(std::string_view key, const TomlKeys& known) const {
  const toml::table* inner = find(key)->as_table();
  if (inner == nullptr) throw error(key, "is not a table");
  return {std::shared_ptr<const toml::table>(table_, inner), path_, known};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key, const TomlKeys& known) const {
  require(key);
  if (!find(key)->is_array_of_tables())
    throw error(key, "is not a list of tables, each headed [[" + std::string(key) + "]]");
  std::vector<TomlTable> tables;
  for (const toml::node& each : *find(key)->as_array())
    tables.push_back({std::shared_ptr<const toml::table>(table_, each.as_table()), path_, known});
  return tables;
}

std::optional<TomlTable> TomlTable::first_table(std::string_view key) const {
  const toml::node* const list = find(key);
  if (list == nullptr || !list->is_array_of_tables()) return std::nullopt;
  const toml::table* const first = list->as_array()->get(0)->as_table();
  TomlKeys keys;
  for (const auto& [name, value] : *first) keys.emplace_back(name.str());
  return TomlTable({table_, first}, path_, keys);
}

double TomlTable::number(std::string_view key, double otherwise, double low, double high) const {
  const toml::node* node = find(key);
  return node == nullptr ? otherwise : number_of(*node, key, low, high);
}

std::int64_t TomlTable::whole_number(std::string_view key, std::int64_t low,
                                     std::int64_t high) const {
  require(key);
  return whole_number_of(*find(key), key, low, high);
}

bool TomlTable::flag(std::string_view key, bool otherwise) const {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  if (!node->is_boolean()) throw error(key, "is neither true nor false");
  return node->value_or(otherwise);
}

std::string TomlTable::text(std::string_view key, const std::string& otherwise) const {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  if (!node->is_string()) throw error(key, "is not a string");
  return node->value_or(otherwise);
}

std::vector<double> TomlTable::numbers(std::string_view key, double low, double high) const {
  std::vector<double> numbers;
  for (const toml::node* element : elements(key))
    numbers.push_back(number_of(*element, key, low, high));
  return numbers;
}

std::vector<double> TomlTable::angles_rad(std::string_view key, double low_deg,
                                          double high_deg) const {
  std::vector<double> angles = numbers(key, low_deg, high_deg);
  for (double& angle : angles) angle = radians(angle);
  return angles;
}

std::vector<std::uint32_t> TomlTable::whole_numbers(std::string_view key, std::int64_t low) const {
  std::vector<std::uint32_t> numbers;
  for (const toml::node* element : elements(key))
    numbers.push_back(static_cast<std::uint32_t>(whole_number_of(*element, key, low, kMaxColumns)));
  return numbers;
}

std::vector<double> TomlTable::number_rows(std::string_view key, double low, double high,
                                           std::size_t& columns) const {
  std::vector<double> values;
  for (const toml::node* row : elements(key)) {
    const toml::array* list = row->as_array();
    if (list == nullptr || list->empty())
      throw error_at(*row, std::string(key) + " is not a list of lists of numbers");
    if (columns == 0) columns = list->size();
    if (list->size() != columns)
      throw error_at(*row, std::string(key) + " has a list of " + std::to_string(list->size()) +
                               " numbers, expected " + std::to_string(columns));
    for (const toml::node& number : *list) values.push_back(number_of(number, key, low, high));
  }
  return values;
}

std::vector<float> TomlTable::rows(std::string_view key, double low, double high,
                                   std::size_t& columns) const {
  std::vector<float> values;
  for (const double value : number_rows(key, low, high, columns))
    values.push_back(static_cast<float>(value));
  return values;
}

std::vector<Vec3d> TomlTable::points(std::string_view key, std::size_t count) const {
  const std::vector<const toml::node*> rows = elements(key);
  if (rows.empty()) return {};
  if (rows.front()->is_number()) return std::vector<Vec3d>(count, point_of(rows, key));
  std::vector<Vec3d> points;
  for (const toml::node* row : rows) {
    if (!row->is_array()) throw error_at(*row, std::string(key) + " is not a list [x, y, z]");
    std::vector<const toml::node*> numbers;
    for (const toml::node& number : *row->as_array()) numbers.push_back(&number);
    points.push_back(point_of(numbers, key));
  }
  return points;
}

std::vector<const toml::node*> TomlTable::elements(std::string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  if (!node->is_array() || node->as_array()->empty()) throw error(key, "is not a list of numbers");
  std::vector<const toml::node*> elements;
  for (const toml::node& element : *node->as_array()) elements.push_back(&element);
  return elements;
}

Vec3d TomlTable::point_of(const std::vector<const toml::node*>& row, std::string_view key) const {
  if (row.size() != 3) throw error(key, "has a point that is not [x, y, z]");
  Vec3d point;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] = number_of(*row[static_cast<std::size_t>(axis)], key, -kFar_m, kFar_m);
  return point;
}

std::int64_t TomlTable::whole_number_of(const toml::node& node, std::string_view key,
                                        std::int64_t low, std::int64_t high) const {
  const auto value = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
  if (!value || *value < low || *value > high)
    throw error_at(node, std::string(key) + " is not a whole number from " + std::to_string(low) +
                             " to " + std::to_string(high));
  return *value;
}

double TomlTable::number_of(const toml::node& node, std::string_view key, double low,
                            double high) const {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value || !(*value >= low && *value <= high)) {
    std::ostringstream message;
    message.imbue(std::locale::classic());
    message << key << " is not a number from " << low << " to " << high;
    throw error_at(node, message.str());
  }
  return *value;
}

}  // namespace adasplats
