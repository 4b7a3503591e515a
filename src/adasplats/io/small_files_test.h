// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/io/base/files_test.h"
#include "adasplats/io/e57/e57_file_test.h"
#include "adasplats/io/laz/laz_samples_test.h"

// What the tests with broken files and the fuzz targets begin with.
namespace adasplats::io_test {

/// A valid file.
struct Seed {
  std::string name;
  std::string content;
};

inline std::string las_seed(int minor, int format, std::size_t record_bytes) {
  const std::size_t header_bytes = minor == 4 ? 375 : 227;
  std::string content(header_bytes + 54 + 5 * record_bytes, '\0');
  put(content, 0, std::uint32_t{0x4653414c});
  put(content, 24, std::uint8_t{1});
  put(content, 25, static_cast<std::uint8_t>(minor));
  put(content, 94, static_cast<std::uint16_t>(header_bytes));
  put(content, 96, static_cast<std::uint32_t>(header_bytes + 54));
  put(content, 100, std::uint32_t{1});
  put(content, 104, static_cast<std::uint8_t>(format));
  put(content, 105, static_cast<std::uint16_t>(record_bytes));
  put(content, 107, std::uint32_t{5});
  for (std::size_t axis = 0; axis < 3; ++axis) put(content, 131 + 8 * axis, 0.01);
  return content;
}

/// Scans of floats and of packed integers, with poses.
inline std::string e57_seed() {
  E57Composer composer;
  const std::string reals = stream_of<double>({1, 2, 3});
  composer.add_scan(3, xyz_fields(), {reals, reals, reals},
                    pose_element({"1", "0", "0", "0", "1", "2", "3"}), 10);
  const std::string fields =
      integer_field("sphericalRange", 1, 1000, "scale=\"0.01\"") +
      float_field("sphericalAzimuth", true) + integer_field("sphericalElevation", 0, 2) +
      integer_field("intensity", 5, 5) + integer_field("sphericalInvalidState", 0, 2);
  composer.add_scan(4, fields, {"abcde", stream_of<float>({0, 1, 2, 3}), "a", "", "b"},
                    "<name><![CDATA[b]]></name>", 3);
  return composer.file();
}

/// Small files of every format of points.
inline std::vector<Seed> small_seeds() {
  const std::string mesh =
      "comment c\nelement vertex 3\nproperty float x\nproperty double y\nproperty uchar z\n"
      "element face 2\nproperty list uchar int vertex_indices\nproperty short c\nend_header\n";
  const std::string ascii_mesh = mesh + "1 2 3\n4 5.5 6\n-7 8e3 9\n3 0 1 2 5\n4 2 1 0 1 6\n";
  std::string binary_mesh = mesh;
  for (int k = 0; k < 3; ++k) binary_mesh += bytes_of(1.0F) + bytes_of(2.0) + "3";
  binary_mesh += "\3" + bytes_of(0) + bytes_of(1) + bytes_of(2) + "ab";
  binary_mesh += "\3" + bytes_of(2) + bytes_of(1) + bytes_of(0) + "cd";
  const std::string pcd =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x _ n\nSIZE 4 1 2\nTYPE F U I\n"
      "COUNT 1 3 2\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";
  const std::string lzf = std::string(
                              "\x03"
                              "abcd\x60\x03",
                              7) +
                          std::string("\x20\x00", 2) +
                          std::string(
                              "\x09"
                              "0123456789",
                              11);
  std::vector<Seed> seeds = {
      {"a.ply", "ply\nformat ascii 1.0\n" + ascii_mesh},
      {"a.ply", "ply\nformat binary_little_endian 1.0\n" + binary_mesh},
      {"a.ply", "ply\nformat binary_big_endian 1.0\n" + binary_mesh},
      {"a.pcd", pcd + "DATA ascii\n1.5 1 2 3 4 5\nnan 1 2 3 4 5\n"},
      {"a.pcd", pcd + "DATA binary\n" + std::string(22, 'b')},
      {"a.pcd", pcd + "DATA binary_compressed\n" +
                    bytes_of(static_cast<std::uint32_t>(lzf.size())) + bytes_of(22U) + lzf},
      {"a.las", las_seed(2, 3, 34)},
      {"a.las", las_seed(4, 7, 40)},
      {"a.xyz", "# x y z\n1 2 3\n4 5.5 -6e3\n"},
      {"a.pts", "2\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n"},
      {"a.csv", "x,y,z,\"t\"\n1,2,3,\n4,5,6,7\n"},
      {"a.ptx",
       "1\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n9 9 9 1\n"
       "1 2 3 0.5\n0 0 0 0.5\n"},
      {"a.e57", e57_seed()},
      {"a.bin", std::string(64, '?')}};
  for (const laz_test::LazSample& sample : laz_test::kLazSamples)
    seeds.push_back({"a.laz", laz_test::laz_file(sample)});
  return seeds;
}

}  // namespace adasplats::io_test
