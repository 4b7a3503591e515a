// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/scan_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "adasplats/core/maths/symmetric_eigen.h"

namespace adasplats {
namespace {

constexpr int kHalvings = 3;
constexpr int kBitsOfAxis = 21;
constexpr double kMostCells = double{1 << kBitsOfAxis} - 1;

/// Spreads 21 bits to every third bit.
std::uint64_t every_third_bit(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  return (v | v << 2) & 0x1249249249249249ULL;
}

/// Cells of the smallest size along a Morton curve, so that a larger one is a run of keys.
std::vector<std::uint64_t> cell_keys(std::span<const Vec3d> positions, double cell_m,
                                     const Executor& executor) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3d low = {kFar, kFar, kFar};
  for (const Vec3d p : positions) low = min(low, p);
  std::vector<std::uint64_t> keys(positions.size());
  executor.for_chunks(positions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::uint64_t key = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double cell = std::floor((positions[i][axis] - low[axis]) / cell_m);
        key |= every_third_bit(static_cast<std::uint64_t>(std::clamp(cell, 0.0, kMostCells)))
               << axis;
      }
      keys[i] = key;
    }
  });
  return keys;
}

/// Looks for planes in runs of sorted keys.
class Search {
 public:
  Search(std::span<const Vec3d> positions, std::span<const std::uint32_t> scans,
         std::span<const std::uint64_t> keys, std::span<const std::uint32_t> order,
         const ScanPlaneOptions& options)
      : positions_(positions), scans_(scans), keys_(keys), order_(order), options_(options) {}

  /// The plane of [begin, end), or those of its eight parts.
  void look(std::size_t begin, std::size_t end, int halvings, ScanPlanes& found) const {
    if (end - begin < options_.least_points) return;
    if (const auto plane = plane_of(begin, end)) {
      const auto first = static_cast<std::uint32_t>(found.points.size());
      found.points.insert(found.points.end(), order_.begin() + static_cast<std::ptrdiff_t>(begin),
                          order_.begin() + static_cast<std::ptrdiff_t>(end));
      found.planes.push_back(*plane);
      found.planes.back().begin = first;
      found.planes.back().end = static_cast<std::uint32_t>(found.points.size());
      return;
    }
    if (halvings == 0) return;
    for_each_run(begin, end, 3 * (halvings - 1),
                 [&](std::size_t from, std::size_t to) { look(from, to, halvings - 1, found); });
  }

  /// Calls body(begin, end) for the runs whose keys are equal but for the low `bits`.
  template <class Body>
  void for_each_run(std::size_t begin, std::size_t end, int bits, Body&& body) const {
    while (begin < end) {
      const std::uint64_t cell = keys_[begin] >> bits;
      const auto behind =
          std::partition_point(keys_.begin() + static_cast<std::ptrdiff_t>(begin),
                               keys_.begin() + static_cast<std::ptrdiff_t>(end),
                               [&](std::uint64_t key) { return key >> bits == cell; });
      const auto next = static_cast<std::size_t>(behind - keys_.begin());
      body(begin, next);
      begin = next;
    }
  }

 private:
  std::optional<ScanPlane> plane_of(std::size_t begin, std::size_t end) const {
    if (!has_scans(begin, end)) return std::nullopt;
    const double n = static_cast<double>(end - begin);
    Vec3d mean;
    for (std::size_t k = begin; k < end; ++k) mean = mean + positions_[order_[k]];
    mean = mean / n;
    SymmetricMat3d spread{};
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3d d = positions_[order_[k]] - mean;
      spread.xx += d.x * d.x / n;
      spread.xy += d.x * d.y / n;
      spread.xz += d.x * d.z / n;
      spread.yy += d.y * d.y / n;
      spread.yz += d.y * d.z / n;
      spread.zz += d.z * d.z / n;
    }
    const SymmetricEigen eigen = symmetric_eigen(spread);
    const double across_m = std::sqrt(std::max(0.0, eigen.values[2]));
    const double along_m = std::sqrt(std::max(0.0, eigen.values[1]));
    if (!(across_m <= options_.flatness_m) || !(across_m <= options_.shape * along_m))
      return std::nullopt;
    return ScanPlane{mean, eigen.vectors[2], {eigen.vectors[0], eigen.vectors[1]}, 0, 0};
  }

  bool has_scans(std::size_t begin, std::size_t end) const {
    std::vector<std::uint32_t> seen;
    for (std::size_t k = begin; k < end && seen.size() < options_.least_scans; ++k) {
      const std::uint32_t scan = scans_[order_[k]];
      if (std::ranges::find(seen, scan) == seen.end()) seen.push_back(scan);
    }
    return seen.size() >= options_.least_scans;
  }

  std::span<const Vec3d> positions_;
  std::span<const std::uint32_t> scans_;
  std::span<const std::uint64_t> keys_;
  std::span<const std::uint32_t> order_;
  const ScanPlaneOptions& options_;
};

}  // namespace

ScanPlanes find_scan_planes(std::span<const Vec3d> positions, std::span<const std::uint32_t> scans,
                            const ScanPlaneOptions& options, const Executor& executor) {
  std::vector<std::uint64_t> keys =
      cell_keys(positions, options.largest_cell_m / (1 << kHalvings), executor);
  std::vector<std::uint32_t> order;
  executor.sort_keys(keys, order);
  const Search search(positions, scans, keys, order, options);
  std::vector<std::size_t> begins;
  search.for_each_run(0, keys.size(), 3 * kHalvings,
                      [&](std::size_t begin, std::size_t) { begins.push_back(begin); });
  begins.push_back(keys.size());
  constexpr std::size_t kCellsOfChunk = 64;
  const std::size_t cells = begins.size() - 1;
  std::vector<ScanPlanes> parts((cells + kCellsOfChunk - 1) / kCellsOfChunk);
  executor.for_chunks(cells, kCellsOfChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell)
      search.look(begins[cell], begins[cell + 1], kHalvings, parts[begin / kCellsOfChunk]);
  });
  ScanPlanes all;
  for (const ScanPlanes& part : parts) {
    const auto shift = static_cast<std::uint32_t>(all.points.size());
    all.points.insert(all.points.end(), part.points.begin(), part.points.end());
    for (ScanPlane plane : part.planes) {
      plane.begin += shift;
      plane.end += shift;
      all.planes.push_back(plane);
    }
  }
  return all;
}

}  // namespace adasplats
