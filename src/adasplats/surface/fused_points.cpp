// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/fused_points.h"

#include <algorithm>
#include <cmath>

#include "adasplats/neighbors/hilbert.h"

namespace adasplats {
namespace {

constexpr std::size_t kGrain = 65536;
constexpr double kMostCells = 1048575;  // 2^20 - 1 on either side of zero: 21 bits an axis

std::uint64_t axis_key(float value, double cell_m) {
  const double cell = std::floor(static_cast<double>(value) / cell_m);
  return static_cast<std::uint64_t>(std::clamp(cell, -kMostCells, kMostCells) + kMostCells);
}

/// Points sorted by cell, and where each cell begins.
struct Cells {
  std::vector<std::uint32_t> begins;
  std::vector<std::uint32_t> members;
};

Cells sort_into_cells(std::span<const Vec3f> points, double cell_m, const Executor& executor) {
  std::vector<std::uint64_t> keys(points.size());
  executor.for_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      keys[i] = axis_key(points[i].x, cell_m) << 42 | axis_key(points[i].y, cell_m) << 21 |
                axis_key(points[i].z, cell_m);
    }
  });
  Cells cells;
  executor.sort_keys(keys, cells.members);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i == 0 || keys[i] != keys[i - 1]) cells.begins.push_back(static_cast<std::uint32_t>(i));
  }
  cells.begins.push_back(static_cast<std::uint32_t>(keys.size()));
  return cells;
}

Vec3f mean_of(std::span<const Vec3f> points, std::span<const std::uint32_t> members) {
  Vec3d sum;
  for (const std::uint32_t i : members) sum = sum + vec_cast<double>(points[i]);
  return vec_cast<float>(sum / static_cast<double>(members.size()));
}

}  // namespace

FusedPoints fuse_points(std::span<const Vec3f> points, double cell_m, const Executor& executor) {
  const Cells cells = sort_into_cells(points, cell_m, executor);
  const std::size_t count = cells.begins.size() - 1;
  const auto members_of = [&](std::size_t cell) {
    return std::span(cells.members)
        .subspan(cells.begins[cell], cells.begins[cell + 1] - cells.begins[cell]);
  };
  std::vector<Vec3f> means(count);
  executor.for_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      means[cell] = mean_of(points, members_of(cell));
    }
  });

  FusedPoints fused;
  fused.positions.reserve(count);
  fused.members.reserve(points.size());
  fused.begins.reserve(count + 1);
  for (const std::uint32_t cell : hilbert_order(means, executor)) {
    fused.positions.push_back(means[cell]);
    fused.begins.push_back(static_cast<std::uint32_t>(fused.members.size()));
    const auto members = members_of(cell);
    fused.members.insert(fused.members.end(), members.begin(), members.end());
  }
  fused.begins.push_back(static_cast<std::uint32_t>(fused.members.size()));
  return fused;
}

}  // namespace adasplats
