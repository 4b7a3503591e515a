// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adasplats/simulate/image/image.h"
#include "adasplats/simulate/image/shading_maths.h"

namespace adasplats {

/// Input of shade() for a scene and options, in host memory.
class Shading {
 public:
  /// Views of the scene, which must outlive it.
  /// Throws std::logic_error if an attribute does not have the size of the scene.
  Shading(const ImageScene& scene, const ImageOptions& options);

  const ShadingTables& tables() const { return tables_; }

 private:
  ShadingTables tables_;
  std::vector<Vec3f> class_colors_;  ///< by class id; negative: none
};

}  // namespace adasplats
