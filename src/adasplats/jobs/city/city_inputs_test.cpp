// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_inputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "adasplats/cloud/load/open_inputs.h"
#include "adasplats/core/error.h"
#include "adasplats/core/recorded_progress_test.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/las/las_writer.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats::city_inputs_tests {
namespace {

namespace fs = std::filesystem;

/// Points on a ground of 10 m, those from `first_x` on, of some labels.
struct Ground {
  std::vector<double> x, y, z, sensor_z;
  std::vector<std::uint32_t> labels;

  Ground(std::size_t points, double first_x, std::uint32_t label) : z(points) {
    for (std::size_t i = 0; i < points; ++i) {
      x.push_back(first_x + 0.01 * static_cast<double>(i % 1000));
      y.push_back(0.1 * static_cast<double>(i / 1000));
      sensor_z.push_back(2);
      labels.push_back(label);
    }
  }
  std::vector<ColumnView> columns() const {
    return {{"x", ColumnType::f64, x.data(), 8},
            {"y", ColumnType::f64, y.data(), 8},
            {"z", ColumnType::f64, z.data(), 8},
            {"sensor_x", ColumnType::f64, x.data(), 8},
            {"sensor_y", ColumnType::f64, y.data(), 8},
            {"sensor_z", ColumnType::f64, sensor_z.data(), 8},
            {"label", ColumnType::u32, labels.data(), 4}};
  }
};

struct Taken {
  CityPoints read;
  std::vector<PointCloud> clouds;
  std::vector<std::string> warnings;

  std::vector<Vec3d> world() const {
    std::vector<Vec3d> all;
    for (const PointCloud& cloud : clouds)
      for (std::size_t i = 0; i < cloud.size(); ++i) all.push_back(cloud.world(i));
    return all;
  }
};

Taken taken(const std::vector<fs::path>& inputs, std::uint64_t piece_records,
            const LoadOptions& load = {}) {
  ModelJob job;
  job.inputs = inputs;
  job.load = load;
  job.load.own_body_m = 0;
  job.load.driven_path_m = 0;
  const Executor executor(2);
  RecordedProgress progress;
  DeviceChoice device;
  Session session = {executor, progress, 1, device};
  Taken taken;
  taken.read = read_city_points(
      job, session, [&](PointCloud&& cloud) { taken.clouds.push_back(std::move(cloud)); },
      {.piece_records = piece_records});
  taken.warnings = progress.warnings;
  return taken;
}

std::string error_of(const std::vector<fs::path>& inputs, const LoadOptions& load = {}) {
  try {
    taken(inputs, 1000, load);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(CityInputs, LargeFilesAreReadPieceByPiece) {
  const TemporaryFolder folder;
  const Ground ground(3500, 0, 40);
  write_ply(folder.path() / "a.ply", 3500, ground.columns());
  write_las(folder.path() / "a.las", 3500, ground.columns(), {});
  for (const char* name : {"a.ply", "a.las"}) {
    const std::vector<fs::path> input = {folder.path() / name};
    const Taken whole = taken(input, 1'000'000), pieces = taken(input, 1000);
    EXPECT_EQ(whole.clouds.size(), 1U);
    EXPECT_EQ(pieces.clouds.size(), 4U);
    EXPECT_EQ(pieces.read.read, 3500U);
    EXPECT_EQ(pieces.world(), whole.world());
    EXPECT_EQ(pieces.clouds[3].size(), 500U);
    EXPECT_EQ(pieces.clouds[3].has_beams(), whole.clouds[0].has_beams());
  }
}

TEST(CityInputs, FilesOutsideOfTheExtentHaveNoPoints) {
  const TemporaryFolder folder;
  write_ply(folder.path() / "a.ply", 1500, Ground(1500, 0, 40).columns());
  write_ply(folder.path() / "b.ply", 1500, Ground(1500, 100, 40).columns());
  const std::vector<fs::path> inputs = {folder.path() / "a.ply", folder.path() / "b.ply"};
  LoadOptions load;
  load.selection.extent = Extent{{100, -1, -1}, {104.995, 9, 9}};
  const Taken some = taken(inputs, 1000, load);
  EXPECT_EQ(some.world().size(), 1000U);
  load.selection.extent = Extent{{50, -1, -1}, {60, 9, 9}};
  EXPECT_NE(error_of(inputs, load).find("is in the extent"), std::string::npos);
}

// Oracle: at once such points are dropped as far, which is an error where they are many.
TEST(CityInputs, PiecesOfTwoPlacesAreAnError) {
  const TemporaryFolder folder;
  write_ply(folder.path() / "a.ply", 1500, Ground(1500, 0, 40).columns());
  write_ply(folder.path() / "b.ply", 1500, Ground(1500, 500e3, 40).columns());
  const std::vector<fs::path> inputs = {folder.path() / "a.ply", folder.path() / "b.ply"};
  const std::string why = error_of(inputs);
  EXPECT_NE(why.find("500 km apart"), std::string::npos) << why;
  LoadOptions load;
  load.max_distance_m = 1e6;
  EXPECT_EQ(taken(inputs, 1000, load).world().size(), 3000U);
}

TEST(CityInputs, PiecesOfTwoCoordinateSystemsAreAnError) {
  const TemporaryFolder folder;
  LasWriteOptions options;
  options.crs.wkt = "LOCAL_CS[\"here\"]";
  write_las(folder.path() / "a.las", 1500, Ground(1500, 0, 40).columns(), options);
  options.crs.wkt = "LOCAL_CS[\"there\"]";
  write_las(folder.path() / "b.las", 1500, Ground(1500, 0, 40).columns(), options);
  const std::string why = error_of({folder.path() / "a.las", folder.path() / "b.las"});
  EXPECT_NE(why.find("b.las"), std::string::npos) << why;
}

TEST(CityInputs, PiecesWithTwoScalesOfIntensitiesAreAWarning) {
  const TemporaryFolder folder;
  std::vector<fs::path> inputs;
  for (const float factor : {1.0F, 257.0F}) {
    const Ground ground(1500, 0, 40);
    std::vector<float> intensities;
    for (int i = 0; i < 1500; ++i) intensities.push_back(factor * static_cast<float>(100 + i % 40));
    std::vector<ColumnView> columns = ground.columns();
    columns.push_back({"intensity", ColumnType::f32, intensities.data(), 4});
    inputs.push_back(folder.path() / (std::to_string(inputs.size()) + ".ply"));
    write_ply(inputs.back(), 1500, columns);
  }
  const std::vector<std::string> warnings = taken(inputs, 1000).warnings;
  EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& text) {
    return text.find("intensities of the inputs have different scales") != std::string::npos;
  }));
  EXPECT_TRUE(taken({inputs[0]}, 1000).warnings.empty());
}

/// A file of scans of 700 points each, a metre apart; the first ones can be flagged as deleted.
fs::path write_scans(const fs::path& file, std::size_t scans, bool in_order = true,
                     std::size_t deleted = 0) {
  const std::size_t points = 700 * scans;
  std::vector<double> x, y, z(points), sensor_x, sensor_y(points), sensor_z(points, 2);
  std::vector<std::uint32_t> numbers;
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t scan = i / 700;
    sensor_x.push_back(static_cast<double>(scan));
    x.push_back(sensor_x.back() + 0.01 * static_cast<double>(i % 700));
    y.push_back(0.01 * static_cast<double>(i % 7));
    numbers.push_back(static_cast<std::uint32_t>(in_order ? scan : scans - scan));
  }
  std::vector<std::uint8_t> withheld(points);
  std::fill_n(withheld.begin(), deleted, std::uint8_t{1});
  const std::vector<ColumnView> columns = {{"x", ColumnType::f64, x.data(), 8},
                                           {"y", ColumnType::f64, y.data(), 8},
                                           {"z", ColumnType::f64, z.data(), 8},
                                           {"sensor_x", ColumnType::f64, sensor_x.data(), 8},
                                           {"sensor_y", ColumnType::f64, sensor_y.data(), 8},
                                           {"sensor_z", ColumnType::f64, sensor_z.data(), 8},
                                           {"scan_index", ColumnType::u32, numbers.data(), 4},
                                           {"withheld", ColumnType::u8, withheld.data(), 1}};
  write_ply(file, points, columns);
  return file;
}

TEST(FilePieces, AreCutBetweenScansAndKnowThePathBeyond) {
  const TemporaryFolder folder;
  const std::vector<fs::path> input = {write_scans(folder.path() / "a.ply", 7)};
  RecordedProgress progress;
  const Executor executor(2);
  const OpenInputs inputs(input, {}, executor, progress);
  const std::vector<InputPiece> pieces = file_pieces(inputs, 1500, executor, progress);
  ASSERT_EQ(pieces.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(pieces[k].first, 1400 * k);
    EXPECT_EQ(pieces[k].count, k < 3 ? 1400U : 700U);
    EXPECT_TRUE(pieces[k].has_whole_scans);
    ASSERT_EQ(pieces[k].beyond.before.size(), 2 * k);
    ASSERT_EQ(pieces[k].beyond.after.size(), k < 3 ? 5 - 2 * k : 0);
    const std::vector<Vec3d>& after = pieces[k].beyond.after;
    EXPECT_EQ((after.empty() ? Vec3d{6, 0, 2} : after.back()), (Vec3d{6, 0, 2}));
  }
  // Scans that are longer than a piece stay whole, but for those that are much longer.
  EXPECT_EQ(file_pieces(inputs, 400, executor, progress).size(), 7U);
  EXPECT_EQ(file_pieces(inputs, 4900, executor, progress).size(), 1U);
  EXPECT_TRUE(progress.warnings.empty());
  const std::vector<InputPiece> cut = file_pieces(inputs, 100, executor, progress);
  ASSERT_EQ(cut.size(), 49U);
  EXPECT_FALSE(cut[0].has_whole_scans);
  ASSERT_EQ(progress.warnings.size(), 1U);
  EXPECT_NE(progress.warnings[0].find("one of its scans has 700 points"), std::string::npos);
}

TEST(FilePieces, ScansThatAreNotInOrderAreSaid) {
  const TemporaryFolder folder;
  const std::vector<fs::path> input = {write_scans(folder.path() / "a.ply", 7, false)};
  RecordedProgress progress;
  const Executor executor(2);
  const OpenInputs inputs(input, {}, executor, progress);
  const std::vector<InputPiece> pieces = file_pieces(inputs, 1500, executor, progress);
  ASSERT_EQ(pieces.size(), 4U);
  EXPECT_EQ(pieces[1].first, 1500U);
  EXPECT_FALSE(pieces[1].has_whole_scans);
  ASSERT_EQ(progress.warnings.size(), 1U);
  EXPECT_NE(progress.warnings[0].find("not ordered by scan"), std::string::npos);
}

TEST(FilePieces, RecordsThatAreLeftOutDoNotShiftThePieces) {
  const TemporaryFolder folder;
  const Taken all = taken({write_scans(folder.path() / "a.ply", 7, true, 900)}, 1500);
  EXPECT_EQ(all.world().size(), std::size_t{7 * 700 - 900});
  EXPECT_TRUE(std::ranges::any_of(all.warnings, [](const std::string& text) {
    return text.find("some of its records are left out") != std::string::npos;
  }));
}

/// A track of poses of a sensor 2 m above the ground, from `begin_s` on.
fs::path write_track(const fs::path& file, double begin_s) {
  std::ofstream out(file);
  out << "time,x,y,z,qw,qx,qy,qz\n";
  for (int k = 0; k <= 100; ++k)
    out << std::to_string(begin_s + 0.1 * k) << "," << 0.1 * k << ",0,2,1,0,0,0\n";
  return file;
}

// Oracle: a file of GPS seconds of the week beside one of GPS seconds.
TEST(CityInputs, PiecesOfTwoClocksAreAnError) {
  const TemporaryFolder folder;
  constexpr double kGps_s = 1311000000, kWeek_s = kGps_s - 2167 * 604800.0;
  const Ground ground(1500, 0, 40);
  std::vector<fs::path> inputs;
  for (const double begin_s : {kGps_s, kWeek_s}) {
    std::vector<double> times;
    for (std::size_t i = 0; i < 1500; ++i)
      times.push_back(begin_s + 0.5 + 0.006 * static_cast<double>(i));
    const std::vector<ColumnView> columns = {{"x", ColumnType::f64, ground.x.data(), 8},
                                             {"y", ColumnType::f64, ground.y.data(), 8},
                                             {"z", ColumnType::f64, ground.z.data(), 8},
                                             {"gps_time", ColumnType::f64, times.data(), 8}};
    inputs.push_back(folder.path() / (std::to_string(inputs.size()) + ".ply"));
    write_ply(inputs.back(), 1500, columns);
  }
  LoadOptions load;
  load.trajectory = write_track(folder.path() / "track.csv", kGps_s);
  load.trust_origins = true;
  const Taken one = taken({inputs[0]}, 1000, load);
  EXPECT_EQ(one.clouds.size(), 2U);
  EXPECT_TRUE(one.clouds[1].has_beams());
  ASSERT_FALSE(one.warnings.empty());
  EXPECT_NE(one.warnings.back().find("not calibrated"), std::string::npos);
  const std::string why = error_of(inputs, load);
  EXPECT_NE(why.find("clock"), std::string::npos) << why;
  EXPECT_NE(why.find("1.ply"), std::string::npos) << why;
}

}  // namespace
}  // namespace adasplats::city_inputs_tests
