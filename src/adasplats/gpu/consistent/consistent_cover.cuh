// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/splats/consistent/seed_growth.h"

namespace adasplats::gpu {

/// Private to gpu/: kernel view of DeviceCover, by disk.
struct CoverView {
  Disk* seeds = nullptr;
  float* radii_m = nullptr;
  std::uint32_t* lists = nullptr;         ///< seeds covered by a disk
  const std::uint64_t* begins = nullptr;  ///< of a disk's list in `lists`
  std::uint32_t* lengths = nullptr;       ///< 0 for absent disks
  double overlap = 0;
  std::uint32_t size = 0;
};

/// Private to gpu/: SurfaceCover in device memory. Chooses the same disks in parallel rounds: a
/// disk is chosen once no open disk that precedes it in the greedy order covers it, and then closes
/// the later disks that it covers. The result is that of the sequential greedy choice.
class DeviceCover {
 public:
  /// `seeds`: device memory, one per point of `index` in its order, copied; absent if they have no
  /// radius. `unchecked`: flags of seeds that have options.unchecked_sectors (null: none). Waits
  /// for the stream. Errors: usage (more neighbours than DevicePointIndex::kMaxNeighbors).
  DeviceCover(const Disk* seeds, const std::uint8_t* unchecked, const DevicePointIndex& index,
              const CoverOptions& options, cudaStream_t stream);

  /// All disks; those not chosen have no radius. Waits for the stream.
  DeviceBuffer<Disk> choose();
  /// Number of rounds of the last choose().
  int rounds() const { return rounds_; }

  CoverView view() const;
  CoverLimits limits() const { return {seeds_.data(), radii_m_.data()}; }
  const DeviceBuffer<float>& radii_m() const { return radii_m_; }

 private:
  cudaStream_t stream_;
  double overlap_;
  DeviceBuffer<Disk> seeds_;
  DeviceBuffer<float> radii_m_;
  DeviceBuffer<std::uint32_t> lists_;
  DeviceBuffer<std::uint64_t> begins_;
  DeviceBuffer<std::uint32_t> lengths_;
  int rounds_ = 0;
};

}  // namespace adasplats::gpu
