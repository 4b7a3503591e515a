// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "adasplats/simulate/color_map.h"
#include "adasplats/simulate/image.h"

namespace adasplats {

/// Private to simulate/: the colour that a ray sees.
class Shading {
 public:
  /// Views of the scene and the options, which must outlive it.
  /// Throws std::logic_error where an attribute has another size than the scene.
  Shading(const ImageScene& scene, const ImageOptions& options);

  Vec3f color(const Ray& ray, const Hit& hit) const;

 private:
  Vec3f background(Vec3f direction) const;
  Vec3f normal_towards(const Ray& ray, std::uint32_t primitive) const;
  Vec3f semantic_color(std::uint32_t primitive) const;
  Vec3f intensity_color(std::uint32_t primitive) const;

  const ImageScene& scene_;
  const ImageOptions& options_;
  std::vector<std::optional<Vec3f>> class_colors_;  ///< by class id
  ValueRange intensities_;
};

}  // namespace adasplats
