// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "adasplats/calibrate/scan_planes.h"
#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/symmetric_eigen.h"

namespace adasplats {

// Steps of the plane search for one element, in the order of PlaneSearchOn. Each writes only the
// data of element `i`, so a parallel loop on any device can run it (for_each of a backend).

inline constexpr int kCellBitsOfAxis = 21;
inline constexpr double kMaxCellsOfAxis = double{1 << kCellBitsOfAxis} - 1;

/// Spreads 21 bits to every third bit.
ADASPLATS_HD inline std::uint64_t every_third_bit(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  return (v | v << 2) & 0x1249249249249249ULL;
}

struct LowestCorner {
  Vec3d low = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity()};

  ADASPLATS_HD LowestCorner& operator+=(const LowestCorner& other) {
    low = min(low, other.low);
    return *this;
  }
};

struct FindLowestCorner {
  const Vec3d* positions;

  ADASPLATS_HD void operator()(std::size_t i, LowestCorner& corner) const {
    corner.low = min(corner.low, positions[i]);
  }
};

/// Morton keys of the smallest cells; a larger cell is a run of keys.
struct MakeCellKey {
  const Vec3d* positions;
  Vec3d low;
  double cell_m;
  std::uint64_t* keys;

  ADASPLATS_HD void operator()(std::size_t i) const {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::floor((positions[i][axis] - low[axis]) / cell_m);
      const double held = cell > 0 ? (cell < kMaxCellsOfAxis ? cell : kMaxCellsOfAxis) : 0;
      key |= every_third_bit(static_cast<std::uint64_t>(held)) << axis;
    }
    keys[i] = key;
  }
};

/// Flags where sorted keys change in more than their low `bits`.
struct FlagRunBegin {
  const std::uint64_t* keys;
  int bits;
  std::uint8_t* flags;

  ADASPLATS_HD void operator()(std::size_t i) const {
    flags[i] = i == 0 || keys[i] >> bits != keys[i - 1] >> bits ? 1 : 0;
  }
};

/// Points [begin, end) of a cell, in the order of the keys.
struct CellRun {
  std::uint32_t begin, end;
};

struct MakeCellRun {
  const std::uint32_t* begins;
  std::size_t count;
  std::uint32_t points;
  CellRun* runs;

  ADASPLATS_HD void operator()(std::size_t r) const {
    runs[r] = {begins[r], r + 1 < count ? begins[r + 1] : points};
  }
};

/// Lower bound of `key` in the sorted keys [begin, end).
ADASPLATS_HD inline std::uint32_t first_not_less(const std::uint64_t* keys, std::uint32_t begin,
                                                 std::uint32_t end, std::uint64_t key) {
  while (begin < end) {
    const std::uint32_t middle = begin + (end - begin) / 2;
    if (keys[middle] < key)
      begin = middle + 1;
    else
      end = middle;
  }
  return begin;
}

/// Splits cells without a plane into eight; `bits`: bits of the keys within one of the eight.
struct DivideCell {
  const std::uint64_t* keys;
  const CellRun* runs;
  const std::uint32_t* divided;  ///< which runs
  int bits;
  CellRun* parts;

  ADASPLATS_HD void operator()(std::size_t i) const {
    const CellRun run = runs[divided[i / 8]];
    const std::uint64_t part = keys[run.begin] >> (bits + 3) << 3 | i % 8;
    const std::uint32_t begin = first_not_less(keys, run.begin, run.end, part << bits);
    parts[i] = {begin, first_not_less(keys, begin, run.end, (part + 1) << bits)};
  }
};

struct FlagLargeRun {
  const CellRun* runs;
  std::uint32_t min_points;
  std::uint8_t* flags;

  ADASPLATS_HD void operator()(std::size_t r) const {
    flags[r] = runs[r].end - runs[r].begin >= min_points ? 1 : 0;
  }
};

/// Fits a plane to the points of a cell and tests its flatness.
struct FitCell {
  static constexpr std::size_t kGrain = 64;

  const Vec3d* positions;
  const std::uint32_t* scans;
  const std::uint32_t* order;
  ScanPlaneOptions options;
  const CellRun* runs;
  const std::uint32_t* large;  ///< which runs
  ScanPlane* planes;
  std::uint8_t* is_plane;
  std::uint8_t* is_none;

  ADASPLATS_HD void operator()(std::size_t i) const {
    const CellRun run = runs[large[i]];
    const bool found = has_scans(run) && fit(run, planes[i]);
    is_plane[i] = found ? 1 : 0;
    is_none[i] = found ? 0 : 1;
  }

 private:
  ADASPLATS_HD bool has_scans(CellRun run) const {
    const std::uint32_t first = scans[order[run.begin]];
    for (std::uint32_t k = run.begin + 1; k < run.end; ++k)
      if (scans[order[k]] != first) return true;
    return false;
  }

  ADASPLATS_HD bool fit(CellRun run, ScanPlane& plane) const {
    const double n = static_cast<double>(run.end - run.begin);
    Vec3d mean;
    for (std::uint32_t k = run.begin; k < run.end; ++k) mean = mean + positions[order[k]];
    mean = mean / n;
    SymmetricMat3d spread{};
    for (std::uint32_t k = run.begin; k < run.end; ++k) {
      const Vec3d d = positions[order[k]] - mean;
      spread.xx += d.x * d.x;
      spread.xy += d.x * d.y;
      spread.xz += d.x * d.z;
      spread.yy += d.y * d.y;
      spread.yz += d.y * d.z;
      spread.zz += d.z * d.z;
    }
    const SymmetricEigen eigen = symmetric_eigen(spread);
    const double across_m = std::sqrt(eigen.values[2] > 0 ? eigen.values[2] / n : 0.0);
    const double along_m = std::sqrt(eigen.values[1] > 0 ? eigen.values[1] / n : 0.0);
    if (!(across_m <= options.flatness_m) || !(across_m <= options.shape * along_m)) return false;
    plane = {mean, eigen.vectors[2], {eigen.vectors[0], eigen.vectors[1]}, run.begin, run.end};
    return true;
  }
};

template <class T>
struct PickValue {
  const T* from;
  const std::uint32_t* at;
  T* to;

  ADASPLATS_HD void operator()(std::size_t i) const { to[i] = from[at[i]]; }
};

template <class T>
struct CopyValue {
  const T* from;
  T* to;

  ADASPLATS_HD void operator()(std::size_t i) const { to[i] = from[i]; }
};

struct KeyOfPlane {
  const ScanPlane* planes;
  std::uint64_t* keys;

  ADASPLATS_HD void operator()(std::size_t p) const { keys[p] = planes[p].begin; }
};

}  // namespace adasplats
