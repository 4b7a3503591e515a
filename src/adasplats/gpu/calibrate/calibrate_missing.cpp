// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if !defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/calibrate/gpu_calibrate.h"

namespace adasplats {

std::unique_ptr<CalibrationSteps> make_cuda_calibration_steps(int) {
  throw Error(ErrorKind::unavailable, "cannot calibrate on a GPU: " + find_gpus().reason);
}

}  // namespace adasplats
#endif
