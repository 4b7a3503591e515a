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
constexpr double kGap_m = 0.5;

/// Root mean square distance of the points from the plane that fits them best.
double roughness_m(std::span<const Vec3d> points) {
  Vec3d mean;
  for (const Vec3d& p : points) mean = mean + p / static_cast<double>(points.size());
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
  const double least = symmetric_eigen(sums).values[2];
  return std::sqrt(std::max(least, 0.0) / static_cast<double>(points.size()));
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
        if (roughness_m(near) <= kFlat_m)
          result[i] = Surroundings::flat;
        else if (have_gap(near))
          result[i] = Surroundings::edge;
      });
  return result;
}

}  // namespace adasplats
