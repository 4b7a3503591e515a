// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/levels/level_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/json_rows.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little,
              "tables are written in the byte order of the machine");

constexpr const char* kFormat = "adasplats levels";
constexpr int kLevelsVersion = 1;
/// The header line is searched in chunks of doubling size, up to kMaxLine (400 bytes per part).
constexpr std::size_t kFirstChunk = 4096;
constexpr std::size_t kMaxLine = std::size_t{1} << 30;

Error damaged(const fs::path& path, const std::string& what) {
  return {ErrorKind::data, path.string() + ": damaged levels of detail: " + what};
}

std::size_t elements_of(const LevelTable& table) {
  const std::vector<bool> own = table.own_nodes();
  std::size_t sum = 0;
  for (std::size_t n = 0; n < table.nodes.size(); ++n)
    if (own[n]) sum += table.nodes[n].count;
  return sum;
}

Json json_of(const LevelPart& part) {
  return {{"file", part.file},      {"root", part.root},   {"first", part.first},
          {"nodes", part.nodes},    {"bytes", part.bytes}, {"sha256", part.sha256},
          {"made_of", part.made_of}};
}

LevelPart part_of(const Json& json) {
  return {json.at("file"),  json.at("root"),   json.at("first"),  json.at("nodes"),
          json.at("bytes"), json.at("sha256"), json.at("made_of")};
}

/// The first line of the file without its end.
std::string first_line(InputFile& file) {
  std::size_t bytes = kFirstChunk;
  for (;;) {
    bytes = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, file.remaining()));
    const auto chunk = file.peek(bytes);
    const std::string_view text(reinterpret_cast<const char*>(chunk.data()), chunk.size());
    if (const std::size_t end = text.find('\n'); end != std::string_view::npos) {
      std::string line(text.substr(0, end));
      file.skip(end + 1);
      return line;
    }
    // Stop early if this is not our header.
    if (!text.starts_with("{\"format\":\"adasplats") || bytes == file.remaining() ||
        bytes > kMaxLine)
      throw Error(ErrorKind::data, file.path().string() + ": not a file of levels of detail");
    bytes *= 2;
  }
}

void check_version(const Json& json, const InputFile& file) {
  if (json.at("format") != kFormat)
    throw Error(ErrorKind::data, file.path().string() + ": not a file of levels of detail");
  if (json.at("version") != kLevelsVersion)
    throw Error(ErrorKind::data, file.path().string() + ": levels of detail of version " +
                                     json.at("version").dump() + "; this program reads version " +
                                     std::to_string(kLevelsVersion));
}

/// The header without the parts, which are appended to `parts`: a city has 100,000 of them.
Json parsed_head(InputFile& file, std::vector<LevelPart>& parts) {
  const std::string line = first_line(file);
  try {
    Json json =
        parse_json_rows(line, "parts", [&](const Json& part) { parts.push_back(part_of(part)); });
    check_version(json, file);
    return json;
  } catch (const Json::exception&) {
    // Another version may have other parts.
    check_version(Json::parse(line), file);
    throw;
  }
}

LevelFacts facts_of(const Json& json, const fs::path& path) {
  LevelFacts facts;
  facts.splats = json.at("splats");
  facts.has_classes = json.at("has_classes");
  facts.has_intensities = json.at("has_intensities");
  facts.intensity_range = {json.at("intensity_range").at(0), json.at("intensity_range").at(1)};
  const auto [low, high] = facts.intensity_range;
  if (!std::isfinite(low) || !std::isfinite(high) || !(low < high))
    throw damaged(path, "an invalid range of intensities");
  return facts;
}

bool is_sound(const LevelNode& node) {
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(node.low[axis]) || !std::isfinite(node.high[axis]) ||
        node.low[axis] > node.high[axis])
      return false;
  return std::isfinite(node.spacing_m) && node.spacing_m >= 0 &&
         std::isfinite(node.largest_radius_m) && node.largest_radius_m >= 0;
}

/// Checks the tree: every node except the first is the child of an earlier one.
void check_tree(const LevelTable& table, const fs::path& path) {
  const std::vector<LevelNode>& nodes = table.nodes;
  std::vector<bool> has_parent(nodes.size(), false);
  std::size_t splats = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const LevelNode& node = nodes[n];
    const std::string name = "node " + std::to_string(n);
    if (!is_sound(node)) throw damaged(path, name + " has an invalid box");
    if (node.child_count == 0) splats += node.count;
    const std::size_t end = std::size_t{node.first_child} + node.child_count;
    if (node.child_count > 8 || end > nodes.size() ||
        (node.child_count > 0 && node.first_child <= n))
      throw damaged(path, name + " has invalid children");
    for (std::size_t child = node.first_child; node.child_count > 0 && child < end; ++child) {
      if (has_parent[child] || nodes[child].level != node.level + 1)
        throw damaged(path, name + " has a child that belongs to another node or level");
      has_parent[child] = true;
    }
  }
  if (std::count(has_parent.begin(), has_parent.end(), false) != 1)
    throw damaged(path, "some nodes have no parent");
  if (splats != table.facts.splats)
    throw damaged(path, std::to_string(splats) + " splats in the leaves; the header has " +
                            std::to_string(table.facts.splats));
}

/// Checks that the nodes of parts exist and that no two parts overlap.
void check_parts(const LevelTable& table, const fs::path& path) {
  std::vector<bool> seen(table.nodes.size(), false);
  const auto add = [&](std::size_t node) {
    if (node >= seen.size() || seen[node]) throw damaged(path, "invalid parts");
    seen[node] = true;
  };
  for (const LevelPart& part : table.parts) {
    if (part.nodes == 0 || part.nodes > seen.size() || part.first > seen.size())
      throw damaged(path, "invalid parts");
    add(part.root);
    for (std::size_t k = 1; k < part.nodes; ++k) add(part.first + k - 1);
  }
}

LevelTable table_of(InputFile& file) {
  LevelTable table;
  const Json json = parsed_head(file, table.parts);
  table.facts = facts_of(json, file.path());
  const std::uint64_t nodes = json.at("nodes");
  if (nodes == 0 || nodes > file.remaining() / sizeof(LevelNode) ||
      nodes > std::numeric_limits<std::uint32_t>::max())
    throw damaged(file.path(), std::to_string(nodes) + " nodes in " +
                                   std::to_string(file.remaining()) + " bytes");
  table.nodes.resize(nodes);
  for (LevelNode& node : table.nodes) {
    std::memcpy(&node, file.peek(sizeof(LevelNode)).data(), sizeof(LevelNode));
    file.skip(sizeof(LevelNode));
  }
  table.elements_at = file.offset();
  check_tree(table, file.path());
  check_parts(table, file.path());
  const std::size_t expected = elements_of(table) * sizeof(LevelElement);
  if (file.remaining() != expected)
    throw damaged(file.path(), std::to_string(file.remaining()) + " bytes of elements, expected " +
                                   std::to_string(expected));
  return table;
}

}  // namespace

std::vector<bool> LevelTable::own_nodes() const {
  std::vector<bool> own(nodes.size(), true);
  for (const LevelPart& part : parts) {
    own.at(part.root) = false;
    for (std::size_t k = 1; k < part.nodes; ++k) own.at(part.first + k - 1) = false;
  }
  return own;
}

std::string level_head(const LevelTable& table) {
  Json json = {
      {"format", kFormat},
      {"version", kLevelsVersion},
      {"splats", table.facts.splats},
      {"has_classes", table.facts.has_classes},
      {"has_intensities", table.facts.has_intensities},
      {"intensity_range", {table.facts.intensity_range.low, table.facts.intensity_range.high}},
      {"nodes", table.nodes.size()},
      {"parts", Json::array()}};
  for (const LevelPart& part : table.parts) json["parts"].push_back(json_of(part));
  std::string bytes = json.dump() + "\n";
  const std::size_t line = bytes.size();
  bytes.resize(line + table.nodes.size() * sizeof(LevelNode));
  std::memcpy(bytes.data() + line, table.nodes.data(), table.nodes.size() * sizeof(LevelNode));
  return bytes;
}

void write_levels(const fs::path& path, const LevelTable& table,
                  std::span<const LevelElement> elements) {
  if (elements.size() != elements_of(table))
    throw std::logic_error("levels of detail: the elements do not fit the nodes");
  std::string bytes = level_head(table);
  const std::size_t head = bytes.size();
  bytes.resize(head + elements.size_bytes());
  if (!elements.empty()) std::memcpy(bytes.data() + head, elements.data(), elements.size_bytes());
  write_file_in_place(path, bytes);
}

void write_levels(const fs::path& path, const LevelTree& tree, const LevelFacts& facts) {
  LevelTable table;
  table.facts = facts;
  table.nodes.assign(tree.nodes().begin(), tree.nodes().end());
  write_levels(path, table, tree.elements());
}

LevelTable read_levels(const fs::path& path) {
  InputFile file(path);
  try {
    return table_of(file);
  } catch (const Json::exception& error) {
    throw damaged(path, error.what());
  }
}

std::string read_level_elements(const fs::path& path, std::uint64_t bytes, std::uint64_t offset,
                                std::size_t count) {
  const InputDescriptor file(path);
  if (file.size_bytes() != bytes)
    throw damaged(path,
                  std::to_string(file.size_bytes()) + " bytes, expected " + std::to_string(bytes));
  std::string elements(count * sizeof(LevelElement), '\0');
  file.read_at(offset, std::as_writable_bytes(std::span(elements)));
  return elements;
}

}  // namespace adasplats
