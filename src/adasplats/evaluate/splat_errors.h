// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "adasplats/evaluate/error_points.h"

namespace adasplats {

/// Whether a file of errors contains the splat that each beam hit. Distances of clouds and files of
/// other programs do not.
inline bool tells_of_splats(const ErrorPoints& points) { return !points.primitives.empty(); }

/// The mean error of each splat of a model over the beams that hit it.
class SplatErrors {
 public:
  explicit SplatErrors(std::size_t splats) : sums_m_(splats, 0), counts_(splats, 0) {}

  /// Adds the beams of a file, with errors clamped to half a metre. `path`: for messages. Errors:
  /// data (no splats, or splats of another model); then nothing is added.
  void add(const ErrorPoints& points, const std::filesystem::path& path);

  /// One per splat, m, negative: early; NaN if no beam hit it.
  std::vector<float> means_m() const;

 private:
  std::vector<double> sums_m_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace adasplats
