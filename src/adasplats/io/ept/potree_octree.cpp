// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/ept/potree_octree.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/ept/octree_records.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using PotreeJson = nlohmann::json;

constexpr std::array<std::pair<std::string_view, ColumnType>, 10> kPotreeTypes = {
    {{"int8", ColumnType::i8},
     {"uint8", ColumnType::u8},
     {"int16", ColumnType::i16},
     {"uint16", ColumnType::u16},
     {"int32", ColumnType::i32},
     {"uint32", ColumnType::u32},
     {"int64", ColumnType::i64},
     {"uint64", ColumnType::u64},
     {"float", ColumnType::f32},
     {"double", ColumnType::f64}}};

Error potree_fault(const fs::path& file, const std::string& what) {
  return {ErrorKind::data, file.string() + ": " + what};
}

std::string text_in(const PotreeJson& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Number `index` of an array.
double number_at(const fs::path& file, const PotreeJson& object, const char* key, std::size_t index,
                 double otherwise) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  if (found->is_array() && index < found->size() && (*found)[index].is_number() &&
      std::isfinite((*found)[index].get<double>()))
    return (*found)[index].get<double>();
  throw potree_fault(file, "'" + std::string(key) + "' has no number " + std::to_string(index));
}

std::string name_of_element(const std::string& name, std::size_t index, std::size_t count) {
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"}, kColours = {"red", "green", "blue"};
  if (name == "position" && index < 3) return kAxes[index];
  if (name == "rgb" && index < 3) return kColours[index];
  return count == 1 ? name : name + "_" + std::to_string(index);
}

void add_attribute(const PotreeJson& facts, const PotreeJson& attribute, RecordSchema& schema) {
  const fs::path& file = schema.file;
  constexpr std::uint64_t kMaxElements = 64;
  std::string name, type;
  std::uint64_t count = 0;
  if (attribute.is_object()) {
    name = text_in(attribute, "name");
    type = text_in(attribute, "type");
    const PotreeJson elements = attribute.value("numElements", PotreeJson());
    if (elements.is_number_unsigned()) count = elements.get<std::uint64_t>();
  }
  std::optional<ColumnType> known;
  for (const auto& [word, column_type] : kPotreeTypes)
    if (word == type) known = column_type;
  if (name.empty() || !known || count == 0 || count > kMaxElements)
    throw potree_fault(file, "attribute " + shown(name) + " has type " + shown(type) + " and " +
                                 std::to_string(count) +
                                 " elements, expected int8 to uint64, float or double");
  const bool is_position = name == "position";
  for (std::size_t k = 0; k < count; ++k)
    schema.add(name_of_element(name, k, count), *known,
               is_position ? number_at(file, facts, "scale", k, 1) : 1,
               is_position ? number_at(file, facts, "offset", k, 0) : 0);
}

RecordSchema schema_of_potree(const fs::path& file, const PotreeJson& facts) {
  const std::string encoding = text_in(facts, "encoding");
  if (lower_case(encoding) != "default" && lower_case(encoding) != "uncompressed")
    throw potree_fault(file, "is a Potree 2 octree with encoding " + shown(encoding) +
                                 ", only DEFAULT is read; give the LAS or LAZ files that it was "
                                 "made from, or convert it to LAS or LAZ");
  const auto attributes = facts.find("attributes");
  if (attributes == facts.end() || !attributes->is_array() || attributes->empty())
    throw potree_fault(file, "has no attributes");
  RecordSchema schema{file};
  for (const PotreeJson& attribute : *attributes) add_attribute(facts, attribute, schema);
  return schema;
}

}  // namespace

bool is_potree_octree(const fs::path& path) {
  std::error_code ignored;
  return path.filename() == "octree.bin" &&
         fs::is_regular_file(fs::absolute(path, ignored).parent_path() / "metadata.json", ignored);
}

Table read_potree_octree(const fs::path& path) {
  const fs::path file = fs::absolute(path).parent_path() / "metadata.json";
  const PotreeJson facts = read_json_object(file);
  const RecordSchema schema = schema_of_potree(file, facts);
  Table table = table_of_records(path, read_file(path), schema);
  const PotreeJson points = facts.value("points", PotreeJson());
  if (!points.is_number_unsigned() || points.get<std::uint64_t>() != table.rows)
    throw potree_fault(path, "holds " + std::to_string(table.rows) +
                                 " points, but metadata.json states " + points.dump() +
                                 "; copy the complete octree.bin");
  table.crs = read_potree_crs(path);
  return table;
}

Crs read_potree_crs(const fs::path& path) {
  const PotreeJson facts = read_json_object(fs::absolute(path).parent_path() / "metadata.json");
  const std::string projection = text_in(facts, "projection");  // usually the text of PROJ
  return projection.find('[') == std::string::npos ? Crs() : crs_of_wkt(projection);
}

}  // namespace adasplats
