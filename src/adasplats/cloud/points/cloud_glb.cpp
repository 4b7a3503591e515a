// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/points/cloud_glb.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/io/text/glb_points.h"

namespace adasplats {

void save_cloud_glb(const std::filesystem::path& path, const PointCloud& cloud,
                    std::span<const std::array<std::uint8_t, 3>> colors) {
  if (colors.size() != cloud.size())
    throw std::logic_error("save_cloud_glb: not one colour a point");
  GlbPoints content;
  content.extras = R"("origin":)" + json_vector(cloud.origin);
  if (!cloud.crs.empty()) content.extras += R"(,"crs":)" + json_text(cloud.crs.name());
  if (!cloud.crs.wkt.empty()) content.extras += R"(,"crs_wkt":)" + json_text(cloud.crs.wkt);
  if (cloud.empty()) {
    write_glb_points(path, 0, content);
    return;
  }
  const std::vector<GlbColor> linear = linear_colors({colors.begin(), colors.end()});
  std::vector<float> intensities = cloud.intensities;  // glTF allows no NaN
  for (float& value : intensities) value = std::isfinite(value) ? value : 0.0F;
  const Vec3f& p = cloud.positions.front();
  const GlbColor& c = linear.front();
  const auto f32 = [](const float& v) {
    return ColumnView{"", ColumnType::f32, &v, sizeof(Vec3f)};
  };
  const auto u8 = [](const std::uint8_t& v) {
    return ColumnView{"", ColumnType::u8, &v, sizeof(GlbColor)};
  };
  content.attributes = {{"POSITION", {f32(p.x), f32(p.y), f32(p.z)}},
                        {"COLOR_0", {u8(c[0]), u8(c[1]), u8(c[2]), u8(c[3])}, true}};
  if (!intensities.empty())
    content.attributes.push_back(
        {"_INTENSITY", {{"", ColumnType::f32, intensities.data(), sizeof(float)}}});
  static const std::uint16_t kPadding = 0;
  if (!cloud.classes.empty())
    content.attributes.push_back(
        {"_CLASS",
         {{"", ColumnType::u16, cloud.classes.data(), sizeof(std::uint16_t)},
          {"", ColumnType::u16, &kPadding, 0}},
         false,
         1});
  write_glb_points(path, cloud.size(), content);
}

}  // namespace adasplats
