// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/city/city_levels.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/sha256.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Maximum number of intensities that survey_levels() samples.
constexpr std::size_t kSurveyedSplats = 8'000'000;

Error wrong_tiles_error(const fs::path& folder) {
  return {ErrorKind::data, (folder / kTopLevelsFile).string() +
                               ": the levels of detail belong to other tiles than those of " +
                               kCityFile};
}

}  // namespace

std::string levels_file_of(TileKey tile) { return "levels/" + name_of(tile) + ".levels"; }

LevelFacts survey_levels(const fs::path& folder, const CityManifest& city) {
  const std::size_t every = 1 + city.splats() / kSurveyedSplats;
  LevelFacts facts;
  facts.splats = city.splats();
  std::vector<float> intensities;
  std::size_t number = 0;
  for (std::size_t k = 0; k < city.tiles.size(); ++k) {
    if (city.tiles[k].splats == 0) continue;
    const SplatModel model = load_city_tile(folder, city, k);
    facts.has_classes =
        facts.has_classes || std::ranges::any_of(model.classes, [](auto id) { return id != 0; });
    for (const float intensity : model.intensities)
      if (number++ % every == 0) intensities.push_back(intensity);
  }
  facts.has_intensities =
      std::ranges::any_of(intensities, [&](float value) { return value != intensities.front(); });
  facts.intensity_range = range_of_intensities(intensities);
  return facts;
}

void write_tile_levels(const fs::path& folder, const CityManifest& city, std::size_t k,
                       const LevelFacts& facts, const Executor& executor) {
  const SplatModel model = load_city_tile(folder, city, k);
  const LevelInput input{.disks = model.disks,
                         .positions = {},
                         .classes = model.classes,
                         .intensities = model.intensities,
                         .errors_m = {}};
  const LevelTree tree(input, {.intensity_range = facts.intensity_range}, executor);
  LevelFacts own = facts;
  own.splats = model.size();
  write_levels(folder / levels_file_of(city.tiles[k].key), tree, own);
}

bool has_levels(const fs::path& folder) {
  std::error_code none;
  return fs::exists(folder / kTopLevelsFile, none);
}

CityLevels::CityLevels(const fs::path& folder, const CityManifest& city)
    : CityLevels(folder, city, read_levels(folder / kTopLevelsFile)) {}

CityLevels::CityLevels(fs::path folder, const CityManifest& city, LevelTable table)
    : folder_(std::move(folder)), table_(std::move(table)) {
  check_parts(city);
  find_elements();
}

void CityLevels::check_parts(const CityManifest& city) const {
  auto part = table_.parts.begin();
  for (const CityTile& tile : city.tiles) {
    if (tile.splats == 0) continue;
    if (part == table_.parts.end() || part->file != levels_file_of(tile.key) ||
        part->made_of != tile.sha256)
      throw wrong_tiles_error(folder_);
    ++part;
  }
  if (part != table_.parts.end() || table_.facts.splats != city.splats())
    throw wrong_tiles_error(folder_);
}

void CityLevels::find_elements() {
  const std::vector<LevelNode>& nodes = table_.nodes;
  const auto here = static_cast<std::uint32_t>(table_.parts.size());
  elements_.assign(nodes.size(), {here, 0});
  for (std::uint32_t p = 0; p < table_.parts.size(); ++p) {
    const LevelPart& part = table_.parts[p];
    const auto node_of = [&](std::size_t k) { return k == 0 ? part.root : part.first + k - 1; };
    std::uint64_t bytes = 0;
    for (std::size_t k = 0; k < part.nodes; ++k)
      bytes += nodes[node_of(k)].count * sizeof(LevelElement);
    if (bytes > part.bytes) throw wrong_tiles_error(folder_);
    // Elements are at the end of a file.
    std::uint64_t offset = part.bytes - bytes;
    for (std::size_t k = 0; k < part.nodes; ++k) {
      elements_[node_of(k)] = {p, offset};
      offset += nodes[node_of(k)].count * sizeof(LevelElement);
    }
  }
  top_bytes_ = table_.elements_at;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (elements_[n].part != here) continue;
    elements_[n].offset = top_bytes_;
    top_bytes_ += nodes[n].count * sizeof(LevelElement);
  }
}

std::string CityLevels::node_bytes(std::size_t n) const {
  const auto [part, offset] = elements_.at(n);
  const std::size_t count = table_.nodes[n].count;
  if (part == table_.parts.size())
    return read_level_elements(folder_ / kTopLevelsFile, top_bytes_, offset, count);
  const LevelPart& tile = table_.parts[part];
  return read_level_elements(folder_ / tile.file, tile.bytes, offset, count);
}

std::vector<Vec3f> CityLevels::samples(std::size_t count) const {
  std::vector<std::size_t> splats(table_.parts.size(), 0);
  for (std::size_t n = 0; n < table_.nodes.size(); ++n)
    if (elements_[n].part < splats.size() && table_.nodes[n].child_count == 0)
      splats[elements_[n].part] += table_.nodes[n].count;
  if (splats.empty()) return {};
  const auto fullest = std::ranges::max_element(splats);
  const std::size_t every = 1 + *fullest / count;
  std::vector<Vec3f> positions;
  std::size_t number = 0;
  for (std::size_t n = 0; n < table_.nodes.size(); ++n) {
    const LevelNode& node = table_.nodes[n];
    if (elements_[n].part != static_cast<std::size_t>(fullest - splats.begin()) ||
        node.child_count > 0)
      continue;
    const std::string bytes = node_bytes(n);
    std::vector<LevelElement> elements(node.count);
    if (!elements.empty()) std::memcpy(elements.data(), bytes.data(), bytes.size());
    LevelSplats there;
    add_splats(node, elements, table_.facts.intensity_range, there);
    for (const Disk& disk : there.disks)
      if (number++ % every == 0) positions.push_back(disk.center);
  }
  return positions;
}

void CityLevels::verify() const {
  for (const LevelPart& part : table_.parts)
    if (sha256_of_file(folder_ / part.file) != part.sha256)
      throw Error(ErrorKind::data,
                  (folder_ / part.file).string() +
                      ": the file has changed since it was written (its SHA-256 differs)");
}

}  // namespace adasplats
