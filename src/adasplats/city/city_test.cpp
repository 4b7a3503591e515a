// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <set>

#include "adasplats/city/city_manifest.h"
#include "adasplats/city/passing_rays.h"
#include "adasplats/city/tile_points.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"

namespace adasplats::cities {
namespace {

PointCloud random_cloud(std::size_t points, Vec3d origin, std::uint64_t seed) {
  PointCloud cloud;
  cloud.origin = origin;
  for (std::size_t i = 0; i < points; ++i) {
    Random random(seed, 0, i);
    const auto place = [&](double reach) {
      return vec_cast<float>(Vec3d{random.uniform(-reach, reach), random.uniform(-reach, reach),
                                   random.uniform(-2, 5)});
    };
    cloud.positions.push_back(place(50));
    cloud.sensor_positions.push_back(place(20));
    cloud.intensities.push_back(static_cast<float>(random.uniform()));
    cloud.classes.push_back(static_cast<std::uint16_t>(i % 7));
  }
  return cloud;
}

template <class Work>
std::string error_of(const Work& work, ErrorKind kind) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(TileGrid, ParsesTileNames) {
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  for (const TileKey tile : {TileKey{0, 0}, TileKey{12, -3}, TileKey{kLeast, kMost}})
    EXPECT_EQ(tile_named(name_of(tile)), tile);
  for (const char* const other :
       {"", "x", "x1", "x1_", "x1_y", "x_y1", "1_y2", "x1y2", "x+1_y2", "x01_y2", "x-0_y1",
        " x1_y2", "x1_y2 ", "x1_y2.ply", "x1_y2147483648", "x1_y-", "y1_x2"})
    EXPECT_EQ(tile_named(other), std::nullopt) << other;
}

TEST(TileGrid, TilesCoverTheGroundOnce) {
  const TileGrid grid{24};
  EXPECT_EQ(grid.tile_of({0, -0.001, 5}), (TileKey{0, -1}));
  EXPECT_EQ(grid.tile_of({24, 23.999, 0}), (TileKey{1, 0}));
  const GroundBox box = grid.box_of({-2, 3});
  EXPECT_TRUE(box.contains(-48, 72));
  EXPECT_FALSE(box.contains(-24, 72));
  EXPECT_EQ(name_of({-2, 3}), "x-2_y3");
}

TEST(GroundBox, SegmentsCrossItOrNot) {
  const GroundBox box = {0, 0, 10, 10};
  EXPECT_TRUE(box.is_crossed({-5, 5, 0}, {15, 5, 9}));     // through it
  EXPECT_TRUE(box.is_crossed({5, 5, 0}, {15, 5, 0}));      // out of it
  EXPECT_TRUE(box.is_crossed({5, -5, 0}, {5, 20, 0}));     // along an axis
  EXPECT_TRUE(box.is_crossed({5, 5, 0}, {5, 5, 3}));       // straight up
  EXPECT_FALSE(box.is_crossed({-5, 5, 0}, {-1, 5, 0}));    // ends before it
  EXPECT_FALSE(box.is_crossed({-5, 8, 0}, {3, 16, 0}));    // past a corner
  EXPECT_FALSE(box.is_crossed({-5, 12, 0}, {15, 12, 0}));  // misses it
}

TEST(TilePoints, RoundTripTileByTile) {
  const TemporaryFolder folder;
  const TileGrid grid{30};
  const Executor executor(2);
  TilePointsWriter writer(folder.path(), grid, 700, executor);  // writes several times
  const Vec3d origin = {1000, 2000, 0};
  std::map<TileKey, std::size_t> expected;
  std::size_t all = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    // The last cloud has another origin and is moved.
    PointCloud cloud = random_cloud(500, seed < 3 ? origin : Vec3d{1010, 2000, 0}, seed);
    cloud.empty_beams.push_back({{0, 0, 1}, {1, 0, 0}, 7});
    for (std::size_t i = 0; i < cloud.size(); ++i) ++expected[grid.tile_of(cloud.world(i))];
    all += cloud.size();
    writer.add(cloud);
  }
  const auto counts = writer.finish();
  EXPECT_EQ(writer.origin(), origin);
  std::size_t found = 0, beams = 0;
  for (const auto& [tile, count] : counts) {
    PointCloud points;
    points.origin = origin;
    if (count.points > 0) read_tile_points(folder.path(), tile, points);
    EXPECT_EQ(points.size(), count.points);
    EXPECT_EQ(points.classes.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(grid.tile_of(points.world(i)), tile);
    EXPECT_EQ(count.points, expected[tile]);
    found += points.size();
    for (const EmptyBeam& beam : read_tile_beams(folder.path(), tile)) {
      EXPECT_EQ(beam.scan, 7U);
      ++beams;
    }
  }
  EXPECT_EQ(found, all);
  EXPECT_EQ(beams, 3U);
}

TEST(TilePoints, OrderAndReplacementClasses) {
  const TemporaryFolder folder;
  const TileGrid grid{30};
  const Executor executor(2);
  TilePointsWriter writer(folder.path(), grid, 700, executor, true);
  PointCloud all;
  for (const std::uint64_t seed : {1, 2, 3}) {
    PointCloud cloud = random_cloud(500, {}, seed);
    writer.add(cloud);
    append(all, std::move(cloud));
  }
  std::set<std::uint64_t> numbers;
  for (const auto& [tile, count] : writer.finish()) {
    const std::vector<std::uint64_t> order = read_tile_order(folder.path(), tile);
    ASSERT_EQ(order.size(), count.points);
    EXPECT_TRUE(std::ranges::is_sorted(order));
    numbers.insert(order.begin(), order.end());
    std::vector<std::uint16_t> classes;
    for (const std::uint64_t number : order)
      classes.push_back(static_cast<std::uint16_t>(1000 + number));
    write_tile_classes(folder.path(), tile, classes);
    EXPECT_EQ(read_tile_classes(folder.path(), tile), classes);
    PointCloud low;
    read_tile_points(
        folder.path(), tile, low, [](Vec3f p) { return p.z < 2; }, classes);
    EXPECT_GT(low.size(), 0U);
    for (std::size_t i = 0; i < low.size(); ++i)
      EXPECT_EQ(low.positions[i], all.positions[low.classes[i] - 1000U]);
    classes.pop_back();
    const std::string why =
        error_of([&] { read_tile_points(folder.path(), tile, low, {}, classes); }, ErrorKind::data);
    EXPECT_NE(why.find(".classes: damaged"), std::string::npos) << why;
  }
  EXPECT_EQ(numbers.size(), all.size());
  EXPECT_EQ(*numbers.rbegin(), all.size() - 1);
}

TEST(TilePoints, FiltersByPosition) {
  const TemporaryFolder folder;
  const Executor executor(2);
  TilePointsWriter writer(folder.path(), TileGrid{1000}, 100, executor);
  const PointCloud cloud = random_cloud(400, {}, 1);
  writer.add(cloud);
  PointCloud high;
  for (const auto& [tile, count] : writer.finish())
    read_tile_points(folder.path(), tile, high, [](Vec3f p) { return p.z > 4; });
  EXPECT_EQ(high.size(), static_cast<std::size_t>(std::ranges::count_if(
                             cloud.positions, [](Vec3f p) { return p.z > 4; })));
  EXPECT_TRUE(std::ranges::all_of(high.positions, [](Vec3f p) { return p.z > 4; }));
}

TEST(TilePoints, RejectDamageAndOtherAttributes) {
  const TemporaryFolder folder;
  const Executor executor(2);
  TilePointsWriter writer(folder.path(), TileGrid{1000}, 1'000'000, executor);
  PointCloud cloud = random_cloud(400, {}, 1);
  writer.add(cloud);
  cloud.classes = {};
  const std::string why = error_of([&] { writer.add(cloud); }, ErrorKind::data);
  EXPECT_NE(why.find("different attributes"), std::string::npos) << why;
  const TileKey tile = writer.finish().begin()->first;
  const auto file = folder.path() / points_file_of(tile);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
  PointCloud read;
  const std::string cut =
      error_of([&] { read_tile_points(folder.path(), tile, read); }, ErrorKind::data);
  EXPECT_NE(cut.find("ends within its points"), std::string::npos) << cut;
  write_file(file, "adasplats points 2 5\n");
  error_of([&] { read_tile_points(folder.path(), tile, read); }, ErrorKind::data);
}

// Oracle: every ray against every tile, in small steps along the ray.
TEST(PassingRays, CrossATileAndEndElsewhere) {
  const PointCloud cloud = random_cloud(600, {5, 7, 0}, 4);
  TileSet tiles;
  tiles.grid = {20};
  tiles.halo_m = 3;
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 1; ++y) tiles.tiles.insert({x, y});
  const RaysByTile passing = passing_rays(cloud, tiles, 0.1, Executor(2));
  std::size_t rays = 0, doubtful = 0;
  for (const TileKey tile : tiles.tiles) {
    const GroundBox reach = tiles.reach_of(tile);
    std::set<std::size_t> expected, found;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vec3d from = cloud.origin + vec_cast<double>(cloud.sensor_positions[i]);
      const Vec3d way = cloud.world(i) - from;
      bool crosses = false;
      for (int k = 0; k <= 2000 && !crosses; ++k) crosses = reach.contains(from + k / 2000.0 * way);
      if (crosses && !reach.contains(cloud.world(i))) expected.insert(i);
    }
    const auto own = passing.find(tile);
    for (std::size_t k = 0; own != passing.end() && k < own->second.size(); ++k) {
      const auto at = std::ranges::find(cloud.positions, own->second.positions[k]);
      found.insert(static_cast<std::size_t>(at - cloud.positions.begin()));
    }
    rays += found.size();
    for (const std::size_t i : expected)
      ASSERT_TRUE(found.contains(i)) << name_of(tile) << " " << i;
    doubtful += found.size() - expected.size();  // steps miss clipped corners
  }
  EXPECT_GT(rays, 1000U);
  EXPECT_LT(doubtful, 10U);
}

TEST(RayFiles, ReturnTheRaysOfEachTile) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "rays");
  const TileKey a = {0, 0}, b = {1, -1}, c = {5, 5};
  const PointCloud cloud = random_cloud(30, {}, 9);
  const auto part = [&](std::uint32_t from, std::uint32_t to) {
    PointCloud rays;
    for (std::uint32_t i = from; i < to; ++i) {
      rays.positions.push_back(cloud.positions[i]);
      rays.sensor_positions.push_back(cloud.sensor_positions[i]);
    }
    return rays;
  };
  write_rays(folder.path() / rays_file_of(a, RaySort::passing), {{a, part(0, 4)}, {b, part(4, 9)}});
  write_rays(folder.path() / rays_file_of(b, RaySort::passing), {{b, part(9, 30)}});
  const RayFiles files(folder.path(), {a, b, c}, RaySort::passing);
  EXPECT_EQ(files.read(a).positions, part(0, 4).positions);
  EXPECT_EQ(files.read(b).sensor_positions, part(4, 30).sensor_positions);
  EXPECT_TRUE(files.read(c).empty());
  const auto file = folder.path() / rays_file_of(b, RaySort::passing);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 8);
  error_of([&] { RayFiles(folder.path(), {a, b}, RaySort::passing); }, ErrorKind::data);
}

/// A city of two tiles with three splats.
CityManifest write_city(const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder / "tiles");
  SplatModel common;
  common.origin = {1000, 0, 0};
  common.method = "consistent";
  save_model(folder / kCityCommonFile, common);
  CityManifest city;
  city.grid = {50};
  city.origin = common.origin;
  city.halo_m = 8;
  for (const TileKey key : {TileKey{20, 0}, TileKey{21, 0}}) {
    SplatModel tile = common;
    tile.disks = {{{key.x == 20 ? 1.0F : 51.0F, 1, 0}, 0.1F, {0, 0, 1}}};
    if (key.x == 21) tile.disks.push_back({{52, 1, 0}, 0.2F, {0, 0, 1}});
    save_model(folder / model_file_of(key), tile);
    city.tiles.push_back({key, 10, 0, sha256_of_file(folder / model_file_of(key)), {}, {}});
    set_splats(tile, city.tiles.back());
  }
  write_file(folder / kCityFile, city_text(city));
  return city;
}

TEST(City, LoadsAsOneModel) {
  const TemporaryFolder folder;
  EXPECT_FALSE(is_city(folder.path()));
  write_city(folder.path());
  ASSERT_TRUE(is_city(folder.path()));
  const CityManifest city = load_city_manifest(folder.path());
  EXPECT_EQ(city.points(), 20U);
  EXPECT_EQ(city.splats(), 3U);
  const SplatModel model = load_splats(folder.path());
  EXPECT_EQ(model.size(), 3U);
  EXPECT_EQ(model.origin, (Vec3d{1000, 0, 0}));
  EXPECT_EQ(model.disks[2].center, (Vec3f{52, 1, 0}));
  verify_city(folder.path(), city);
}

TEST(City, ReportsDamage) {
  const TemporaryFolder folder;
  const CityManifest city = write_city(folder.path());
  const auto tile = folder.path() / model_file_of({21, 0});
  SplatModel less = load_model(tile);
  less.disks.pop_back();
  save_model(tile, less);
  const std::string why = error_of([&] { load_city(folder.path()); }, ErrorKind::data);
  EXPECT_NE(why.find("x21_y0.ply"), std::string::npos) << why;
  error_of([&] { verify_city(folder.path(), city); }, ErrorKind::data);
  SplatModel soft = less;
  soft.disks.push_back(soft.disks.back());
  soft.opacities.assign(soft.size(), 0.5F);
  save_model(tile, soft);
  const std::string softness = error_of([&] { load_city(folder.path()); }, ErrorKind::data);
  EXPECT_NE(softness.find("has opacities"), std::string::npos) << softness;
  std::string text = read_file(folder.path() / kCityFile);
  text.replace(text.find("\"version\": 1"), 12, "\"version\": 9");
  write_file(folder.path() / kCityFile, text);
  const std::string version = error_of([&] { load_city_manifest(folder.path()); }, ErrorKind::data);
  EXPECT_NE(version.find("version 9"), std::string::npos) << version;
  write_file(folder.path() / kCityFile, "{");
  error_of([&] { load_city_manifest(folder.path()); }, ErrorKind::data);
}

TEST(City, RejectsSplatsOutsideTheBoxOfTheirTile) {
  const TemporaryFolder folder;
  CityManifest city = write_city(folder.path());
  const auto k = static_cast<std::size_t>(
      std::ranges::find(city.tiles, TileKey{21, 0}, &CityTile::key) - city.tiles.begin());
  EXPECT_GT(load_city_tile(folder.path(), city, k).size(), 0U);
  city.tiles[k].high.y -= 0.01;
  const std::string why =
      error_of([&] { load_city_tile(folder.path(), city, k); }, ErrorKind::data);
  EXPECT_NE(why.find("x21_y0.ply: the splats have y from"), std::string::npos) << why;
  EXPECT_NE(why.find("the city's manifest has"), std::string::npos) << why;
}

TEST(City, SplatsOutsideAllTilesBelongToANeighbor) {
  const TileGrid grid{50};
  const std::vector<CityTile> tiles = {{.key = {0, 0}}, {.key = {1, 0}}};
  EXPECT_EQ(owner_of({60, 10, 0}, grid, tiles), (TileKey{1, 0}));
  EXPECT_EQ(owner_of({60, -0.01, 0}, grid, tiles), (TileKey{0, 0}));
}

}  // namespace
}  // namespace adasplats::cities
