// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/gaussian_ply.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/base/number_text.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/splats/model/gaussians.h"
#include "adasplats/splats/model/model_comments.h"

namespace adasplats {
namespace {

struct Gaussian {
  Vec3f position, normal;
  std::array<float, 3> color;
  float opacity;
  std::array<float, 3> scales;
  std::array<float, 4> rotation;
};

Gaussian gaussian_of(const Disk& disk, double sigma, double opacity,
                     const std::array<std::uint8_t, 3>& rgb) {
  const double log_sigma = std::log(sigma);
  const auto along = static_cast<float>(log_sigma);
  const Quaternion q = rotation_from_z(vec_cast<double>(disk.normal));
  return {disk.center,
          disk.normal,
          {harmonic_of(rgb[0]), harmonic_of(rgb[1]), harmonic_of(rgb[2])},
          static_cast<float>(std::log(opacity / (1 - opacity))),
          {along, along, static_cast<float>(log_sigma + std::log(kGaussianThickness))},
          {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
           static_cast<float>(q.z)}};
}

std::vector<ColumnView> columns_of(const Gaussian* first, GaussianKind kind) {
  std::vector<ColumnView> columns;
  const auto add = [&](std::string_view name, const float& value) {
    columns.push_back({name, ColumnType::f32, &value, sizeof(Gaussian)});
  };
  const Gaussian& g = *first;
  add("x", g.position.x);
  add("y", g.position.y);
  add("z", g.position.z);
  add("nx", g.normal.x);
  add("ny", g.normal.y);
  add("nz", g.normal.z);
  add("f_dc_0", g.color[0]);
  add("f_dc_1", g.color[1]);
  add("f_dc_2", g.color[2]);
  add("opacity", g.opacity);
  add("scale_0", g.scales[0]);
  add("scale_1", g.scales[1]);
  if (kind == GaussianKind::volumes) add("scale_2", g.scales[2]);
  add("rot_0", g.rotation[0]);
  add("rot_1", g.rotation[1]);
  add("rot_2", g.rotation[2]);
  add("rot_3", g.rotation[3]);
  return columns;
}

}  // namespace

void write_gaussian_ply(const std::filesystem::path& path, const SplatModel& model,
                        std::span<const std::array<std::uint8_t, 3>> colors, GaussianKind kind) {
  if (colors.size() != model.size())
    throw std::logic_error("write_gaussian_ply: the number of colours is not the number of disks");
  std::vector<Gaussian> gaussians;
  gaussians.reserve(model.size());
  constexpr double kLeast = 1.0 / 255;  // what renderers skip
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Disk& disk = model.disks[i];
    const bool is_soft = !model.opacities.empty();
    const double opacity =
        is_soft ? std::clamp(static_cast<double>(model.opacities[i]), kLeast, kGaussianOpacity)
                : kGaussianOpacity;
    gaussians.push_back(gaussian_of(disk, gaussian_sigma(disk, is_soft), opacity, colors[i]));
  }
  const Vec3d o = model.origin;
  std::vector<std::string> comments = comments_of(model);
  comments.insert(comments.begin(), std::string("adasplats.origin ") + exact_text(o.x) + " " +
                                        exact_text(o.y) + " " + exact_text(o.z));
  const Gaussian none{};
  write_ply(path, gaussians.size(), columns_of(gaussians.empty() ? &none : gaussians.data(), kind),
            comments);
}

}  // namespace adasplats
