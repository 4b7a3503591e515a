// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "adasplats/core/recordings_test.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/ply/ply.h"

// Small files of other projects' tests, with a catalogue of what they hold that was made with other
// readers (LASzip, the headers' text): the oracle of this file.
namespace adasplats {
namespace {

using io_test::values_of;

class RealFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto found = recording("formats");
    if (!found) GTEST_SKIP() << kNoRecordings;
    folder_ = *found;
    std::ifstream catalog(folder_ / "CATALOG.tsv");
    for (std::string line; std::getline(catalog, line);) {
      std::istringstream fields(line);
      std::string name, size, what;
      std::getline(fields, name, '\t');
      std::getline(fields, size, '\t');
      std::getline(fields, what);
      catalog_[name] = what;
    }
  }

  /// How many points the reader has left out as withheld.
  static std::size_t withheld_of(const Table& table) {
    for (const ReaderNote& note : table.notes)
      if (note.kind == NoteKind::withheld) return number_after(note.text, "").value();
    return 0;
  }
  /// The number that follows `word` in a file's line of the catalogue.
  static std::optional<std::size_t> number_after(const std::string& what, const std::string& word) {
    const std::size_t found = what.find(word);
    if (found == std::string::npos) return std::nullopt;
    const std::string digits = what.substr(found + word.size());
    std::size_t number = 0;
    const auto [stop, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return error == std::errc() ? std::optional(number) : std::nullopt;
  }

  std::filesystem::path folder_;
  std::map<std::string, std::string> catalog_;
};

TEST_F(RealFiles, LasAndPcdHaveTheCataloguedPoints) {
  const std::map<std::string, std::string> broken = {
      {"PDAL+PDAL__test__data__las__garbage_nVariableLength.las", "1069128089"},
      {"PDAL+PDAL__test__data__las__permutations__1.2-no-points.las", "holds 0 of"},
      {"PDAL+PDAL__test__data__pcd__missingheader.pcd", "'289814.15'"}};
  int read = 0;
  for (const auto& entry : catalog_) {
    const std::string& name = entry.first;
    const std::string& what = entry.second;
    if (!name.ends_with(".las") && !name.ends_with(".pcd")) continue;
    SCOPED_TRACE(name);
    if (broken.contains(name)) {
      expect_error(ErrorKind::data, {broken.at(name)}, [&] { read_points(folder_ / name); });
      continue;
    }
    const Table table = read_points(folder_ / name);
    EXPECT_EQ(std::optional(table.rows + withheld_of(table)), number_after(what, "points "));
    for (const Column& column : table.columns) EXPECT_EQ(column.size(), table.rows);
    EXPECT_NE(table.find("x"), nullptr);
    ++read;
  }
  EXPECT_EQ(read, 37);
}

TEST_F(RealFiles, LazHasTheCataloguedPoints) {
  const std::map<std::string, std::string> broken = {
      {"LASzip+LASzip__data__broken_coder.laz", "coder 15"},
      {"LASzip+LASzip__data__broken_type.laz", "'laszip encoded' is damaged"},
      {"LASzip+LASzip__data__broken_version.laz", "version 6"}};
  int read = 0;
  for (const auto& entry : catalog_) {
    const std::string& name = entry.first;
    const std::string& what = entry.second;
    if (!name.ends_with(".laz")) continue;
    SCOPED_TRACE(name);
    if (broken.contains(name)) {
      expect_error(ErrorKind::data, {name, "LAZ", broken.at(name)},
                   [&] { read_points(folder_ / name); });
      continue;
    }
    const Table table = read_points(folder_ / name);
    EXPECT_EQ(std::optional(table.rows + withheld_of(table)), number_after(what, "points "));
    for (const Column& column : table.columns) EXPECT_EQ(column.size(), table.rows);
    ++read;
  }
  EXPECT_EQ(read, 19);
}

// The same points, packed by LASzip (versions 1.2, 2.0, 2.2 and 3.1) and as LAS.
TEST_F(RealFiles, LazHasTheValuesOfLas) {
  const std::vector<std::pair<const char*, const char*>> twins = {
      {"PDAL+PDAL__test__data__laz__simple-laszip-compressor-version-1.2r0.laz",
       "PDAL+PDAL__test__data__las__simple.las"},
      {"PDAL+PDAL__test__data__laszip__laszip-generated.laz",
       "PDAL+PDAL__test__data__las__simple.las"},
      {"laspy+laspy__tests__data__simple.laz", "PDAL+PDAL__test__data__las__simple.las"},
      {"hobuinc+laz-perf__cpp__test__raw-sets__point-time.las.laz",
       "laz-rs+laz-rs__tests__data__point-time.las"},
      {"hobuinc+laz-perf__cpp__test__raw-sets__extrabytes.laz",
       "laz-rs+laz-rs__tests__data__extra-bytes.las"},
      {"laspy+laspy__tests__data__extra.laz", "laz-rs+laz-rs__tests__data__extra-bytes.las"}};
  for (const auto& [packed, plain] : twins) {
    SCOPED_TRACE(packed);
    const Table found = read_points(folder_ / packed);
    const Table expected = read_points(folder_ / plain);
    ASSERT_EQ(found.columns.size(), expected.columns.size());
    for (std::size_t k = 0; k < found.columns.size(); ++k) {
      EXPECT_EQ(found.columns[k].name, expected.columns[k].name);
      EXPECT_EQ(found.columns[k].values, expected.columns[k].values) << found.columns[k].name;
    }
  }
}

TEST_F(RealFiles, PlyHaveTheCataloguedVertices) {
  for (const auto& entry : catalog_) {
    const std::string& name = entry.first;
    const std::string& what = entry.second;
    if (!name.ends_with(".ply")) continue;
    SCOPED_TRACE(name);
    if (name == "assimp+assimp__test__models__invalid__empty.ply") {
      expect_error(ErrorKind::data, {"empty"}, [&] { read_points(folder_ / name); });
      continue;
    }
    const Table table = read_points(folder_ / name);
    EXPECT_EQ(std::optional(table.rows), number_after(what, "'vertex', '"));
    const std::size_t faces = number_after(what, "'face', '").value_or(0);
    EXPECT_EQ(ply_has_faces(folder_ / name), faces > 0);
    if (faces > 0) {
      EXPECT_GE(read_ply_mesh(folder_ / name).faces.rows, faces);
    }
  }
}

// The same cube written with two line ends.
TEST_F(RealFiles, CubeIsTheUnitCube) {
  for (const char* name :
       {"assimp+assimp__test__models__PLY__cube_binary.ply",
        "assimp+assimp__test__models__PLY__cube_binary_header_with_RN_newline.ply"}) {
    const MeshTable mesh = read_ply_mesh(folder_ / name);
    EXPECT_EQ(mesh.faces.rows, 12U);
    EXPECT_EQ(values_of(mesh.vertices, "x"), (std::vector<double>{0, 0, 0, 0, 1, 1, 1, 1}));
    EXPECT_EQ(values_of(mesh.vertices, "y"), (std::vector<double>{0, 0, 1, 1, 0, 0, 1, 1}));
    EXPECT_EQ(values_of(mesh.vertices, "z"), (std::vector<double>{0, 1, 1, 0, 0, 1, 1, 0}));
  }
}

// Compressed PCD: the images' 256 x 256 pixels as PCL wrote them.
TEST_F(RealFiles, CompressedPcdUnpacksToAnImage) {
  const Table table = read_pcd(folder_ / "PointCloudLibrary+pcl__test__2d__canny.pcd");
  std::size_t edges = 0;
  for (const double value : values_of(table, "intensity")) {
    EXPECT_TRUE(value == 0 || value == 255) << value;
    edges += value == 255 ? 1 : 0;
  }
  EXPECT_GT(edges, 100U);
  EXPECT_LT(edges, 20000U);
}

// LAS headers hold the box of their points: every coordinate is in it, and touches it.
TEST_F(RealFiles, LasPointsTouchTheHeadersBox) {
  // The box of wontcompress3.las holds points that are withheld.
  for (const char* name : {"PDAL+PDAL__test__data__las__simple.las",
                           "PDAL+PDAL__test__data__autzen__autzen-bmx-2010.las",
                           "laz-rs+laz-rs__tests__data__point-time.las"}) {
    SCOPED_TRACE(name);
    std::ifstream file(folder_ / name, std::ios::binary);
    std::string header(227, '\0');
    file.read(header.data(), 227);
    const Table table = read_las(folder_ / name);
    for (const std::size_t axis : {0U, 1U, 2U}) {
      double high = 0, low = 0;
      std::memcpy(&high, header.data() + 179 + 16 * axis, 8);
      std::memcpy(&low, header.data() + 187 + 16 * axis, 8);
      const std::vector<double> values = values_of(table, std::string(1, "xyz"[axis]));
      EXPECT_NEAR(*std::max_element(values.begin(), values.end()), high, 0.011);
      EXPECT_NEAR(*std::min_element(values.begin(), values.end()), low, 0.011);
    }
  }
}

// Counts of lines of the files themselves; the bunny's own count (8) is one too small.
TEST_F(RealFiles, TextHasAPointALine) {
  const std::map<std::string, std::pair<std::size_t, std::size_t>> rows_and_columns = {
      {"PDAL+PDAL__test__data__pts__bunny_8.pts", {9, 3}},
      {"PDAL+PDAL__test__data__pts__site_56_8.pts", {8, 4}},
      {"PDAL+PDAL__test__data__pts__test.pts", {19, 7}},
      {"PDAL+PDAL__test__data__gdal__data.xyz", {400, 3}},
      {"daavoo+pyntcloud__tests__data__diamond.xyz", {6, 6}},
      {"PDAL+PDAL__test__data__ptx__1.2-with-color.ptx", {1065, 10}},
      {"PDAL+PDAL__test__data__ptx__multiple-and-transform.ptx", {8, 7}},
      {"PDAL+PDAL__test__data__ptx__complex-transform.ptx", {4, 10}}};
  for (const auto& [name, expected] : rows_and_columns) {
    SCOPED_TRACE(name);
    const Table table = read_points(folder_ / name);
    EXPECT_EQ(table.rows, expected.first);
    EXPECT_EQ(table.columns.size(), expected.second);
  }
}

// Two scans of the same four points, one of them as (x - 600000, ..., (z - 400) / 2).
TEST_F(RealFiles, PtxTransformGivesTheSamePoints) {
  const Table table =
      read_points(folder_ / "PDAL+PDAL__test__data__ptx__multiple-and-transform.ptx");
  for (const char* name : {"x", "y", "z"}) {
    const std::vector<double> values = values_of(table, name);
    ASSERT_GE(values.size(), 8U);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(values[k], values[k + 4], 1e-6);
  }
}

// Oracle: what libE57Format 3.3 reads of the same files.
TEST_F(RealFiles, E57HasTheCataloguedPoints) {
  const std::map<std::string, std::string> broken = {
      {"asmaloney+libE57Format-test-data__self__PinholeImageWithDistortionParameters.e57",
       "the file has no scans"},
      {"asmaloney+libE57Format-test-data__self__bad-crc.e57", "page 0 (from 0) is damaged"},
      {"asmaloney+libE57Format-test-data__self__empty.e57", "the file has no scans"},
      {"cry-inc+e57__testdata__corrupt_crc.e57", "page 33 (from 0) is damaged"}};
  // Points with a return, of those of the catalogue's first scan (it lists other tables, too).
  const std::map<std::string, std::size_t> without_return = {
      {"cry-inc+e57__testdata__read_error.e57", 2651},
      {"cry-inc+e57__testdata__tiny_spherical.e57", 180}};
  int read = 0;
  for (const auto& entry : catalog_) {
    const std::string& name = entry.first;
    if (!name.ends_with(".e57")) continue;
    SCOPED_TRACE(name);
    if (broken.contains(name)) {
      expect_error(ErrorKind::data, {broken.at(name)}, [&] { read_points(folder_ / name); });
      continue;
    }
    const Table table = read_points(folder_ / name);
    const std::size_t left_out = without_return.contains(name) ? without_return.at(name) : 0;
    EXPECT_EQ(std::optional(table.rows + left_out), number_after(entry.second, "records ['"));
    EXPECT_EQ(table.notes.size(), left_out > 0 ? 1U : 0U);
    ++read;
  }
  EXPECT_EQ(read, 6);
}

// Oracle: libE57Format. Real32 in a file of CloudCompare, scaled integers of las2e57.
TEST_F(RealFiles, E57HasTheReferencesValues) {
  const Table cloud = read_points(folder_ / "cry-inc+e57__testdata__tinyCartesianFloatRgb.e57");
  EXPECT_EQ(values_of(cloud, "x").at(1), -8.652949333190918);
  EXPECT_EQ(values_of(cloud, "y").at(1), 4.5148820877075195);
  EXPECT_EQ(values_of(cloud, "z").at(1), 295.66818237304688);
  EXPECT_EQ(values_of(cloud, "red").at(1), 231);
  EXPECT_EQ(cloud.find("sensor_x"), nullptr);
  const Table cube = read_points(folder_ / "cry-inc+e57__testdata__las2e57_no_images_tag.e57");
  EXPECT_EQ(values_of(cube, "x").at(1), -0.5);
  EXPECT_EQ(values_of(cube, "y").at(1), 0.169);
  EXPECT_EQ(values_of(cube, "z").at(1), 0.485);
  EXPECT_EQ(values_of(cube, "blue").at(1), 65280);
  const Table integers = read_points(folder_ / "cry-inc+e57__testdata__integer_intensity.e57");
  // -66 and 66 of the intensityLimits -66 and 66.
  EXPECT_EQ(values_of(integers, "intensity"), (std::vector<double>{0, 1}));
}

}  // namespace
}  // namespace adasplats
