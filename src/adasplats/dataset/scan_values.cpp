// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/scan_values.h"

namespace adasplats {

std::vector<float> points_with_intensity(const Scan& scan) {
  std::vector<float> values;
  values.reserve(4 * scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vec3f p = scan.positions[i];
    const float intensity = scan.intensities.empty() ? 0.0F : scan.intensities[i];
    values.insert(values.end(), {p.x, p.y, p.z, intensity});
  }
  return values;
}

std::vector<std::uint32_t> packed_labels(const Scan& scan) {
  std::vector<std::uint32_t> labels(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const std::uint32_t instance = scan.instances.empty() ? 0 : scan.instances[i];
    const std::uint32_t semantic_class = scan.classes.empty() ? 0 : scan.classes[i];
    labels[i] = instance << 16 | semantic_class;
  }
  return labels;
}

}  // namespace adasplats
