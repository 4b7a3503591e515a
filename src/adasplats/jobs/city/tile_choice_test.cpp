// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/tile_choice.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats::tile_choice_tests {
namespace {

namespace fs = std::filesystem;

constexpr double kLength_m = 320, kWidth_m = 16;

/// A street along x, a point every decimetre along it; twice as many in its second half.
fs::path write_street(const fs::path& file) {
  std::vector<double> x, y, z;
  for (int i = 0; i < 3200; ++i)
    for (int j = 0; j < (i < 1600 ? 40 : 80); ++j) {
      x.push_back(0.1 * i + 0.05);
      y.push_back(0.2 * (j % 80) + 0.1);
      z.push_back(0);
    }
  const std::vector<ColumnView> columns = {{"x", ColumnType::f64, x.data(), 8},
                                           {"y", ColumnType::f64, y.data(), 8},
                                           {"z", ColumnType::f64, z.data(), 8}};
  write_ply(file, x.size(), columns);
  return file;
}

class TileChoices : public testing::Test {
 protected:
  TileChoices() {
    job_.inputs = {write_street(folder_.path() / "street.ply")};
    job_.output = folder_.path() / "city";
  }
  TileAdvice advice(double memory_gb, int threads = 1) {
    job_.memory.memory_gb = memory_gb;
    const Executor executor(threads);
    ProgressSink quiet;
    DeviceChoice device;
    Session session = {executor, quiet, 1, device};
    return advise_tiles(job_, session);
  }

  static constexpr double kPoints = 1600 * 120;
  TemporaryFolder folder_;
  CityJob job_;
};

TEST_F(TileChoices, APlaceThatFitsIsOnePiece) {
  EXPECT_EQ(advice(1).tile_m, 0);
  EXPECT_EQ(advice(0).tile_m, 0);  // three quarters of this machine's memory
}

// Oracle: points a metre, by hand.
TEST_F(TileChoices, TilesFitIntoTheMemory) {
  const auto gb = [](double points) { return points * kModelBytesAPoint / 1e9; };
  const TileAdvice tiles = advice(0.9 * gb(kPoints));
  EXPECT_EQ(tiles.tile_m, 64);
  EXPECT_NEAR(tiles.points, kPoints, 0.02 * kPoints);
  EXPECT_NEAR(tiles.need_gb, gb(tiles.points), 1e-9);
  // A tile of 64 m has at most 96 m of 800 points each with its halo, in squares of 16 m.
  EXPECT_EQ(advice(gb(0.9 * 96 * 800)).tile_m, 32);
  EXPECT_EQ(advice(gb(0.9 * 64 * 800)).tile_m, 16);
  // Two tiles at a time need twice as much.
  EXPECT_EQ(advice(gb(1.1 * 96 * 800), 16).tile_m, 16);
  EXPECT_EQ(advice(gb(1.1 * 96 * 800), 16).at_once, 0U);  // as many as there are threads for
  // Not even two of 16 m with 48 m of points each fit: one of 32 m.
  const TileAdvice one_by_one = advice(gb(0.95 * 96 * 800), 16);
  EXPECT_EQ(one_by_one.tile_m, 32);
  EXPECT_EQ(one_by_one.at_once, 1U);
  try {
    advice(gb(1000));
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data);
    EXPECT_NE(std::string(error.what()).find("street.ply"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("tiles of 16 m"), std::string::npos) << error.what();
  }
}

TEST(PlaceEstimate, SizesOfFilesSayAtMostHowManyPointsThereAre) {
  const TemporaryFolder folder;
  folder.write("drive/velodyne/000000.bin", std::string(160, 0));
  folder.write("drive/velodyne/000001.bin", std::string(320, 0));
  const std::vector<fs::path> inputs = {folder.path() / "drive"};
  EXPECT_EQ(max_points_of(inputs), 30);
}

}  // namespace
}  // namespace adasplats::tile_choice_tests
