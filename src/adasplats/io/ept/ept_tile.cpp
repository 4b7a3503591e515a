// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/ept/ept_tile.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/io/bags/unpack.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/ept/octree_records.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using EptJson = nlohmann::json;

fs::path facts_of_tile(const fs::path& tile) {
  return fs::absolute(tile).parent_path().parent_path() / "ept.json";
}

std::optional<ColumnType> ept_type(std::string_view type, std::int64_t size) {
  using Type = ColumnType;
  const std::int64_t key = size * 10 + (type == "signed" ? 0 : type == "unsigned" ? 1 : 2);
  const bool is_known =
      type == "signed" || type == "unsigned" || type == "float" || type == "floating";
  if (!is_known) return std::nullopt;
  switch (key) {
    case 10: return Type::i8;
    case 11: return Type::u8;
    case 20: return Type::i16;
    case 21: return Type::u16;
    case 40: return Type::i32;
    case 41: return Type::u32;
    case 42: return Type::f32;
    case 80: return Type::i64;
    case 81: return Type::u64;
    case 82: return Type::f64;
    default: return std::nullopt;
  }
}

double number_in(const fs::path& file, const EptJson& entry, const char* key, double otherwise) {
  const auto found = entry.find(key);
  if (found == entry.end()) return otherwise;
  if (found->is_number() && std::isfinite(found->get<double>())) return found->get<double>();
  throw Error(ErrorKind::data, file.string() + ": schema: '" + key + "' is not a number");
}

RecordSchema read_ept_schema(const fs::path& file) {
  const EptJson facts = read_json_object(file);
  const auto fault = [&file](const std::string& what) {
    return Error(ErrorKind::data, file.string() + ": schema: " + what);
  };
  const auto entries = facts.find("schema");
  if (entries == facts.end() || !entries->is_array() || entries->empty())
    throw fault("expected an array of dimensions");
  RecordSchema schema{file};
  for (const EptJson& entry : *entries) {
    if (!entry.is_object()) throw fault("expected objects with name, type and size");
    const std::string name = entry.value("name", EptJson()).is_string()
                                 ? entry.at("name").get<std::string>()
                                 : std::string();
    const EptJson type = entry.value("type", EptJson()), size = entry.value("size", EptJson());
    std::optional<ColumnType> known;
    if (type.is_string() && size.is_number_unsigned() && size.get<std::uint64_t>() <= 8)
      known = ept_type(type.get<std::string>(), size.get<std::int64_t>());
    if (name.empty() || !known)
      throw fault("dimension " + shown(name) + " has type " + type.dump() + " and size " +
                  size.dump() + ", expected signed, unsigned or float and 1, 2, 4 or 8");
    const bool is_coordinate = name == "X" || name == "Y" || name == "Z";
    schema.add(is_coordinate ? lower_case(name) : name, *known, number_in(file, entry, "scale", 1),
               number_in(file, entry, "offset", 0));
  }
  return schema;
}

std::string records_of_tile(const fs::path& tile) {
  std::string bytes = read_file(tile);
  if (tile.extension() != ".zst") return bytes;
  std::string records;  // writers do not state its size
  std::string_view rest = bytes;
  const auto next = [&rest](std::size_t done) {
    rest.remove_prefix(done);
    return rest;
  };
  const auto take = [&](std::string_view part) {
    if (part.size() > kMaxChunkBytes - records.size())
      throw Error(ErrorKind::data, tile.string() + ": decompresses to more than 1 GiB");
    records += part;
  };
  unpack_zstd_stream(next, take, tile.string());
  return records;
}

}  // namespace

bool is_ept_tile(const fs::path& path) {
  const fs::path extension = path.extension();
  if (extension != ".bin" && extension != ".zst") return false;
  std::error_code ignored;
  const fs::path folder = fs::absolute(path, ignored).parent_path();
  return folder.filename() == "ept-data" &&
         fs::is_regular_file(folder.parent_path() / "ept.json", ignored);
}

Table read_ept_tile(const fs::path& path) {
  Table table = table_of_records(path, records_of_tile(path), read_ept_schema(facts_of_tile(path)));
  table.crs = read_ept_crs(path);
  return table;
}

std::uint64_t ept_tile_points(const fs::path& path) {
  const RecordSchema schema = read_ept_schema(facts_of_tile(path));
  if (path.extension() == ".zst") return schema.records_in(path, records_of_tile(path).size());
  return schema.records_in(path, fs::file_size(path));
}

std::optional<std::uint64_t> ept_stated_points(const fs::path& folder) {
  std::optional<std::uint64_t> points;
  for (const fs::path& file : list_folder_if_any(folder / "ept-hierarchy")) {
    if (file.extension() != ".json") continue;
    // -1: the counts below are in another file.
    for (const EptJson& count : read_json_object(file))
      if (count.is_number_unsigned()) points = points.value_or(0) + count.get<std::uint64_t>();
  }
  if (points) return points;
  const EptJson stated = read_json_object(folder / "ept.json").value("points", EptJson());
  if (stated.is_number_unsigned()) return stated.get<std::uint64_t>();
  return std::nullopt;
}

Crs read_ept_crs(const fs::path& path) {
  const EptJson facts = read_json_object(facts_of_tile(path));
  const auto srs = facts.find("srs");
  if (srs == facts.end() || !srs->is_object()) return {};
  const EptJson wkt = srs->value("wkt", EptJson());
  // Some writers store the text of PROJ here.
  if (!wkt.is_string() || wkt.get<std::string>().find('[') == std::string::npos) return {};
  return crs_of_wkt(wkt.get<std::string>());
}

}  // namespace adasplats
