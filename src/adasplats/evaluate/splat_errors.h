// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "adasplats/evaluate/error_points.h"

namespace adasplats {

/// Whether a file of errors says which splat each beam hit. Distances of clouds do not, nor do
/// files of other programs.
inline bool tells_of_splats(const ErrorPoints& points) { return !points.primitives.empty(); }

/// The mean error of each splat of a model over the beams that hit it.
class SplatErrors {
 public:
  explicit SplatErrors(std::size_t splats) : sums_m_(splats, 0), counts_(splats, 0) {}

  /// Counts the beams of a file; single ones count for at most half a metre. `path`: of it, for
  /// messages. Errors: data (its beams are not said to have hit splats, or hit other ones than a
  /// model of as many has); then nothing of it counts.
  void add(const ErrorPoints& points, const std::filesystem::path& path);

  /// One a splat, m, early below 0; NaN where no beam hit it.
  std::vector<float> means_m() const;

 private:
  std::vector<double> sums_m_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace adasplats
