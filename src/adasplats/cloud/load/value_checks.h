// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Warns if the coordinates of a file, beyond 10 km from zero, are on steps of more than 1 cm that
/// a loss of digits explains: float32 numbers, or few decimals. Regular grids (equal steps, one
/// point per place) do not count. Looks at 4096 points at most.
void warn_of_steps(const std::filesystem::path& file, std::span<const Vec3d> world,
                   ProgressSink& progress);

/// Whether the intensities of files have a common scale. Those of two files have none if their
/// ranges (2nd to 98th percentile) are apart, and their medians differ by a factor of at least 8.
class IntensityScales {
 public:
  /// Adds the points of a file, or some of them.
  void add(const std::filesystem::path& file, std::span<const float> intensities);
  /// Both ranges with their files; empty: a common scale.
  std::string warning() const;

 private:
  struct Range {
    double low = 0, median = 0, high = 0;
    std::string file, text;
  };
  Range least_, most_;
};

/// Warns if the intensities of two parts have no common scale (IntensityScales).
void warn_of_intensity_scales(std::span<const CloudPart> parts, ProgressSink& progress);

}  // namespace adasplats
