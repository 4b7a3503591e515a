// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if !defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/consistent/consistent_cuda.h"

namespace adasplats::gpu {

std::unique_ptr<ConsistentSteps> make_cuda_consistent_steps(int) {
  throw Error(ErrorKind::unavailable, "cannot build models on a GPU: " + find_gpus().reason);
}

Reflectances measure_reflectances(int, const std::vector<Disk>&, const std::vector<float>&,
                                  const PointCloud&) {
  throw Error(ErrorKind::unavailable, "cannot build models on a GPU: " + find_gpus().reason);
}

}  // namespace adasplats::gpu
#endif
