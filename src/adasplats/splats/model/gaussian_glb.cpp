// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/gaussian_glb.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/io/text/glb_points.h"
#include "adasplats/splats/model/gaussians.h"
#include "adasplats/splats/model/model_comments.h"

namespace adasplats {
namespace {

constexpr const char* kSplatting = "KHR_gaussian_splatting";
constexpr const char* kLidar = "EXT_gaussian_lidar";

struct GlbGaussian {
  Vec3f position;
  GlbColor color;
  std::array<float, 4> rotation;  ///< x y z w
  std::array<float, 3> scales;    ///< m
  std::array<float, 3> log_scales;
  float opacity = 1;
  std::array<float, 3> harmonics;
  float intensity = 0, drop = 0;
  std::uint16_t class_id = 0, group = 0, padding = 0;
  std::uint8_t intensity_byte = 0, drop_byte = 0;
};

/// 1, or what is full scale in models with larger intensities.
float full_scale(const SplatModel& model) {
  float highest = 0;
  for (const float value : model.intensities)
    if (std::isfinite(value)) highest = std::max(highest, value);
  return highest <= 1 ? 1.0F : (highest <= 255 ? 255.0F : 65535.0F);
}

std::uint8_t byte_of(float share) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0F, 1.0F)));
}

std::vector<GlbGaussian> gaussians_of(const SplatModel& model,
                                      std::span<const std::array<std::uint8_t, 3>> colors) {
  const std::vector<GlbColor> linear = linear_colors({colors.begin(), colors.end()});
  const bool is_soft = !model.opacities.empty();
  const float full = full_scale(model);
  std::vector<GlbGaussian> all(model.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Disk& disk = model.disks[i];
    GlbGaussian& made = all[i];
    made.position = disk.center;
    if (is_soft) made.opacity = model.opacities[i];
    made.color = linear[i];
    made.color[3] = byte_of(made.opacity);
    const Quaternion q = rotation_from_z(vec_cast<double>(disk.normal));
    made.rotation = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
                     static_cast<float>(q.w)};
    const double sigma = gaussian_sigma(disk, is_soft);
    made.scales = {static_cast<float>(sigma), static_cast<float>(sigma),
                   static_cast<float>(kGaussianThickness * sigma)};
    for (std::size_t k = 0; k < 3; ++k) {
      made.log_scales[k] = std::log(made.scales[k]);
      made.harmonics[k] = harmonic_of(colors[i][k]);
    }
    if (!model.classes.empty()) made.class_id = model.classes[i];
    if (!model.groups.empty()) made.group = static_cast<std::uint16_t>(model.groups[i]);
    if (!model.intensities.empty()) {
      // glTF allows no NaN.
      made.intensity = std::isfinite(model.intensities[i]) ? model.intensities[i] : 0.0F;
      made.intensity_byte = byte_of(made.intensity / full);
    }
    if (!model.drop_log_odds.empty()) {
      made.drop = model.drop_log_odds[i];
      made.drop_byte = byte_of(1 / (1 + std::exp(-made.drop)));
    }
  }
  return all;
}

ColumnView column(const float& v) { return {"", ColumnType::f32, &v, sizeof(GlbGaussian)}; }
ColumnView column(const std::uint8_t& v) { return {"", ColumnType::u8, &v, sizeof(GlbGaussian)}; }
ColumnView column(const std::uint16_t& v) { return {"", ColumnType::u16, &v, sizeof(GlbGaussian)}; }

template <class Values>
std::vector<ColumnView> columns(const Values& values) {
  std::vector<ColumnView> all;
  all.reserve(values.size());
  for (const auto& value : values) all.push_back(column(value));
  return all;
}

void add_attributes(const SplatModel& model, const GlbGaussian& g, GlbPoints& content) {
  std::vector<GlbAttribute>& all = content.attributes;
  const std::string prefix = std::string(kSplatting) + ":";
  all.push_back({"POSITION", {column(g.position.x), column(g.position.y), column(g.position.z)}});
  all.push_back({"COLOR_0", columns(g.color), true});
  all.push_back({prefix + "ROTATION", columns(g.rotation)});
  all.push_back({prefix + "SCALE", columns(g.scales)});
  all.push_back({prefix + "OPACITY", {column(g.opacity)}});
  all.push_back({prefix + "SH_DEGREE_0_COEF_0", columns(g.harmonics)});
  all.push_back({"_LOG_SCALE", columns(g.log_scales)});
  // The numbers of accessors are for 3dgs_io, which takes nothing else.
  content.primitive = std::string(R"(,"extensions":{")") + kSplatting +
                      R"(":{"kernel":"ellipse","colorSpace":"srgb_rec709_display",)"
                      R"("rotation":2,"scale":6,"opacity":4,"sh":[5]})";
  content.extensions = {kSplatting};
  if (!model.classes.empty())
    all.push_back({"_CLASS", {column(g.class_id), column(g.padding)}, false, 1});
  if (!model.groups.empty())
    all.push_back({"_GROUP", {column(g.group), column(g.padding)}, false, 1});
  std::string lidar;
  const auto add_lidar = [&](const char* name, const std::uint8_t& first) {
    lidar +=
        (lidar.empty() ? "\"" : ",\"") + std::string(name) + "\":" + std::to_string(all.size());
    all.push_back({"", {column(first)}, true});
  };
  if (!model.intensities.empty()) {
    all.push_back({"_INTENSITY", {column(g.intensity)}});
    add_lidar("lidar_intensity_raw", g.intensity_byte);
  }
  if (!model.drop_log_odds.empty()) {
    all.push_back({"_DROP", {column(g.drop)}});
    add_lidar("lidar_raydrop_logit", g.drop_byte);
  }
  if (!lidar.empty()) {
    content.primitive += std::string(",\"") + kLidar + "\":{" + lidar + "}";
    content.extensions.emplace_back(kLidar);
  }
  content.primitive += "}";
}

}  // namespace

void write_gaussian_glb(const std::filesystem::path& path, const SplatModel& model,
                        std::span<const std::array<std::uint8_t, 3>> colors) {
  if (colors.size() != model.size())
    throw std::logic_error("write_gaussian_glb: the number of colours is not the number of disks");
  GlbPoints content;
  content.extras = R"("origin":)" + json_vector(model.origin) + R"(,"adasplats":[)";
  std::string comments;
  for (const std::string& comment : comments_of(model))
    comments += (comments.empty() ? "" : ",") + json_text(comment);
  content.extras += comments + "]";
  if (!model.crs.empty()) content.extras += R"(,"crs":)" + json_text(model.crs.name());
  const std::vector<GlbGaussian> gaussians = gaussians_of(model, colors);
  if (!gaussians.empty()) add_attributes(model, gaussians.front(), content);
  write_glb_points(path, gaussians.size(), content);
}

}  // namespace adasplats
