// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "adasplats/simulate/scan/scan.h"

namespace adasplats {

/// Where the attributes of returns are, in host or device memory; null: not there. The names are
/// Scan's, so that for_each_scan_attribute() knows them.
struct ReturnArrays {
  Vec3f* positions = nullptr;
  float* ranges_m = nullptr;
  float* intensities = nullptr;
  std::uint16_t* classes = nullptr;
  std::uint16_t* instances = nullptr;
  std::uint16_t* rings = nullptr;
  std::uint32_t* columns = nullptr;
  float* times_s = nullptr;
  std::uint8_t* return_indices = nullptr;
};

/// Arrays of `returns` values in one block of memory at `base`, each on a border of 256 bytes.
/// `bytes` is the size of the block; with a null `base` only that is of use.
struct ReturnLayout {
  ReturnArrays arrays;
  std::size_t bytes = 0;

  ReturnLayout(const ScanFields& fields, std::size_t returns, std::uint8_t* base);
};

/// Scans of a run whose returns stand one behind the other.
struct ScanBatch {
  std::size_t first = 0;  ///< scan of the run
  /// Returns of scan first + i are [offsets[i], offsets[i + 1]).
  std::vector<std::uint32_t> offsets;
  ReturnArrays arrays;
  int device = -1;               ///< CUDA's number of it; -1: host memory
  std::shared_ptr<void> memory;  ///< of the arrays, as long as anyone holds it

  std::size_t scans() const { return offsets.size() - 1; }
  std::size_t returns() const { return offsets.back(); }
};

/// A batch of one scan, scan `first` of a run, whose arrays it takes.
ScanBatch batch_of(std::size_t first, Scan&& scan);

}  // namespace adasplats
