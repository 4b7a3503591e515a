// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "adasplats/calibrate/cell_steps.h"
#include "adasplats/calibrate/scan_planes.h"

namespace adasplats {

/// find_scan_planes() for all devices; the code for one element is in cell_steps.h. `Backend` is
/// CpuArrays or gpu::GpuBackend. Memory is reused by the next search.
template <class Backend>
class PlaneSearchOn {
 public:
  template <class T>
  using Array = typename Backend::template Array<T>;

  explicit PlaneSearchOn(const Backend& backend) : backend_(backend) {}

  /// Finds the planes of `count` points, at most 2^31.
  void run(const Vec3d* positions, const std::uint32_t* scans, std::size_t count,
           const ScanPlaneOptions& options) {
    order_points(positions, count, options.largest_cell_m / (1 << kHalvings));
    Array<CellRun> runs = largest_cells(count);
    std::vector<Array<ScanPlane>> found;
    for (int halvings = kHalvings;; --halvings) {
      Array<std::uint32_t> divided = judge(runs, positions, scans, options, found);
      if (halvings == 0 || divided.size() == 0) break;
      Array<CellRun> parts = backend_.template array<CellRun>(8 * divided.size());
      backend_.for_each(
          parts.size(), "divide cells",
          DivideCell{keys_.data(), runs.data(), divided.data(), 3 * (halvings - 1), parts.data()});
      runs = std::move(parts);
    }
    join(found);
  }

  /// Planes of the last search, sorted by their begin in order().
  const Array<ScanPlane>& planes() const { return planes_; }
  const Array<std::uint32_t>& order() const { return order_; }
  Array<ScanPlane> take_planes() { return std::move(planes_); }
  Array<std::uint32_t> take_order() { return std::move(order_); }

 private:
  static constexpr int kHalvings = 3;

  void order_points(const Vec3d* positions, std::size_t count, double cell_m) {
    const Vec3d low =
        backend_.template sum<LowestCorner>(count, "find the corner", FindLowestCorner{positions})
            .low;
    backend_.resize(keys_, count);
    backend_.for_each(count, "find cells", MakeCellKey{positions, low, cell_m, keys_.data()});
    backend_.sort(keys_, order_);
  }

  Array<CellRun> largest_cells(std::size_t count) {
    backend_.resize(flags_, count);
    backend_.for_each(count, "find cells",
                      FlagRunBegin{keys_.data(), 3 * kHalvings, flags_.data()});
    const Array<std::uint32_t> begins = backend_.flagged(flags_);
    Array<CellRun> runs = backend_.template array<CellRun>(begins.size());
    backend_.for_each(
        runs.size(), "find cells",
        MakeCellRun{begins.data(), begins.size(), static_cast<std::uint32_t>(count), runs.data()});
    return runs;
  }

  /// Adds the planes of these cells to `found` and returns the cells to be divided.
  Array<std::uint32_t> judge(const Array<CellRun>& runs, const Vec3d* positions,
                             const std::uint32_t* scans, const ScanPlaneOptions& options,
                             std::vector<Array<ScanPlane>>& found) const {
    Array<std::uint8_t> is_large = backend_.template array<std::uint8_t>(runs.size());
    backend_.for_each(runs.size(), "find cells",
                      FlagLargeRun{runs.data(), options.min_points, is_large.data()});
    const Array<std::uint32_t> large = backend_.flagged(is_large);
    Array<ScanPlane> planes = backend_.template array<ScanPlane>(large.size());
    Array<std::uint8_t> is_plane = backend_.template array<std::uint8_t>(large.size());
    Array<std::uint8_t> is_none = backend_.template array<std::uint8_t>(large.size());
    backend_.for_each(large.size(), "fit planes",
                      FitCell{positions, scans, order_.data(), options, runs.data(), large.data(),
                              planes.data(), is_plane.data(), is_none.data()});
    found.push_back(picked(planes, backend_.flagged(is_plane)));
    return picked(large, backend_.flagged(is_none));
  }

  void join(const std::vector<Array<ScanPlane>>& found) {
    std::size_t count = 0;
    for (const Array<ScanPlane>& part : found) count += part.size();
    Array<ScanPlane> all = backend_.template array<ScanPlane>(count);
    std::size_t at = 0;
    for (const Array<ScanPlane>& part : found) {
      backend_.for_each(part.size(), "join planes",
                        CopyValue<ScanPlane>{part.data(), all.data() + at});
      at += part.size();
    }
    Array<std::uint64_t> begins = backend_.template array<std::uint64_t>(count);
    backend_.for_each(count, "order planes", KeyOfPlane{all.data(), begins.data()});
    planes_ = picked(all, backend_.sort(begins));
  }

  template <class T>
  Array<T> picked(const Array<T>& values, const Array<std::uint32_t>& at) const {
    Array<T> result = backend_.template array<T>(at.size());
    backend_.for_each(at.size(), "join planes",
                      PickValue<T>{values.data(), at.data(), result.data()});
    return result;
  }

  const Backend& backend_;
  Array<std::uint64_t> keys_;  ///< of the points, sorted
  Array<std::uint32_t> order_;
  Array<std::uint8_t> flags_;
  Array<ScanPlane> planes_;
};

}  // namespace adasplats
