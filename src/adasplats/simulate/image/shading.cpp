// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/shading.h"

#include <stdexcept>
#include <string>

#include "adasplats/simulate/image/class_colors.h"

namespace adasplats {

namespace {

constexpr Vec3f kNoColor = {-1, -1, -1};

void check_size(std::size_t values, std::size_t primitives, const char* name) {
  if (values != 0 && values != primitives)
    throw std::logic_error(std::string("an image's ") + name +
                           " must have one value per primitive");
}

template <class T>
const T* data_or_null(std::span<const T> values) {
  return values.empty() ? nullptr : values.data();
}

}  // namespace

ValueRange shown_range(const ImageScene& scene, ImageColor color) {
  constexpr double kLow = 0.02, kHigh = 0.98;
  if (color == ImageColor::intensity)
    return quantile_range(scene.attributes.intensities, kLow, kHigh);
  if (color != ImageColor::height) return {};
  std::vector<float> heights;
  for (const Disk& disk : scene.view.disks) heights.push_back(disk.center.z);
  if (scene.view.mesh != nullptr)
    for (const Vec3f& vertex : scene.view.mesh->vertices) heights.push_back(vertex.z);
  return quantile_range(heights, kLow, kHigh);
}

Shading::Shading(const ImageScene& scene, const ImageOptions& options) {
  const std::size_t primitives = scene.view.primitive_count();
  check_size(scene.attributes.classes.size(), primitives, "classes");
  check_size(scene.attributes.intensities.size(), primitives, "intensities");
  check_size(scene.colors.size(), primitives, "colors");
  check_size(scene.groups.size(), primitives, "groups");
  tables_.disks = scene.view.disks.data();
  tables_.disk_count = static_cast<std::uint32_t>(scene.view.disk_count());
  if (scene.view.mesh != nullptr) {
    tables_.vertices = scene.view.mesh->vertices.data();
    tables_.triangles = scene.view.mesh->triangles.data();
  }
  tables_.classes = data_or_null(scene.attributes.classes);
  tables_.groups = data_or_null(scene.groups);
  tables_.intensities = data_or_null(scene.attributes.intensities);
  tables_.colors = data_or_null(scene.colors);
  tables_.color = options.color;
  tables_.range = options.range.value_or(shown_range(scene, options.color));
  if (scene.labels == nullptr) return;
  for (const SemanticClass& known : scene.labels->classes()) {
    if (known.rgb == kNoClassColor) continue;
    if (known.id >= class_colors_.size()) class_colors_.resize(known.id + std::size_t{1}, kNoColor);
    class_colors_[known.id] = color_of(muted(known.rgb));
  }
  tables_.class_colors = class_colors_.data();
  tables_.class_color_count = static_cast<std::uint32_t>(class_colors_.size());
}

}  // namespace adasplats
