// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/tileset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

using TileJson = nlohmann::json;

TileJson json_file(const std::filesystem::path& path) { return TileJson::parse(read_file(path)); }

/// A sheet of disks in the square of a part, 100 m wide.
ColoredDisks sheet(TileKey key, std::size_t count) {
  ColoredDisks made;
  Random random(7, static_cast<std::uint64_t>(key.x + 100),
                static_cast<std::uint64_t>(key.y + 100));
  for (std::size_t i = 0; i < count; ++i) {
    const float x = static_cast<float>(random.uniform(0, 100) + 100 * key.x);
    const float y = static_cast<float>(random.uniform(0, 100) + 100 * key.y);
    made.disks.push_back({{x, y, std::sin(x / 10)}, 0.2F, {0, 0, 1}});
    made.colors.push_back({static_cast<std::uint8_t>(i % 256), 7, 9});
  }
  return made;
}

/// What a walk over all tiles finds.
struct Walk {
  std::size_t leaf_splats = 0, tiles = 0, most_splats = 0;
};

void walk(const std::filesystem::path& folder, const TileJson& tile, const TileJson* parent,
          Walk& found) {
  const auto box = tile["boundingVolume"]["box"].get<std::vector<double>>();
  if (parent != nullptr) {
    EXPECT_LE(tile["geometricError"], (*parent)["geometricError"]);
    const auto outer = (*parent)["boundingVolume"]["box"].get<std::vector<double>>();
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_LE(std::fabs(box[axis] - outer[axis]) + box[3 + 4 * axis], outer[3 + 4 * axis] + 1e-9);
  }
  const std::string uri = tile["content"]["uri"];
  if (uri.ends_with(".json")) {
    const TileJson inner = json_file(folder / uri);
    EXPECT_EQ(inner["root"]["boundingVolume"], tile["boundingVolume"]);
    return walk((folder / uri).parent_path(), inner["root"], parent, found);
  }
  ++found.tiles;
  const std::string glb = read_file(folder / uri);
  const std::size_t at = glb.find("\"count\":") + 8;
  const auto splats = static_cast<std::size_t>(std::stoul(glb.substr(at, 9)));
  found.most_splats = std::max(found.most_splats, splats);
  if (!tile.contains("children")) {
    found.leaf_splats += splats;
    EXPECT_EQ(tile["geometricError"], 0);
    return;
  }
  EXPECT_GT(tile["geometricError"], 0);
  for (const TileJson& child : tile["children"]) walk(folder, child, &tile, found);
}

Walk walked(const std::filesystem::path& folder) {
  const TileJson tileset = json_file(folder / "tileset.json");
  EXPECT_EQ(tileset["asset"]["version"], "1.1");
  EXPECT_GE(tileset["geometricError"], tileset["root"]["geometricError"]);
  Walk found;
  walk(folder, tileset["root"], nullptr, found);
  return found;
}

TEST(Tileset, TilesOfAModelContainTheirChildren) {
  const TemporaryFolder folder;
  OwnSession own;
  const TilesetParts parts{{}, {}, {{0, 0}}};
  const std::string place = write_tileset(
      folder.path(), parts,
      [](std::size_t) {
        return sheet({0, 0}, 300'000);
      },
      own);
  EXPECT_EQ(
      place,
      "not georeferenced: the model has no coordinate system; placed at latitude 0, longitude 0");
  const Walk found = walked(folder.path());
  EXPECT_EQ(found.leaf_splats, 300'000U);
  EXPECT_GT(found.tiles, 4U);
  EXPECT_LE(found.most_splats, 65'536U);
}

TEST(Tileset, SmallestModel) {
  const TemporaryFolder folder;
  OwnSession own;
  const TilesetParts parts{{}, {}, {{0, 0}}};
  write_tileset(
      folder.path(), parts,
      [](std::size_t) {
        return sheet({0, 0}, 1);
      },
      own);
  const Walk found = walked(folder.path());
  EXPECT_EQ(found.leaf_splats, 1U);
  EXPECT_EQ(found.tiles, 1U);
  // A disk of 0.2 m with a vertical normal.
  const TileJson box = json_file(folder.path() / "tileset.json")["root"]["boundingVolume"]["box"];
  EXPECT_NEAR(box[3], 0.2, 1e-6);
  EXPECT_NEAR(box[11], 0, 1e-6);
}

TEST(Tileset, TilesOfACityHaveTilesAbove) {
  const std::vector<TileKey> keys = {{-3, 2}, {-2, 2}, {-2, 3}, {0, 0}, {4, 0}};
  std::map<std::string, std::string> bytes;
  for (const int threads : {1, 3}) {
    const TemporaryFolder folder;
    OwnSession own({}, threads);
    const TilesetParts parts{{}, {}, keys};
    std::vector<std::size_t> loaded;
    write_tileset(
        folder.path(), parts,
        [&](std::size_t k) {
          loaded.push_back(k);
          return sheet(keys[k], 1000 * (k + 1));
        },
        own);
    std::ranges::sort(loaded);
    EXPECT_EQ(loaded, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
    const Walk found = walked(folder.path());
    EXPECT_EQ(found.leaf_splats, 15'000U);
    EXPECT_GE(found.tiles, 7U);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
      if (!entry.is_regular_file()) continue;
      const std::string name = entry.path().lexically_relative(folder.path()).string();
      const std::string content = read_file(entry.path());
      EXPECT_EQ(bytes.try_emplace(name, content).first->second, content) << name;
    }
  }
}

TEST(Tileset, PlaceOfUtm) {
  const TemporaryFolder folder;
  OwnSession own;
  // proj4js 2: 49.021249770362 N 8.384502721974 E, 100 m.
  const TilesetParts parts{
      {455000.25 - 50, 5430000.5 - 50, 100}, crs_of_wkt("EPSG:32632"), {{0, 0}}};
  const auto corner = [](std::size_t) {
    ColoredDisks disks;
    for (const float at : {0.0F, 100.0F}) {
      disks.disks.push_back({{at, at, 0}, 0.1F, {0, 0, 1}});
      disks.colors.push_back({1, 2, 3});
    }
    return disks;
  };
  const std::string place = write_tileset(folder.path(), parts, corner, own);
  EXPECT_NE(place.find("latitude 49.02125, longitude 8.384503"), std::string::npos) << place;
  const auto m =
      json_file(folder.path() / "tileset.json")["root"]["transform"].get<std::vector<double>>();
  const double expected[] = {4145925.529762425, 611071.2273776407, 4792184.301347313};
  for (std::size_t row = 0; row < 3; ++row)
    EXPECT_NEAR(50 * m[row] + 50 * m[4 + row] + m[12 + row], expected[row], 1e-3);
}

TEST(Tileset, SystemsThatAreNotKnown) {
  OwnSession own;
  for (const auto& [system, x, words] :
       {std::tuple{"EPSG:2263", 0.0, "not georeferenced: EPSG:2263 is neither"},
        std::tuple{"EPSG:32632", 9e6,
                   "not georeferenced: the coordinates are outside EPSG:32632"}}) {
    const TemporaryFolder folder;
    const TilesetParts parts{{x, 5e6, 0}, crs_of_wkt(system), {{0, 0}}};
    const std::string place = write_tileset(
        folder.path(), parts,
        [](std::size_t) {
          return sheet({0, 0}, 3);
        },
        own);
    EXPECT_EQ(place.find(words), 0U) << place;
  }
}

}  // namespace
}  // namespace adasplats
