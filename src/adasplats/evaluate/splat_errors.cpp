// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/splat_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr double kMaxError_m = 0.5;  // limit for one beam

/// Throws data unless the beams are of a model with `splats`.
void check(const ErrorPoints& points, std::size_t splats, const std::filesystem::path& path) {
  if (!tells_of_splats(points))
    throw Error(ErrorKind::data, path.string() +
                                     ": has no column 'splat' for the splats that its beams "
                                     "hit; write it again with 'evaluate resimulate --errors'");
  if (points.primitive_count == 0)
    throw Error(ErrorKind::data,
                path.string() +
                    ": has no comment 'adasplats.splats N' with the number of splats of "
                    "its model; write it again with 'evaluate resimulate --errors'");
  if (points.primitive_count != splats)
    throw Error(ErrorKind::data, path.string() + ": the errors are of another model, of " +
                                     std::to_string(points.primitive_count) +
                                     " splats; this one has " + std::to_string(splats));
  for (const std::uint32_t splat : points.primitives)
    if (splat != Hit::kNone && splat >= splats)
      throw Error(ErrorKind::data, path.string() + ": a beam hit splat " + std::to_string(splat) +
                                       " of " + std::to_string(splats));
}

}  // namespace

void SplatErrors::add(const ErrorPoints& points, const std::filesystem::path& path) {
  check(points, counts_.size(), path);
  for (std::size_t i = 0; i < points.primitives.size(); ++i) {
    const std::uint32_t splat = points.primitives[i];
    if (splat == Hit::kNone || std::isnan(points.errors_m[i])) continue;
    sums_m_[splat] +=
        std::clamp(static_cast<double>(points.errors_m[i]), -kMaxError_m, kMaxError_m);
    ++counts_[splat];
  }
}

std::vector<float> SplatErrors::means_m() const {
  std::vector<float> means(counts_.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < means.size(); ++i)
    if (counts_[i] > 0) means[i] = static_cast<float>(sums_m_[i] / counts_[i]);
  return means;
}

}  // namespace adasplats
