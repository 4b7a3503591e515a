// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/beam_surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "adasplats/core/maths/symmetric_eigen.h"
#include "adasplats/neighbors/point_index.h"

namespace adasplats {
namespace {

constexpr std::uint32_t kBeams = 9;  // with the beam itself
constexpr double kFlat_m = 0.03;
constexpr double kFlatRange_m = 0.1;
constexpr double kGap_m = 0.5;

/// Whether the points are on a plane, also as measured along the beam: one that nearly contains the
/// beam fits any points that are close together for the sensor.
bool are_flat(std::span<const Vec3d> points, Vec3d direction) {
  const double count = static_cast<double>(points.size());
  Vec3d mean;
  for (const Vec3d& p : points) mean = mean + p / count;
  SymmetricMat3d sums;
  for (const Vec3d& p : points) {
    const Vec3d d = p - mean;
    sums.xx += d.x * d.x;
    sums.xy += d.x * d.y;
    sums.xz += d.x * d.z;
    sums.yy += d.y * d.y;
    sums.yz += d.y * d.z;
    sums.zz += d.z * d.z;
  }
  const SymmetricEigen eigen = symmetric_eigen(sums);
  const double distance_m = std::sqrt(std::max(eigen.values[2], 0.0) / count);
  const double cosine = std::fabs(dot(eigen.vectors[2], direction));
  return distance_m <= kFlat_m && distance_m <= cosine * kFlatRange_m;
}

bool have_gap(std::span<const Vec3d> points) {
  std::array<double, kBeams> ranges_m;  // NOLINT: filled here
  for (std::size_t k = 0; k < points.size(); ++k) ranges_m[k] = length(points[k]);
  const auto all = std::span(ranges_m).first(points.size());
  std::ranges::sort(all);
  const auto is_gap = [](double a, double b) { return b - a > kGap_m; };
  return std::ranges::adjacent_find(all, is_gap) != all.end();
}

}  // namespace

std::string_view name_of(Surroundings surroundings) {
  constexpr std::array<std::string_view, kSurroundings> kNames = {"flat", "rough", "edge"};
  return kNames[static_cast<std::size_t>(surroundings)];
}

std::vector<Surroundings> surroundings_of(std::span<const Vec3f> points, const Executor& executor) {
  std::vector<Surroundings> result(points.size(), Surroundings::rough);
  std::vector<Vec3f> directions;
  for (const Vec3f& p : points) directions.push_back(length(p) > 0 ? p / length(p) : Vec3f{});
  const PointIndex index(directions, executor);
  index.for_each_neighborhood(
      executor, [](std::uint32_t) { return NeighborLimit{kBeams}; },
      [&](std::uint32_t rank, const NeighborList& neighbors) {
        std::array<Vec3d, kBeams> of_beams;
        for (std::uint32_t k = 0; k < neighbors.size; ++k)
          of_beams[k] = vec_cast<double>(points[index.index_of(neighbors.ranks[k])]);
        const auto near = std::span<const Vec3d>(of_beams).first(neighbors.size);
        const std::uint32_t i = index.index_of(rank);
        if (!(length(points[i]) > 0)) return;
        if (are_flat(near, vec_cast<double>(directions[i])))
          result[i] = Surroundings::flat;
        else if (have_gap(near))
          result[i] = Surroundings::edge;
      });
  return result;
}

}  // namespace adasplats
