// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/points/cloud_glb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

/// A .glb taken apart by section 4.4 of the specification.
struct Glb {
  nlohmann::json json;
  std::string binary;

  template <class T>
  T at(const std::string& attribute, std::size_t point, std::size_t component = 0) const {
    const auto& place = json["meshes"][0]["primitives"][0]["attributes"][attribute];
    const auto& accessor = json["accessors"][place.get<std::size_t>()];
    const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const auto stride = view["byteStride"].get<std::size_t>();
    T value;
    std::memcpy(&value,
                binary.data() + point * stride + view["byteOffset"].get<std::size_t>() +
                    component * sizeof(T),
                sizeof(T));
    return value;
  }
};

Glb written(const PointCloud& cloud, const std::vector<Rgb>& colors) {
  const TemporaryFolder folder;
  save_cloud_glb(folder.path() / "a.glb", cloud, colors);
  const std::string file = read_file(folder.path() / "a.glb");
  const auto word = [&file](std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + offset, sizeof(value));
    return value;
  };
  EXPECT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2U);
  EXPECT_EQ(word(8), file.size());
  const std::uint32_t json_bytes = word(12);
  EXPECT_EQ(json_bytes % 4, 0U);
  EXPECT_EQ(word(16), 0x4e4f534aU);
  Glb glb{nlohmann::json::parse(file.substr(20, json_bytes)), ""};
  const std::size_t binary = 20 + json_bytes;
  if (binary < file.size()) {
    EXPECT_EQ(word(binary + 4), 0x004e4942U);
    glb.binary = file.substr(binary + 8);
    EXPECT_EQ(glb.binary.size(), word(binary));
    EXPECT_EQ(glb.binary.size(), glb.json["buffers"][0]["byteLength"].get<std::size_t>());
  }
  return glb;
}

TEST(CloudGlb, EveryAttribute) {
  PointCloud cloud;
  cloud.origin = {448000, 5411000, 0};
  cloud.crs = crs_of_wkt("PROJCS[\"UTM 32N\",AUTHORITY[\"EPSG\",\"32632\"]]");
  cloud.positions = {{0.1F, 2, -3}, {-4, 5.5F, 0.3F}, {1, 1, 1}};
  cloud.intensities = {0.25F, std::numeric_limits<float>::quiet_NaN(), 255};
  cloud.classes = {40, 65535, 0};
  const std::vector<Rgb> colors = {{0, 128, 255}, {1, 2, 3}, {10, 188, 50}};
  const Glb glb = written(cloud, colors);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(glb.at<float>("POSITION", i, static_cast<std::size_t>(k)), cloud.positions[i][k]);
    EXPECT_EQ(glb.at<std::uint8_t>("COLOR_0", i, 3), 255);
    EXPECT_EQ(glb.at<std::uint16_t>("_CLASS", i), cloud.classes[i]);
  }
  EXPECT_EQ(glb.at<float>("_INTENSITY", 0), 0.25F);
  EXPECT_EQ(glb.at<float>("_INTENSITY", 1), 0.0F);
  // sRGB 128 and 188 are 0.216 and 0.503 of the light (published tables of the curve).
  EXPECT_EQ(glb.at<std::uint8_t>("COLOR_0", 0, 0), 0);
  EXPECT_EQ(glb.at<std::uint8_t>("COLOR_0", 0, 1), 55);
  EXPECT_EQ(glb.at<std::uint8_t>("COLOR_0", 0, 2), 255);
  EXPECT_EQ(glb.at<std::uint8_t>("COLOR_0", 2, 1), 128);
  // The bounds are floats exactly.
  const auto& accessor = glb.json["accessors"][0];
  EXPECT_EQ(accessor["min"][2].get<double>(), -3.0);
  EXPECT_EQ(accessor["max"][2].get<double>(), 1.0);
  EXPECT_EQ(accessor["min"][0].get<double>(), -4.0);
  EXPECT_EQ(glb.json["nodes"][0]["extras"]["origin"], (nlohmann::json{448000, 5411000, 0}));
  EXPECT_EQ(glb.json["nodes"][0]["extras"]["crs"], cloud.crs.name());
  EXPECT_EQ(glb.json["nodes"][0]["extras"]["crs_wkt"], cloud.crs.wkt);
}

// Oracle: the specification (y up, z forward, x left) and Hamilton's product.
TEST(CloudGlb, AxesAreTurned) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  const Glb glb = written(cloud, std::vector<Rgb>(1));
  const auto q = glb.json["nodes"][0]["rotation"].get<std::vector<double>>();
  const Vec3d p = rotation_from_quaternion(q[3], q[0], q[1], q[2]) * Vec3d{1, 2, 3};
  EXPECT_EQ(p, (Vec3d{2, 3, 1}));
}

TEST(CloudGlb, PositionsAloneAndNoPoints) {
  PointCloud cloud;
  cloud.positions = {{0.1F, 0.2F, 0.3F}};
  const Glb one = written(cloud, std::vector<Rgb>(1));
  EXPECT_EQ(one.json["accessors"].size(), 2U);
  EXPECT_EQ(static_cast<float>(one.json["accessors"][0]["max"][0].get<double>()), 0.1F);
  const Glb none = written({}, {});
  EXPECT_FALSE(none.json.contains("meshes"));
  EXPECT_TRUE(none.binary.empty());
  const TemporaryFolder folder;
  EXPECT_THROW(save_cloud_glb(folder.path() / "a.glb", cloud, {}), std::logic_error);
}

}  // namespace
}  // namespace adasplats
