// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/range_image.h"

#include <gtest/gtest.h>
#include <png.h>

#include <stdexcept>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

/// Two rings of three columns: returns at (0, 2), (1, 0) twice, and (1, 1).
Scan small_scan() {
  Scan scan;
  scan.positions.resize(4);
  scan.ranges_m = {10.5F, 0.001F, 7.0F, 300.0F};
  scan.rings = {0, 1, 1, 1};
  scan.columns = {2, 0, 0, 1};
  scan.times_s.resize(4);
  scan.return_indices = {0, 0, 1, 0};
  scan.classes = {40, 50, 70, 12345};
  scan.instances = {0, 3, 0, 0};
  return scan;
}

template <class T>
std::vector<T> png_values(const std::filesystem::path& path, png_uint_32 format,
                          std::size_t channels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << image.message;
  EXPECT_EQ(image.format, format);
  std::vector<T> values(std::size_t{image.width} * image.height * channels);
  EXPECT_NE(png_image_finish_read(&image, nullptr, values.data(), 0, nullptr), 0);
  return values;
}

// Oracle: by hand.
TEST(RangeImage, HasFirstReturnsAtTheirPixels) {
  const RangeImage image = range_image(small_scan(), {2, 3});
  EXPECT_EQ(image.ranges_m, (std::vector<float>{0, 0, 10.5F, 0.001F, 300, 0}));
  EXPECT_EQ(image.labels, (std::vector<std::uint32_t>{0, 0, 40, 3U << 16 | 50, 12345, 0}));
  EXPECT_THROW(range_image(small_scan(), {2, 2}), std::logic_error);
  EXPECT_THROW(range_image(small_scan(), {1, 3}), std::logic_error);
}

TEST(RangeImage, SizeOfFirings) {
  EXPECT_EQ(image_size_of({}).rings, 0U);
  const Firing firings[] = {{{1, 0, 0}, 4, 7, 0, {}}, {{1, 0, 0}, 1, 9, 0, {}}};
  EXPECT_EQ(image_size_of(firings).rings, 5U);
  EXPECT_EQ(image_size_of(firings).columns, 10U);
}

// Oracle: libpng's reader; KITTI's depth maps have 256 steps a metre.
TEST(RangeImage, Files) {
  const TemporaryFolder folder;
  write_range_image(folder.path(), "000007", range_image(small_scan(), {2, 3}),
                    &semantickitti_labels());
  const std::string npy = read_file(folder.path() / "000007_range.npy");
  EXPECT_NE(npy.find("'<f4', 'fortran_order': False, 'shape': (2, 3), }"), std::string::npos);
  EXPECT_EQ(npy.size(), 128U + 6 * 4);
  EXPECT_NE(read_file(folder.path() / "000007_label.npy").find("'<u4'"), std::string::npos);
  EXPECT_EQ(png_values<std::uint16_t>(folder.path() / "000007_range.png", PNG_FORMAT_LINEAR_Y, 1),
            (std::vector<std::uint16_t>{0, 0, 2688, 1, 65535, 0}));
  const auto pixels =
      png_values<std::uint8_t>(folder.path() / "000007_label.png", PNG_FORMAT_RGB, 3);
  const std::vector<std::uint8_t> expected = {0,   0,   0, 0,   0,   0,   255, 0, 255,
                                              255, 200, 0, 128, 128, 128, 0,   0, 0};
  EXPECT_EQ(pixels, expected);
}

TEST(RangeImage, NoLabelsNoPointsNoPixels) {
  const TemporaryFolder folder;
  Scan scan = small_scan();
  scan.classes.clear();
  scan.instances.clear();
  write_range_image(folder.path(), "a", range_image(scan, {2, 3}), nullptr);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a_label.npy"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "a_range.png"));
  EXPECT_EQ(range_image({}, {1, 2}).ranges_m, (std::vector<float>{0, 0}));
  write_range_image(folder.path(), "b", range_image({}, {0, 0}), nullptr);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "b_range.npy"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "b_range.png"));
}

}  // namespace
}  // namespace adasplats
