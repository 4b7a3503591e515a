// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "adasplats/simulate/scan/scan.h"

namespace adasplats {

/// Arrays of the attributes of returns, in host or device memory; null: absent. The names are those
/// of Scan, for for_each_scan_attribute().
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

/// Arrays of `returns` values in one block of memory at `base`, each aligned to 256 bytes. `bytes`
/// is the size of the block; with a null `base`, only the size is valid.
struct ReturnLayout {
  ReturnArrays arrays;
  std::size_t bytes = 0;

  ReturnLayout(const ScanFields& fields, std::size_t returns, std::uint8_t* base);
};

/// Consecutive scans of a run with contiguous returns.
struct ScanBatch {
  std::size_t first = 0;  ///< first scan, numbered within the run
  /// Returns of scan first + i are [offsets[i], offsets[i + 1]).
  std::vector<std::uint32_t> offsets;
  ReturnArrays arrays;
  int device = -1;               ///< CUDA device number; -1: host memory
  std::shared_ptr<void> memory;  ///< shared ownership of the arrays

  std::size_t scans() const { return offsets.size() - 1; }
  std::size_t returns() const { return offsets.back(); }
};

/// A batch of one scan, scan `first` of a run; takes its arrays.
ScanBatch batch_of(std::size_t first, Scan&& scan);

}  // namespace adasplats
