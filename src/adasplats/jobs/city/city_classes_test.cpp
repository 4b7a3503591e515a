// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_classes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "adasplats/city/tile_points.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/city/city_points.h"
#include "adasplats/jobs/city/city_squares.h"
#include "adasplats/jobs/city/city_work.h"
#include "adasplats/segment/network/network_text_test.h"

namespace adasplats::city_classes {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPoints = 8'000;  // a file

/// A street of 80 m with kerbs, walls, poles, crowns and a car, seen from its middle; points in no
/// order, in two files that both hold all of the place.
PointCloud street(std::uint64_t file) {
  PointCloud cloud;
  for (std::size_t i = 0; i < kPoints; ++i) {
    Random random(11, file, i);
    const double x = random.uniform(-37, 43);
    Vec3d p = {x, random.uniform(-12, 12), random.normal() * 0.02};
    const double kind = random.uniform();
    const double around = random.uniform(0, 6.28), high = random.uniform();
    if (std::fabs(p.y) > 5) p.z += 0.15;
    if (kind < 0.25)
      p = {x, kind < 0.13 ? 11.5 : -11.5, 8 * high};
    else if (kind < 0.32)
      p = {8 * std::floor(x / 8) + 0.1 * std::cos(around), 5.5, 5 * high};
    else if (kind < 0.4)
      p = {10 * std::floor(x / 10) + 1.5 * high * std::cos(around), -6 + high * std::sin(around),
           3 + 2 * random.uniform()};
    else if (kind < 0.44)
      p = {3 + 4 * high, 2 + 0.9 * std::cos(around), 0.3 + random.uniform()};
    cloud.positions.push_back(vec_cast<float>(p));
    cloud.sensor_positions.push_back({static_cast<float>(x / 2), 0, 2});
    cloud.intensities.push_back(static_cast<float>(random.uniform(0, 3) * random.uniform()));
    cloud.classes.push_back(static_cast<std::uint16_t>(i % 2 == 0 ? 40 : 10));
  }
  return cloud;
}

/// Hears warnings; stops the work when squares were looked at.
class Listener final : public ProgressSink {
 public:
  std::string warnings;
  std::uint64_t stop_at = 0;

  void begin_step(std::string_view name, std::uint64_t) override { step_ = name; }
  void advance(std::uint64_t done) override {
    if (stop_at > 0 && step_ == "segment" && done >= stop_at) throw std::runtime_error("stopped");
  }
  void warn(std::string_view message) override { warnings += std::string(message) + "\n"; }

 private:
  std::string step_;
};

/// Classes of points by the numbers of these in the order in which they are read.
using ByNumber = std::map<std::uint64_t, std::uint16_t>;

class CityClasses : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_segment()) GTEST_SKIP() << "built without OpenBLAS";
    for (const std::uint64_t file : {0, 1}) {
      job_.inputs.push_back(folder_.path() / ("street" + std::to_string(file) + ".ply"));
      save_cloud_ply(job_.inputs.back(), street(file));
    }
    job_.build.recipe = ConsistentOptions();
    job_.segment.on = true;
    job_.segment.network = folder_.write("small.network", network_test::pole_network().text());
    job_.calibration.on = false;
    job_.tiles = {7.3, 2};  // borders cut through cells
    job_.output = folder_.path() / "city";
  }

  /// What a whole city or its beginning has of classes; stopped where the listener says so.
  ByNumber classes_by(Listener& listener, int threads = 2) {
    const Executor executor(threads);
    DeviceChoice device;
    Session session = {executor, listener, 1, device};
    ResumableFolder folder(job_.output, false, kCityCommand, {{"a", "test"}});
    LayerWork work(job_, session, folder.path());
    sort_points(work, folder);
    give_classes(PointClassifier(job_.segment.network), work, folder);
    report_ = *work.segmented;
    rays_ = work.layer.facts.rays;
    ByNumber found;
    for (const TileKey tile : work.tiles.tiles) {
      PointCloud points;
      points.origin = work.layer.facts.origin;
      read_points_of(tile, work.folder(), job_, points);
      const std::vector<std::uint64_t> order = read_tile_order(work.folder(), tile);
      EXPECT_EQ(order.size(), points.size());
      for (std::size_t i = 0; i < points.size(); ++i) found[order[i]] = points.classes[i];
    }
    return found;
  }

  fs::path unfinished() const { return folder_.path() / ".city.unfinished"; }

  /// Files of a kind below the unfinished folder, with when they were written.
  std::map<fs::path, fs::file_time_type> files(const std::string& ending) const {
    std::map<fs::path, fs::file_time_type> found;
    for (const auto& entry : fs::directory_iterator(unfinished() / layer_folder(0) / "points"))
      if (entry.path().extension() == ending) found[entry.path()] = entry.last_write_time();
    return found;
  }

  const TemporaryFolder folder_;
  const Executor executor_{2};
  CityJob job_;
  SegmentReport report_;
  std::size_t rays_ = 0;
};

void flip_last_byte(const fs::path& file) {
  std::string bytes = read_file(file);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  std::ofstream(file, std::ios::binary) << bytes;
}

// Oracle: the place in one cloud.
TEST_F(CityClasses, AreThoseOfThePlaceInOneCloud) {
  Listener listener;
  DeviceChoice device;
  Session session = {executor_, listener, 1, device};
  const PointCloud whole = load_cloud(job_.inputs, job_.load, executor_, listener).first;
  job_.segment.network.clear();  // the default one sees more than heights
  const PointClassifier classifier("");
  const PointClasses expected = classifier.classes_of(whole, {}, session);
  EXPECT_GT(expected.tiles, 5U);
  EXPECT_GT(std::set(expected.ids.begin(), expected.ids.end()).size(), 5U);
  for (const double tile_m : {7.3, 50.0}) {
    job_.tiles.tile_m = tile_m;
    const ByNumber found = classes_by(listener);
    ASSERT_EQ(found.size(), whole.size());
    std::size_t different = 0;
    for (const auto& [number, id] : found) different += id == expected.ids[number] ? 0 : 1;
    EXPECT_EQ(different, 0U) << tile_m;
    EXPECT_EQ(report_.classes.tiles, expected.tiles);
    EXPECT_EQ(report_.classes.cells, expected.cells);
    for (std::size_t k = 0; k < expected.by_class.size(); ++k) {
      EXPECT_EQ(report_.classes.by_class[k].name, expected.by_class[k].name);
      EXPECT_EQ(report_.classes.by_class[k].points, expected.by_class[k].points);
    }
    std::size_t stay = 0;
    for (const std::uint16_t id : expected.ids)
      stay += is_removed(*semantickitti_labels().find(id), job_.build.remove) ? 0 : 1;
    EXPECT_EQ(rays_, stay);
    EXPECT_LT(stay, whole.size());
    EXPECT_TRUE(report_.replaced_labels);
    EXPECT_NE(listener.warnings.find("labels of the points are replaced"), std::string::npos);
    fs::remove_all(unfinished());
  }
}

/// Ground, and above it cells of 0.5 m that borders of tiles of 7.3 m cut. Their means are 1.25 m
/// and 0.48 of a float's last bit: which point is the first decides how that is rounded.
PointCloud cells_on_the_edge() {
  PointCloud cloud;
  const auto add = [&](double x, double y, float z) {
    cloud.positions.push_back({static_cast<float>(x), static_cast<float>(y), z});
  };
  constexpr std::uint64_t kPairs = 12;
  for (std::uint64_t j = 0; j <= 2 * kPairs; ++j) {
    std::uint64_t cell = 0;
    for (int border = -4; border <= 4; ++border) {
      for (int row = -20; row < 20; ++row, ++cell) {
        const auto above = static_cast<float>(1.25 + Random(5, cell, j / 2).uniform(0.05, 0.2));
        float z = j % 2 == 0 ? above : 2.5F - above;
        if (j == 2 * kPairs) z = 1.25F + 12 * 0x1p-23F;
        Random random(6, cell, j);
        add(std::floor(2 * 7.3 * border) / 2 + random.uniform(0.02, 0.48),
            0.5 * row + random.uniform(0.02, 0.48), z);
      }
    }
  }
  for (int i = -70; i < 70; ++i)
    for (int j = -25; j < 25; ++j) add(0.5 * i + 0.2, 0.5 * j + 0.2, 0);
  return cloud;
}

TEST_F(CityClasses, FollowFromPointsInTheOrderOfTheInputs) {
  network_test::NetworkText network = network_test::pole_network();
  network.header["shape"]["height_unit_m"] = 1.25;
  job_.segment.network = folder_.write("edge.network", network.text());
  job_.inputs.resize(1);
  save_cloud_ply(job_.inputs[0], cells_on_the_edge());
  Listener listener;
  DeviceChoice device;
  Session session = {executor_, listener, 1, device};
  const PointCloud whole = load_cloud(job_.inputs, job_.load, executor_, listener).first;
  const std::vector<std::uint16_t> expected =
      PointClassifier(job_.segment.network).classes_of(whole, {}, session).ids;
  const auto high = std::ranges::count(expected, 80);
  EXPECT_GT(high, 500);
  EXPECT_LT(high, 8500);  // of 9000
  const ByNumber found = classes_by(listener);
  ASSERT_EQ(found.size(), expected.size());
  std::size_t different = 0;
  for (const auto& [number, id] : found) different += id == expected[number] ? 0 : 1;
  EXPECT_EQ(different, 0U);
}

TEST_F(CityClasses, AreTheSameWhereSeveralTilesAreLookedAtAtATime) {
  Listener listener;
  const ByNumber two = classes_by(listener, 2);
  fs::remove_all(unfinished());
  EXPECT_EQ(classes_by(listener, 24), two);
}

TEST_F(CityClasses, StoppedRunsGoOn) {
  Listener listener;
  const ByNumber expected = classes_by(listener);
  fs::remove_all(unfinished());
  Listener stopped;
  stopped.stop_at = 3;
  EXPECT_THROW(classes_by(stopped), std::runtime_error);
  const auto before = files(".squares");
  EXPECT_EQ(before.size(), 3U);
  EXPECT_TRUE(files(".classes").empty());
  EXPECT_EQ(classes_by(listener), expected);
  const auto after = files(".squares");
  EXPECT_GT(after.size(), before.size());
  for (const auto& [file, time] : before) EXPECT_EQ(after.at(file), time) << file;
  // And what is done is left.
  const auto classes = files(".classes");
  EXPECT_EQ(classes_by(listener), expected);
  EXPECT_EQ(files(".classes"), classes);
  EXPECT_EQ(files(".squares"), after);
}

TEST_F(CityClasses, WhatWasDamagedIsMadeAgain) {
  Listener listener;
  const ByNumber expected = classes_by(listener);
  flip_last_byte(files(".classes").begin()->first);
  EXPECT_EQ(classes_by(listener), expected);
  for (const auto& [file, time] : files(".squares")) flip_last_byte(file);
  fs::remove(files(".classes").begin()->first);
  EXPECT_EQ(classes_by(listener), expected);
  flip_last_byte(files(".order").begin()->first);
  expect_error(ErrorKind::data, {".order", "changed since it was written"},
               [&] { classes_by(listener); });
}

TEST_F(CityClasses, OtherPointsThanThoseThatGotClassesAreAnError) {
  Listener listener;
  classes_by(listener);
  DeviceChoice device;
  Session session = {executor_, listener, 1, device};
  LayerWork work(job_, session, unfinished());
  load_sorted(work);
  const TileKey tile = *work.tiles.tiles.begin();
  std::vector<std::uint16_t> classes = read_tile_classes(work.folder(), tile);
  for (const std::size_t size : {classes.size() + 1, classes.size() - 1, std::size_t{0}}) {
    classes.resize(size);
    write_tile_classes(work.folder(), tile, classes);
    PointCloud points;
    expect_error(ErrorKind::data, {name_of(tile) + ".classes", "damaged"},
                 [&] { read_points_of(tile, work.folder(), job_, points); });
  }
}

TEST_F(CityClasses, EverySquareIsInOneGroup) {
  Listener listener;
  classes_by(listener);
  DeviceChoice device;
  Session session = {executor_, listener, 1, device};
  LayerWork work(job_, session, unfinished());
  load_sorted(work);
  for (const double tile_m : {3.0, 7.3, 100.0}) {
    work.tiles.grid = {tile_m};
    work.tiles.tiles.clear();
    const PointCloud points = street(0);
    for (std::size_t i = 0; i < points.size(); ++i)
      work.tiles.tiles.insert(work.tiles.grid.tile_of(points.world(i)));
    const std::vector<SquareGroup> groups = groups_of_squares({}, work);
    for (const Vec3f p : points.positions) {
      const SegmentSquare square = square_of(p, {});
      ASSERT_EQ(std::ranges::count_if(groups,
                                      [&](const SquareGroup& g) {
                                        return g.contains(square) &&
                                               g.tile == group_of(square, {}, work);
                                      }),
                1);
      ASSERT_EQ(std::ranges::count_if(
                    groups, [&](const SquareGroup& group) { return group.contains(square); }),
                1);
    }
  }
}

TEST_F(CityClasses, PointsFartherThanGridsReachAreAnError) {
  PointCloud cloud = street(0);
  cloud.positions.push_back({300e3F, 0, 0});
  cloud.sensor_positions.push_back({300e3F, 0, 0});
  cloud.intensities.push_back(0);
  cloud.classes.push_back(40);
  job_.inputs.resize(1);
  save_cloud_ply(job_.inputs[0], cloud);
  job_.load.max_distance_m = 1e9;
  Listener listener;
  expect_error(ErrorKind::data, {"100 km", "segment"}, [&] { classes_by(listener); });
}

TEST(SquareClasses, ComeBackAndDamageIsSaid) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "some.squares";
  SquareClasses classes = {3, 1000, {{{0, -1}, {40, 50}}, {{2, 7}, {10}}}};
  write_square_classes(file, classes);
  const SquareClasses read = read_square_classes(file);
  EXPECT_EQ(read.squares, 3U);
  EXPECT_EQ(read.cells, 1000U);
  EXPECT_EQ(read.of_tile, classes.of_tile);
  const std::string text = read_file(file);
  write_file(file, text.substr(0, text.size() - 1));
  expect_error(ErrorKind::data, {"some.squares", "ends within its classes"},
               [&] { read_square_classes(file); });
  write_file(file, text + "x");
  expect_error(ErrorKind::data, {"some.squares", "follow the classes"},
               [&] { read_square_classes(file); });
  write_file(file, text.substr(0, 24));
  expect_error(ErrorKind::data, {"some.squares", "head"}, [&] { read_square_classes(file); });
  write_file(file, "adasplats classes 2 1 1 0\n");
  expect_error(ErrorKind::data, {"some.squares", "not a file of classes"},
               [&] { read_square_classes(file); });
  write_square_classes(file, {});
  EXPECT_TRUE(read_square_classes(file).of_tile.empty());
}

}  // namespace
}  // namespace adasplats::city_classes
