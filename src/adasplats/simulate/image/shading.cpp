// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/shading.h"

#include <stdexcept>
#include <string>

namespace adasplats {

namespace {

/// Label schemes give black to what has no class; a black surface would show no shape.
constexpr std::array<std::uint8_t, 3> kUnlabelled = {0, 0, 0};
constexpr Vec3f kNoColor = {-1, -1, -1};

void check_size(std::size_t values, std::size_t primitives, const char* name) {
  if (values != 0 && values != primitives)
    throw std::logic_error(std::string("an image's ") + name + " are not one a primitive");
}

template <class T>
const T* data_or_null(std::span<const T> values) {
  return values.empty() ? nullptr : values.data();
}

}  // namespace

Shading::Shading(const ImageScene& scene, const ImageOptions& options) {
  const std::size_t primitives = scene.view.primitive_count();
  check_size(scene.attributes.classes.size(), primitives, "classes");
  check_size(scene.attributes.intensities.size(), primitives, "intensities");
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
  tables_.color = options.color;
  tables_.background = color_of(options.background);
  tables_.sky = options.sky;
  if (options.color == ImageColor::intensity)
    tables_.intensity_range = quantile_range(scene.attributes.intensities, 0.02, 0.98);
  if (scene.labels == nullptr) return;
  for (const SemanticClass& known : scene.labels->classes()) {
    if (known.rgb == kUnlabelled) continue;
    if (known.id >= class_colors_.size()) class_colors_.resize(known.id + std::size_t{1}, kNoColor);
    class_colors_[known.id] = color_of(known.rgb);
  }
  tables_.class_colors = class_colors_.data();
  tables_.class_color_count = static_cast<std::uint32_t>(class_colors_.size());
}

}  // namespace adasplats
