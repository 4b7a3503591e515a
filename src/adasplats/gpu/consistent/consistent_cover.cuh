// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/splats/consistent/seed_growth.h"

namespace adasplats::gpu {

/// Private to gpu/: what kernels read and change of DeviceCover, by disk.
struct CoverView {
  Disk* seeds = nullptr;
  float* radii_m = nullptr;
  std::uint32_t* lists = nullptr;         ///< seeds that a disk covers
  const std::uint64_t* begins = nullptr;  ///< of a disk's list in `lists`
  std::uint32_t* lengths = nullptr;       ///< 0 for disks that are not there
  double overlap = 0;
  std::uint32_t size = 0;
};

/// Private to gpu/: SurfaceCover in device memory: the same disks, chosen in rounds. A disk is
/// chosen when none that comes before it in the greedy order and covers it is open any more; what
/// it covers of those that come after it is closed. So all that greed would choose one after the
/// other are chosen, many at a time.
class DeviceCover {
 public:
  /// `seeds`: device memory, one a point of `index` in its order, copied; without a radius: not
  /// there. `unchecked`: flags of seeds that have options.unchecked_sectors (null: none). Waits
  /// for the stream.
  /// Errors: usage (more neighbours than DevicePointIndex::kMaxNeighbors).
  DeviceCover(const Disk* seeds, const std::uint8_t* unchecked, const DevicePointIndex& index,
              const CoverOptions& options, cudaStream_t stream);

  /// The chosen disks, the others with no radius. Waits for the stream.
  DeviceBuffer<Disk> choose();
  /// How many rounds the last choose() took.
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
