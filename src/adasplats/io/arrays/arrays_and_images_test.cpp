// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <string>
#include <vector>

#include "adasplats/io/arrays/npy.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {
namespace {

using io_test::bytes_of;
using io_test::put;
using io_test::values_of;

// The oracle: the bytes that numpy/lib/format.py (format version 1.0) describes, written by hand.
TEST(Npy, BytesOfFormatVersion10) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "file.npy";
  write_npy(path, std::vector<float>{1, 2, 3, 4, 5, 6}, 2, 3);
  std::string header = std::string("\x93NUMPY\x01\x00\x76\x00", 10) +
                       "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }";
  header.resize(127, ' ');
  std::string values;
  for (const float value : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}) values += bytes_of(value);
  EXPECT_EQ(read_file(path), header + "\n" + values);

  write_npy(path, std::vector<std::uint32_t>{7, 0xffffffff});
  header = std::string("\x93NUMPY\x01\x00\x76\x00", 10) +
           "{'descr': '<u4', 'fortran_order': False, 'shape': (2,), }";
  header.resize(127, ' ');
  EXPECT_EQ(read_file(path), header + "\n" + bytes_of(7U) + bytes_of(0xffffffffU));
}

TEST(Npy, ShapeMustMatchAndMayBeEmpty) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "file.npy";
  const std::vector<float> six(6);
  EXPECT_THROW(write_npy(path, six, 2, 4), std::logic_error);
  EXPECT_THROW(write_npy(path, six, 6, 0), std::logic_error);
  // 2^63 + 3 times 2 wraps to 6.
  EXPECT_THROW(write_npy(path, six, (std::size_t{1} << 63) + 3, 2), std::logic_error);
  EXPECT_EQ(folder.file_count(), 0U);
  write_npy(path, std::vector<float>{}, 0, 4);
  EXPECT_EQ(read_file(path).size(), 128U);
}

// The oracle: libpng's reader.
TEST(Png, RoundTripOfNoiseAndOfOneColour) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "image.png";
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{1, 1}, {7, 3}, {640, 480}}) {
    for (const bool is_noise : {false, true}) {
      std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * height * 3, 90);
      std::uint32_t state = 1;
      for (std::uint8_t& value : pixels)
        if (is_noise)
          value = static_cast<std::uint8_t>((state = state * 1664525U + 1013904223U) >> 24);
      write_png(path, width, height, pixels);
      png_image image{};
      image.version = PNG_IMAGE_VERSION;
      ASSERT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0);
      EXPECT_EQ(image.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
      EXPECT_EQ(image.width, static_cast<png_uint_32>(width));
      EXPECT_EQ(image.height, static_cast<png_uint_32>(height));
      std::vector<std::uint8_t> read(pixels.size());
      ASSERT_NE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr), 0);
      EXPECT_EQ(read, pixels);
    }
  }
}

TEST(Png, PixelsMustMatchTheSize) {
  const std::vector<std::uint8_t> pixels(12);
  EXPECT_THROW(write_png("never-written.png", 2, 3, pixels), std::logic_error);
  EXPECT_THROW(write_png("never-written.png", 0, 0, {}), std::logic_error);
  EXPECT_THROW(write_png("never-written.png", -2, -2, pixels), std::logic_error);
}

// The oracle: libpng's reader of 16-bit levels as they are.
TEST(Png, GreyLevelsOf16Bits) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "image.png";
  const std::vector<std::uint16_t> levels = {0, 1, 255, 256, 12345, 65535};
  write_png16(path, 3, 2, levels);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0);
  EXPECT_EQ(image.format, static_cast<png_uint_32>(PNG_FORMAT_LINEAR_Y));
  EXPECT_EQ(image.width, 3U);
  std::vector<std::uint16_t> read(levels.size());
  ASSERT_NE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr), 0);
  EXPECT_EQ(read, levels);
  EXPECT_THROW(write_png16(path, 2, 2, levels), std::logic_error);
  EXPECT_THROW(write_png16(path, 0, 0, {}), std::logic_error);
}

// The oracle: the values back from the bytes; shapes as numpy writes tuples.
TEST(Npy, AnyTypeAndShape) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "file.npy";
  const std::vector<std::uint32_t> values = {1, 2, 3, 0xffffffff};
  write_npy(path, NpyArray{ColumnType::u32, {2, 2, 1}, values.data()});
  const std::string bytes = read_file(path);
  EXPECT_NE(bytes.find("'descr': '<u4', 'fortran_order': False, 'shape': (2, 2, 1), }"),
            std::string::npos);
  EXPECT_EQ(bytes.substr(128), bytes_of(1U) + bytes_of(2U) + bytes_of(3U) + bytes_of(0xffffffffU));
  write_npy(path, NpyArray{ColumnType::i8, {0, 9}, nullptr});
  EXPECT_NE(read_file(path).find("'|i1'"), std::string::npos);
  const NpyArray huge = {ColumnType::f64, {std::size_t{1} << 62}, nullptr};
  EXPECT_THROW(write_npy(path, huge), std::logic_error);
  EXPECT_THROW(write_npy(path, NpyArray{ColumnType::u8, {}, nullptr}), std::logic_error);
}

TEST(KittiBin, FourFloatsAPoint) {
  const TemporaryFolder folder;
  std::string content;
  for (int k = 0; k < 40000; ++k)
    for (const float part : {0.0F, 0.25F, 0.5F, 0.75F})
      content += bytes_of(static_cast<float>(k) + part);
  const Table table = read_kitti_bin(folder.write("000000.bin", content));
  ASSERT_EQ(table.rows, 40000U);
  for (std::size_t column = 0; column < 4; ++column) {
    const auto& values = std::get<std::vector<float>>(table.columns[column].values);
    for (std::size_t k = 0; k < table.rows; ++k)
      ASSERT_EQ(values[k], static_cast<float>(k) + 0.25F * static_cast<float>(column));
  }
  EXPECT_EQ(table.columns[3].name, "intensity");
}

TEST(KittiBin, PartOfAPointIsAnError) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::data, {"byte 17", "found 1 bytes"},
               [&] { read_kitti_bin(folder.write("a.bin", std::string(17, 'x'))); });
  expect_error(ErrorKind::data, {"empty"}, [&] { read_kitti_bin(folder.write("b.bin", "")); });
  expect_error(ErrorKind::no_input, {}, [&] { read_kitti_bin(folder.path() / "c.bin"); });
}

/// `points` points on a circle around the sensor, of 4 floats or, with a ring, of 5.
std::string circle(int points, int floats) {
  std::string content;
  for (int k = 0; k < points; ++k) {
    const double angle = 0.1 * k;
    for (const double value : {9.5 * std::cos(angle), 9.5 * std::sin(angle), -1.7, 12.0 + k % 90})
      content += bytes_of(static_cast<float>(value));
    if (floats == 5) content += bytes_of(static_cast<float>(k % 32));
  }
  return content;
}

TEST(KittiBin, FiveFloatsAPointAreReadByName) {
  const TemporaryFolder folder;
  const Table table = read_points(folder.write("n__LIDAR_TOP__1.pcd.bin", circle(50, 5)));
  ASSERT_EQ(table.rows, 50U);
  EXPECT_EQ(table.columns[4].name, "ring");
  EXPECT_EQ(table.columns[4].as_double(33), 1.0);
  EXPECT_EQ(table.columns[3].as_double(33), 45.0);
  EXPECT_EQ(table.columns[0].as_double(0), 9.5);
  expect_error(ErrorKind::data, {"a.pcd.bin", "20 bytes a point", "found 16 bytes"},
               [&] { read_points(folder.write("a.pcd.bin", circle(51, 4))); });
  expect_error(ErrorKind::data, {"a.pcd.bin", "not a ring"},
               [&] { read_points(folder.write("a.pcd.bin", circle(50, 4))); });
}

TEST(KittiBin, FiveFloatsAreNotTakenForFour) {
  const TemporaryFolder folder;
  // 80 bytes divide 400: both sizes fit, the values do not. 51 x 20 is no multiple of 16.
  for (const int points : {20, 40, 51, 500})
    expect_error(ErrorKind::data, {"b.bin", "nuScenes", "*.pcd.bin"},
                 [&] { read_points(folder.write("b.bin", circle(points, 5))); });
  for (const int points : {20, 40, 51, 500})
    EXPECT_EQ(read_points(folder.write("b.bin", circle(points, 4))).rows,
              static_cast<std::size_t>(points));
}

// The name is no way out among the scans of a sequence.
TEST(KittiBin, FiveFloatsInASequenceMustBeConverted) {
  const TemporaryFolder folder;
  for (const char* name : {"b.bin", "b.pcd.bin"})
    for (const int points : {20, 51})
      expect_error(ErrorKind::data, {name, "nuScenes", "remove the ring"},
                   [&] { read_kitti_bin(folder.write(name, circle(points, 5))); });
}

TEST(KittiBin, IntensitiesThatAreNotFiniteAreUnknown) {
  const TemporaryFolder folder;
  for (const float value : {std::nanf(""), HUGE_VALF, -HUGE_VALF}) {
    std::string content = circle(3, 4);
    put(content, 12, value);
    EXPECT_EQ(read_kitti_bin(folder.write("a.bin", content)).rows, 3U);
    std::string five = circle(3, 5);
    put(five, 12, value);
    EXPECT_EQ(read_points(folder.write("a.pcd.bin", five)).rows, 3U);
  }
}

TEST(KittiBin, OtherFilesAreNotTakenForScans) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::data, {"c.bin", "CloudCompare"},
               [&] { read_points(folder.write("c.bin", "CCB2" + std::string(60, '\0'))); });
  // Three floats a point: the fourth is the next one's x.
  std::string three;
  for (int k = 0; k < 16; ++k)
    for (const double value : {9.5 * std::cos(0.5 * k), 9.5 * std::sin(0.5 * k), -1.7})
      three += bytes_of(static_cast<float>(value));
  expect_error(ErrorKind::data, {"d.bin", "point 2", "-1.7", "0 to 65535", "not a KITTI scan"},
               [&] { read_points(folder.write("d.bin", three)); });
}

// Oracle: the layout that was written. All values are possible coordinates and intensities.
TEST(KittiBin, OtherWidthsAreErrors) {
  const TemporaryFolder folder;
  for (const int width : {3, 4, 5, 6, 7, 8}) {
    std::string content;
    for (int k = 0; k < 420; ++k) {
      const double values[] = {30 + 10 * std::cos(0.01 * k),
                               50 + 10 * std::sin(0.01 * k),
                               5 + 0.001 * k,
                               0.3 + 0.1 * (k % 3),
                               0.5 + k % 16,
                               0.0001 * k,
                               2.5,
                               1};
      for (int i = 0; i < width; ++i)
        content += bytes_of(static_cast<float>(values[static_cast<std::size_t>(i)]));
    }
    const auto file = folder.write("w.bin", content);
    if (width == 4)
      EXPECT_EQ(read_points(file).rows, 420U);
    else
      expect_error(ErrorKind::data, {"w.bin", std::to_string(width) + " floats a point"},
                   [&] { read_points(file); });
  }
}

// As S3DIS has them: 100 points in no order, with 8-bit colours. All can be intensities.
TEST(KittiBin, SixFloatsOfPointsInNoOrder) {
  const TemporaryFolder folder;
  std::string six, four;
  for (int k = 0; k < 100; ++k) {
    const int random = k * 37 % 101;
    const double values[] = {0.05 * random, 0.03 * (random * 13 % 97), 0.02 * (random * 7 % 103)};
    for (const double value : values) six += bytes_of(static_cast<float>(value));
    for (const double value : values) four += bytes_of(static_cast<float>(value));
    for (const int grey : {0, 3, -5})
      six += bytes_of(static_cast<float>(100 + grey + random * 11 % 89));
    four += bytes_of(static_cast<float>(100 + random * 11 % 89));
  }
  EXPECT_EQ(read_points(folder.write("four.bin", four)).rows, 100U);
  expect_error(ErrorKind::data, {"six.bin", "6 floats a point"},
               [&] { read_points(folder.write("six.bin", six)); });
}

// The layout of NCLT: 2 bytes each for x, y and z, 1 each for intensity and laser.
TEST(KittiBin, IntegersAreNotFloats) {
  const TemporaryFolder folder;
  std::string content;
  for (int k = 0; k < 200; ++k) {
    for (const int value : {20000 + 7 * k, 19000 - 5 * k, 20100 + k})
      content += bytes_of(static_cast<std::uint16_t>(value));
    content += bytes_of(static_cast<std::uint8_t>(k));
    content += bytes_of(static_cast<std::uint8_t>(k % 32));
  }
  expect_error(ErrorKind::data, {"n.bin", "not a KITTI scan", "8 bytes a point", "NCLT"},
               [&] { read_points(folder.write("n.bin", content)); });
}

}  // namespace
}  // namespace adasplats
