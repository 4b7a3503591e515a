// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/city/tile_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <set>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats::streams {
namespace {

constexpr std::size_t kTiles = 40;
constexpr double kSide_m = 50;
constexpr std::size_t kBytesASplat = 1000;
constexpr std::size_t kSplats = 100;  // per tile

/// A row of tiles along x.
CityManifest write_row(const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder / "tiles");
  CityManifest city;
  city.grid = {kSide_m};
  city.origin = {5000, 0, 0};
  for (std::size_t k = 0; k < kTiles; ++k) {
    SplatModel tile;
    tile.origin = city.origin;
    const double x = kSide_m * static_cast<double>(k);
    for (std::size_t i = 0; i < kSplats; ++i)
      tile.disks.push_back(
          {vec_cast<float>(Vec3d{x + 0.5 * static_cast<double>(i), 25, 0}), 0.1F, {0, 0, 1}});
    const TileKey key = {static_cast<std::int32_t>(100 + k), 0};
    save_model(folder / model_file_of(key), tile);
    city.tiles.push_back({key, 1, 0, "", {}, {}});
    set_splats(tile, city.tiles.back());
  }
  return city;
}

/// Records its calls and checks their arguments.
class CheckingHolder final : public TileHolder {
 public:
  std::size_t bytes_per_splat() const override { return kBytesASplat; }
  void load(std::size_t tile, SplatModel&& model, const Executor&) override {
    const std::lock_guard lock(mutex_);
    EXPECT_TRUE(loaded.insert(tile).second);
    EXPECT_EQ(model.size(), kSplats);
    EXPECT_FLOAT_EQ(model.disks[0].center.x, 50.0F * static_cast<float>(tile));
    max_loaded = std::max(max_loaded, loaded.size());
  }
  void drop(std::size_t tile) override {
    const std::lock_guard lock(mutex_);
    EXPECT_EQ(loaded.erase(tile), 1U);
    EXPECT_FALSE(std::ranges::binary_search(shown, tile));
  }
  void show(std::span<const std::size_t> tiles) override {
    const std::lock_guard lock(mutex_);
    EXPECT_TRUE(std::ranges::is_sorted(tiles));
    shown.assign(tiles.begin(), tiles.end());
    for (const std::size_t tile : shown) EXPECT_TRUE(loaded.contains(tile));
  }

  std::set<std::size_t> loaded;
  std::vector<std::size_t> shown;
  std::size_t max_loaded = 0;

 private:
  std::mutex mutex_;
};

/// Back and forth, one scan per metre.
std::vector<SeenFrom> drive() {
  std::vector<SeenFrom> scans;
  for (int turn = 0; turn < 2; ++turn) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3d at = {5000 + static_cast<double>(turn == 0 ? i : 1999 - i), 25, 2};
      scans.push_back({at, at, 70});
    }
  }
  return scans;
}

/// Drives through the row; returns the number of prefetch() calls.
std::size_t drive_through(TileStream& stream, const CityManifest& city, CheckingHolder& holder) {
  const std::vector<SeenFrom> scans = drive();
  std::size_t spans = 0;
  for (std::size_t first = 0; first < scans.size(); ++spans) {
    const std::size_t ready = stream.prefetch(std::span(scans).subspan(first));
    EXPECT_GT(ready, 0U);
    for (std::size_t i = first; i < first + ready; ++i)
      for (std::size_t tile = 0; tile < kTiles; ++tile) {
        const bool is_shown = std::ranges::binary_search(holder.shown, tile);
        EXPECT_TRUE(is_shown || !scans[i].reaches(city.tiles[tile])) << i << " " << tile;
      }
    first += ready;
  }
  return spans;
}

TEST(TileStream, ShowsTilesInRangeWithinItsBudget) {
  const TemporaryFolder folder;
  const CityManifest city = write_row(folder.path());
  CheckingHolder holder;
  TileStream stream(folder.path(), city, holder, 9 * kSplats * kBytesASplat, 2);
  EXPECT_EQ(stream.prefetch({}), 0U);
  const std::size_t spans = drive_through(stream, city, holder);
  EXPECT_LT(spans, 200U);  // for 4,000 scans
  EXPECT_LE(holder.max_loaded, 9U);
  EXPECT_LE(stream.counts().max_bytes, 9 * kSplats * kBytesASplat);
  // Each tile is loaded once per direction, except those near the turn and those still in memory.
  EXPECT_GE(stream.counts().loaded, kTiles);
  EXPECT_LE(stream.counts().loaded, 2 * kTiles);
}

TEST(TileStream, KeepsAllTilesThatFit) {
  const TemporaryFolder folder;
  const CityManifest city = write_row(folder.path());
  CheckingHolder holder;
  TileStream stream(folder.path(), city, holder, kTiles * kSplats * kBytesASplat, 1);
  drive_through(stream, city, holder);
  EXPECT_EQ(stream.counts().loaded, kTiles);
}

TEST(TileStream, TilesOfOneScanLoadWhateverTheBudget) {
  const TemporaryFolder folder;
  const CityManifest city = write_row(folder.path());
  CheckingHolder holder;
  TileStream stream(folder.path(), city, holder, 1, 1);
  drive_through(stream, city, holder);
  EXPECT_LE(holder.max_loaded, 5U);
}

TEST(TileStream, ReportsATileThatCannotBeLoaded) {
  const TemporaryFolder folder;
  const CityManifest city = write_row(folder.path());
  const std::filesystem::path file = folder.path() / model_file_of(city.tiles[10].key);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 5);
  CheckingHolder holder;
  TileStream stream(folder.path(), city, holder, 9 * kSplats * kBytesASplat, 1);
  try {
    drive_through(stream, city, holder);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data);
    EXPECT_NE(std::string(error.what()).find(file.filename().string()), std::string::npos);
  }
}

TEST(SeenFrom, ReachesTilesAroundIt) {
  CityTile tile;
  tile.splats = 1;
  tile.low = {0, 0, 0};
  tile.high = {10, 10, 3};
  EXPECT_TRUE((SeenFrom{{5, 5, 2}, {5, 5, 2}, 1}.reaches(tile)));
  EXPECT_TRUE((SeenFrom{{-3, -4, 0}, {-3, -4, 0}, 5}.reaches(tile)));
  EXPECT_FALSE((SeenFrom{{-3.1, -4, 0}, {-3.1, -4, 0}, 5}.reaches(tile)));
  EXPECT_TRUE((SeenFrom{{-30, 2, 0}, {-4, 4, 0}, 5}.reaches(tile)));  // a moving sensor
  tile.splats = 0;
  EXPECT_FALSE((SeenFrom{{5, 5, 2}, {5, 5, 2}, 1}.reaches(tile)));
}

}  // namespace
}  // namespace adasplats::streams
