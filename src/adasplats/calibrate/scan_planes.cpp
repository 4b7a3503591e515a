// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/scan_planes.h"

#include "adasplats/calibrate/plane_search_on.h"
#include "adasplats/core/cpu_arrays.h"

namespace adasplats {

ScanPlanes find_scan_planes(std::span<const Vec3d> positions, std::span<const std::uint32_t> scans,
                            const ScanPlaneOptions& options, const Executor& executor) {
  const CpuArrays backend(executor);
  PlaneSearchOn<CpuArrays> search(backend);
  search.run(positions.data(), scans.data(), positions.size(), options);
  return {search.take_planes(), search.take_order()};
}

}  // namespace adasplats
